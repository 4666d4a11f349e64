#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/knobs.h"
#include "base/limits.h"
#include "base/progress.h"
#include "base/result.h"
#include "placement/coverage.h"
#include "placement/free_space.h"
#include "placement/optimise.h"
#include "placement/picture.h"
#include "placement/probe_set.h"
#include "scene/probe_grid.h"
#include "scene/scene.h"

namespace sconce
{

/// Ranges and prices: base/knobs.h.
struct PlaceSettings
{
    enum class Method
    {
        sdf,   // skeleton of the distance field, greedy cover, exchange
        balls, // the same with the skeleton of ball shrinking
        grid   // uniform grid in the bounds of the reachable space; points in solid stay
    };
    Method method = Method(knobs::method.place());
    glm::ivec3 grid{0};                     // grid: points along each axis, product 1..65,535; 0: chosen from `count`
    bool fitGrid = knobs::fitGrid.value;    // grid: of several shapes and poses that whose cells' corners see best
    std::optional<ProbeGrid> pose;          // grid: this one, of gridPoses()
    bool powersOfTwo = false;               // grid: along each axis, of the product nearest to `count`
    uint32_t count = knobs::count.value;    // probes; 0: the fewest that reach `coverage`; a grid takes 64
    float coverage = knobs::coverage.value; // share of the surface points that rays hit; when count is 0, grid apart
    std::vector<vec3> inside; // world, metres: the space that counts; empty: where the cameras are, else the largest enclosed region
    OpenSpace open;           // what counts beside what is enclosed
    std::vector<Pin> pins;    // positions that the user decides; not with a grid. Kept ones count as probes of `count`, added ones don't
    uint64_t seed = knobs::placeSeed.value;              // of every random choice; same scene, settings and seed: same bytes
    float clearance = knobs::clearance.value;            // metres from every surface, sdf; 0: one cell of the distance field
    uint32_t voxels = knobs::distanceVoxels.value;       // most cells of the distance field
    uint32_t candidates = knobs::candidates.value;       // positions to choose from
    Refine refine = Refine(knobs::refine.place());       // how positions are moved after the choice, grid apart
    uint32_t refineRounds = knobs::refineRounds.value;   // times through all probes
    uint32_t refineSurfels = knobs::refineSurfels.value; // surface samples to refine by; up to half where few probes see
    bool explain = false;                                // fills PlaceReport::picture
    uint32_t surfels = knobs::surfels.value;             // surface samples to choose by
};

struct PlaceReport
{
    Bounds reachable;             // of the reachable free space, metres
    double reachableVolume = 0.0; // cubic metres
    float surfaceLeftOut = 0.0f;  // share of the scene's surface, by area, with no space that counts on either side of it
    float ground = 0.0f;          // metres above open ground that count
    float voxel = 0.0f;           // side of a cell of the distance field, metres
    float clearance = 0.0f;       // that was kept, metres; 0 for a grid
    float comfort = 0.0f;         // that most keep, metres
    float coverageRays = 0.0f;    // measured on samples that the choice did not use
    float coverageArea = 0.0f;
    float medianCosine = 0.0f;       // of what is seen, in the best probe
    float medianDistance = 0.0f;     // metres, the same
    float bestPossible = 0.0f;       // sdf: share of the surface points that any candidate at all sees
    size_t candidates = 0;           // positions that were tested
    std::vector<float> newlyCovered; // [probes] sdf: share of the surface points that this probe sees and no earlier one
    std::vector<float> alone;        // [probes] sdf: share that no other probe sees
    uint32_t gridOutside = 0;        // grid: points outside the reachable space
    double seconds = 0.0;
    Picture picture;                   // when settings.explain: drawPlacement
    std::vector<std::string> warnings; // a sentence each
};

/// Decides where the probes of a scene go.
/// Errors: badArgument names the setting; badInput when the scene has no triangles or no free space; cancelled.
/// Cost: sdf 5 to 60 s on two cores for 0.1 to 2 million triangles.
Result<ProbeSet> placeProbes(const Scene& scene, const PlaceSettings& settings, PlaceReport& report, const Progress& progress = {});

/// The uniform grids that `fitGrid` chooses among: some shapes of about as many probes, at some distances from the bounds of the reachable
/// space. For whoever knows a better judge than what their cells' corners see. Errors: as placeProbes().
Result<std::vector<ProbeGrid>> gridPoses(const Scene& scene, const PlaceSettings& settings, const Progress& progress = {});

} // namespace sconce
