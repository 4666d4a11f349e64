#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "placement/free_space.h"
#include "placement/select.h"
#include "placement/skeleton.h"
#include "placement/visibility.h"

namespace sconce
{

/// How positions are refined after the choice. Source: Wang et al. 2019, "Fast Non-uniform Radiance Probe Placement and Tracing",
/// section 3.3: eight support positions on the corners of a cube around the probe, of which
enum class Refine
{
    none,
    gradient,  // the best is taken when it is better
    gibbs,     // the best is proposed; a worse one is accepted at times
    stochastic // a point inside the cube is proposed, drawn by a linear model of the fitness along each axis; a worse one at times
};

struct OptimiseSettings
{
    Refine refine = Refine::stochastic;
    uint32_t rounds = 6;    // times through all probes; each costs 8 or 9 views a probe
    float step = 0.0f;      // metres, half side of the first cube; 0: a quarter of the targets' spacing
    float clearance = 0.0f; // metres, that every position keeps
    float comfort = 0.0f;   // metres, that a position which keeps it goes on keeping
    uint64_t seed = 1;
    size_t fixed = 0; // the first so many positions stay
};

/// Moves probes, one at a time, to where the fitness of the whole set is higher. The fitness R is the sum over targets of the best view's
/// worth; the paper's equation (2) adds the views of all probes up, which rewards probes that crowd before the same wall. Legal positions
/// stay legal. The best set met is kept, so R never falls. Deterministic for any number of threads. Errors: cancelled.
Status optimisePositions(const LegalSpace& legal, const ViewTargets& targets, std::vector<vec3>& positions,
                         const OptimiseSettings& settings, const Progress& progress);

/// A number in [0,1] with density proportional to (1 - x) f0 + x f1, from a uniform one: the inverse of the linear model's distribution.
/// Written so that f0 = f1 (the paper's a = 0) and f0 + f1 = 0 need no case of their own beyond a guard.
float sampleLinear(float f0, float f1, float uniform);

/// A point of the unit cube drawn by the fitness at its corners (bit 0 of the index: x, bit 1: y, bit 2: z): first along the four x edges,
/// then between those along y, last along z.
vec3 sampleCube(const std::array<float, 8>& fitness, std::span<const float, 7> uniforms);

} // namespace sconce
