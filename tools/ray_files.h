#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "scene/result.h"
#include "scene/scene.h"

namespace sconce::tools
{

struct Ray
{
    vec3 origin{0.0f};    // world, metres
    vec3 direction{0.0f}; // any length
};

enum class HitStatus : uint32_t
{
    miss,
    hit,
    unknown
};

/// A line of hits.csv. On miss and unknown t and position are the last point reached, and radiance is what shading would use.
struct RayHit
{
    HitStatus status = HitStatus::miss;
    float t = 0.0f; // metres along the unit direction
    vec3 position{0.0f};
    vec3 normal{0.0f}; // unit on a hit, else zero
    vec3 radiance{0.0f};
    int probe = -1;
    int handoffs = 0;
    int distanceFetches = 0;
    int indexFetches = 0;
};

/// rays.csv: header ox,oy,oz,dx,dy,dz, then a ray a line; numbers as text, nan and inf included. Errors: fileError; badInput names the
/// line.
Result<std::vector<Ray>> readRays(const std::filesystem::path& file);

/// hits.csv in the order of the rays; a number that is not finite is written as 0. Whole or not at all.
Status writeHits(std::span<const RayHit> hits, const std::filesystem::path& file);

} // namespace sconce::tools
