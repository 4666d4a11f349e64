#pragma once

#include <bit>
#include <memory>

#include "runtime/field/light_field.h"
#include "runtime/frame/denoiser.h"
#include "runtime/frame/frame_inputs.h"
#include "runtime/sconce.h"

namespace sconce
{

/// What stands behind the handle IndirectLight.
struct IndirectLight::State
{
    std::shared_ptr<Gpu> gpu;
    LightField field;
    Desc desc;
    Spirv glossyShader; // of the traced terms
    Buffer frame;
    GpuImage glossyImage, scratch, mirrorImage, countImage, noCounts, diffuseImage, roughImage;
    std::unique_ptr<TileList> tileList; // its address is what denoisers keep; null when no term is made
    DescriptorSet glossySet, mirrorSet, diffuseSet, gatherSet, glossyFillSet, diffuseFillSet;
    Pipeline glossyPass, mirrorPass, diffusePass, gatherPass, glossyFill, diffuseFill;
    Denoiser denoiser;

    State(Gpu& device, const LightField& asked, const Desc& wanted, Spirv shader);
    Status make();
    void setInputs(const FrameInputs& inputs);
    void record(VkCommandBuffer cmd, const gpu::FrameView& view, GpuTimer* timer) noexcept;
    uint64_t deviceBytes() const;

private:
    Status makeImage(GpuImage& target, VkFormat format, const char* what);
    struct Bound
    {
        uint32_t binding;
        const GpuImage* image;
    };
    Status makePass(Pipeline& pipeline, DescriptorSet& set, Spirv shader, std::initializer_list<Bound> images,
                    std::initializer_list<ShaderConstant> constants);
    Status makeTrace(uint32_t term, GpuImage& image, Pipeline& pipeline, DescriptorSet& set);
    Status makeFill(uint32_t term, const GpuImage& image, Pipeline& pipeline, DescriptorSet& set);
    Status makeGather();
    uint32_t everyLog() const { return uint32_t(std::countr_zero(desc.traceEvery)); }
    bool gathersDiffuse() const { return desc.effects.diffuse && !desc.effects.tracedDiffuse; }
    uint32_t gatherList() const // of the tiles that the gathering pass runs on
    {
        return !gathersDiffuse() ? gpu::kTermRough : desc.effects.rough ? gpu::kListGathered : gpu::kTermDiffuse;
    }
};

/// @param glossyShader  SPIR-V with trace_glossy.comp's interface; empty: our tracer. The bench brings its opponents through it.
Result<IndirectLight> makeIndirectLight(Gpu& gpu, const LightField& field, const IndirectLight::Desc& desc, Spirv glossyShader = {});

} // namespace sconce
