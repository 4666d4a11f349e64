#include "bench/race/ray_file.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include "base/safe_file.h"

namespace sconce
{
namespace
{

static_assert(std::endian::native == std::endian::little, "the file is little endian and written as it lies in memory");

constexpr uint32_t kVersion = 3;
constexpr float kMissed = -1.0f;
constexpr uint32_t kNoViewpoint = ~0u;

struct Header
{
    char magic[4] = {'S', 'C', 'N', 'R'};
    uint32_t version = kVersion;
    uint32_t rays = 0;
    float diagonal = 0.0f;
    uint32_t unused[4] = {};
};
static_assert(sizeof(Header) == 32);

struct Record
{
    vec3 origin, direction, normal;
    float truth, fartherTruth; // metres
    uint32_t viewpoint;
};
static_assert(sizeof(Record) == 48);

float recorded(const RayTruth& truth)
{
    return truth.hit ? truth.t : kMissed;
}
RayTruth truthFrom(float distance)
{
    RayTruth truth;
    truth.hit = distance >= 0.0f;
    truth.t = truth.hit ? distance : 0.0f;
    return truth;
}

Error damaged(const std::filesystem::path& file, const char* what)
{
    return {ErrorCode::badInput, fmt::format("File '{}' {}; record the rays again.", file.string(), what)};
}

} // namespace

Status saveRays(const RaySet& set, const std::filesystem::path& file)
{
    assert(set.truth.size() == set.size() && set.fartherTruth.size() == set.size());
    Header header;
    header.rays = uint32_t(set.size());
    header.diagonal = set.diagonal;
    std::vector<Record> records(set.size());
    for (size_t i = 0; i < set.size(); ++i)
        records[i] = {set.origins[i],
                      set.directions[i],
                      set.normals[i],
                      recorded(set.truth[i]),
                      recorded(set.fartherTruth[i]),
                      set.viewpoints.empty() ? kNoViewpoint : set.viewpoints[i]};
    auto target = SafeFile::create(file);
    if (!target) return target.error();
    if (auto status = target->append(std::as_bytes(std::span(&header, 1))); !status) return status;
    if (auto status = target->append(std::as_bytes(std::span(records))); !status) return status;
    return target->commit();
}

Result<RaySet> loadRays(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return Error{ErrorCode::fileError, fmt::format("File '{}' can't be read.", file.string())};
    Header header, expected;
    if (!stream.read(reinterpret_cast<char*>(&header), sizeof header) ||
        std::memcmp(header.magic, expected.magic, sizeof header.magic) != 0)
        return damaged(file, "holds no rays");
    if (header.version != kVersion) return damaged(file, "has another version");
    std::error_code problem;
    // The length before the records: a made-up number of rays must not be allocated.
    const uintmax_t bytes = std::filesystem::file_size(file, problem);
    if (problem || bytes != sizeof(Header) + uintmax_t(header.rays) * sizeof(Record)) return damaged(file, "is not as long as it says");
    if (!(header.diagonal > 0.0f && std::isfinite(header.diagonal))) return damaged(file, "has no diagonal");
    std::vector<Record> records(header.rays);
    if (!stream.read(reinterpret_cast<char*>(records.data()), std::streamsize(records.size() * sizeof(Record))))
        return damaged(file, "can't be read to its end");
    RaySet set;
    set.diagonal = header.diagonal;
    for (const Record& record : records)
    {
        // Every number at once: a single one that is none would go unnoticed into the scores of all tracers.
        float numbers[offsetof(Record, viewpoint) / sizeof(float)];
        std::memcpy(numbers, &record, sizeof numbers);
        for (const float number : numbers)
            if (!std::isfinite(number)) return damaged(file, "has numbers that are not finite");
        set.origins.push_back(record.origin);
        set.directions.push_back(record.direction);
        set.normals.push_back(record.normal);
        if (record.viewpoint != kNoViewpoint) set.viewpoints.push_back(record.viewpoint);
        set.truth.push_back(truthFrom(record.truth));
        set.fartherTruth.push_back(truthFrom(record.fartherTruth));
    }
    if (!set.viewpoints.empty() && set.viewpoints.size() != set.size()) return damaged(file, "has viewpoints for some rays alone");
    set.startCosine.assign(set.size(), 1.0f);
    return set;
}

} // namespace sconce
