#include "bench/report/report_page.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include "base/safe_file.h"
#include "embedded/report_template.h"

namespace sconce
{

namespace
{

using Json = nlohmann::ordered_json;

/// JSON that can stand in a <script>: the only way out of one is a '<', and in JSON that stands in strings alone.
std::string scriptSafe(const Json& json)
{
    const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string safe;
    safe.reserve(text.size());
    for (const char c : text)
    {
        if (c == '<')
            safe += "\\u003c";
        else
            safe += c;
    }
    return safe;
}

/// The same for an attribute in double quotes.
std::string attributeSafe(std::string_view text)
{
    std::string safe;
    for (const char c : text)
    {
        if (c == '&')
            safe += "&amp;";
        else if (c == '"')
            safe += "&quot;";
        else
            safe += c;
    }
    return safe;
}

/// RFC 4648.
std::string base64(const std::vector<uint8_t>& bytes)
{
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text((bytes.size() + 2) / 3 * 4, '=');
    for (size_t i = 0; i < bytes.size(); i += 3)
    {
        const size_t present = std::min<size_t>(3, bytes.size() - i);
        uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k) word = word << 8 | (k < present ? bytes[i + k] : 0u);
        for (size_t k = 0; k <= present; ++k) text[i / 3 * 4 + k] = digits[word >> (18 - 6 * k) & 63];
    }
    return text;
}

void collectImages(const Json& owner, std::set<std::string>& files)
{
    const auto images = owner.find("images");
    if (images == owner.end() || !images->is_object()) return;
    for (const Json& file : *images)
        if (file.is_string()) files.insert(file.get<std::string>());
}

/// Every image file that the results name, once.
std::set<std::string> imageFiles(const Json& results)
{
    std::set<std::string> files;
    const auto listIn = [](const Json& owner, const char* name)
    { return owner.is_object() && owner.contains(name) && owner[name].is_array() ? owner[name] : Json::array(); };
    for (const Json& scene : listIn(results, "scenes"))
    {
        if (scene.is_object() && scene.contains("reference") && scene["reference"].is_object()) collectImages(scene["reference"], files);
        for (const Json& point : listIn(scene, "points"))
            if (point.is_object()) collectImages(point, files);
    }
    return files;
}

/// The header (docs/formats.md) and as many pixels as it says.
bool isWholeImage(const std::vector<uint8_t>& bytes)
{
    struct
    {
        char magic[4];
        uint32_t width, height, kind;
    } header;
    if (bytes.size() < sizeof header) return false;
    std::memcpy(&header, bytes.data(), sizeof header);
    if (std::memcmp(header.magic, "SCNI", 4) != 0 || header.kind > 1) return false;
    const uint64_t pixel = header.kind == 0 ? 6 : 4, pixels = bytes.size() - sizeof header; // bytes
    return pixels % pixel == 0 && pixels / pixel == uint64_t(header.width) * header.height;
}

Result<std::vector<uint8_t>> readImage(const std::filesystem::path& folder, const std::string& name)
{
    const std::filesystem::path relative = std::filesystem::path(name).lexically_normal();
    if (relative.empty() || relative.is_absolute() || *relative.begin() == "..")
        return Error{ErrorCode::badInput,
                     fmt::format("Report: the image '{}' lies outside the folder of results.json; name it relative to that folder.", name)};
    const std::string path = (folder / relative).string();
    std::ifstream file(path, std::ios::binary);
    if (!file) return Error{ErrorCode::fileError, fmt::format("Report: the image {} that results.json names can't be read.", path)};
    std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (file.bad()) return Error{ErrorCode::fileError, fmt::format("Report: reading the image {} failed.", path)};

    if (!isWholeImage(bytes))
        return Error{ErrorCode::badInput, fmt::format("Report: {} is no report image, or cut short; measure that point again.", path)};
    return bytes;
}

/// zlib's format (RFC 1950), which browsers call "deflate".
std::vector<uint8_t> deflated(const std::vector<uint8_t>& bytes)
{
    uLongf size = compressBound(uLong(bytes.size()));
    std::vector<uint8_t> packed(size);
    compress2(packed.data(), &size, bytes.data(), uLong(bytes.size()), Z_DEFAULT_COMPRESSION); // can't fail: the bound is large enough
    packed.resize(size);
    return packed;
}

} // namespace

Status writeReportPage(const nlohmann::ordered_json& results, const std::filesystem::path& folder)
{
    const std::string_view page(reinterpret_cast<const char*>(report_template), sizeof report_template);
    constexpr std::string_view mark = "<!--sconce:data-->"; // build.mjs sees to it that the template has it once
    const size_t place = page.find(mark);

    const std::filesystem::path target = folder / "report" / "index.html";
    std::error_code failed;
    std::filesystem::create_directories(target.parent_path(), failed);
    if (failed)
        return Error{ErrorCode::fileError,
                     fmt::format("Report: the folder {} can't be made: {}.", target.parent_path().string(), failed.message())};
    Result<SafeFile> file = SafeFile::create(target);
    if (!file) return file.error();
    const auto append = [&](std::string_view text) { return file->append(std::as_bytes(std::span(text))); };

    if (const Status done = append(page.substr(0, place)); !done) return done;
    if (const Status done = append(fmt::format("<script type=\"application/json\" id=\"results\">{}</script>\n", scriptSafe(results)));
        !done)
        return done;
    for (const std::string& name : imageFiles(results))
    {
        const Result<std::vector<uint8_t>> bytes = readImage(folder, name);
        if (!bytes) return bytes.error();
        const std::string script = fmt::format("<script type=\"application/octet-stream\" data-name=\"{}\">{}</script>\n",
                                               attributeSafe(name), base64(deflated(*bytes)));
        if (const Status done = append(script); !done) return done;
    }
    if (const Status done = append(page.substr(place + mark.size())); !done) return done;
    return file->commit();
}

} // namespace sconce
