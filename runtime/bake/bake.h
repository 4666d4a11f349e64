#pragma once

#include <optional>
#include <span>

#include "base/knobs.h"
#include "base/progress.h"
#include "runtime/bake/probe_faces.h"
#include "runtime/field/field_data.h"
#include "runtime/frame/effect_plan.h"
#include "runtime/scene/device_scene.h"
#include "runtime/vulkan/gpu.h"
#include "scene/exact_rays.h"
#include "scene/probe_grid.h"
#include "svo/build_octree.h"

namespace sconce
{

class BakeJournal; // runtime/bake/bake_journal.h
enum class BakeStage : uint32_t;
struct LightLayout; // runtime/bake/surface_baker.h

/// Ranges and prices: base/knobs.h.
struct BakeSettings
{
    uint32_t resolution = knobs::resolution.value;   // texels a side of an octahedral map; cube faces have half of it
    uint32_t chart = uint32_t(knobs::chart.place()); // kChartCube, or kChartOctahedral, which the grid baselines need
    uint32_t bounces = knobs::bounces.value;         // times the baked light is re-injected at most; each costs one gather a texel
    float converged = knobs::converged.value;        // stop earlier, after a bounce that adds less than this share of all light; 0: never
    uint32_t surfaceTexels = knobs::surfaceTexels.value; // texels a side of a cube face of the surface light; 0: none
    float surfaceRefined = knobs::surfaceRefined.value;  // share of them that is refined at most, where `rays` gather
    uint32_t lampTexels = knobs::lampTexels.value;       // a side of a lamp's shadow map; 0, or without `rays`: emitters are no lamps
    uint32_t surfaceRays = knobs::surfaceRays.value;     // that gather light for each of them
    uint32_t liveLinks = knobs::liveLinks.value;         // of each texel, so that lights may move; bakeLightGroups() makes them; 0: none
    bool lit = true;                                     // false: geometry and material alone, with live links; relightField() lights it
    const ExactRays* rays = nullptr;     // to the triangles of the scene that is baked, that gather it; null: through the field
    ProbeFaces* faces = nullptr;         // draws what probes see; null: the bake draws the scene
    DeviceSceneDesc scene;               // textures and lights
    std::vector<std::string> effects;    // names of the plan's effects, kept in the file for reports
    bool radiance = true;                // keep the maps' radiance, which traced rays need: half of the field
    bool compact = knobs::compact.value; // maps in blocks of 4 x 4 texels (runtime/field/map_blocks.h)
    bool readsSurfaces = true;           // keep surface light, which diffuse light and rough reflections are read from
    bool prefiltered = true;             // make the prefiltered radiance, which rough reflections need: 21 KiB a probe
    OctreeSettings octree;
    std::optional<ProbeGrid> grid; // set when the probes are a uniform one
    /// Baked before, of the same scene and probes, with cube faces, surface light and no lamps: its light is what the probes' surfaces
    /// reflect, and nothing is gathered. What octahedral maps need, which hold no surface light. Null: what this bake finds itself.
    const FieldData* light = nullptr;
    LightLayout* layout = nullptr; // where light is kept that isn't in texels: an empty one is filled; null: as this bake finds it
    uint64_t hostMemory = knobs::hostBytes.value;   // bytes of main memory that it may take; 0: what is free
    float submissionMs = knobs::submissionMs.value; // that it holds the device at most at once, as far as its passes can be cut
    /// Where maps, octree and what is gathered are looked for before the bake works, and kept as soon as they are done. Null: nowhere.
    BakeJournal* journal = nullptr;

    /// Keeps what frames by a plan ask for, and the names of the plan's effects. @param tracedDiffuse  diffuse light by rays, too
    void take(const EffectPlan& plan, bool tracedDiffuse = false);
};

/// The bake that finds light at surfaces for another with these settings to take as its `light`: cube faces of as many texels, no lamps.
BakeSettings lendingBake(BakeSettings settings);

/// What one of several processes does of a bake: of a stage that goes probe by probe, every count-th probe. Neighbours, which cost alike,
/// are then of different shards.
struct BakeShard
{
    uint32_t index = 0, count = 1;
    BakeStage stage{}; // maps, or gather
    bool has(size_t probe) const { return probe % count == index; }
};
inline constexpr uint32_t kMostShards = 4096;

/// What a bake cost. Seconds are wall-clock. What a journal had done before isn't in it.
struct BakeReport
{
    double sceneSeconds = 0.0;   // upload and shadow maps
    double probeSeconds = 0.0;   // faces, direct light, chains, first irradiance
    double octreeSeconds = 0.0;  // summaries and octree
    bool octreeOnDevice = false; // else the maps didn't fit the device's memory and the host built it: the same bytes, later
    double gatherSeconds = 0.0;  // rays of the surface light
    double bounceSeconds = 0.0;
    uint64_t gatherRays = 0; // to triangles, that surface light took: of texels, cells and finer texels, on by lobes, and to lights
    double prefilterSeconds = 0.0;
    double longestSubmission = 0.0; // seconds that the device was held at once, uploads and what lights move by with it
    uint64_t peakDeviceBytes = 0;   // besides what the device held before; with what other threads take of it meanwhile
    /// Mean over all probes and directions of the radiance that arrives there, luminance, W/(m^2 sr): of direct light, emission and sky,
    /// and then what each bounce adds. Where surface light is gathered by triangles, bounces are of what rays that end bring: glossy
    /// surfaces turn on a share of them, which the others make up for.
    std::vector<double> energy;
    uint32_t lights = 0; // delta lights, emitter samples and sky directions
    uint32_t moved = 0;  // probes that stood on a surface, or nearer than the faces' near plane, and were moved off it
    uint32_t tight = 0;  // of them, those that found no place, between surfaces: they see through one of them
};

/// Bakes a light field: what each probe sees, rasterised, lit directly by every light of the scene and then, bounce by bounce, by the light
/// gathered at the surfaces that its texels show (without surface texels: by the probes' irradiance). A probe's maps before the first
/// bounce don't depend on the other probes. Same input, same driver: same bytes. What rays meet is as bright to all sides: a probe's texel
/// holds one radiance for all directions.
/// @param probes  world, metres; at least one, at most 65,535. One that stands on a surface, or nearer to it than 2e-4 of the diagonal, is
/// moved
///                off it (runtime/bake/probe_clearance.h) where the probes are no grid
/// Errors: badArgument (settings, probes: named), badInput (scene), outOfMemory (with the numbers), deviceFailure, cancelled.
Result<FieldData> bakeLightField(Gpu& gpu, const Scene& scene, std::span<const vec3> probes, const BakeSettings& settings,
                                 const Progress& progress, BakeReport& report);

/// A shard of the same bake, into settings.journal: bakeLightField() with a journal that has the parts of all shards gives the field that
/// it gives without, to the byte. Stage gather needs the maps of all probes in the journal, and surface light; shard 0 gathers the cells,
/// too. Errors: as bakeLightField(), and the journal's; badInput: the maps of a probe aren't there; badArgument: no journal, no such shard.
Status bakeShard(Gpu& gpu, const Scene& scene, std::span<const vec3> probes, const BakeSettings& settings, const BakeShard& shard,
                 const Progress& progress, BakeReport& report);

} // namespace sconce
