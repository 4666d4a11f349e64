#include "runtime/scene/device_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <span>
#include <tuple>

#include <fmt/format.h>

#include "base/numbers.h"
#include "runtime/vulkan/nan_scan.h"
#include "spirv/shadow_masked_frag.h"
#include "spirv/shadow_masked_vert.h"
#include "spirv/shadow_vert.h"

namespace sconce
{

namespace
{

constexpr float kNearBorder = 0.25f; // of the width of the finest map about an eye: as far as the eye may go from its middle

std::string eyeFault(vec3 eye)
{
    if (finite(eye)) return {};
    return fmt::format("The eye {}, {}, {} that the sun's maps are to be about isn't a place; give it in metres", eye.x, eye.y, eye.z);
}

std::string settingsFault(const DeviceSceneDesc& desc)
{
    const LightSettings& light = desc.light;
    const Knob<uint32_t>&emitters = light.areaShadows ? knobs::emitterSamples : knobs::tracedLightSamples,
          &sky = light.areaShadows ? knobs::skySamples : knobs::tracedLightSamples;
    for (const auto& [name, knob, value] : {std::tuple{knobs::emitterSamples.name, emitters, light.emitterSamples},
                                            std::tuple{knobs::skySamples.name, sky, light.skySamples}})
        if (!knob.inRange(value)) return knob_words::fault(name, knobText(value), rangeText(knob));
    return firstFault({light.eye ? eyeFault(*light.eye) : "", faultOf(knobs::textureSize, desc.maxTextureSize),
                       faultOf(knobs::sunShadow, light.sunShadow), faultOf(knobs::pointShadow, light.pointShadow),
                       faultOf(knobs::emitterShadow, light.emitterShadow), faultOf(knobs::skyShadow, light.skyShadow)});
}

Result<GpuImage> depthArray(Gpu& gpu, uint32_t size, uint32_t layers, VkFormat format, const char* what)
{
    ImageDesc desc;
    desc.format = format;
    desc.width = desc.height = size;
    desc.layers = layers;
    desc.array = true;
    desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    return gpu.makeImage(desc, what);
}

} // namespace

/// The pipelines that draw depth alone, for one depth format.
struct DeviceScene::DepthPipelines
{
    Pipeline opaque, masked;

