#pragma once

#include "runtime/denoiser.h"
#include "runtime/frame_inputs.h"
#include "runtime/light_field.h"
#include "shaders/shared/frame.h"

namespace sconce
{

/// Which of the indirect terms a frame has; what is off has no pipeline, no image and no dispatch.
struct IndirectEffects
{
    bool diffuse = true;
    bool glossy = true;
    bool denoise = true; // of the glossy term
};

/// Records one frame's indirect light into the host's command buffer. Made once for a size; recording never allocates, throws or submits.
class IndirectLight
{
public:
    struct Desc
    {
        uint32_t width = 0, height = 0; // pixels, 1..16384
        IndirectEffects effects;
        Spirv glossyShader; // SPIR-V with trace_glossy.comp's interface; empty: our tracer. The bench brings its baselines through it.
    };
    static Result<IndirectLight> create(Gpu& gpu, const LightField& field, const Desc& desc);

    /// Binds the G-buffer; before the first record and whenever its views change. Not while the GPU runs a recorded frame.
    void setInputs(const FrameInputs& inputs);
    /// Ends with the barrier that lets any later stage read the outputs (layout GENERAL).
    /// @param timer  optional; scopes "glossy trace", "diffuse gather", "denoise"
    void record(VkCommandBuffer cmd, const gpu::FrameView& view, GpuTimer* timer = nullptr) noexcept;

    // Outputs, RGBA32F; empty when the effect is off.
    const GpuImage& glossy() const { return smoothGlossy ? smoothGlossy : noisyGlossy; } // rgb radiance reflected to the eye, BRDF included
    const GpuImage& diffuse() const
    {
        return diffuseImage;
    } // rgb cosine-weighted mean of what surfaces reflect: no albedo, and no light straight from emitters or sky
    const GpuImage& counts() const { return countImage; } // RGBA32UI: probe, hand-offs, reads, unknown rays; of the glossy trace
    uint64_t deviceBytes() const;

private:
    IndirectLight() = default;
    Status makePass(Pipeline& pipeline, DescriptorSet& set, Spirv shader, uint32_t storageImages);
    Gpu* gpu = nullptr;
    const LightField* field = nullptr;
    Desc desc;
    Buffer frame;
    GpuImage noisyGlossy, smoothGlossy, countImage, diffuseImage;
    DescriptorSet glossySet, diffuseSet;
    Pipeline glossyPass, diffusePass;
    Denoiser denoiser;
};

} // namespace sconce
