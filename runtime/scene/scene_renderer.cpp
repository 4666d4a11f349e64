#include "runtime/scene/scene_renderer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "runtime/vulkan/nan_scan.h"
#include "scene/camera_check.h"
#include "shaders/shared/frame_passes.h"

#include "spirv/area_light_comp.h"
#include "spirv/area_light_field_comp.h"
#include "spirv/compose_comp.h"
#include "spirv/direct_comp.h"
#include "spirv/gbuffer_frag.h"
#include "spirv/gbuffer_vert.h"

namespace sconce
{
namespace
{

// The G-buffer, 24 bytes a pixel with depth; emission is drawn into the direct light, which is there anyway. Base colour in 8 bits of sRGB
// would save 4 of them, and is seen: bench/results/tried.json, frame__srgb.
constexpr VkFormat kGBufferFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat kGeometricNormalFormat = VK_FORMAT_R32_UINT;
constexpr VkFormat kPictureFormat = VK_FORMAT_R32G32B32A32_SFLOAT; // what is shown and written, of any brightness
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr float kNear = 1e-6f; // field units, a millimetre of a kilometre; depth is near / W, so its value costs no precision

struct CameraBasis
{
    vec3 right, up, forward; // right and up scaled by the tangents of the half angles
};

CameraBasis basisOf(const Camera& camera, uint32_t width, uint32_t height)
{
    const float tangent = std::tan(0.5f * camera.verticalFov);
    CameraBasis basis;
    basis.forward = glm::normalize(camera.forward);
    const vec3 right = glm::normalize(glm::cross(basis.forward, camera.up));
    basis.right = right * tangent * float(width) / float(height);
    basis.up = glm::cross(right, basis.forward) * tangent;
    return basis;
}

/// x right, y down, depth near / W.
gpu::SceneView viewOf(const Camera& camera, const CameraBasis& basis, const gpu::LightFieldInfo& space)
{
    const vec3 x = basis.right / glm::dot(basis.right, basis.right), y = -basis.up / glm::dot(basis.up, basis.up), w = basis.forward;
    gpu::SceneView view;
    view.clip = mat4(vec4(x.x, y.x, 0, w.x), vec4(x.y, y.y, 0, w.y), vec4(x.z, y.z, 0, w.z), vec4(0, 0, kNear, 0));
    view.centre = (camera.eye - space.origin) / space.scale;
    return view;
}

/// The inverse: world * depth = eye * depth + scale * near * (forward + x right - y up), and w = depth.
mat4 worldFromClip(const Camera& camera, const CameraBasis& basis, const gpu::LightFieldInfo& space)
{
    const float s = space.scale * kNear;
    return mat4(vec4(s * basis.right, 0), vec4(-s * basis.up, 0), vec4(camera.eye, 1), vec4(s * basis.forward, 0));
}

/// x right, y down, w metres along the view's axis.
mat4 clipFromWorld(const Camera& camera, const CameraBasis& basis)
{
    const vec3 x = basis.right / glm::dot(basis.right, basis.right), y = -basis.up / glm::dot(basis.up, basis.up), w = basis.forward;
    const vec3 origin(glm::dot(x, camera.eye), glm::dot(y, camera.eye), glm::dot(w, camera.eye));
    return mat4(vec4(x.x, y.x, 0, w.x), vec4(x.y, y.y, 0, w.y), vec4(x.z, y.z, 0, w.z), vec4(-origin.x, -origin.y, 0, -origin.z));
}

} // namespace

Status SceneRenderer::makePass(Pipeline& pipeline, DescriptorSet& set, Spirv shader, std::span<const DescriptorSet::Binding> extra,
                               uint32_t pushBytes, VkDescriptorSetLayout first, std::span<const ShaderConstant> constants,
                               VkDescriptorSetLayout third)
{
    auto made = makeFrameSet(gpu, indirect->state().frame, extra);
    if (!made) return made.error();
    set = std::move(*made);
    writeInputs(set, gBuffer);
    const VkDescriptorSetLayout layouts[] = {first, set.layout(), third};
    auto built = Pipeline::compute(gpu, shader, std::span(layouts).first(third ? 3 : 2), pushBytes, constants);
    if (!built) return built.error();
    pipeline = std::move(*built);
    return success();
}

Status SceneRenderer::make()
{
    const IndirectEffects& effects = settings.effects;
    const bool rays = effects.glossy || effects.mirror;
    // First, since passes made below take its images and its list of tiles.
    auto light = makeIndirectLight(gpu, field,
                                   {settings.width, settings.height, effects, settings.traceEvery, settings.surfaceProbes,
                                    settings.layers && rays, uint32_t(settings.shapes.size())},
                                   settings.lightShaders);
    if (!light) return light.error();
    if (Status status = light->setShapes(settings.shapes); !status) return status;
    indirect.emplace(std::move(*light));

    // Whatever is drawn is sampled by passes and may be copied, by readBack() or a scan for NaN.
    auto image = [&](GpuImage& target, VkFormat format, VkImageUsageFlags usage, const char* what) -> Status
    {
        ImageDesc desc;
        desc.format = format;
        desc.width = settings.width;
        desc.height = settings.height;
        desc.usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        auto made = gpu.makeImage(desc, what);
        if (!made) return made.error();
        target = std::move(*made);
        return success();
    };
    if (auto s = image(depth, kDepthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, "depth"); !s) return s;
    for (auto [target, format, usage, what] : {std::tuple{&normalRoughness, kGBufferFormat, VkImageUsageFlags(0), "normals"},
                                               {&baseColorMetallic, kGBufferFormat, VkImageUsageFlags(0), "base colour"},
                                               {&direct, kLightFormat, VkImageUsageFlags(VK_IMAGE_USAGE_STORAGE_BIT), "direct light"},
                                               {&geometricNormal, kGeometricNormalFormat, VkImageUsageFlags(0), "geometric normals"}})
        if (auto s = image(*target, format, usage | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, what); !s) return s;
    const bool filtersDiffuse = effects.diffuse && !indirect->state().readsSurfaces();
    for (auto [target, format, what, wanted] :
         {std::tuple{&beauty, kPictureFormat, "picture", true},
          {&scratch, kLightFormat, "scratch of the diffuse filter", filtersDiffuse && !indirect->state().scratch},
          {&diffuseLayer, kLightFormat, "diffuse layer", settings.layers && effects.diffuse},
          {&glossyLayer, kLightFormat, "glossy layer", settings.layers && (effects.rough || rays)}})
    {
        if (!wanted) continue;
        auto made = makeLightImage(gpu, format, settings.width, settings.height, what);
        if (!made) return made.error();
        *target = std::move(*made);
    }
    gBuffer = {.depth = depth.view(),
               .normalRoughness = normalRoughness.view(),
               .baseColorMetallic = baseColorMetallic.view(),
               .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
               .pictureBefore = beauty.view(), // until a frame writes its own over it
               .pictureLayout = VK_IMAGE_LAYOUT_GENERAL};
    // Once: the images of the G-buffer stay the same in all frames.
    indirect->setInputs(gBuffer);

    // In the order of the fragment shader's outputs.
    const VkFormat formats[] = {kGBufferFormat, kGBufferFormat, kLightFormat, kGeometricNormalFormat};
    const VkDescriptorSetLayout layouts[] = {scene.layout()};
    // Below 0: surfaces keep their own. A specialization constant is 32 bits of any type, here a float's.
    const float roughness = settings.roughness.value_or(-1.0f);
    const ShaderConstant constant{gpu::kRoughnessOverrideId, std::bit_cast<uint32_t>(roughness)};
    Pipeline::Graphics desc;
    desc.vertex = gbuffer_vert;
    desc.fragment = gbuffer_frag;
    desc.sets = layouts;
    desc.pushBytes = sizeof(gpu::SceneView);
    desc.vertexBindings = SceneMesh::vertexBindings();
    desc.vertexAttributes = SceneMesh::vertexAttributes();
    desc.colorFormats = formats;
    desc.depthFormat = kDepthFormat;
    desc.constants = std::span(&constant, 1);
    auto pipeline = Pipeline::graphics(gpu, desc);
    if (!pipeline) return pipeline.error();
    gBufferPass = std::move(*pipeline);

    // Without the field's set: direct light is of lights and their shadow maps alone, whatever the probes know.
    const DescriptorSet::Binding directBindings[] = {{gpu::kDirectNormalBinding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                                                     {gpu::kDirectLightBinding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
    if (auto s = makePass(directPass, directSet, direct_comp, directBindings, sizeof(gpu::DirectPush), scene.layout(), {}); !s) return s;
    directSet.write(gpu::kDirectNormalBinding, geometricNormal.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    directSet.write(gpu::kDirectLightBinding, direct.view(), VK_IMAGE_LAYOUT_GENERAL);

    if (effects.diffuse)
        if (auto s = makeDiffuse(); !s) return s;
    return makeCompose();
}

bool SceneRenderer::hasAreaLight() const
{
    const gpu::LightsHeader& lights = scene.lights().header;
    return !settings.effects.tracedDiffuse && lights.emitterCount + lights.skyCount > 0; // traced light has them in it
}

/// Light of emitters and sky, and the filter over all diffuse light: nothing of it with surface light, which has all in it and no noise.
Status SceneRenderer::makeDiffuse()
{
    if (indirect->state().readsSurfaces()) return success();
    if (hasAreaLight())
    {
        const DescriptorSet::Binding bindings[] = {{gpu::kAreaNormalBinding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                                                   {gpu::kAreaDiffuseBinding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                                                   {gpu::kTileBinding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
        const bool traced = settings.effects.fieldShadows;
        std::vector<ShaderConstant> constants = {indirect->state().tileList->constant()};
        if (traced)
            for (const ShaderConstant& ofField : shaderConstants(field)) constants.push_back(ofField);
        if (auto s = makePass(areaPass, areaSet, traced ? Spirv(area_light_field_comp) : Spirv(area_light_comp), bindings,
                              sizeof(gpu::AreaPush), scene.layout(), constants, traced ? field.layout() : VK_NULL_HANDLE);
            !s)
            return s;
        areaSet.write(gpu::kAreaNormalBinding, geometricNormal.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        areaSet.write(gpu::kAreaDiffuseBinding, indirect->state().diffuseImage.view(), VK_IMAGE_LAYOUT_GENERAL);
        areaSet.write(gpu::kTileBinding, indirect->state().tileList->buffer());
    }
    // Read where probes are, it has none.
    if (!hasAreaLight() && !settings.effects.tracedDiffuse && !settings.effects.patches) return success();
    const Denoiser::Desc desc{scene.layout(), gpu::kTermDiffuse, false, settings.effects.temporal, false, indirect->state().tileList.get(),
                              settings.width, settings.height};
    auto made = Denoiser::create(gpu, desc, indirect->state().frame, indirect->state().diffuseImage, filterScratch());
    if (!made) return made.error();
    denoiser = std::move(*made);
    denoiser.setInputs(gBuffer);
    return success();
}

Status SceneRenderer::makeCompose()
{
    const IndirectEffects& effects = settings.effects;
    struct Shown
    {
        uint32_t binding;
        const GpuImage& image;
        bool made;
        VkDescriptorType type = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    };
    // What is not made is not read: anything of the format may be bound in its place.
    const Shown images[] = {{gpu::kComposeDirectBinding, direct, true},
                            {gpu::kComposeDiffuseBinding, indirect->state().diffuseImage, effects.diffuse},
                            {gpu::kComposeRoughBinding, indirect->state().roughImage, effects.rough},
                            {gpu::kComposeGlossyBinding, indirect->state().glossyImage, effects.glossy},
                            {gpu::kComposeMirrorBinding, indirect->state().mirrored(), effects.mirror},
                            {gpu::kComposeBeautyBinding, beauty, true, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                            {gpu::kComposeDiffuseLayerBinding, diffuseLayer, bool(diffuseLayer), VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                            {gpu::kComposeGlossyLayerBinding, glossyLayer, bool(glossyLayer), VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
    std::vector<DescriptorSet::Binding> bindings;
    for (const Shown& shown : images) bindings.push_back({shown.binding, shown.type});
    uint32_t made = 0;
    for (const auto& [term, on] : {std::pair{gpu::kTermDiffuse, effects.diffuse},
                                   {gpu::kTermRough, effects.rough},
                                   {gpu::kTermGlossy, effects.glossy},
                                   {gpu::kTermMirror, effects.mirror}})
        made |= on ? 1u << term : 0u;
    const ShaderConstant constants[] = {
        {gpu::kMadeId, made}, {gpu::kDiffuseLayerId, diffuseLayer ? 1u : 0u}, {gpu::kGlossyLayerId, glossyLayer ? 1u : 0u}};
    if (auto s = makePass(composePass, composeSet, compose_comp, bindings, 0, scene.layout(), constants); !s) return s;
    for (const Shown& shown : images) composeSet.write(shown.binding, (shown.made ? shown.image : direct).view(), VK_IMAGE_LAYOUT_GENERAL);
    return success();
}

namespace
{

std::string settingsFault(const RenderSettings& settings)
{
    return firstFault({faultOf(knobs::glossyRays, settings.glossyRays), faultOf(knobs::raysBelow, settings.raysBelow),
                       faultOf(knobs::areaSamples, settings.areaSamples),
                       settings.roughness ? faultOf(knobs::roughness, *settings.roughness) : std::string()});
}

} // namespace

Status SceneRenderer::setSampling(const RenderSettings& wanted)
{
    if (std::string fault = settingsFault(wanted); !fault.empty()) return Error{ErrorCode::badArgument, std::move(fault)};
    settings.glossyRays = wanted.glossyRays;
    settings.raysBelow = wanted.raysBelow;
    settings.areaSamples = wanted.areaSamples;
    settings.normalOffset = wanted.normalOffset;
    settings.seed = wanted.seed;
    return success();
}

Result<std::unique_ptr<SceneRenderer>> SceneRenderer::create(Gpu& gpu, const DeviceScene& scene, const LightField& field,
                                                             const RenderSettings& settings)
{
    const std::string fault = settingsFault(settings);
    if (!fault.empty()) return Error{ErrorCode::badArgument, fault};
    const bool mapless = std::ranges::any_of(scene.lights().lights, [](const gpu::GpuLight& l) { return l.shadowLayer == kNoShadowMap; });
    if (mapless && settings.effects.diffuse && !readsSurfaceLight(settings.effects, field.info()) && !settings.effects.tracedDiffuse &&
        !settings.effects.fieldShadows)
        return Error{ErrorCode::badArgument,
                     "The scene's emitters and sky have no shadow maps; make it with sceneForFrames() of the same effects, or ask for "
                     "fieldShadows"};
    std::unique_ptr<SceneRenderer> made(new SceneRenderer(gpu, scene, field, settings));
    if (auto status = made->make(); !status) return status.error();
    return made;
}

void SceneRenderer::drawGBuffer(VkCommandBuffer cmd, const gpu::SceneView& view)
{
    const GpuImage* targets[] = {&normalRoughness, &baseColorMetallic, &direct, &geometricNormal}; // as the shader's outputs
    const GpuImage* const sampled[] = {&normalRoughness, &baseColorMetallic, &geometricNormal};
    VkRenderingAttachmentInfo colors[4]{};
    // Write after read: the frame before, or a copy of it to the host, may still read them; and after write: direct light was a pass's.
    // From undefined: every pixel is cleared, so that nothing needs to be kept.
    constexpr VkPipelineStageFlags2 readers =
        VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    transition(gpu, cmd, targets,
               {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, readers,
                VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT});
    for (int i = 0; i < 4; ++i)
    {
        colors[i].sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
        colors[i].imageView = targets[i]->view();
        colors[i].imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        colors[i].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        colors[i].storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    }
    constexpr VkPipelineStageFlags2 tests = VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
    // Depth likewise; its tests read it, too.
    transition(gpu, cmd, depth,
               {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, readers, tests, 0,
                VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT});
    VkRenderingAttachmentInfo depthInfo{};
    depthInfo.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    depthInfo.imageView = depth.view();
    depthInfo.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depthInfo.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR; // to 0: nothing, infinitely far
    depthInfo.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    rendering.renderArea.extent = {settings.width, settings.height};
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = 4;
    rendering.pColorAttachments = colors;
    rendering.pDepthAttachment = &depthInfo;
    gpu.vk.CmdBeginRendering(cmd, &rendering);
    const VkViewport viewport{0.0f, 0.0f, float(settings.width), float(settings.height), 0.0f, 1.0f};
    const VkRect2D scissor{{0, 0}, {settings.width, settings.height}};
    gpu.vk.CmdSetViewport(cmd, 0, 1, &viewport);
    gpu.vk.CmdSetScissor(cmd, 0, 1, &scissor);
    const VkDescriptorSet sets[] = {scene.descriptorSet()};
    gBufferPass.bind(cmd, sets);
    gBufferPass.push(cmd, view);
    scene.mesh().bind(cmd);
    scene.mesh().leaveOutBackFaces(cmd, view);
    scene.mesh().cull(view, draws);
    // One pipeline for both kinds, unlike a shadow map's: the G-buffer reads the material of every triangle anyway.
    scene.mesh().draw(cmd, draws.opaque);
    scene.mesh().draw(cmd, draws.masked);
    gpu.vk.CmdEndRendering(cmd);
    constexpr VkImageLayout read = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    // Read after write: compute passes alone read the G-buffer, and one adds to the direct light.
    transition(gpu, cmd, direct,
               {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT});
    transition(gpu, cmd, sampled,
               {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, read, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT});
    // The same for depth, whichever tests wrote it.
    transition(gpu, cmd, depth,
               {VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, read, tests, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT});
}

void SceneRenderer::record(VkCommandBuffer cmd, const Camera& camera, uint32_t seed, GpuTimer* timer)
{
    const gpu::LightFieldInfo& space = field.info();
    const CameraBasis basis = basisOf(camera, settings.width, settings.height);
    gpu::FrameView view = field.frameView(settings.width, settings.height);
    view.worldFromClip = worldFromClip(camera, basis, space);
    view.eye = camera.eye;
    view.seed = seed;
    view.glossyRays = settings.glossyRays;
    view.raysBelow = settings.raysBelow;
    // Without a frame before, or after a cut, view.follows stays 0 and histories count for nothing.
    if (before)
    {
        view.follows = changing > 0 ? gpu::kFollowsChange : 1;
        view.eyeBefore = before->eye;
        view.clipFromWorldBefore = clipFromWorld(*before, basisOf(*before, settings.width, settings.height));
    }
    before = camera;
    changing -= changing > 0 ? 1 : 0;
    // In metres; as a share of the diagonal the setting fits scenes of any size.
    view.normalOffset = settings.normalOffset * space.diagonal * space.scale;

    if (timer) timer->begin(cmd, "G-buffer");
    drawGBuffer(cmd, viewOf(camera, basis, space));
    if (timer) timer->end(cmd);
    for (const GpuImage* image : {&depth, &normalRoughness, &baseColorMetallic})
        scanImage(gpu, cmd, "G-buffer", *image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    scanImage(gpu, cmd, "G-buffer", direct);

    // Begins by waiting for the frame before, so that nothing of this one, but the G-buffer, may stand ahead of it.
    indirect->record(cmd, view, timer);

    constexpr VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    // Workgroups of direct light and composition are 8 x 8 pixels; these passes drop what lies beyond the edge.
    const uint32_t groupsX = (settings.width + 7) / 8, groupsY = (settings.height + 7) / 8;
    if (timer) timer->begin(cmd, "direct light");
    const VkDescriptorSet directSets[] = {scene.descriptorSet(), directSet.handle()};
    directPass.bind(cmd, directSets);
    directPass.push(cmd, gpu::DirectPush{space.origin, space.scale, space.sky, scene.lights().header.deltaCount});
    gpu.vk.CmdDispatch(cmd, groupsX, groupsY, 1);
    if (timer) timer->end(cmd);
    scanImage(gpu, cmd, "direct light", direct);

    const auto begin = [&](const Pipeline& pipeline, const DescriptorSet& set, const char* name, bool withField = false)
    {
        // Read after write: area light adds to the diffuse term in place, composition reads every term and direct light. All of them are
        // compute passes.
        memoryBarrier(gpu, cmd, compute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, compute,
                      VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
        if (timer) timer->begin(cmd, name);
        const VkDescriptorSet sets[] = {scene.descriptorSet(), set.handle(), field.descriptorSet()};
        pipeline.bind(cmd, std::span(sets).first(withField ? 3 : 2));
    };
    if (areaPass)
    {
        begin(areaPass, areaSet, "area light", settings.effects.fieldShadows);
        areaPass.push(cmd, gpu::AreaPush{space.origin, space.scale, settings.areaSamples});
        indirect->state().tileList->dispatch(cmd, gpu::kTermDiffuse);
        if (timer) timer->end(cmd);
        scanImage(gpu, cmd, "area light", indirect->state().diffuseImage);
    }
    // After the area lights, whose noise is filtered together with the rest of the diffuse term.
    if (denoiser)
    {
        if (timer) timer->begin(cmd, "diffuse denoise");
        denoiser.record(cmd, scene.descriptorSet());
        if (timer) timer->end(cmd);
        scanImage(gpu, cmd, "diffuse denoise", indirect->state().diffuseImage);
        scanImage(gpu, cmd, "diffuse denoise", filterScratch());
    }
    begin(composePass, composeSet, "compose");
    gpu.vk.CmdDispatch(cmd, groupsX, groupsY, 1);
    if (timer) timer->end(cmd);
    for (const GpuImage* image : {&beauty, &diffuseLayer, &glossyLayer})
        if (*image) scanImage(gpu, cmd, "compose", *image);
    // Who shows or copies the picture is not known here.
    memoryBarrier(gpu, cmd, compute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                  VK_ACCESS_2_MEMORY_READ_BIT);
}

/// Four 32-bit channels a pixel; 16-bit images are widened.
Result<std::vector<glm::vec4>> SceneRenderer::readBack(const GpuImage& image, VkImageLayout layout)
{
    const size_t pixels = size_t(settings.width) * settings.height;
    const bool isDepth = image.desc().format == kDepthFormat, isHalf = image.desc().format == VK_FORMAT_R16G16B16A16_SFLOAT;
    const size_t pixelBytes = texelBytes(image.desc().format);
    auto buffer = gpu.makeBuffer(pixels * pixelBytes, 0, MemoryUse::readback, "picture read back");
    if (!buffer) return buffer.error();
    auto status = gpu.submit(
        [&](VkCommandBuffer cmd)
        {
            // Read after write. From all commands: the G-buffer's images are written by draws, the others by compute passes.
            transition(gpu, cmd, image,
                       {layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_COPY_BIT,
                        VK_ACCESS_2_MEMORY_WRITE_BIT, VK_ACCESS_2_TRANSFER_READ_BIT});
            VkBufferImageCopy copy{};
            copy.imageSubresource = {image.aspect(), 0, 0, 1};
            copy.imageExtent = {settings.width, settings.height, 1};
            gpu.vk.CmdCopyImageToBuffer(cmd, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer->handle(), 1, &copy);
            // Back to the layout that the descriptors name; the next frame's writes come after the copy's reads.
            transition(gpu, cmd, image,
                       {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout, VK_PIPELINE_STAGE_2_COPY_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                        VK_ACCESS_2_TRANSFER_READ_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT});
            // For the host's reads, which the fence alone doesn't cover.
            memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                          VK_ACCESS_2_HOST_READ_BIT);
        });
    if (!status) return status.error();
    std::vector<glm::vec4> values(pixels);
    for (size_t i = 0; i < pixels; ++i)
    {
        const std::byte* at = buffer->mapped() + i * pixelBytes;
        if (isDepth)
            std::memcpy(&values[i].x, at, 4);
        else if (isHalf)
        {
            uint32_t words[2];
            std::memcpy(words, at, 8);
            values[i] = vec4(glm::unpackHalf2x16(words[0]), glm::unpackHalf2x16(words[1]));
        }
        else
            std::memcpy(&values[i], at, 16);
    }
    return values;
}

uint64_t SceneRenderer::deviceBytes() const
{
    return indirect->deviceBytes() + (scratch ? scratch.bytes() : 0) + denoiser.deviceBytes();
}

Result<std::vector<GpuTimer::Scope>> SceneRenderer::draw(const Camera& camera, uint32_t index)
{
    if (const std::string fault = cameraFault(camera); !fault.empty()) return Error{ErrorCode::badArgument, fault};
    // Room for every pass that a frame can have, 13.
    auto timer = GpuTimer::create(gpu, 16);
    if (!timer) return timer.error();
    auto status = gpu.submit(
        [&](VkCommandBuffer cmd)
        {
            timer->reset(cmd);
            record(cmd, camera, settings.seed + index, &*timer);
        });
    if (!status) return status.error();
    return timer->read();
}

Result<RenderedFrame> SceneRenderer::render(const Camera& camera, uint32_t index)
{
    auto times = draw(camera, index);
    if (!times) return times.error();
    auto frame = read();
    if (frame) frame->times = std::move(*times);
    return frame;
}

FramePictures SceneRenderer::pictures() const
{
    const auto made = [](const GpuImage& image) { return image ? &image : nullptr; };
    return {&beauty,
            &direct,
            made(diffuseLayer),
            made(glossyLayer),
            &normalRoughness,
            &baseColorMetallic,
            &depth,
            made(indirect->state().countImage),
            kNear * field.info().scale};
}

Result<RenderedFrame> SceneRenderer::read()
{
    RenderedFrame frame;
    frame.width = settings.width;
    frame.height = settings.height;
    const size_t pixels = size_t(frame.width) * frame.height;
    auto colors = [&](std::vector<vec3>& target, const GpuImage& image, VkImageLayout layout,
                      std::vector<float>* fourth = nullptr) -> Status
    {
        auto values = readBack(image, layout);
        if (!values) return values.error();
        target.assign(values->begin(), values->end());
        if (fourth)
            for (const vec4& value : *values) fourth->push_back(value.w);
        return success();
    };
    constexpr VkImageLayout general = VK_IMAGE_LAYOUT_GENERAL, read = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    std::vector<float> whole;
    if (auto s = colors(frame.beauty, beauty, general, &whole); !s) return s.error();
    frame.clamped = size_t(std::ranges::count(whole, 0.0f));
    std::vector<float> scales; // of storedBright()
    if (auto s = colors(frame.direct, direct, general, &scales); !s) return s.error();
    for (size_t i = 0; i < pixels; ++i) frame.direct[i] *= scales[i];
    frame.diffuseIndirect.assign(pixels, vec3(0.0f));
    frame.glossyIndirect.assign(pixels, vec3(0.0f));
    frame.counts.assign(pixels, glm::uvec4(gpu::kNoProbe, 0, 0, 0));
    for (const auto& [layer, target] : {std::pair{&diffuseLayer, &frame.diffuseIndirect}, {&glossyLayer, &frame.glossyIndirect}})
        if (*layer)
            if (auto s = colors(*target, *layer, general); !s) return s.error();
    if (indirect->state().countImage)
    {
        auto counts = readBack(indirect->state().countImage, general);
        if (!counts) return counts.error();
        std::memcpy(frame.counts.data(), counts->data(), pixels * sizeof(glm::uvec4));
    }
    if (auto s = colors(frame.normal, normalRoughness, read, &frame.roughness); !s) return s.error();
    for (float& roughness : frame.roughness) roughness = gpu::roughnessOf(roughness);
    std::vector<float> metallic;
    if (auto s = colors(frame.albedo, baseColorMetallic, read, &metallic); !s) return s.error();
    std::vector<vec3> depths;
    if (auto s = colors(depths, depth, read); !s) return s.error();
    frame.depth.resize(pixels);
    for (size_t i = 0; i < pixels; ++i) frame.depth[i] = depths[i].x > 0.0f ? kNear * field.info().scale / depths[i].x : 0.0f;
    if (indirect->state().readsSurfaces())
    {
        std::vector<vec3> light;
        std::vector<float>
            probes; // SurfaceLight::probes, from -3 on, where a pixel has the term: as termsOf() of shaders/shared/frame.h says
        if (auto s = colors(light, indirect->state().diffuseImage, general, &probes); !s) return s.error();
        for (size_t i = 0; i < pixels; ++i)
            if (frame.depth[i] > 0.0f && metallic[i] < 1.0f && glm::any(glm::greaterThan(frame.albedo[i], vec3(0.0f))))
                ++frame.diffuseFrom[size_t(int(probes[i]) + 3)];
    }
    return frame;
}

} // namespace sconce
