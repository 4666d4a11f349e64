#include "tools/ray_files.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "base/safe_file.h"

namespace sconce::tools
{

namespace
{

constexpr const char* kRaysHeader = "ox,oy,oz,dx,dy,dz";
constexpr const char* kRaysWithNormalsHeader = "ox,oy,oz,dx,dy,dz,nx,ny,nz";
constexpr const char* kHitsHeader = "status,t,x,y,z,nx,ny,nz,r,g,b,probe,handoffs,distance_fetches,index_fetches";

/// One number, which may be followed by spaces; false when it is not one. Beyond the range of float it becomes infinite or zero.
bool parseNumber(const char*& at, const char* end, float& value)
{
    while (at != end && (*at == ' ' || *at == '\t')) ++at;
    if (at != end && *at == '+') ++at;
    double number = 0.0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error == std::errc::result_out_of_range)
    {
        // Too small by a negative exponent, or by zeros after the point; else too large.
        const std::string_view text(at, size_t(next - at));
        const size_t exponent = text.find_first_of("eE");
        const bool small = exponent != text.npos ? text[exponent + 1] == '-' : text.find('.') < text.find_first_of("123456789");
        number = std::copysign(small ? 0.0 : std::numeric_limits<double>::infinity(), text.front() == '-' ? -1.0 : 1.0);
    }
    else if (error != std::errc{})
        return false;
    value = float(number);
    at = next;
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\r')) ++at;
    return true;
}

/// Scaled first, so that neither a tiny nor a huge direction is lost on the way to unit length.
glm::vec3 unitOrZero(glm::vec3 d)
{
    const float largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    return std::isfinite(d.x) && std::isfinite(d.y) && std::isfinite(d.z) && largest > 0.0f ? glm::normalize(d / largest) : glm::vec3(0.0f);
}

void append(std::string& text, float value)
{
    char digits[32];
    const auto [end, error] = std::to_chars(digits, digits + sizeof(digits), std::isfinite(value) ? value : 0.0f);
    text += ',';
    text.append(digits, end);
}

void append(std::string& text, glm::vec3 v)
{
    append(text, v.x), append(text, v.y), append(text, v.z);
}

} // namespace

Result<std::vector<gpu::Ray>> readRays(const std::filesystem::path& file)
{
    std::ifstream stream(file);
    std::string line;
    if (!stream || !std::getline(stream, line))
        return Error{ErrorCode::fileError,
                     fmt::format("Cannot read rays from '{}'; give a CSV file with a header and a ray a line.", file.string())};
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const int columns = line == kRaysWithNormalsHeader ? 9 : 6;
    if (columns == 6 && line != kRaysHeader)
        return Error{ErrorCode::badInput, fmt::format("Rays file '{}' begins with '{}' instead of the header {} or {}.", file.string(),
                                                      line.substr(0, 60), kRaysHeader, kRaysWithNormalsHeader)};
    std::vector<gpu::Ray> rays;
    for (size_t number = 2; std::getline(stream, line); ++number)
    {
        if (line.empty() || line == "\r") continue;
        gpu::Ray ray{};
        const char *at = line.data(), *end = line.data() + line.size();
        bool good = true;
        for (int column = 0; column < columns && good; ++column)
        {
            glm::vec3& vector = column < 3 ? ray.origin : (column < 6 ? ray.direction : ray.normal);
            float& value = vector[column % 3];
            good = (column == 0 || (at != end && *at++ == ',')) && parseNumber(at, end, value);
        }
        if (!good || at != end)
            return Error{ErrorCode::badInput, fmt::format("Line {} of '{}' is '{}' instead of {} numbers separated by commas.", number,
                                                          file.string(), line.substr(0, 60), columns == 9 ? "nine" : "six")};
        ray.direction = unitOrZero(ray.direction);
        ray.normal = unitOrZero(ray.normal);
        rays.push_back(ray);
    }
    if (stream.bad()) return Error{ErrorCode::fileError, fmt::format("Reading '{}' failed after {} rays.", file.string(), rays.size())};
    return rays;
}

Status writeHits(std::span<const gpu::RayHit> hits, const std::filesystem::path& file)
{
    static constexpr const char* kNames[] = {"miss", "hit", "unknown"}; // in the order of gpu::RayHit::status;
    Result<SafeFile> target = SafeFile::create(file);
    if (!target) return target.error();
    std::string text = fmt::format("{}\n", kHitsHeader);
    const auto flush = [&]
    {
        const Status status = target->append(std::as_bytes(std::span(text)));
        text.clear();
        return status;
    };
    for (const gpu::RayHit& hit : hits)
    {
        text += kNames[hit.status];
        append(text, hit.t);
        append(text, hit.position);
        append(text, hit.normal);
        append(text, hit.radiance);
        for (const int count : {hit.probe == gpu::kNoProbe ? -1 : int(hit.probe), hit.handoffs, hit.distanceReads, hit.indexReads})
            text += fmt::format(",{}", count);
        text += '\n';
        if (text.size() > (1u << 20))
            if (Status status = flush(); !status) return status;
    }
    if (Status status = flush(); !status) return status;
    return target->commit();
}

} // namespace sconce::tools
