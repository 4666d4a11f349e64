#pragma once

#include <optional>
#include <string_view>

#include "base/knobs.h"
#include "base/progress.h"
#include "bench/reference/ray_scene.h"
#include "runtime/field/field_data.h"
#include "runtime/field/light_field.h"
#include "runtime/vulkan/pipeline.h"
#include "scene/probe_grid.h"
#include "shaders/opponents/baseline.h"
#include "shaders/opponents/volume.h"

namespace sconce
{

/// Volumes of irradiance that users of engines would have instead of ours: diffuse light alone, no reflections.
enum class Volume : uint32_t
{
    ddgi = gpu::kVolumeDdgi,             // Majercik et al. 2019 and 2021, on a uniform grid
    ddgiPlaced = gpu::kVolumeDdgiPlaced, // the same maps and weights where our probes are, found by our octree
    sh = gpu::kVolumeSh // spherical harmonics on a uniform grid, corners in solids left out, in outline as Unity ships them
};
inline constexpr Volume kVolumes[] = {Volume::ddgi, Volume::ddgiPlaced, Volume::sh};

/// ddgi, ddgi-placed, sh-grid.
std::string_view volumeName(Volume volume);
std::optional<Volume> volumeNamed(std::string_view name);

struct VolumeSettings
{
    uint32_t rays = 1024;                      // a probe
    float bias = gpu::kLookUpBias;             // metres that look-ups are moved along the normal
    float viewShare = knobs::lookUpView.value; // of them towards the viewer; 4: 0.2 to 0.8, as Majercik et al. 2021 publish
    uint32_t bounces = 2;                      // of the light that arrives at probes, as BakeSettings::bounces
    uint64_t seed = 1;
    bool relocate = true; // a grid's probes in solids or close to surfaces are moved, as published for ddgi
    bool solids = true;   // what is seen from behind has an inside; false for scenes of open sheets, where no probe stands in a solid
};

uint32_t volumeWordsPerProbe(Volume volume);

/// Rays a probe by which a volume's noise is what DDGI's is once it has settled, as far as there aren't too many probes for that.
uint32_t raysOfVolume(size_t probes);

/// Moves the look-ups of a volume that stands on a device otherwise than it was made with: metres along the normal, times as far towards
/// the viewer. Errors: deviceFailure.
Status moveLookUps(Gpu& gpu, const LightField& volume, float bias, float viewShare);

/// A light field of a grid about a scene that has nothing but the places of its probes.
FieldData bareGrid(const Scene& scene, const ProbeGrid& grid);

/// Fills a volume with the light of a path tracer, so that it is as right as its probes can tell: what surfaces reflect, without emission
/// and sky, which frames take from their lights. What stands in a solid: by 32 fixed rays, a quarter of them back faces. Harmonics of
/// probes in solids are their neighbours' means.
/// @param field  its space, its probes' places and grid, of ddgi-placed the octree, too, are kept; all else goes
/// Cost: rays x probes paths on all cores. Errors: badInput (no grid, no octree), cancelled.
Result<FieldData> irradianceVolume(FieldData field, Volume volume, const RayScene& truth, const VolumeSettings& settings,
                                   const Progress& progress);

/// For LightShaders::gather, of frames without rough reflections.
Spirv volumePass(Volume volume);

} // namespace sconce
