#include "bench/opponents/irradiance_volume.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include "base/parallel.h"
#include "bench/reference/path_tracer.h"
#include "runtime/field/field_space.h"
#include "shaders/shared/pure.h"
#include "spirv/gather_volume_ddgi.h"
#include "spirv/gather_volume_ddgi_placed.h"
#include "spirv/gather_volume_sh.h"

namespace sconce
{
namespace
{

constexpr uint32_t kFixedRays = 32;        // by which probes are moved and told to stand in solids
constexpr float kSolidShare = 0.25f;       // of them that meet back faces
constexpr float kClearance = 1.0f;         // metres to the nearest surface that a moved probe is after
constexpr float kFarthestMove = 0.45f;     // of the grid's step
constexpr uint32_t kMoves = 32;            // at most; each is one of what ships makes a frame
constexpr float kFarthestSeen = 1.5f;      // of the diagonal between neighbours: distances beyond are the same
constexpr float kDistanceExponent = 50.0f; // of the cosine that distances are averaged by
// Of all probes, and of one: DDGI's blending by 0.97 of what was before is a mean over some (1 + 0.97) / (1 - 0.97) frames of 256 rays.
constexpr uint32_t kRaysOfAll = 1u << 24, kFewestRays = 1024, kMostRays = 16384;
constexpr float kBackShare = 0.2f; // of its distance that a back face counts as, so that probes in solids see little
constexpr size_t kBatch = 64;      // probes between two reports

struct Entry
{
    std::string_view name;
    Spirv pass;
    uint32_t words; // a probe
};

const Entry& entryOf(Volume volume)
{
    static const Entry table[] = {{"ddgi", gather_volume_ddgi, gpu::kDdgiWords},
                                  {"ddgi-placed", gather_volume_ddgi_placed, gpu::kDdgiWords},
                                  {"sh-grid", gather_volume_sh, gpu::kShWords}};
    return table[uint32_t(volume)];
}

/// Evenly over the sphere (spherical Fibonacci, Keinert et al. 2015).
vec3 evenDirection(uint32_t i, uint32_t count)
{
    const float y = 1.0f - (2.0f * float(i) + 1.0f) / float(count), radius = std::sqrt(std::max(0.0f, 1.0f - y * y));
    const float angle = 2.0f * std::numbers::pi_v<float> * std::fmod(float(i) * 0.618033989f, 1.0f);
    return {radius * std::cos(angle), y, radius * std::sin(angle)};
}

/// What a fixed ray meets.
struct Met
{
    float t = std::numeric_limits<float>::infinity();
    bool back = false;
};

class Filler
{
public:
    Filler(const RayScene& scene, Volume kind, const VolumeSettings& wanted, vec3 gridStep)
        : rays(scene), tracer(scene, {}, wanted.bounces == 0 ? kStraight : wanted.bounces - 1), settings(wanted), volume(kind),
          step(gridStep), hasSolids(wanted.solids)
    {
    }

    /// Moved out of solids and off surfaces, Majercik et al. 2021, section 5.
    vec3 relocated(vec3 place) const
    {
        vec3 offset(0.0f);
        for (uint32_t i = 0; i < kMoves; ++i)
        {
            const vec3 next = movedOnce(place + offset, offset);
            const vec3 share = next / step;
            if (!(glm::dot(share, share) < kFarthestMove * kFarthestMove) || next == offset) break;
            offset = next;
        }
        return place + offset;
    }

    bool inSolid(vec3 place) const
    {
        uint32_t backs = 0;
        for (uint32_t i = 0; i < kFixedRays; ++i) backs += meet(place, evenDirection(i, kFixedRays)).back ? 1 : 0;
        return float(backs) > kSolidShare * float(kFixedRays);
    }

    /// @param words  of this probe
    void fill(vec3 place, float scale, uint64_t probe, std::span<uint32_t> words) const
    {
        const std::vector<Seen> seen = look(place, probe);
        if (volume == Volume::sh)
            harmonics(seen, words);
        else
            maps(seen, scale, words);
    }

private:
    struct Seen
    {
        vec3 direction{0.0f}, light{0.0f};
        float distance = 0.0f; // metres
        bool back = false;
    };

    Met meet(vec3 place, vec3 direction) const
    {
        const auto hit = rays.closest(place, direction);
        if (!hit) return {};
        return {hit->t, hasSolids && glm::dot(hit->geometricNormal, direction) > 0.0f};
    }

