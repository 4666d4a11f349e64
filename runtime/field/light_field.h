#pragma once

#include <array>
#include <span>

#include "runtime/field/field_data.h"
#include "runtime/field/quality.h"
#include "runtime/vulkan/pipeline.h"

namespace sconce
{

/// A light field on the device: the maps, the octree's 3D texture and the descriptor set that shaders/light_field.glsl expects. Move-only;
/// destroy it after the GPU has finished with it and before its Gpu.
class LightField
{
public:
    /// Uploads a baked field. Errors: badArgument (no probes, knobs out of range: named), outOfMemory (names the bytes), deviceFailure.
    static Result<LightField> create(Gpu& gpu, const FieldData& field, const Quality& quality = {});

    VkDescriptorSetLayout layout() const { return set.layout(); }
    VkDescriptorSet descriptorSet() const { return set.handle(); }
    const gpu::LightFieldInfo& info() const { return fieldInfo; }
    uint64_t deviceBytes() const { return bytes; }
    /// Values of the first constant ids of a pass that includes shaders/light_field.glsl: `farBounds`, and whether it holds radiance, are
    /// fixed in a pass when it is made.
    std::array<uint32_t, 2> constants() const;
    bool holdsRadiance() const { return radianceHeld; }              // as rays need it
    bool holdsPrefiltered() const { return prefiltered.size() > 0; } // as rough reflections need it
    bool holdsPatches() const { return patchesHeld; }                // as diffuse light by patches needs them
    /// Takes effect for command buffers submitted after it. Not while the GPU reads the field.
    Status setQuality(const Quality& quality);

private:
    LightField() = default;
    Gpu* gpu = nullptr;
    gpu::LightFieldInfo fieldInfo{};
    Buffer block, probes, distance, radiance, irradiance, prefiltered, patches;
    bool readsFarBounds = false, radianceHeld = false, patchesHeld = false;
    GpuImage octree;
    DescriptorSet set;
    uint64_t bytes = 0;
};

/// Traces lists of rays: what `sconce trace` and the tests use, and what a host can use for its own queries.
class RayTracer
{
public:
    /// @param shader  SPIR-V of a pass with trace_rays.comp's interface; empty: our tracer. The bench brings its baselines through it.
    static Result<RayTracer> create(Gpu& gpu, const LightField& field, Spirv shader = {});

    /// Records the trace of `count` rays (gpu::Ray) into hits (gpu::RayHit); ends with the barrier that lets any stage read them.
    void record(VkCommandBuffer cmd, const Buffer& rays, const Buffer& hits, uint32_t count);
    /// Uploads, traces and downloads, in pieces of at most 2^18 rays; waits for the result. Misuse: spans of different length assert.
    /// @param milliseconds  of the trace passes alone, by the GPU's clock; 0 when the queue has none
    Status trace(std::span<const gpu::Ray> rays, std::span<gpu::RayHit> hits, double* milliseconds = nullptr);

private:
    RayTracer() = default;
    Gpu* gpu = nullptr;
    const LightField* field = nullptr;
    DescriptorSet set;
    Pipeline pipeline;
};

} // namespace sconce
