#include "runtime/bake/probe_baker.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "runtime/bake/drawn_faces.h"
#include "runtime/vulkan/nan_scan.h"

#include "spirv/bake_bounce_comp.h"
#include "spirv/bake_bounce_surface_comp.h"
#include "spirv/bake_chain_comp.h"
#include "spirv/bake_downsample_moments_comp.h"
#include "spirv/bake_downsample_radiance_comp.h"
#include "spirv/bake_gather_irradiance_comp.h"
#include "spirv/bake_gather_moments_comp.h"
#include "spirv/bake_gbuffer_frag.h"
#include "spirv/bake_gbuffer_masked_frag.h"
#include "spirv/bake_gbuffer_vert.h"
#include "spirv/bake_octahedral_comp.h"
#include "spirv/bake_octahedral_low_comp.h"
#include "spirv/bake_surface_comp.h"
#include "spirv/bake_texels_comp.h"

namespace sconce
{

namespace
{

void afterCompute(const Gpu& gpu, VkCommandBuffer cmd)
{
    // Read after write: a probe's passes read each other's results, and copyOut() takes the last. They also overwrite what earlier ones
    // read (the coarse cells are made twice), which the same barrier orders. All memory rather than single buffers: nothing else runs
    // beside the bake.
    memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_COPY_BIT,
                  VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_READ_BIT);
}

/// The fence of a submission says that copies are done, not that the host sees them: that takes a barrier to the host's stage.
void forTheHost(const Gpu& gpu, VkCommandBuffer cmd)
{
    memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                  VK_ACCESS_2_HOST_READ_BIT);
}

} // namespace

Result<std::unique_ptr<ProbeBaker>> ProbeBaker::create(Gpu& gpu, const DeviceScene& scene, const gpu::LightFieldInfo& info,
                                                       bool surfaceLight, bool coatsByRays, ProbeFaces* faces, PacedWork& work)
{
    std::unique_ptr<ProbeBaker> baker(new ProbeBaker(gpu, scene, info, surfaceLight, coatsByRays, faces, work));
    baker->octahedral = info.chart == gpu::kChartOctahedral;
    baker->emitters = scene.lights().shines;
    baker->radianceWords = radianceWordsPerProbe(info.chart, info.faceSize);
    if (auto status = baker->createBuffers(); !status) return status.error();
    if (auto status = baker->createPipelines(); !status) return status.error();
    return baker;
}

