#pragma once

#include <memory>

#include "runtime/field/field_data.h"
#include "runtime/field/light_field_file.h"
#include "runtime/sconce.h"
#include "runtime/vulkan/pipeline.h"

namespace sconce
{

/// Of a field that streams: room for the maps of some probes, which FieldStream fills.
struct MapPool
{
    MapFile file;
    uint32_t slots = 0;                   // probes whose maps there is room for
    Buffer slotOfProbe;                   // kNoProbe: not there
    Buffer asked;                         // a count for each probe, of passes, taken and cleared by the host
    bool fed = false;                     // a FieldStream has it
    bool used = false;                    // one has had it: slotOfProbe may tell of maps that the next one doesn't know of
    LightGroups::State* groups = nullptr; // that the field's radiance is mixed of; null: it is what the file holds
};

/// What stands behind the handle LightField.
struct LightField::State
{
    std::shared_ptr<Gpu> gpu;
    gpu::LightFieldInfo info{};
    Buffer block, probes, distance, radiance, irradiance, prefiltered, surface, patches, lamps;
    uint32_t lampCount = 0, groupCount = 0;
    bool mixed = false;              // LightGroups or LiveLight write its light, of which there is one
    uint64_t lightHash = 0;          // lightHashOf() what it was made of
    Buffer liveIncident, liveAlbedo; // of LiveLight, which passes that it was made before go on reading; none: light is static
    vec3 radianceWeight{1.0f};       // see gpu::FieldBlock
    bool readsFarBounds = false, radianceHeld = false, patchesHeld = false, byTexels = false;
    uint32_t probeOrder = 0; // TraceQuality::order
    GpuImage octree;
    std::unique_ptr<MapPool> maps; // null: the maps of all probes are there
    DescriptorSet set;
    std::vector<std::string> effects;
    std::string sceneName;
    std::vector<gpu::ProbeHeader> headers; // of the probes
    uint64_t bytes = 0;

    Status setQuality(const Quality& quality);
};

/// How passes read a field's words: the same words either way.
enum class WordAccess
{
    texelBuffers, // where every map fits one, else by address: software Vulkan (Mesa 22.3) gathers texels with one instruction for all
                  // lanes
    addresses
};

/// Uploads a baked field. Errors: badArgument (no probes, knobs out of range: named), outOfMemory (names the bytes), deviceFailure.
Result<LightField> makeLightField(Gpu& gpu, const FieldData& field, const Quality& quality = {},
                                  WordAccess access = WordAccess::texelBuffers);

/// Uploads all but the maps. @param field  without them. @param resident  probes whose maps there is room for, 1 to all
/// Errors: as makeLightField().
Result<LightField> makeStreamedField(Gpu& gpu, const FieldData& field, MapFile maps, uint32_t resident, const Quality& quality = {});

/// LightField::constants() as pipelines take them.
std::array<ShaderConstant, 2> shaderConstants(const LightField& field);

/// Says so where a field is of another device than what is to read it. Errors: badArgument.
Status checkDevice(const Gpu& gpu, const LightField& field);

/// What stands behind the handle RayTracer.
struct RayTracer::State
{
    std::shared_ptr<Gpu> gpu;
    LightField field;
    Pipeline pipeline;
    uint32_t raysALane; // at most
};

/// Passes with trace_rays.comp's interface.
struct RayShaders
{
    Spirv plain;
    Spirv refilled; // with SCONCE_REFILLS; empty: there is none
};

/// @param shaders  empty: our tracer. The bench brings its opponents through it.
Result<RayTracer> makeRayTracer(Gpu& gpu, const LightField& field, RayShaders shaders = {});

/// RayTracer::record on buffers of ours, which SCONCE_NAN_SCAN=1 scans after it.
void recordTrace(const RayTracer& tracer, VkCommandBuffer cmd, const Buffer& rays, const Buffer& hits, uint32_t count);

} // namespace sconce
