#pragma once

#include <array>
#include <bit>
#include <memory>

#include "runtime/field/light_field.h"
#include "runtime/frame/denoiser.h"
#include "runtime/frame/frame_inputs.h"
#include "runtime/sconce.h"

namespace sconce
{

/// Passes in place of ours, SPIR-V with the interfaces of trace_glossy.comp and gather_light.comp; empty: our own. The bench brings its
/// opponents through them.
struct LightShaders
{
    Spirv glossy;                               // of the traced terms
    Spirv gather;                               // of diffuse light and rough reflections that are read
    std::vector<ShaderConstant> constants = {}; // of gather, besides ours
};

/// What stands behind the handle IndirectLight.
struct IndirectLight::State
{
    std::shared_ptr<Gpu> gpu;
    LightField field;
    Desc desc;
    LightShaders shaders;
    Buffer frame;
    Buffer screen;                     // clipFromWorld of the frame, of screen_trace.glsl; null: rays don't ask the picture
    Buffer moving;                     // gpu::MovingShapesHead, shapes, their light; null: nothing moves
    std::vector<std::byte> shapeBytes; // of the next frame
    std::array<bool, 2> kindsMove{};   // round shapes, boxes
    GpuImage glossyImage, scratch, mirrorImage, countImage, noCounts, diffuseImage, roughImage;
    std::unique_ptr<TileList> tileList; // its address is what denoisers keep; null when no term is made
    DescriptorSet glossySet, mirrorSet, diffuseSet, surfaceSet, gatherSet, lampSet, glossyFillSet, diffuseFillSet, movingFacingsSet,
        movingDiffuseSet, movingRoughSet;
    Pipeline glossyPass, mirrorPass, diffusePass, surfacePass, surfaceRestPass, gatherPass, lampPass, lampRestPass, glossyFill, diffuseFill,
        movingFacings;
    std::array<Pipeline, 2> movingDiffuse, movingRough; // of round shapes, of boxes
    Denoiser denoiser;
    uint32_t lampLookUps = 0; // the list of what the first pass over lamps leaves

    State(Gpu& device, const LightField& asked, const Desc& wanted, const LightShaders& passes);
    Status make();
    Status makeLamps();  // after it, where the field has some
    Status makeMoving(); // after it, where shapes move
    Status setShapes(std::span<const MovingShape> shapes);
    void setInputs(const FrameInputs& inputs);
    void record(VkCommandBuffer cmd, const gpu::FrameView& view, GpuTimer* timer) noexcept;
    uint64_t deviceBytes() const;
    /// Where the mirror's light is: in the glossy image, where passes write the pixels of their term alone, for no pixel has both.
    const GpuImage& mirrored() const { return mirrorsInGlossy() ? glossyImage : mirrorImage; }
    /// Whether diffuse light is read from the field's surface light, which has no noise and all sources but the host's in it.
    bool readsSurfaces() const { return readsSurfaceLight(desc.effects, field.info()); }

private:
    class Recording;
    Status makeImage(GpuImage& target, VkFormat format, const char* what);
    struct Bound
    {
        uint32_t binding;
        const GpuImage* image;
    };
    Status makePass(Pipeline& pipeline, DescriptorSet& set, Spirv shader, std::initializer_list<Bound> images,
                    std::vector<ShaderConstant> constants, bool traces = false);
    Status makeTrace(uint32_t term, GpuImage& image, Pipeline& pipeline, DescriptorSet& set);
    Status makeFill(uint32_t term, const GpuImage& image, Pipeline& pipeline, DescriptorSet& set);
    Status makeGather();
    uint32_t everyLog() const { return uint32_t(std::countr_zero(desc.traceEvery)); }
    uint32_t untinted(uint32_t term) const { return term == gpu::kTermGlossy && desc.effects.denoise ? 1 : 0; } // gpu::kUntintedId
    bool mirrorsInGlossy() const { return desc.effects.tiles && desc.effects.glossy && desc.effects.mirror; }
    bool asksPicture() const { return desc.effects.screenTrace && (desc.effects.glossy || desc.effects.mirror); }
    bool tracesDiffuse() const { return desc.effects.diffuse && desc.effects.tracedDiffuse; }
    bool gathersDiffuse() const { return desc.effects.diffuse && !tracesDiffuse() && !readsSurfaces(); }
    std::vector<TileList::LookUps> lookUps() const;
    bool hasLamps() const { return field.state().lampCount > 0; }
    uint32_t gatherLookUps() const { return readsSurfaces() || hasLamps() ? 2 : 0; } // the gathering pass's list of them
};

Result<IndirectLight> makeIndirectLight(Gpu& gpu, const LightField& field, const IndirectLight::Desc& desc,
                                        const LightShaders& passes = {});

} // namespace sconce