    vec3 movedOnce(vec3 place, vec3 offset) const
    {
        Met nearestBack, nearest, farthest{0.0f};
        vec3 toBack(0.0f), toNearest(0.0f), toFarthest(0.0f);
        uint32_t backs = 0;
        for (uint32_t i = 0; i < kFixedRays; ++i)
        {
            const vec3 direction = evenDirection(i, kFixedRays);
            const Met met = meet(place, direction);
            if (met.back)
            {
                ++backs;
                if (met.t < nearestBack.t) nearestBack = met, toBack = direction;
                continue;
            }
            if (met.t < nearest.t) nearest = met, toNearest = direction;
            if (met.t > farthest.t) farthest = met, toFarthest = direction;
        }
        const float clearance = std::min(kClearance, kFarthestMove * std::min({step.x, step.y, step.z}));
        if (float(backs) > kSolidShare * float(kFixedRays)) return offset + toBack * (nearestBack.t + 0.5f * clearance);
        if (nearest.t < clearance)
            return glm::dot(toNearest, toFarthest) <= 0.0f ? offset + toFarthest * std::min(farthest.t, 0.1f * clearance) : offset;
        const float away = glm::length(offset);
        const float back = std::min(nearest.t - clearance, away);
        return away > 0.0f && back > 1e-3f * clearance ? offset - back / away * offset : offset;
    }

    std::vector<Seen> look(vec3 place, uint64_t probe) const
    {
        // Turned at random, each probe its own way, so that no two miss the same small thing.
        Random turn(settings.seed, probe);
        const vec3 z = turn.direction(), x = glm::normalize(glm::cross(z, std::abs(z.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0)));
        const vec3 y = glm::cross(z, x);
        std::vector<Seen> seen(settings.rays);
        for (uint32_t i = 0; i < settings.rays; ++i)
        {
            Seen& s = seen[i];
            const vec3 d = evenDirection(i, settings.rays);
            s.direction = glm::normalize(d.x * x + d.y * y + d.z * z);
            s.distance = std::numeric_limits<float>::infinity();
            const auto hit = rays.closest(place, s.direction);
            if (!hit) continue; // the sky is among the frame's lights
            s.back = hasSolids && glm::dot(hit->geometricNormal, s.direction) > 0.0f;
            s.distance = s.back ? kBackShare * hit->t : hit->t;
            if (s.back) continue;
            Random random(settings.seed, probe, i);
            const PathLight light = tracer.trace(place, s.direction, random);
            s.light = light.direct - tracer.shade(*hit, -s.direction).emission + light.diffuse + light.glossy;
        }
        return seen;
    }

    void maps(const std::vector<Seen>& seen, float scale, std::span<uint32_t> words) const
    {
        const float farthest = kFarthestSeen * glm::length(step);
        for (uint32_t texel = 0; texel < gpu::kDdgiIrradianceSide * gpu::kDdgiIrradianceSide; ++texel)
        {
            const vec3 direction = directionOf(texel, gpu::kDdgiIrradianceSide);
            vec3 sum(0.0f);
            float weights = 1e-20f;
            for (const Seen& s : seen)
            {
                const float weight = std::max(glm::dot(s.direction, direction), 0.0f);
                if (s.back) continue;
                sum += weight * s.light;
                weights += weight;
            }
            const vec3 encoded = glm::pow(glm::max(sum / weights, vec3(0.0f)), vec3(1.0f / gpu::kDdgiGamma));
            words[2 * texel] = glm::packHalf2x16({encoded.x, encoded.y});
            words[2 * texel + 1] = glm::packHalf2x16({encoded.z, gpu::kVolumeValid});
        }
        const std::span<uint32_t> distances = words.subspan(2 * gpu::kDdgiIrradianceSide * gpu::kDdgiIrradianceSide);
        for (uint32_t texel = 0; texel < distances.size(); ++texel)
        {
            const vec3 direction = directionOf(texel, gpu::kDdgiDistanceSide);
            double mean = 0.0, square = 0.0, weights = 1e-20;
            for (const Seen& s : seen)
            {
                const double cosine = glm::dot(s.direction, direction);
                if (cosine <= 0.5) continue; // 0.5^50 = 1e-15
                const double weight = std::pow(cosine, double(kDistanceExponent)), r = std::min(s.distance, farthest) / scale;
                mean += weight * r, square += weight * r * r, weights += weight;
            }
            distances[texel] = glm::packHalf2x16({float(mean / weights), float(square / weights)});
        }
    }