Status ProbeBaker::createBuffers()
{
    const uint32_t n = info.faceSize, faceTexels = 6 * n * n;
    ImageDesc desc;
    desc.width = n;
    // The six faces below one another: one image, one render pass, one pair of transitions.
    desc.height = 6 * n;
    desc.format = kProbeFaceFormat;
    desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    auto surface = gpu.makeImage(desc, "A probe's faces");
    if (!surface) return surface.error();
    surfaceImage = std::move(*surface);
    desc.format = kProbeDepthFormat;
    desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    auto depth = gpu.makeImage(desc, "A probe's depth");
    if (!depth) return depth.error();
    depthImage = std::move(*depth);

    struct Need
    {
        Buffer& buffer;
        uint64_t count; // words
        MemoryUse use;
        const char* what;
    };
    const uint64_t transferWords =
        uint64_t(info.wordsPerProbe) + 4ull * radianceWords + kIrradianceWordsPerProbe + (octahedral ? faceTexels : 0) + texelWords();
    std::vector<Need> needs = {{words, info.wordsPerProbe, MemoryUse::device, "A probe's distance words"},
                               {light, 4ull * radianceWords, MemoryUse::device, "A probe's radiance"},
                               // Six faces of 32 x 32 cells, four words each: more than the octahedral map's 64 x 64 (recordGather).
                               {cells, 4ull * 6 * 32 * 32, MemoryUse::device, "A probe's coarse cells"},
                               {irradiance, kIrradianceWordsPerProbe, MemoryUse::device, "A probe's irradiance"},
                               {transfer, transferWords, MemoryUse::readback, "The bake's transfer buffer"}};
    if (info.surfaceSize > 0) needs.push_back({texels, texelWords(), MemoryUse::device, "A probe's surface texels"});
    if (octahedral)
    {
        needs.push_back({faceWords, faceTexels, MemoryUse::device, "A probe's face words"});
        needs.push_back({faceLight, 3ull * faceTexels, MemoryUse::device, "A probe's face radiance"});
    }
    for (const Need& need : needs)
    {
        auto buffer = gpu.makeBuffer(need.count * 4, 0, need.use, need.what);
        if (!buffer) return buffer.error();
        need.buffer = std::move(*buffer);
    }
    const DescriptorSet::Binding bindings[] = {{gpu::kBakeSurfaceBinding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                                               {gpu::kBakeDepthBinding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE}};
    auto set = DescriptorSet::create(gpu, bindings);
    if (!set) return set.error();
    images = std::move(*set);
    images.write(gpu::kBakeSurfaceBinding, surfaceImage.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    images.write(gpu::kBakeDepthBinding, depthImage.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    return success();
}

Status ProbeBaker::createPipelines()
{
    const VkDescriptorSetLayout sceneSet[] = {scene.layout()};
    const VkFormat formats[] = {kProbeFaceFormat};
    Pipeline::Graphics desc;
    desc.vertex = bake_gbuffer_vert;
    desc.sets = sceneSet;
    desc.pushBytes = sizeof(gpu::SceneView);
    desc.vertexBindings = SceneMesh::vertexBindings();
    desc.vertexAttributes = SceneMesh::vertexAttributes();
    desc.colorFormats = formats;
    desc.depthFormat = kProbeDepthFormat;
    for (const auto& [pipeline, fragment] : {std::pair<Pipeline*, Spirv>{&opaque, bake_gbuffer_frag}, {&masked, bake_gbuffer_masked_frag}})
    {
        if (hostFaces || (pipeline == &masked && !scene.mesh().hasMasked())) continue;
        desc.fragment = fragment;
        auto made = Pipeline::graphics(gpu, desc);
        if (!made) return made.error();
        *pipeline = std::move(*made);
    }
    const VkDescriptorSetLayout sceneAndImages[] = {scene.layout(), images.layout()};
    const VkDescriptorSetLayout imagesOnly[] = {images.layout()};
    struct Pass
    {
        Pipeline& pipeline;
        Spirv code;
        std::span<const VkDescriptorSetLayout> sets;
    };
    const ShaderConstant constants[] = {{gpu::kBakeAreaLightId, surfacesLit ? 0u : 1u}, {gpu::kBakeCoatsId, coats ? 1u : 0u}};
    for (const Pass& pass :
         {Pass{surfacePass, bake_surface_comp, sceneAndImages}, Pass{chainPass, bake_chain_comp, {}}, Pass{texelPass, bake_texels_comp, {}},
          Pass{octahedralPass, bake_octahedral_comp, imagesOnly}, Pass{lowPass, bake_octahedral_low_comp, {}},
          Pass{downsample[0], bake_downsample_radiance_comp, {}}, Pass{downsample[1], bake_downsample_moments_comp, {}},
          Pass{gather[0], bake_gather_irradiance_comp, {}}, Pass{gather[1], bake_gather_moments_comp, {}}})
    {
        auto made = Pipeline::compute(gpu, pass.code, pass.sets, sizeof(gpu::BakePush), constants, VK_PIPELINE_CREATE_DISPATCH_BASE_BIT);
        if (!made) return made.error();
        pass.pipeline = std::move(*made);
    }
    return success();
}

gpu::BakePush ProbeBaker::pushFor(vec3 centre) const
{
    const VkDeviceAddress base = light.address(), part = VkDeviceAddress(radianceWords) * 4;
    gpu::BakePush push{};
    push.words = words.address();
    push.radiance = base;
    push.surface = base + part;
    push.emitted = emitters ? base + 2 * part : 0;
    push.extra = base + 3 * part;
    push.centre = centre;
    push.nearPlane = kProbeNear * info.diagonal;
    push.size = info.faceSize;
    push.faceWords = octahedral ? 0 : info.wordsPerProbe / 6;
    push.chart = info.chart;
    push.sky = info.sky;
    push.skyDistance = 2.0f * info.diagonal;
    push.texels = info.surfaceSize > 0 ? texels.address() : 0;
    push.surfaceSize = info.surfaceSize;
    return push;
}

void ProbeBaker::add(std::string_view name, const Pipeline& pipeline, std::vector<VkDescriptorSet> sets, const gpu::BakePush& push,
                     uint32_t width, uint32_t layers, std::function<void(VkCommandBuffer)> scan)
{
    const glm::uvec3 groups((width + 7) / 8, (width + 7) / 8, layers);
    const uint32_t rows = groups.y * groups.z;
    work.add(name, rows,
             [=, this, &pipeline, sets = std::move(sets), scan = std::move(scan)](VkCommandBuffer cmd, uint32_t first, uint32_t count)
             {
                 pipeline.bind(cmd, sets);
                 pipeline.push(cmd, push);
                 dispatchRows(gpu, cmd, groups, first, count);
                 afterCompute(gpu, cmd);
                 if (scan && first + count == rows) scan(cmd);
             });
}

void ProbeBaker::drawScene(VkCommandBuffer cmd, const gpu::SceneView& view)
{
    const VkDescriptorSet sets[] = {scene.descriptorSet()};
    scene.mesh().bind(cmd);
    scene.mesh().leaveOutBackFaces(cmd, view);
    scene.mesh().cull(view, draws);
    for (const auto& [pipeline, runs] : {std::pair(&opaque, &draws.opaque), std::pair(&masked, &draws.masked)})
    {
        if (runs->empty()) continue;
        pipeline->bind(cmd, sets);
        pipeline->push(cmd, view);
        scene.mesh().draw(cmd, *runs);
    }
}

constexpr VkPipelineStageFlags2 kDepthTests = VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;

void ProbeBaker::toAttachments(VkCommandBuffer cmd)
{
    // The faces of the probe before are dropped (undefined), and the passes that read them are done, since their submission was waited for:
    // nothing to wait for.
    transition(gpu, cmd, surfaceImage,
               {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_NONE,
                VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, 0, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT});
    // Depth likewise. Both stages of tests: which of them reads and writes depth is the driver's choice.
    transition(gpu, cmd, depthImage,
               {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_NONE, kDepthTests, 0,
                VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT});
}

void ProbeBaker::toImagesRead(VkCommandBuffer cmd)
{
    // Read after write: compute passes alone sample the faces, to make the maps.
    transition(gpu, cmd, surfaceImage,
               {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT});
    // The same for depth, whichever tests wrote it.
    transition(gpu, cmd, depthImage,
               {VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kDepthTests,
                VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                VK_ACCESS_2_SHADER_SAMPLED_READ_BIT});
    scanImage(gpu, cmd, "bake faces", depthImage, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

Status ProbeBaker::drawFace(VkCommandBuffer cmd, uint32_t probe, vec3 centre, uint32_t face)
{
    const uint32_t n = info.faceSize;
    VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    color.imageView = surfaceImage.view();
    color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE; // only read where the depth says that something is there
    color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    // Cleared, unlike the surfaces: depth is what tells where nothing was drawn.
    VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    depth.imageView = depthImage.view();
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    const VkRect2D area{{0, int32_t(n * face)}, {n, n}}; // what is cleared, and drawn to
    rendering.renderArea = area;
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &color;
    rendering.pDepthAttachment = &depth;
    const VkViewport viewport{0.0f, float(n) * float(face), float(n), float(n), 0.0f, 1.0f};
    gpu.vk.CmdBeginRendering(cmd, &rendering);
    gpu.vk.CmdSetViewport(cmd, 0, 1, &viewport);
    gpu.vk.CmdSetScissor(cmd, 0, 1, &area);
    const gpu::SceneView view = faceView(centre, int(face), kProbeNear * info.diagonal);
    Status drawn = success();
    if (hostFaces)
        drawn = hostFaces->draw(cmd, faceInWorld(view, info, probe, face));
    else
        drawScene(cmd, view);
    gpu.vk.CmdEndRendering(cmd);
    return drawn;
}

void ProbeBaker::addFaces(uint32_t probe, vec3 centre, Status& drawn)
{
    work.add("bake faces", 6,
             [=, this, &drawn](VkCommandBuffer cmd, uint32_t first, uint32_t count)
             {
                 if (first == 0) toAttachments(cmd);
                 for (uint32_t face = first; face < first + count && drawn; ++face) drawn = drawFace(cmd, probe, centre, face);
                 if (first + count == 6) toImagesRead(cmd);
             });
}

void ProbeBaker::addMaps(vec3 centre)
{
    const uint32_t n = info.faceSize;
    gpu::BakePush push = pushFor(centre);
    // The octahedral map is resampled from cube faces: the surface pass writes those to buffers of their own first.
    if (octahedral)
    {
        push.words = faceWords.address();
        push.radiance = faceLight.address();
        push.surface = faceLight.address() + VkDeviceAddress(6) * n * n * 4;
        push.emitted = emitters ? faceLight.address() + VkDeviceAddress(12) * n * n * 4 : 0;
        push.faceWords = n * n;
    }
    const auto scanLight = [this](VkCommandBuffer cmd, const char* pass, VkDeviceSize first)
    { scanBuffer(gpu, cmd, pass, light, {.kind = gpu::kScanRadiance, .first = first, .count = radianceWords}); };
    const auto scanSurfaces = [=, this](VkCommandBuffer cmd)
    {
        if (octahedral)
        {
            scanBuffer(gpu, cmd, "bake surfaces", faceWords, {.kind = gpu::kScanNearness});
            scanBuffer(gpu, cmd, "bake surfaces", faceLight, {.kind = gpu::kScanRadiance, .count = VkDeviceSize(6) * n * n});
            return;
        }
        scanLight(cmd, "bake surfaces", 0);
        if (emitters) scanLight(cmd, "bake surfaces", 2 * radianceWords);
    };
    add("bake surfaces", surfacePass, {scene.descriptorSet(), images.handle()}, push, n, 6, scanSurfaces);
    if (!octahedral)
    {
        for (push.level = 2; push.level <= info.topLevel; push.level += 2)
            add("bake chain", chainPass, {}, push, (n + (1u << push.level) - 1) >> push.level, 6);
        push.level = 0;
        add("bake far bounds", chainPass, {}, push, uint32_t(std::ceil(std::sqrt(double(push.faceWords - n * n)))), 6,
            [this](VkCommandBuffer cmd)
            { scanBuffer(gpu, cmd, "bake chain", words, {.kind = gpu::kScanNearness, .count = info.wordsPerProbe}); });
        if (info.surfaceSize > 0) add("bake texels", texelPass, {}, push, info.surfaceSize, 6);
        return;
    }
    // From here on the targets are the field's again, and the faces are what is read.
    push = pushFor(centre);
    push.extra = faceLight.address();
    add("bake octahedral map", octahedralPass, {images.handle()}, push, n, 1);
    add("bake low map", lowPass, {}, push, n / gpu::kLowFactor, 1,
        [=, this](VkCommandBuffer cmd)
        {
            scanBuffer(gpu, cmd, "bake octahedral map", words, {.kind = gpu::kScanDistance, .count = info.wordsPerProbe});
            scanLight(cmd, "bake octahedral map", 0);
        });
}

void ProbeBaker::addGather(bool moments)
{
    gpu::BakePush push = pushFor(vec3(0.0f));
    // A direction's sum runs over all cells, so texels are joined into coarse ones first. The moments' lobe is narrower (cos^50; moments:
    // McGuire et al. 2017, section 5.2), so their cells are half as wide.
    push.level = (octahedral ? 32u : 16u) * (moments ? 2u : 1u);
    while (info.faceSize % push.level != 0) --push.level; // cells of whole texels
    push.extra = cells.address();
    const uint32_t faces = octahedral ? 1 : 6, cellCount = faces * push.level * push.level;
    const char* name = moments ? "bake moments" : "bake irradiance";
    add(moments ? "bake cells of moments" : "bake cells", downsample[moments], {}, push, push.level, faces,
        [=, this](VkCommandBuffer cmd) { scanBuffer(gpu, cmd, name, cells, {.count = VkDeviceSize(4) * cellCount}); });
    push.words = irradiance.address();
    // Scanned: one half alone; the other is not made yet, or is the last bounce's.
    add(name, gather[moments], {}, push, gpu::kIrradianceSize, 1,
        [=, this](VkCommandBuffer cmd)
        { scanBuffer(gpu, cmd, name, irradiance, {.kind = gpu::kScanIrradiance, .stride = 2, .mask = moments ? 2u : 1u}); });
}

void ProbeBaker::copyOut(VkCommandBuffer cmd, std::span<const VkBufferCopy> pieces, const Buffer& from)
{
    gpu.vk.CmdCopyBuffer(cmd, from.handle(), transfer.handle(), uint32_t(pieces.size()), pieces.data());
}

Status ProbeBaker::bakeDirect(uint32_t probe, vec3 centre, const ProbeTarget& target)
{
    const VkDeviceSize wordBytes = info.wordsPerProbe * VkDeviceSize(4), lightBytes = radianceWords * VkDeviceSize(emitters ? 12 : 8);
    const VkDeviceSize faceBytes = octahedral ? VkDeviceSize(6) * info.faceSize * info.faceSize * 4 : 0;
    assert(target.distance.size_bytes() == wordBytes && target.radiance.size() == radianceWords && target.surface.size() == radianceWords &&
           target.emitted.size() == (emitters ? radianceWords : 0) && target.irradiance.size() == kIrradianceWordsPerProbe &&
           target.faces.size_bytes() == faceBytes && target.texels.size_bytes() == 4 * texelWords());
    const VkDeviceSize irradianceAt = wordBytes + lightBytes, facesAt = irradianceAt + kIrradianceWordsPerProbe * 4;
    const VkDeviceSize texelsAt = facesAt + faceBytes;
    Status drawn = success();
    addFaces(probe, centre, drawn);
    addMaps(centre);
    addGather(false);
    addGather(true);
    work.add("bake copies", 1,
             [=, this](VkCommandBuffer cmd, uint32_t, uint32_t)
             {
                 copyOut(cmd, std::array{VkBufferCopy{0, 0, wordBytes}}, words);
                 copyOut(cmd, std::array{VkBufferCopy{0, wordBytes, lightBytes}}, light);
                 copyOut(cmd, std::array{VkBufferCopy{0, irradianceAt, kIrradianceWordsPerProbe * 4}}, irradiance);
                 if (octahedral) copyOut(cmd, std::array{VkBufferCopy{0, facesAt, faceBytes}}, faceWords);
                 if (texels) copyOut(cmd, std::array{VkBufferCopy{0, texelsAt, 4 * texelWords()}}, texels);
                 forTheHost(gpu, cmd);
             });
    const Status status = work.run();
    if (!drawn) return drawn; // what was recorded before is done, and is nobody's
    if (!status) return status;
    const std::byte* from = transfer.mapped();
    for (const std::span<uint32_t> part :
         {target.distance, target.radiance, target.surface, target.emitted, target.irradiance, target.faces})
    {
        if (!part.empty()) std::memcpy(part.data(), from, part.size_bytes());
        from += part.size_bytes();
    }
    if (texels) std::memcpy(target.texels.data(), from, target.texels.size_bytes());
    return success();
}

Status ProbeBaker::bakeBounce(uint32_t probe, vec3 centre, const LightField& field, std::span<const uint32_t> direct,
                              const ProbeTarget& target)
{
    if (!bouncePass)
    {
        const VkDescriptorSetLayout sets[] = {field.layout()};
        const Spirv code = surfacesLit ? Spirv(bake_bounce_surface_comp) : Spirv(bake_bounce_comp);
        auto made = Pipeline::compute(gpu, code, sets, sizeof(gpu::BakePush), shaderConstants(field), VK_PIPELINE_CREATE_DISPATCH_BASE_BIT);
        if (!made) return made.error();
        bouncePass = std::move(*made);
    }
    const VkDeviceSize wordBytes = info.wordsPerProbe * VkDeviceSize(4), radianceBytes = radianceWords * VkDeviceSize(4);
    assert(direct.size() == radianceWords && target.surface.size() == radianceWords && target.radiance.size() == radianceWords);
    std::memcpy(transfer.mapped(), target.distance.data(), wordBytes);
    std::memcpy(transfer.mapped() + wordBytes, target.surface.data(), radianceBytes);
    std::memcpy(transfer.mapped() + wordBytes + radianceBytes, direct.data(), radianceBytes);
    if (emitters) std::memcpy(transfer.mapped() + wordBytes + 2 * radianceBytes, target.emitted.data(), radianceBytes);
    work.add("bake copies", 1,
             [=, this](VkCommandBuffer cmd, uint32_t, uint32_t)
             {
                 const VkBufferCopy toWords{0, 0, wordBytes};
                 const VkBufferCopy toLight[] = {{wordBytes, radianceBytes, radianceBytes},
                                                 {wordBytes + radianceBytes, 3 * radianceBytes, radianceBytes},
                                                 {wordBytes + 2 * radianceBytes, 2 * radianceBytes, radianceBytes}};
                 gpu.vk.CmdCopyBuffer(cmd, transfer.handle(), words.handle(), 1, &toWords);
                 gpu.vk.CmdCopyBuffer(cmd, transfer.handle(), light.handle(), emitters ? 3 : 2, toLight);
                 // Read after write: the passes read what is copied in. Write after read: the copies out, below, overwrite the transfer
                 // buffer that these copies read. What the host wrote into it is visible by the submit itself.
                 memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_TRANSFER_READ_BIT,
                               VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_COPY_BIT,
                               VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT);
             });
    gpu::BakePush push = pushFor(centre);
    push.probe = probe;
    add("bake bounce", bouncePass, {field.descriptorSet()}, push, info.faceSize, octahedral ? 1 : 6,
        [this](VkCommandBuffer cmd) { scanBuffer(gpu, cmd, "bake bounce", light, {.kind = gpu::kScanRadiance, .count = radianceWords}); });
    addGather(false);
    work.add("bake copies", 1,
             [=, this](VkCommandBuffer cmd, uint32_t, uint32_t)
             {
                 copyOut(cmd, std::array{VkBufferCopy{0, 0, radianceBytes}}, light);
                 copyOut(cmd, std::array{VkBufferCopy{0, radianceBytes, kIrradianceWordsPerProbe * 4}}, irradiance);
                 forTheHost(gpu, cmd);
             });
    const Status status = work.run();
    if (!status) return status;
    std::memcpy(target.radiance.data(), transfer.mapped(), radianceBytes);
    std::vector<uint32_t> fresh(kIrradianceWordsPerProbe);
    std::memcpy(fresh.data(), transfer.mapped() + radianceBytes, kIrradianceWordsPerProbe * 4);
    for (uint32_t i = 0; i < kIrradianceWordsPerProbe; i += 2) target.irradiance[i] = fresh[i]; // the odd words are the moments
    return success();
}

} // namespace sconce
