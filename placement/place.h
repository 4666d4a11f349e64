#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/limits.h"
#include "base/progress.h"
#include "base/result.h"
#include "placement/coverage.h"
#include "placement/free_space.h"
#include "placement/optimise.h"
#include "placement/picture.h"
#include "placement/probe_set.h"
#include "scene/scene.h"

namespace sconce
{

struct PlaceSettings
{
    enum class Method
    {
        sdf,   // skeleton of the distance field, greedy cover, exchange
        balls, // the same with the skeleton of ball shrinking
        grid   // uniform grid in the bounds of the reachable space; points in solid stay
    };
    Method method = Method::sdf;
    glm::ivec3 grid{0};       // grid: points along each axis, product 1..65,535; 0: chosen from `count`
    uint32_t count = 0;       // probes, 0..65,535; 0: the fewest that reach `coverage`; a grid takes 64
    float coverage = 0.995f;  // (0,1], share of the surface points that rays hit; when count is 0, grid apart
    std::vector<vec3> inside; // world, metres: the space that counts; empty: where the cameras are, else the largest enclosed region
    std::vector<Pin> pins;    // positions that the user decides; not with a grid. Kept ones count as probes of `count`, added ones don't
    uint64_t seed = 1;        // of every random choice; same scene, settings and seed: same bytes
    float clearance = 0.0f;   // metres from every surface, sdf; 0: one cell of the distance field
    uint32_t voxels = kDefaultVoxels; // most cells of the distance field, 4,096..268,435,456; cost: about 20 bytes and 0.3 us each
    uint32_t candidates = 2800;       // positions to choose from, 100..100,000; few cost coverage (500 instead of 1,500: 20 points)
    Refine refine = Refine::gradient; // how positions are moved after the choice, grid apart; the others cost more and gain nothing
    uint32_t refineRounds = 6;        // times through all probes, 0..1,000; each costs 8 views a probe, or 9
    uint32_t relocateRounds = 3; // times each probe is tried where no other sees, after the choice, 0..1,000; each costs 32 views a probe
    uint32_t refineSurfels = 32000; // surface samples to relocate and refine by, 1,000..1,000,000; up to half where few probes see
    bool explain = false;           // fills PlaceReport::picture
    uint32_t surfels = 48000;       // surface samples to choose by, the same; cost: 0.1 us times candidates times surfels
};

struct PlaceReport
{
    Bounds reachable;             // of the reachable free space, metres
    double reachableVolume = 0.0; // cubic metres
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

} // namespace sconce
