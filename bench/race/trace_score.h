#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace sconce
{

using glm::vec3;

struct RayTruth
{
    bool hit = false;
    float t = 0.0f; // metres; 0 when nothing is hit
    vec3 position{0.0f};
    vec3 normal{0.0f}; // geometric, on the ray's side
    uint32_t triangle = 0;
};

/// Rays with what they really hit.
struct RaySet
{
    std::vector<vec3> origins;          // [n] metres, 1e-4 of the diagonal off the surface
    std::vector<vec3> directions;       // [n] unit
    std::vector<vec3> normals;          // [n] geometric normal of the surface they leave, on the ray's side; 0 when it is not known
    std::vector<float> startCosine;     // [n] with the surface they leave; below 0.05 (3 degrees) is a grazing start
    std::vector<uint32_t> viewpoints;   // [n] that saw the surface they leave, ascending; or [0], where they have none
    std::vector<RayTruth> truth;        // [n]
    std::vector<RayTruth> fartherTruth; // [n] of the same rays begun kFartherStart further off; or [0], where no opponent asks
    float diagonal = 0.0f;              // of the scene, metres

    size_t size() const { return origins.size(); }
};

enum class TraceStatus : uint32_t
{
    miss,
    hit,
    unknown
};

/// What a tracer said of one ray.
struct TracedRay
{
    TraceStatus status = TraceStatus::unknown;
    float t = 0.0f; // metres, of a hit, or where sight was lost
    uint32_t handoffs = 0;
    uint32_t distanceReads = 0;
    uint32_t indexReads = 0;
};

/// Every ray is exactly one of right, false, leak, unresolved.
enum class TraceVerdict
{
    right,     // a hit within 1 % of the diagonal of the true one, or a true miss
    falseHit,  // a hit where the truth goes on: nearer by more than 1 % of the diagonal
    leak,      // passes through: farther by more than 1 %, or a miss where the truth hits
    unresolved // UNKNOWN, or a hit at a distance that is not a number
};
TraceVerdict judge(const RayTruth& truth, const TracedRay& traced, float diagonal);

struct Spread
{
    double mean = 0.0;
    uint32_t p95 = 0; // nearest rank
    uint32_t max = 0;
};

struct TraceScore // shares of all rays, [0,1]
{
    size_t rays = 0;
    double right1 = 0.0;
    double right02 = 0.0; // within 0.2 % of the diagonal, or a true miss; part of right1
    // Standard errors of these two. They count viewpoints, not rays: rays of one viewpoint fail together, so that more of them say little
    // of other viewpoints. 0 with fewer than two.
    double right1Unsure = 0.0, right02Unsure = 0.0;
    double falseHit = 0.0;
    double leak = 0.0;
    double unresolved = 0.0;
    double assumed1 = 0.0; // right within 1 % if what is unresolved were a hit where the tracer lost sight (McGuire et al. 2017, section 4)
    double assumed02 = 0.0;
    Spread handoffs;
    Spread distanceReads;
    Spread indexReads;
};

/// Scores a tracer. Misuse: spans of different length assert. Share and spreads of an empty set are 0.
/// @param farther  its rays started kFartherStart further off: they are judged by fartherTruth
TraceScore scoreTraces(const RaySet& set, std::span<const TracedRay> traced, bool farther = false);

} // namespace sconce
