#include "runtime/bake/lamps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include "base/numbers.h"
#include "base/parallel.h"

namespace sconce
{
namespace
{

constexpr float kSharpest = 0.1f;     // radians that a lamp is wide, in the mean over its light
constexpr double kLeastShare = 0.02;  // of the light of all emitters
constexpr double kMostBehind = 0.01;  // of its light, to its other side
constexpr double kMostAskew = 0.01;   // of its light, beyond kMostTangent
constexpr float kMostTangent = 2.0f;  // of the angle to its normal, that a map shows
constexpr uint32_t kPlaces = 16384;   // where light falls, of all probes
constexpr float kFlat = 0.9999f;      // cosine between the normals of two triangles of one plane
constexpr uint32_t kDepths = 0xfffeu; // steps between a map's nearest and farthest; one more is nothing

/// Triangles joined by corners, that shine.
struct Part
{
    std::vector<uint32_t> triangles;
    vec3 emission{0.0f}, centre{0.0f};
    float area = 0.0f;
    bool even = true; // all of it shines alike, without a texture
};

/// Where light falls.
struct Place
{
    vec3 position, normal; // world; on the side that a probe sees
};

std::vector<Part> emittingParts(const Scene& scene)
{
    struct Emitting
    {
        uint32_t triangle;
        vec3 emission;
    };
    std::vector<Emitting> emitting;
    std::map<std::array<float, 3>, uint32_t> corners; // of them: the same positions are one
    std::vector<uint32_t> parent;
    const auto rootOf = [&](uint32_t i)
    {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    const auto cornerOf = [&](uint32_t vertex)
    {
        const vec3 p = scene.positions[vertex] + 0.0f; // -0 is 0
        const auto [found, isNew] = corners.try_emplace({p.x, p.y, p.z}, uint32_t(parent.size()));
        if (isNew) parent.push_back(found->second);
        return rootOf(found->second);
    };
    for (uint32_t t = 0; t < scene.triangles.size(); ++t)
    {
        const vec3 emission = meanEmission(scene, t);
        if (emission == vec3(0.0f)) continue;
        emitting.push_back({t, emission});
        const uint32_t first = cornerOf(scene.triangles[t].x);
        parent[cornerOf(scene.triangles[t].y)] = first;
        parent[cornerOf(scene.triangles[t].z)] = rootOf(first);
    }
    std::map<uint32_t, Part> parts; // in the order of their first corner
    for (const Emitting& e : emitting)
    {
        const uvec3 corner = scene.triangles[e.triangle];
        Part& part = parts[cornerOf(corner.x)];
        const vec3 a = scene.positions[corner.x], b = scene.positions[corner.y], c = scene.positions[corner.z];
        const float area = 0.5f * glm::length(glm::cross(b - a, c - a));
        part.even = part.even && scene.materials[scene.triangleMaterial[e.triangle]].emissionTexture.image < 0 &&
                    (part.triangles.empty() || e.emission == part.emission);
        part.emission = e.emission;
        part.centre += area * (a + b + c) / 3.0f;
        part.area += area;
        part.triangles.push_back(e.triangle);
    }
    std::vector<Part> found;
    for (auto& [root, part] : parts)
    {
        part.centre /= std::max(part.area, 1e-30f);
        if (part.area > 0.0f) found.push_back(std::move(part));
    }
    return found;
}

/// The corners of a part that is a triangle or a convex quadrilateral, in turn; of a triangle the last twice.
std::optional<std::array<vec3, 4>> outlineOf(const Scene& scene, const Part& part)
{
    if (!part.even || part.triangles.size() > 2) return std::nullopt;
    const auto corners = [&](uint32_t triangle)
    {
        const uvec3 t = scene.triangles[triangle];
        return std::array<vec3, 3>{scene.positions[t.x], scene.positions[t.y], scene.positions[t.z]};
    };
    const std::array<vec3, 3> first = corners(part.triangles[0]);
    if (part.triangles.size() == 1) return std::array<vec3, 4>{first[0], first[1], first[2], first[2]};
    const std::array<vec3, 3> second = corners(part.triangles[1]);
    if (std::abs(glm::dot(geometricNormal(scene, part.triangles[0]), geometricNormal(scene, part.triangles[1]))) < kFlat)
        return std::nullopt;
    const auto isIn = [](vec3 p, const std::array<vec3, 3>& of) { return std::ranges::find(of, p) != of.end(); };
    const auto lone = std::ranges::find_if(first, [&](vec3 p) { return !isIn(p, second); });
    const auto other = std::ranges::find_if(second, [&](vec3 p) { return !isIn(p, first); });
    if (lone == first.end() || other == second.end()) return std::nullopt;
    const size_t at = size_t(lone - first.begin());
    const std::array<vec3, 4> outline = {*lone, first[(at + 1) % 3], *other, first[(at + 2) % 3]};
    if (!isIn(outline[1], second) || !isIn(outline[3], second)) return std::nullopt; // joined by a corner alone
    vec3 turn(0.0f);
    for (size_t i = 0; i < 4; ++i)
    {
        const vec3 bend = glm::cross(outline[(i + 1) % 4] - outline[i], outline[(i + 2) % 4] - outline[(i + 1) % 4]);
        if (i > 0 && glm::dot(turn, bend) <= 0.0f) return std::nullopt; // not convex
        turn = bend;
    }
    return outline;
}

/// What probes see all around them.
std::vector<Place> placesOf(const ExactRays& rays, const gpu::LightFieldInfo& space, std::span<const gpu::ProbeHeader> probes)
{
    const uint32_t each = std::clamp<uint32_t>(kPlaces / uint32_t(probes.size()), 32, 1024);
    std::vector<Place> places;
    for (const gpu::ProbeHeader& probe : probes)
        for (uint32_t i = 0; i < each; ++i)
        {
            const float y = 1.0f - (2.0f * float(i) + 1.0f) / float(each), r = std::sqrt(std::max(0.0f, 1.0f - y * y));
            const double turn = double(i) * (std::numbers::phi - 1.0);
            const float angle = 2.0f * std::numbers::pi_v<float> * float(turn - std::floor(turn));
            const vec3 direction(r * std::cos(angle), y, r * std::sin(angle)), from = space.origin + space.scale * probe.centre;
            const auto hit = rays.closest(from, direction);
            if (!hit) continue;
            const vec3 normal = geometricNormal(rays.scene(), hit->triangle);
            places.push_back({from + hit->t * direction, glm::dot(normal, direction) > 0.0f ? -normal : normal});
        }
    return places;
}

/// An emitter that may be a lamp, and how its light falls.
struct Candidate
{
    const Part* part;
    std::array<vec3, 4> outline;
    vec3 normal; // to where its light goes
    double light = 0.0;
};

/// Luminance of the light of all parts, unshadowed, summed over the places: each shines as a ball of as much power.
double lightOfAll(const std::vector<Part>& parts, std::span<const Place> places)
{
    double sum = 0.0;
    for (const Place& place : places)
        for (const Part& part : parts)
        {
            const vec3 to = part.centre - place.position;
            const float d2 = std::max(glm::dot(to, to), part.area);
            sum += double(glm::dot(part.emission, kLuminance) * 0.25f * part.area * std::max(glm::dot(place.normal, to), 0.0f) /
                          (d2 * std::sqrt(d2)));
        }
    return sum;
}

std::optional<Candidate> candidateOf(const Scene& scene, const Part& part, std::span<const Place> places)
{
    const auto outline = outlineOf(scene, part);
    if (!outline) return std::nullopt;
    Candidate found{&part, *outline, glm::normalize(glm::cross((*outline)[1] - (*outline)[0], (*outline)[2] - (*outline)[0]))};
    double light[2] = {}, width[2] = {}, askew[2] = {}; // to the side of the normal, and the other
    for (const Place& place : places)
    {
        const vec3 to = part.centre - place.position;
        const float d2 = std::max(glm::dot(to, to), part.area), distance = std::sqrt(d2), lit = glm::dot(place.normal, to) / distance;
        const float facing = -glm::dot(found.normal, to) / distance, tilt = std::abs(facing);
        if (!(lit > 0.0f) || !(tilt > 0.0f)) continue;
        const double given = double(glm::dot(part.emission, kLuminance) * part.area * tilt * lit / d2);
        const int side = facing > 0.0f ? 0 : 1;
        light[side] += given;
        width[side] += given * 2.0 * std::sqrt(double(part.area * tilt) / std::numbers::pi) / double(distance);
        if (tilt * tilt * (1.0f + kMostTangent * kMostTangent) < 1.0f) askew[side] += given;
    }
    const int side = light[1] > light[0] ? 1 : 0;
    found.light = light[side];
    if (!(light[side] > 0.0) || light[1 - side] > kMostBehind * light[side] || width[side] > double(kSharpest) * light[side] ||
        askew[side] > kMostAskew * light[side])
        return std::nullopt;
    if (side == 1)
    {
        found.normal = -found.normal;
        std::swap(found.outline[1], found.outline[3]);
    }
    return found;
}

/// A lamp without its map; places tell its window.
gpu::Lamp lampOf(const Candidate& candidate, const gpu::LightFieldInfo& space, std::span<const Place> places, uint32_t texels)
{
    gpu::Lamp lamp{};
    const auto local = [&](vec3 p) { return (p - space.origin) / space.scale; };
    for (size_t i = 0; i < 4; ++i) lamp.corner[i] = local(candidate.outline[i]);
    lamp.radiance = candidate.part->emission;
    lamp.centre = local(candidate.part->centre);
    lamp.reach = std::sqrt(candidate.part->area / std::numbers::pi_v<float>) / space.scale;
    lamp.normal = candidate.normal;
    lamp.axisX = glm::normalize(candidate.outline[1] - candidate.outline[0]);
    lamp.axisY = glm::cross(lamp.normal, lamp.axisX);
    vec2 low(kMostTangent), high(-kMostTangent);
    for (const Place& place : places)
    {
        const vec3 from = local(place.position) - lamp.centre;
        const float along = glm::dot(from, lamp.normal);
        const vec2 at = vec2(glm::dot(from, lamp.axisX), glm::dot(from, lamp.axisY)) / along;
        if (!(along > lamp.reach) || std::max(std::abs(at.x), std::abs(at.y)) > kMostTangent) continue;
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    // The border that places, which are samples, leave out; and the width of shadows' edges.
    const vec2 margin = 0.03f * (high - low) + 1e-3f;
    lamp.low = low - margin;
    lamp.perTangent = float(texels) / (high - low + 2.0f * margin);
    lamp.size = texels;
    return lamp;
}

/// How far along the normal the nearest surface is, by texel, field units; infinite where there is none.
std::vector<float> depthsOf(const gpu::Lamp& lamp, const ExactRays& rays, const gpu::LightFieldInfo& space)
{
    std::vector<float> depths(size_t(lamp.size) * lamp.size);
    const float gap = 2.0f * rayOffset(rays.scene());
    const vec3 from = space.origin + space.scale * lamp.centre;
    parallelFor(lamp.size,
                [&](size_t y)
                {
                    for (uint32_t x = 0; x < lamp.size; ++x)
                    {
                        const vec2 at = lamp.low + (vec2(float(x), float(y)) + 0.5f) / lamp.perTangent;
                        const vec3 direction = lamp.normal + at.x * lamp.axisX + at.y * lamp.axisY; // 1 along the normal
                        const auto hit = rays.closest(from + gap * direction, glm::normalize(direction));
                        depths[y * lamp.size + x] = hit ? (gap + hit->t / glm::length(direction)) / space.scale : INFINITY;
                    }
                });
    return depths;
}

/// Least and most of each block of a level that is `side` wide.
std::vector<uint32_t> blocksOf(std::span<const uint32_t> least, std::span<const uint32_t> most, uint32_t side)
{
    const uint32_t blocks = side / gpu::kLampBlock;
    std::vector<uint32_t> words(size_t(blocks) * blocks, 0xffffu);
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x)
        {
            uint32_t& word = words[size_t(y / gpu::kLampBlock) * blocks + x / gpu::kLampBlock];
            const size_t i = size_t(y) * side + x;
            word = std::min(word & 0xffffu, least[i]) | std::max(word >> 16, most[i]) << 16;
        }
    return words;
}

/// Adds the map's words, and to the lamp its depths' ends.
void addMap(gpu::Lamp& lamp, std::span<const float> depths, std::vector<uint32_t>& maps)
{
    lamp.near = INFINITY;
    lamp.far = 0.0f;
    for (const float depth : depths)
        if (depth < INFINITY)
        {
            lamp.near = std::min(lamp.near, depth);
            lamp.far = std::max(lamp.far, depth);
        }
    if (!(lamp.near < lamp.far)) lamp.near = 0.0f, lamp.far = std::max(lamp.far, lamp.reach);
    std::vector<uint32_t> texels(depths.size());
    for (size_t i = 0; i < depths.size(); ++i)
        texels[i] = depths[i] < INFINITY ? uint32_t(std::lround(double(depths[i] - lamp.near) / double(lamp.far - lamp.near) * kDepths))
                                         : gpu::kLampFar;
    for (size_t i = 0; i < texels.size(); i += 2) maps.push_back(texels[i] | texels[i + 1] << 16);
    const std::vector<uint32_t> blocks = blocksOf(texels, texels, lamp.size);
    maps.insert(maps.end(), blocks.begin(), blocks.end());
    std::vector<uint32_t> least(blocks.size()), most(blocks.size());
    for (size_t i = 0; i < blocks.size(); ++i) least[i] = blocks[i] & 0xffffu, most[i] = blocks[i] >> 16;
    const std::vector<uint32_t> larger = blocksOf(least, most, lamp.size / gpu::kLampBlock);
    maps.insert(maps.end(), larger.begin(), larger.end());
}

} // namespace

Lamps findLamps(const ExactRays& rays, const gpu::LightFieldInfo& space, std::span<const gpu::ProbeHeader> probes, uint32_t texels)
{
    Lamps found;
    const std::vector<Part> parts = emittingParts(rays.scene());
    if (parts.empty() || probes.empty()) return found;
    const std::vector<Place> places = placesOf(rays, space, probes);
    const double all = lightOfAll(parts, places);
    std::vector<Candidate> candidates;
    for (const Part& part : parts)
        if (const auto candidate = candidateOf(rays.scene(), part, places); candidate && candidate->light >= kLeastShare * all)
            candidates.push_back(*candidate);
    std::ranges::stable_sort(candidates, std::greater(), &Candidate::light);
    candidates.resize(std::min<size_t>(candidates.size(), gpu::kMostLamps));
    for (const Candidate& candidate : candidates)
    {
        found.lamps.push_back(lampOf(candidate, space, places, texels));
        found.lamps.back().firstWord = uint32_t(candidates.size() * sizeof(gpu::Lamp) / sizeof(uint32_t) + found.maps.size());
        addMap(found.lamps.back(), depthsOf(found.lamps.back(), rays, space), found.maps);
        found.oneOf.push_back(candidate.part->triangles.front());
        found.triangles.insert(found.triangles.end(), candidate.part->triangles.begin(), candidate.part->triangles.end());
    }
    std::ranges::sort(found.triangles);
    return found;
}

Lamps lampsIn(const Scene& scene, Lamps lamps)
{
    for (size_t i = 0; i < lamps.lamps.size(); ++i) lamps.lamps[i].radiance = meanEmission(scene, lamps.oneOf[i]);
    return lamps;
}

} // namespace sconce
