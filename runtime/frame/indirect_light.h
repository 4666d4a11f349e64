#pragma once

#include <bit>
#include <memory>

#include "runtime/field/light_field.h"
#include "runtime/frame/denoiser.h"
#include "runtime/frame/effect_plan.h"
#include "runtime/frame/frame_inputs.h"
#include "shaders/shared/frame.h"

namespace sconce
{

/// Records one frame's indirect light into the host's command buffer. Made once for a size; recording never allocates, throws or submits.
class IndirectLight
{
public:
    struct Desc
    {
        uint32_t width = 0, height = 0; // pixels, 1..16384
        IndirectEffects effects;
        uint32_t traceEvery = knobs::traceEvery.value; // trace one pixel of so many, of reflections and of traced diffuse light, and make
                                                       // the rest from it: shaders/reconstruct.comp. Mirrors are traced at every pixel
        bool counts = false; // write what each pixel's ray cost: an image of 16 bytes a pixel
        Spirv glossyShader;  // SPIR-V with trace_glossy.comp's interface; empty: our tracer. The bench brings its baselines through it.
    };
    /// Errors: badArgument (size, or an effect whose maps the field doesn't hold: named), outOfMemory, deviceFailure.
    static Result<IndirectLight> create(Gpu& gpu, const LightField& field, const Desc& desc);

    /// Binds the G-buffer; before the first record and whenever its views change. Not while the GPU runs a recorded frame.
    void setInputs(const FrameInputs& inputs);
    /// Record frames in the order in which they are shown, where the effect `temporal` is on. Ends with the barrier that lets any later
    /// stage read the outputs (layout GENERAL).
    /// @param timer  optional; scopes "classify tiles", "gather light", "diffuse trace", "glossy trace", "mirror trace", "diffuse fill",
    ///               "glossy fill", "glossy denoise"
    void record(VkCommandBuffer cmd, const gpu::FrameView& view, GpuTimer* timer = nullptr) noexcept;

    // Outputs, RGBA32F; empty when the effect is off. An image holds values where a pixel has the term (shaders/shared/frame.h, termsOf)
    // and anything elsewhere; shaders/compose.comp shows how they make a picture.
    const GpuImage& diffuse() const
    {
        return diffuseImage;
    }                                                    // rgb cosine-weighted mean of what surfaces reflect: no albedo, and no light
                                                         // straight from emitters or sky, unless it is traced
    const GpuImage& rough() const { return roughImage; } // rgb radiance reflected to the eye, BRDF included; as the next two
    const GpuImage& glossy() const { return glossyImage; }
    const GpuImage& mirror() const { return mirrorImage; }
    const GpuImage& counts() const { return countImage; } // RGBA32UI: probe, hand-offs, reads, unknown rays; of the traced terms
    /// The tiles of each term, for the host's own passes over the terms; null when no term is made.
    const TileList* tiles() const { return tileList.get(); }
    uint64_t deviceBytes() const;

private:
    IndirectLight() = default;
    Status makeImage(GpuImage& target, VkFormat format, const char* what);
    Status makePass(Pipeline& pipeline, DescriptorSet& set, Spirv shader, std::initializer_list<const GpuImage*> images,
                    std::initializer_list<uint32_t> constants);
    Status makeTrace(uint32_t term, GpuImage& image, Pipeline& pipeline, DescriptorSet& set);
    Status makeFill(uint32_t term, const GpuImage& image, Pipeline& pipeline, DescriptorSet& set);
    Status makeGather();
    uint32_t everyLog() const { return uint32_t(std::countr_zero(desc.traceEvery)); }
    bool gathersDiffuse() const { return desc.effects.diffuse && !desc.effects.tracedDiffuse; }
    uint32_t gatherList() const // of the tiles that the gathering pass runs on
    {
        return !gathersDiffuse() ? gpu::kTermRough : desc.effects.rough ? gpu::kListGathered : gpu::kTermDiffuse;
    }
    Gpu* gpu = nullptr;
    const LightField* field = nullptr;
    Desc desc;
    Buffer frame, brdfTable;
    GpuImage glossyImage, scratch, mirrorImage, countImage, noCounts, diffuseImage, roughImage;
    std::unique_ptr<TileList> tileList; // its address is what denoisers keep
    DescriptorSet glossySet, mirrorSet, diffuseSet, gatherSet, glossyFillSet, diffuseFillSet;
    Pipeline glossyPass, mirrorPass, diffusePass, gatherPass, glossyFill, diffuseFill;
    Denoiser denoiser;
};

} // namespace sconce