    /// Ramamoorthi and Hanrahan 2001: radiance projected, each order times what the cosine leaves of it, by pi.
    void harmonics(const std::vector<Seen>& seen, std::span<uint32_t> words) const
    {
        double sums[27] = {};
        size_t fronts = 0;
        for (const Seen& s : seen)
        {
            if (s.back) continue;
            ++fronts;
            const double x = s.direction.x, y = s.direction.y, z = s.direction.z;
            const double basis[9] = {0.282095,
                                     0.488603 * y,
                                     0.488603 * z,
                                     0.488603 * x,
                                     1.092548 * x * y,
                                     1.092548 * y * z,
                                     0.315392 * (3 * z * z - 1),
                                     1.092548 * x * z,
                                     0.546274 * (x * x - y * y)};
            for (int i = 0; i < 27; ++i) sums[i] += basis[i / 3] * double(s.light[i % 3]);
        }
        float halves[28];
        for (int i = 0; i < 27; ++i)
        {
            const double cosine = i < 3 ? 1.0 : i < 12 ? 2.0 / 3.0 : 0.25;
            halves[i] = float(cosine * 4.0 * std::numbers::pi * sums[i] / double(std::max<size_t>(fronts, 1)));
        }
        halves[27] = gpu::kVolumeValid;
        for (uint32_t i = 0; i < gpu::kShWords; ++i) words[i] = glm::packHalf2x16({halves[2 * i], halves[2 * i + 1]});
    }

    static vec3 directionOf(uint32_t texel, uint32_t side)
    {
        return Pure<float>::directionFromOctahedral((vec2(texel % side, texel / side) + 0.5f) / float(side));
    }

