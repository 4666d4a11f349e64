#pragma once

#include <array>
#include <optional>

#include "runtime/frame/indirect_light.h"
#include "runtime/scene/device_scene.h"
#include "scene/scene.h"

namespace sconce
{

/// A small deferred renderer around IndirectLight: what `sconce render` and the bench draw with, and an example of a host.
/// Ranges and prices: base/knobs.h.
struct RenderSettings
{
    uint32_t width = knobs::width.value, height = knobs::height.value; // pixels
    uint32_t glossyRays = knobs::glossyRays.value;                     // rays a pixel; time of the trace grows in proportion
    uint32_t traceEvery = knobs::traceEvery.value;                     // as in IndirectLight::Desc
    uint32_t surfaceProbes = knobs::surfaceProbes.value;               // the same
    IndirectEffects effects;
    bool layers = true;                              // keep each term's share of the picture, and what rays cost: 32 bytes a pixel
    float raysBelow = knobs::raysBelow.value;        // roughness: reflections below it are traced, above it read from prefiltered radiance
    std::optional<float> roughness;                  // [0,1]: every surface has this roughness (the benchmark of both papers)
    uint32_t areaSamples = knobs::areaSamples.value; // samples of the emitters, and as many of the sky, a pixel; noise falls with the root
    uint32_t seed = knobs::frameSeed.value;
    std::vector<MovingShape> shapes;                // that move: of the scene that is drawn, but not of the field's
    LightShaders lightShaders;                      // as makeIndirectLight() takes them
    float normalOffset = knobs::normalOffset.value; // share of the scene's diagonal that rays start off their surface
};

/// One frame in host memory, row 0 at the top.
struct RenderedFrame
{
    uint32_t width = 0, height = 0;
    std::vector<vec3> beauty, direct, diffuseIndirect, glossyIndirect; // radiance to the eye, W/(m^2 sr); the last three 0 without layers
    std::vector<float> depth;                                          // metres along the view axis; 0: nothing
    std::vector<vec3> normal;                                          // shading normal on the viewer's side; 0: nothing
    std::vector<vec3> albedo;                                          // base colour, linear
    std::vector<float> roughness;
    std::vector<glm::uvec4> counts;      // probe, hand-offs, reads, unknown rays of the glossy trace
    std::vector<GpuTimer::Scope> times;  // milliseconds a pass, by the GPU's clock
    size_t clamped = 0;                  // pixels with a term of indirect light at gpu::kMostLight, which may have been brighter
    std::array<size_t, 6> diffuseFrom{}; // pixels whose diffuse light is read at surfaces: of the probes' irradiance alone, of cells in the
                                         // open, of hidden surfaces, of the nearest texel, of one probe, of two; 0 with other diffuse light
};

/// What a frame has drawn, for whoever shows it; in VK_IMAGE_LAYOUT_GENERAL, G-buffer and depth in SHADER_READ_ONLY_OPTIMAL. Null: not
/// made.
struct FramePictures
{
    const GpuImage* beauty;                              // RGBA32F, radiance to the eye; as the next three
    const GpuImage *direct, *diffuseLayer, *glossyLayer; // RGBA16F; direct light is storedBright() of shaders/stored_light.glsl
    const GpuImage *normalRoughness, *baseColorMetallic, *depth;
    const GpuImage* counts; // RGBA32UI, as RenderedFrame::counts
    float depthScale;       // metres along the view's axis times what `depth` holds
};

class SceneRenderer
{
public:
    static Result<std::unique_ptr<SceneRenderer>> create(Gpu& gpu, const DeviceScene& scene, const LightField& field,
                                                         const RenderSettings& settings);
    /// Records G-buffer, direct light, indirect light and composition.
    void record(VkCommandBuffer cmd, const Camera& camera, uint32_t seed, GpuTimer* timer);
    /// Records, submits and waits; milliseconds a pass, by the GPU's clock. Without a pause between frames, as a host draws.
    /// @param index  of the frame in a sequence: added to the seed
    Result<std::vector<GpuTimer::Scope>> draw(const Camera& camera, uint32_t index = 0);
    /// The same, and reads every picture back.
    Result<RenderedFrame> render(const Camera& camera, uint32_t index = 0);
    /// Reads the pictures of the last recorded frame back, once it was submitted; without times. Submits and waits.
    Result<RenderedFrame> read();
    FramePictures pictures() const;
    /// What passes read anew in each frame, from the next on: glossyRays, raysBelow, areaSamples, normalOffset and seed. The rest of the
    /// settings is fixed. Errors: badArgument (names the knob); what was set before stays.
    Status setSampling(const RenderSettings& wanted);
    /// As IndirectLight::setShapes(), of as many as RenderSettings::shapes has at most. What is drawn is the scene's affair.
    Status setShapes(std::span<const MovingShape> shapes) { return indirect->setShapes(shapes); }
    /// The next frame doesn't follow the one before: the camera is cut.
    void cut() { before.reset(); }
    /// Light is another from the next frame on: histories forget what was.
    void lightChanged() { changing = gpu::kChangeFrames; }
    /// Bytes of the images and buffers of indirect light, as many as its effects call for.
    uint64_t deviceBytes() const;

private:
    SceneRenderer(Gpu& device, const DeviceScene& lit, const LightField& asked, const RenderSettings& wanted)
        : gpu(device), scene(lit), field(asked), settings(wanted)
    {
    }
    Status make();
    Status makePass(Pipeline& pipeline, DescriptorSet& set, Spirv shader, std::span<const DescriptorSet::Binding> extra, uint32_t pushBytes,
                    VkDescriptorSetLayout first, std::span<const ShaderConstant> constants, VkDescriptorSetLayout third = VK_NULL_HANDLE);
    Status makeDiffuse();
    Status makeCompose();
    bool hasAreaLight() const;
    /// Of the diffuse filter, which runs after the glossy one: that one's, where there is one.
    const GpuImage& filterScratch() const { return scratch ? scratch : indirect->state().scratch; }
    void drawGBuffer(VkCommandBuffer cmd, const gpu::SceneView& view);
    Result<std::vector<glm::vec4>> readBack(const GpuImage& image, VkImageLayout layout);

    Gpu& gpu;
    const DeviceScene& scene;
    LightField field; // a handle: the caller's may go
    RenderSettings settings;
    GpuImage depth, normalRoughness, baseColorMetallic, geometricNormal, direct, beauty, scratch, diffuseLayer, glossyLayer;
    Pipeline gBufferPass, directPass, areaPass, composePass;
    DescriptorSet directSet, areaSet, composeSet;
    Denoiser denoiser;
    std::optional<Camera> before; // the camera of the frame before
    uint32_t changing = 0;        // frames to come of changed light
    FrameInputs gBuffer;
    std::optional<IndirectLight> indirect;
    SceneDraws draws;
};

} // namespace sconce
