#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "placement/free_space.h"
#include "placement/surface_samples.h"

namespace sconce
{

/// How much of the reachable surface some probe sees, at a cosine above kLeastCosine, and how well.
struct Coverage
{
    float rays = 0.0f;           // share of the points that random rays from the reachable space hit: what a traced ray needs
    float area = 0.0f;           // the same by surface area
    float medianCosine = 0.0f;   // of the seen ray points, in their best probe
    float medianDistance = 0.0f; // metres, the same
    size_t rayPoints = 0;        // sample sizes; 0 when no ray hits anything
    size_t areaPoints = 0;
    float backs = 0.0f;         // share of the ray points on the backs of single-sided surfaces: above 0.05 the space holds voids
    std::vector<Surfel> points; // the ray points
    std::vector<float> quality; // [points] viewQuality of the best probe, 0 where none sees the point
    std::vector<Surfel> unseen; // the ray points that no probe sees
};

struct CoverageSettings
{
    std::vector<vec3> inside;         // as in PlaceSettings
    OpenSpace open;                   // as in PlaceSettings
    uint64_t seed = 1;                // of the samples; never those that a placement of the same seed was chosen by
    size_t points = 60000;            // samples of each measure, 1,000..10,000,000; the standard error at 99 % is 0.04 % of 60,000
    uint32_t voxels = kDefaultVoxels; // most cells of the distance field
};

Result<Coverage> measureCoverage(const Scene& scene, std::span<const vec3> probes, const CoverageSettings& settings,
                                 const Progress& progress = {});

/// The same where visibility and free space are at hand.
Result<Coverage> measureCoverage(const Scene& scene, const Visibility& visibility, const FreeSpace& space, std::span<const vec3> probes,
                                 const CoverageSettings& settings, const Progress& progress = {});

/// The distance at which a probe's view counts half: the side of the cube of reachable space that falls to each of `probes` probes.
float probeSpacing(const FreeSpace& space, size_t probes);

} // namespace sconce