    const RayScene& rays;
    PathTracer tracer;
    VolumeSettings settings;
    Volume volume;
    vec3 step; // metres
    bool hasSolids;
};

std::array<uint32_t, gpu::kVolumeHeaderWords> headerOf(float bias, float viewShare, float scale)
{
    return {std::bit_cast<uint32_t>(bias / scale), std::bit_cast<uint32_t>(bias * viewShare / scale)};
}

/// Marks a probe by its last half.
void setInSolid(Volume volume, std::span<uint32_t> words)
{
    words[volume == Volume::sh ? gpu::kShWords - 1 : 1] &= 0xffffu;
}

/// Probes in solids get the mean of their neighbours that are not, layer by layer, and count as free from then on.
void dilate(const glm::ivec3& count, std::vector<bool>& solid, std::span<uint32_t> words)
{
    const auto at = [&](glm::ivec3 p) { return size_t(p.x + count.x * (p.y + count.y * p.z)); };
    for (bool changed = true; changed;)
    {
        changed = false;
        std::vector<bool> next = solid;
        for (int z = 0; z < count.z; ++z)
            for (int y = 0; y < count.y; ++y)
                for (int x = 0; x < count.x; ++x)
                {
                    if (!solid[at({x, y, z})]) continue;
                    float sums[28] = {};
                    int neighbours = 0;
                    for (int i = 0; i < 27; ++i)
                    {
                        const glm::ivec3 p(x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1);
                        if (glm::any(glm::lessThan(p, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(p, count)) || solid[at(p)])
                            continue;
                        ++neighbours;
                        for (uint32_t w = 0; w < gpu::kShWords; ++w)
                        {
                            const glm::vec2 pair = glm::unpackHalf2x16(words[at(p) * gpu::kShWords + w]);
                            sums[2 * w] += pair.x, sums[2 * w + 1] += pair.y;
                        }
                    }
                    if (neighbours == 0) continue;
                    for (uint32_t w = 0; w < gpu::kShWords; ++w)
                        words[at({x, y, z}) * gpu::kShWords + w] =
                            glm::packHalf2x16(vec2(sums[2 * w], sums[2 * w + 1]) / float(neighbours));
                    next[at({x, y, z})] = false;
                    changed = true;
                }
        solid = std::move(next);
    }
}

} // namespace

std::string_view volumeName(Volume volume)
{
    return entryOf(volume).name;
}

std::optional<Volume> volumeNamed(std::string_view name)
{
    for (Volume volume : kVolumes)
        if (volumeName(volume) == name) return volume;
    return {};
}

uint32_t volumeWordsPerProbe(Volume volume)
{
    return entryOf(volume).words;
}

FieldData bareGrid(const Scene& scene, const ProbeGrid& grid)
{
    FieldData field;
    gpu::LightFieldInfo& info = field.info;
    info = fieldSpace(scene.bounds());
    info.sky = scene.sky;
    info.chart = gpu::kChartOctahedral;
    info.gridX = uint32_t(grid.count.x), info.gridY = uint32_t(grid.count.y), info.gridZ = uint32_t(grid.count.z);
    info.gridOrigin = (grid.origin - info.origin) / info.scale;
    info.gridStep = grid.step / info.scale;
    for (int z = 0; z < grid.count.z; ++z)
        for (int y = 0; y < grid.count.y; ++y)
            for (int x = 0; x < grid.count.x; ++x) field.probes.emplace_back().centre = info.gridOrigin + info.gridStep * vec3(x, y, z);
    info.probeCount = uint32_t(field.probes.size());
    field.sceneName = scene.name;
    return field;
}

Result<FieldData> irradianceVolume(FieldData field, Volume volume, const RayScene& truth, const VolumeSettings& settings,
                                   const Progress& progress)
{
    const bool placed = volume == Volume::ddgiPlaced;
    if (!placed && field.info.gridX == 0)
        return Error{ErrorCode::badInput, fmt::format("The volume {} of scene '{}' needs a grid of probes; place with --method grid.",
                                                      volumeName(volume), field.sceneName)};
    if (placed && field.octree.texels.empty())
        return Error{ErrorCode::badInput, fmt::format("The volume {} of scene '{}' finds its probes by an octree, and the light field has "
                                                      "none; bake it again.",
                                                      volumeName(volume), field.sceneName)};
    FieldData made;
    made.info = field.info;
    made.probes = std::move(field.probes);
    if (placed) made.octree = std::move(field.octree);
    made.sceneName = std::move(field.sceneName);
    made.bounces = settings.bounces;
    const gpu::LightFieldInfo& info = made.info;
    // Probes that are no grid are as far apart as if they were one.
    const vec3 extent = (info.sceneHigh - info.sceneLow) * info.scale;
    const vec3 step = placed ? vec3(std::cbrt(extent.x * extent.y * extent.z / float(info.probeCount))) : info.gridStep * info.scale;
    const uint32_t words = volumeWordsPerProbe(volume);
    made.irradiance.resize(gpu::kVolumeHeaderWords + made.probes.size() * words);
    std::ranges::copy(headerOf(settings.bias, settings.viewShare, info.scale), made.irradiance.begin());
    const std::span<uint32_t> maps = std::span(made.irradiance).subspan(gpu::kVolumeHeaderWords);
    const Filler filler(truth, volume, settings, step);
    std::vector<uint8_t> inSolid(made.probes.size(), 0); // not bits: threads write neighbours
    for (size_t first = 0; first < made.probes.size(); first += kBatch)
    {
        if (!report(progress, "volume", double(first) / double(made.probes.size())))
            return Error{ErrorCode::cancelled, "The volume was cancelled."};
        parallelFor(std::min(kBatch, made.probes.size() - first),
                    [&](size_t i)
                    {
                        const size_t probe = first + i;
                        vec3 place = made.probes[probe].centre * info.scale + info.origin;
                        if (!placed && settings.relocate) place = filler.relocated(place);
                        made.probes[probe].centre = (place - info.origin) / info.scale;
                        filler.fill(place, info.scale, probe, maps.subspan(probe * words, words));
                        inSolid[probe] = !placed && filler.inSolid(place) ? 1 : 0;
                    });
    }
    std::vector<bool> solid(inSolid.begin(), inSolid.end());
    if (volume == Volume::sh) dilate(glm::ivec3(info.gridX, info.gridY, info.gridZ), solid, maps);
    for (size_t probe = 0; probe < solid.size(); ++probe)
        if (solid[probe]) setInSolid(volume, maps.subspan(probe * words, words));
    return made;
}

Status moveLookUps(Gpu& gpu, const LightField& volume, float bias, float viewShare)
{
    const std::array words = headerOf(bias, viewShare, volume.info().scale);
    return gpu.upload(volume.state().irradiance, 0, std::as_bytes(std::span(words)));
}

uint32_t raysOfVolume(size_t probes)
{
    return std::clamp(uint32_t(kRaysOfAll / std::max<size_t>(probes, 1)), kFewestRays, kMostRays);
}

Spirv volumePass(Volume volume)
{
    return entryOf(volume).pass;
}

} // namespace sconce
