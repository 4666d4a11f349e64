#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "runtime/bake/bake_parts.h"
#include "runtime/bake/hidden_surfaces.h"
#include "runtime/bake/lamps.h"
#include "runtime/bake/refined_texels.h"
#include "runtime/bake/triangle_gather.h"
#include "runtime/field/light_field.h"
#include "runtime/scene/device_scene.h"
#include "runtime/vulkan/paced_work.h"
#include "shaders/shared/bake_passes.h"

namespace sconce
{

/// Where the light of a bake is kept besides the texels: what is found by the light of one bake, for others of the same scene and probes in
/// other light, so that the words of all are of the same places.
struct LightLayout
{
    uint32_t liveLinks = 0; // that `live` is to have; 0: it isn't asked for
    size_t groups = 0;      // whose light is kept apart
    LiveTransport live;
    std::optional<Lamps> lamps;
    std::optional<HiddenPlaces> hidden;
    std::optional<RefinedPlaces> refined;
};

/// Gathers light at the surface points of all probes' texels (shaders/shared/surface_light.h), straight from emitters and sky and bounce by
/// bounce: rays are traced once, through the field or to the scene's triangles, and each bounce reads what was found where they ended. Each
/// call submits and waits.
class SurfaceBaker
{
public:
    struct Desc
    {
        uint32_t rays = 0;                         // a texel, to gather light
        uint32_t shadowRays = 0;                   // a texel, to emitters; at most gpu::kMostShadowRays
        float offset = 0.0f;                       // field units that rays through the field start off their surface
        const TriangleGather* triangles = nullptr; // gathers in their place, by as many rays
        bool live = false;                         // transport() will be asked for; with triangles
        BakeParts parts = {};                      // where gathered light is looked for and kept
        PacedWork* work = nullptr;                 // that passes are done by; never null
    };
    /// @param field   with distances, octree and surfaceSize; it is only read
    /// @param texels  of all probes, [probe][6 surfaceSize^2]
    static Result<SurfaceBaker> create(Gpu& gpu, const DeviceScene& scene, const LightField& field,
                                       std::span<const gpu::SurfaceTexel> texels, const Desc& desc);

    /// A probe's texels: their light straight from emitters and sky, and where their rays end. All probes before the first bounce.
    Status gather(uint32_t probe);
    /// With triangles, where the rays of cells in the open end: before light is read.
    Status findCells();
    /// One bounce at all texels; the first call makes the light without one.
    Status bounce();
    /// Mean over probes and directions of the radiance, luminance (Rec. 709), that the texels send after the last bounce; before the first,
    /// of direct light alone.
    Result<double> meanSent();
    /// The light as FieldData::surfaceLight, filtered, and with that of the cells, which has as many bounces.
    Status read(std::span<uint32_t> light);
    /// Refines texels of a field whose light was read last.
    /// @param share   of all texels, at most
    /// @param layout  where; null: found
    Status refine(FieldData& data, float share, LightLayout* layout = nullptr);
    /// What lets lights move, but for the albedo: after refine().
    /// @param count  links of each texel and place, at most Desc::rays
    /// @param hidden  that the field was refined with
    LiveTransport transport(const FieldData& data, uint32_t count, const HiddenPlaces& hidden) const;
    uint64_t hostBytes() const { return uint64_t(links.size()) * sizeof(uint32_t); }

private:
    SurfaceBaker(Gpu& device, const DeviceScene& deviceScene, const LightField& asked, const Desc& wanted)
        : gpu(&device), scene(&deviceScene), field(asked), desc(wanted)
    {
    }
    Status make(std::span<const gpu::SurfaceTexel> texels);
    Status gatherCells();
    Status cellsFromTriangles(std::span<uint32_t> words);
    /// @param floats  what the pass writes, to be scanned for numbers that are none where that is asked for; null: it writes words
    /// Over a probe's texels.
    Status dispatch(const Pipeline& pipeline, bool withScene, const gpu::SurfacePush& push, const char* name, const Buffer* floats);
    Status dispatch(const Pipeline& pipeline, bool withScene, const gpu::SurfacePush& push, const char* name, glm::uvec3 groups,
                    const Buffer* floats);
    gpu::SurfacePush pushFor(uint32_t probe, uint32_t rays) const;
    Status findTilts();
    Status gatherTriangles(uint32_t probe);
    Status gatherThroughField(uint32_t probe);
    Status upload(uint32_t probe);
    /// What texels sent before the last bounce, and before those that reflections ask for.
    Result<TriangleGather::Sent> sentBefore();
    /// Of `sent`: where what texels send after a bounce is; -1: before the first.
    VkDeviceSize keptAt(int bounce) const { return 4 * texels() * (uint32_t(bounce + int(gpu::kSentKept)) % gpu::kSentKept); }
    bool directions() const { return field.info().surfaceDirections != 0; }
    size_t words() const { return surfaceTexelWords(field.info()) + cellWords(field.info()); }
    size_t texels() const { return texelsOfProbe() * field.info().probeCount; }
    size_t texelsOfProbe() const { return size_t(6) * field.info().surfaceSize * field.info().surfaceSize; }

    Gpu* gpu;
    const DeviceScene* scene;
    LightField field;
    Desc desc;
    Pipeline gatherPass, bouncePass, tiltPass, filterPass, cellPass;
    Buffer texelBuffer, first, light, linkBuffer, sent, filtered; // of all probes but the links, which are of one
    Buffer tints, reflected;
    Buffer tilts, tilted;        // the same, where the field has directions
    std::vector<uint32_t> links; // [probe][ray][texel]
    TriangleGather::Cells cells; // by rays to triangles
    std::vector<gpu::LiveTexel> liveTexels;
    int bounceMade = -1; // the last; 0: the light without one
};

} // namespace sconce