    static Result<DepthPipelines> create(Gpu& gpu, VkDescriptorSetLayout sceneSet, VkFormat format, bool hasMasked)
    {
        const VkDescriptorSetLayout sets[] = {sceneSet};
        Pipeline::Graphics desc;
        desc.vertex = shadow_vert;
        desc.pushBytes = sizeof(gpu::SceneView);
        desc.vertexBindings = SceneMesh::vertexBindings();
        desc.vertexAttributes = SceneMesh::vertexAttributes().first(1);
        desc.depthFormat = format;
        auto opaque = Pipeline::graphics(gpu, desc);
        if (!opaque) return opaque.error();
        if (!hasMasked) return DepthPipelines{std::move(*opaque), {}};
        desc.vertex = shadow_masked_vert;
        desc.fragment = shadow_masked_frag;
        desc.sets = sets;
        desc.vertexAttributes = SceneMesh::vertexAttributes();
        auto masked = Pipeline::graphics(gpu, desc);
        if (!masked) return masked.error();
        return DepthPipelines{std::move(*opaque), std::move(*masked)};
    }
};

namespace
{

void renderDepth(Gpu& gpu, VkCommandBuffer cmd, const DeviceScene::DepthPipelines& pipelines, const SceneMesh& mesh,
                 VkDescriptorSet sceneSet, const GpuImage& maps, uint32_t layer, const gpu::SceneView& view, SceneDraws& draws)
{
    VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    depth.imageView = maps.layerView(layer);
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE; // cleared to 0: infinitely far
    const uint32_t size = maps.desc().width;
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea = {{0, 0}, {size, size}};
    rendering.layerCount = 1;
    rendering.pDepthAttachment = &depth;
    gpu.vk.CmdBeginRendering(cmd, &rendering);
    const VkViewport viewport{0.0f, 0.0f, float(size), float(size), 0.0f, 1.0f};
    gpu.vk.CmdSetViewport(cmd, 0, 1, &viewport);
    gpu.vk.CmdSetScissor(cmd, 0, 1, &rendering.renderArea);
    mesh.bind(cmd);
    mesh.cull(view, draws);
    if (!draws.opaque.empty())
    {
        pipelines.opaque.bind(cmd);
        pipelines.opaque.push(cmd, view);
        mesh.draw(cmd, draws.opaque);
    }
    if (!draws.masked.empty())
    {
        pipelines.masked.bind(cmd, {&sceneSet, 1});
        pipelines.masked.push(cmd, view);
        mesh.draw(cmd, draws.masked);
    }
    gpu.vk.CmdEndRendering(cmd);
}

VkSamplerCreateInfo samplerInfo(VkFilter filter, VkSamplerAddressMode wrap)
{
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = info.minFilter = filter;
    info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    info.addressModeU = info.addressModeV = info.addressModeW = wrap;
    info.maxLod = VK_LOD_CLAMP_NONE;
    return info;
}

/// The shadow maps of lights of a kind.
struct MapKind
{
    GpuImage& maps;
    uint32_t size, layers, binding;
    VkFormat format;
    const Sampler& sampler;
    const char* what;
};

/// Each layer is cleared where it is drawn.
/// @param sampled  whether frames have read them, as all commands may; of new images nothing is to be waited for
void toAttachment(Gpu& gpu, VkCommandBuffer cmd, const GpuImage& maps, bool sampled)
{
    transition(gpu, cmd, maps,
               {sampled ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                sampled ? VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT : VK_PIPELINE_STAGE_2_NONE,
                VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                sampled ? VK_ACCESS_2_SHADER_SAMPLED_READ_BIT : VkAccessFlags2(0),
                VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT});
}

/// Read after write, for the draws of all submits before. All commands: who samples the scene's set first is not known here.
void toSampled(Gpu& gpu, VkCommandBuffer cmd, const GpuImage& maps)
{
    transition(gpu, cmd, maps,
               {VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT});
}

/// Draws every light's maps: suns', the sky's, points' and emitters' kind, in this order.
Status drawMaps(Gpu& gpu, const LightList& lights, const SceneMesh& triangles, const DescriptorSet& set, std::span<const MapKind, 4> kinds,
                const Progress& progress)
{
    // A pipeline names the format of the depth it draws to: one for each format in use.
    constexpr VkFormat kFormats[] = {VK_FORMAT_D32_SFLOAT, VK_FORMAT_D16_UNORM};
    DeviceScene::DepthPipelines pipelines[2];
    for (size_t i = 0; i < std::size(kFormats); ++i)
    {
        if (std::ranges::none_of(kinds, [&](const MapKind& kind) { return kind.maps && kind.format == kFormats[i]; })) continue;
        auto made = DeviceScene::DepthPipelines::create(gpu, set.layout(), kFormats[i], triangles.hasMasked());
        if (!made) return made.error();
        pipelines[i] = std::move(*made);
    }
    // A submit for each light rather than one for all, so that a bake can tell how far it is and be stopped.
    SceneDraws draws;
    for (size_t i = 0; i < lights.lights.size(); ++i)
    {
        if (!report(progress, "shadow maps", double(i) / double(lights.lights.size())))
            return Error{ErrorCode::cancelled, "The bake was stopped while rendering shadow maps"};
        const gpu::GpuLight& light = lights.lights[i];
        // Samples that rays shadow have no map to draw.
        if (light.shadowLayer == kNoShadowMap) continue;
        const MapKind& kind = kinds[light.type == gpu::kLightDirectional ? 0
                                    : light.type == gpu::kLightSky       ? 1
                                    : light.type == gpu::kLightEmitter   ? 3
                                                                         : 2];
        const DeviceScene::DepthPipelines& pipeline = pipelines[kind.format == kFormats[0] ? 0 : 1];
        const std::vector<gpu::SceneView> views = shadowViews(light, lights.header);
        auto status = gpu.submit(
            [&](VkCommandBuffer cmd)
            {
                for (uint32_t v = 0; v < views.size(); ++v)
                    renderDepth(gpu, cmd, pipeline, triangles, set.handle(), kind.maps, uint32_t(light.shadowLayer) + v, views[v], draws);
            });
        if (!status) return status;
    }
    return success();
}

} // namespace

DeviceSceneDesc sceneForFrames(const IndirectEffects& effects, const gpu::LightFieldInfo& field, std::optional<vec3> eye)
{
    DeviceSceneDesc desc;
    desc.light.eye = eye;
    if (!effects.diffuse || effects.tracedDiffuse || readsSurfaceLight(effects, field))
        desc.light.emitterSamples = desc.light.skySamples = 0;
    else if (effects.fieldShadows)
    {
        desc.light.areaShadows = false;
        desc.light.emitterSamples = desc.light.skySamples = kTracedLightSamples;
    }
    return desc;
}

Result<DeviceScene> DeviceScene::create(Gpu& gpu, const Scene& scene, const gpu::LightFieldInfo& space, const DeviceSceneDesc& desc,
                                        const Progress& progress)
{
    if (scene.triangles.empty())
        return Error{ErrorCode::badInput, fmt::format("The scene '{}' has no triangles; there is nothing to light", scene.name)};
    if (const std::string fault = validate(scene); !fault.empty()) return Error{ErrorCode::badInput, fault};
    if (const std::string fault = settingsFault(desc); !fault.empty()) return Error{ErrorCode::badArgument, fault};
    const uint64_t before = gpu.memory().used();
    auto mesh = SceneMesh::create(gpu, scene, space);
    if (!mesh) return mesh.error();
    DeviceScene made(std::move(*mesh));
    // Two arrays, since an array has one format: colours are sRGB, data is linear.
    auto color = makeTextureArray(gpu, scene, TextureKind::color, desc.maxTextureSize);
    if (!color) return color.error();
    made.color = std::move(*color);
    auto data = makeTextureArray(gpu, scene, TextureKind::data, desc.maxTextureSize);
    if (!data) return data.error();
    made.data = std::move(*data);
    const std::vector<gpu::GpuMaterial> materials = gpuMaterials(scene, made.color, made.data);
    auto materialBuffer = gpu.makeBufferWith<gpu::GpuMaterial>(materials, 0, "The scene's materials");
    if (!materialBuffer) return materialBuffer.error();
    made.materials = std::move(*materialBuffer);

    LightSettings light = desc.light;
    const uint32_t most = gpu.properties.limits.maxImageArrayLayers; // some devices have no more than Vulkan asks for, 256
    if (light.areaShadows)
        light.emitterSamples = std::min(light.emitterSamples, most / 6), light.skySamples = std::min(light.skySamples, most);
    made.lightList = buildLightList(scene, space, light);
    made.origin = space.origin;
    made.scale = space.scale;
    // Room for one light at least: the array behind the header is bound even when it is empty.
    std::vector<std::byte> list(sizeof(gpu::LightsHeader) + std::max<size_t>(made.lightList.lights.size(), 1) * sizeof(gpu::GpuLight));
    std::memcpy(list.data(), &made.lightList.header, sizeof(gpu::LightsHeader));
    if (!made.lightList.lights.empty())
        std::memcpy(list.data() + sizeof(gpu::LightsHeader), made.lightList.lights.data(),
                    made.lightList.lights.size() * sizeof(gpu::GpuLight));
    auto lightBuffer = gpu.makeBufferWith<std::byte>(list, 0, "The list of lights");
    if (!lightBuffer) return lightBuffer.error();
    made.lightBuffer = std::move(*lightBuffer);

    // Smooth for suns and lamps, each of which has one map, whose texels would show as steps; nearest for sky and emitters, where many
    // samples share the light and their steps average out.
    VkSamplerCreateInfo compare = samplerInfo(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    compare.compareEnable = VK_TRUE;
    compare.compareOp = VK_COMPARE_OP_GREATER_OR_EQUAL; // lit where nothing in the map is nearer
    auto smooth = Sampler::create(gpu, compare);
    if (!smooth) return smooth.error();
    made.smoothCompare = std::move(*smooth);
    compare.magFilter = compare.minFilter = VK_FILTER_NEAREST;
    auto nearest = Sampler::create(gpu, compare);
    if (!nearest) return nearest.error();
    made.nearestCompare = std::move(*nearest);
    auto sampler = Sampler::create(gpu, samplerInfo(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT));
    if (!sampler) return sampler.error();
    made.textureSampler = std::move(*sampler);

    // One set for every pass that shades, the bake's and the frame's: each shader names of it what it reads.
    // Of materials only what draws knows, so that compute passes, which have a light field's bindings besides, keep to what each may have.
    constexpr VkDescriptorType kMap = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    std::vector<DescriptorSet::Binding> bindings = {
        {gpu::kMaterialsBinding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_FRAGMENT_BIT},
        {gpu::kLightsBinding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
        {gpu::kColorTexturesBinding, kMap, VK_SHADER_STAGE_FRAGMENT_BIT},
        {gpu::kDataTexturesBinding, kMap, VK_SHADER_STAGE_FRAGMENT_BIT}};
    for (uint32_t shadows : {gpu::kSunShadowsBinding, gpu::kSkyShadowsBinding, gpu::kPointShadowsBinding, gpu::kEmitterShadowsBinding})
        bindings.push_back({shadows, kMap});
    auto set = DescriptorSet::create(gpu, bindings);
    if (!set) return set.error();
    made.set = std::move(*set);
    made.set.write(gpu::kMaterialsBinding, made.materials);
    made.set.write(gpu::kColorTexturesBinding, made.color.image.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                   made.textureSampler.handle());
    made.set.write(gpu::kDataTexturesBinding, made.data.image.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                   made.textureSampler.handle());
    made.set.write(gpu::kLightsBinding, made.lightBuffer);
    // After materials and textures are in the set: masked triangles are drawn into the maps by both.
    if (auto status = made.makeShadowMaps(gpu, progress); !status) return status.error();
    // Served the uploads only, so it goes before the scene's bytes are counted.
    gpu.releaseStaging();
    made.bytes = gpu.memory().used() - before;
    return made;
}

Status DeviceScene::makeShadowMaps(Gpu& gpu, const Progress& progress)
{
    const LightSettings& sizes = lightList.settings;
    // 16 bits for the sky: it has the most maps by far, and their step of 1.5e-5 is below the bias of 5e-5 by which they are looked up.
    const MapKind kinds[] = {{sunMaps, sizes.sunShadow, lightList.sunLayers, gpu::kSunShadowsBinding, VK_FORMAT_D32_SFLOAT, smoothCompare,
                              "The suns' shadow maps"},
                             {skyMaps, sizes.skyShadow, lightList.skyLayers, gpu::kSkyShadowsBinding, VK_FORMAT_D16_UNORM, nearestCompare,
                              "The sky's shadow maps"},
                             {pointMaps, sizes.pointShadow, lightList.pointLayers, gpu::kPointShadowsBinding, VK_FORMAT_D32_SFLOAT,
                              smoothCompare, "The point lights' shadow maps"},
                             {emitterMaps, sizes.emitterShadow, lightList.emitterLayers, gpu::kEmitterShadowsBinding, VK_FORMAT_D32_SFLOAT,
                              nearestCompare, "The emitters' shadow maps"}};
    const uint32_t most = gpu.properties.limits.maxImageArrayLayers;
    for (const MapKind& kind : kinds)
    {
        if (kind.layers == 0) continue;
        if (kind.layers > most)
            return Error{
                ErrorCode::missingFeature,
                fmt::format("{} are {} layers of an image; the device allows {}; light the scene by fewer", kind.what, kind.layers, most)};
        auto maps = depthArray(gpu, kind.size, kind.layers, kind.format, kind.what);
        if (!maps) return maps.error();
        kind.maps = std::move(*maps);
    }
    const auto some = std::ranges::find_if(kinds, [](const MapKind& kind) { return bool(kind.maps); });
    if (some ==
        std::end(kinds)) // the bindings of kinds that a scene lacks are another kind's maps, which nothing reads; these where all lack
    {
        auto maps = depthArray(gpu, 1, 1, VK_FORMAT_D16_UNORM, "The stand-in for shadow maps");
        if (!maps) return maps.error();
        noMaps = std::move(*maps);
    }
    const GpuImage& any = some == std::end(kinds) ? noMaps : some->maps;
    for (const MapKind& kind : kinds)
        set.write(kind.binding, (kind.maps ? kind.maps : any).view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kind.sampler.handle());
    const auto everyMap = [&](VkCommandBuffer cmd, const auto& to)
    {
        for (const MapKind& kind : kinds)
            if (kind.maps) to(gpu, cmd, kind.maps);
        if (noMaps) to(gpu, cmd, noMaps);
    };
    // All layers at once and before any draw: the draws are submits of their own, and a transition from undefined drops what an image
    // holds.
    const auto toDraw = [](Gpu& on, VkCommandBuffer cmd, const GpuImage& maps) { toAttachment(on, cmd, maps, false); };
    if (auto status = gpu.submit([&](VkCommandBuffer cmd) { everyMap(cmd, toDraw); }); !status) return status;
    if (auto status = drawMaps(gpu, lightList, triangles, set, kinds, progress); !status) return status;
    return gpu.submit(
        [&](VkCommandBuffer cmd)
        {
            everyMap(cmd, toSampled);
            for (const MapKind& kind : kinds)
                if (kind.maps) scanImage(gpu, cmd, "shadow maps", kind.maps, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        });
}

Status DeviceScene::lookFrom(Gpu& gpu, vec3 eye)
{
    if (const std::string fault = eyeFault(eye); !fault.empty()) return Error{ErrorCode::badArgument, fault};
    if (lightList.header.sunLevels <= 1) return success();
    gpu::LightsHeader moved = lightList.header;
    moved.eye = (eye - origin) / scale;
    const float finest = std::pow(gpu::kFinerSun, float(moved.sunLevels - 1));
    const auto isSun = [](const gpu::GpuLight& light) { return light.type == gpu::kLightDirectional; };
    // Across and along each map apart: of a long scene they are narrow one way.
    const vec3 way = moved.eye - lightList.header.eye;
    const auto isNear = [&](const gpu::GpuLight& light)
    {
        const vec2 off(glm::dot(vec3(light.shadowX), way), glm::dot(vec3(light.shadowY), way));
        return !isSun(light) || finest * std::max(std::abs(off.x), std::abs(off.y)) < kNearBorder;
    };
    if (std::ranges::all_of(lightList.lights, isNear)) return success();
    if (!sunPipelines)
    {
        auto made = DepthPipelines::create(gpu, set.layout(), sunMaps.desc().format, triangles.hasMasked());
        if (!made) return made.error();
        sunPipelines = std::make_shared<const DepthPipelines>(std::move(*made));
    }
    SceneDraws draws;
    const auto record = [&](VkCommandBuffer cmd)
    {
        // After frames that read where the eye was, which are done with it wherever they did; before those to come.
        memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_PIPELINE_STAGE_2_TRANSFER_BIT, 0);
        gpu.vk.CmdUpdateBuffer(cmd, lightBuffer.handle(), 0, sizeof(moved), &moved);
        memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                      VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
        toAttachment(gpu, cmd, sunMaps, true);
        for (const gpu::GpuLight& light : lightList.lights)
        {
            if (!isSun(light)) continue;
            const std::vector<gpu::SceneView> views = shadowViews(light, moved);
            for (uint32_t v = 1; v < views.size(); ++v) // the first is the whole scene's
                renderDepth(gpu, cmd, *sunPipelines, triangles, set.handle(), sunMaps, uint32_t(light.shadowLayer) + v, views[v], draws);
        }
        toSampled(gpu, cmd, sunMaps);
    };
    if (auto status = gpu.submit(record); !status) return status;
    lightList.header = moved;
    return success();
}

} // namespace sconce
