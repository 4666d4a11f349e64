#include "runtime/field/light_field.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <glm/gtc/matrix_access.hpp>

#include "runtime/vulkan/nan_scan.h"
#include "shaders/shared/field_passes.h"

#include "spirv/trace_rays_comp.h"
#include "spirv/trace_rays_refilled_comp.h"

namespace sconce
{
namespace
{

std::string checkQuality(const gpu::TraceQuality& q)
{
    const std::string fault = firstFault(
        {faultOf(knobs::ranked, q.ranked), faultOf(knobs::maxHandoffs, q.maxHandoffs), faultOf(knobs::startLevel, q.startLevel),
         faultOf(knobs::coarsestLevel, q.coarsestLevel), faultOf(knobs::tolerance, q.tolerance), faultOf(knobs::epsilon, q.epsilon),
         faultOf(knobs::opinion, q.opinion), faultOf(knobs::farBounds, q.farBounds), faultOf(knobs::order, q.order)});
    return fault.empty() ? fault : fmt::format("quality: {}", fault);
}

Result<GpuImage> uploadOctree(Gpu& gpu, const Octree& octree)
{
    const glm::uvec3 size = octree.textureSize();
    if (std::max({size.x, size.y, size.z}) > gpu.properties.limits.maxImageDimension3D)
        return Error{ErrorCode::missingFeature,
                     fmt::format("the octree needs a 3D texture of {} texels a side and the device allows {}; build it with fewer voxels",
                                 std::max({size.x, size.y, size.z}), gpu.properties.limits.maxImageDimension3D)};
    const bool narrow = octree.marker == 255;
    ImageDesc desc;
    desc.format = narrow ? VK_FORMAT_R8G8B8A8_UINT : VK_FORMAT_R16G16B16A16_UINT;
    desc.width = size.x;
    desc.height = size.y;
    desc.depth = size.z;
    desc.volume = true;
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    auto image = gpu.makeImage(desc, "octree");
    if (!image) return image.error();
    std::vector<uint8_t> bytes(octree.bytes());
    if (narrow)
        std::transform(octree.texels.begin(), octree.texels.end(), bytes.begin(), [](uint16_t v) { return uint8_t(v); });
    else
        std::memcpy(bytes.data(), octree.texels.data(), bytes.size());
    auto staging = gpu.makeBufferWith<uint8_t>(bytes, 0, "octree staging");
    if (!staging) return staging.error();
    auto status = gpu.submit(
        [&](VkCommandBuffer cmd)
        {
            // A new image: nothing used it, and nothing in it is kept.
            transition(gpu, cmd, *image,
                       {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_NONE,
                        VK_PIPELINE_STAGE_2_COPY_BIT, 0, VK_ACCESS_2_TRANSFER_WRITE_BIT});
            VkBufferImageCopy copy{};
            copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            copy.imageExtent = {size.x, size.y, size.z};
            gpu.vk.CmdCopyBufferToImage(cmd, staging->handle(), image->handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
            // Read after write. All commands: the set's stages are all of them, and a host's own shaders may trace in any; it happens once
            // a field.
            transition(gpu, cmd, *image,
                       {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_2_COPY_BIT,
                        VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT});
        });
    if (!status) return status.error();
    return image;
}

/// Room for maps, none of which is there.
Result<std::unique_ptr<MapPool>> makePool(Gpu& gpu, MapFile file, uint32_t slots, uint32_t probes)
{
    auto pool = std::make_unique<MapPool>(MapPool{std::move(file), slots});
    const std::vector<uint32_t> nowhere(probes, gpu::kNoProbe);
    auto where = gpu.makeBufferWith<uint32_t>(nowhere, 0, "slots of maps");
    if (!where) return where.error();
    pool->slotOfProbe = std::move(*where);
    auto asked = gpu.makeBuffer(probes * sizeof(uint32_t), 0, MemoryUse::readback, "maps asked for");
    if (!asked) return asked.error();
    pool->asked = std::move(*asked);
    std::memset(pool->asked.mapped(), 0, pool->asked.size());
    return pool;
}

/// Words of a field, and where they are bound.
struct Part
{
    Buffer& buffer;
    std::span<const uint32_t> words;
    const char* what;
    uint32_t binding;
    size_t room = 0; // words that come later
    VkFormat texel = VK_FORMAT_R32_UINT;
    size_t size() const { return std::max(words.size(), room); }
};

std::array<Part, 5> partsOf(LightField::State& made, const FieldData& field, const MapPool* pool)
{
    const size_t distances = pool ? pool->slots * pool->file.distanceWords() : 0;
    const size_t radiances = pool ? pool->slots * pool->file.radianceWords() : 0;
    return {{{made.distance, field.distance, "probe distances", gpu::kFieldDistanceBinding, distances},
             {made.radiance, field.radiance, "probe radiance", gpu::kFieldRadianceBinding, radiances,
              inBlocks(field.info) ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R32_UINT},
             {made.irradiance, field.irradiance, "probe irradiance", gpu::kFieldIrradianceBinding},
             {made.prefiltered, field.prefiltered, "prefiltered radiance", gpu::kFieldPrefilteredBinding},
             {made.surface, field.surfaceLight, "surface light", gpu::kFieldSurfaceBinding}}};
}

Status uploadParts(Gpu& gpu, LightField::State& made, std::span<const Part> parts)
{
    for (const Part& part : parts)
    {
        if (part.size() == 0) continue;
        auto buffer = part.words.empty() ? (made.byTexels ? gpu.makeTexelBuffer(part.room * 4, part.texel, part.what)
                                                          : gpu.makeBuffer(part.room * 4, 0, MemoryUse::device, part.what))
                      : made.byTexels    ? gpu.makeTexelBuffer<uint32_t>(part.words, part.texel, part.what)
                                         : gpu.makeBufferWith<uint32_t>(part.words, 0, part.what);
        if (!buffer) return buffer.error();
        part.buffer = std::move(*buffer);
        made.bytes += part.buffer.size();
    }
    made.radianceHeld = made.radiance.size() > 0;
    return success();
}

Status uploadLamps(Gpu& gpu, LightField::State& made, const FieldData& field)
{
    if (field.lamps.empty()) return success();
    std::vector<uint32_t> words(field.lamps.size() * sizeof(gpu::Lamp) / sizeof(uint32_t));
    std::memcpy(words.data(), field.lamps.data(), field.lamps.size() * sizeof(gpu::Lamp));
    words.insert(words.end(), field.lampMaps.begin(), field.lampMaps.end());
    auto buffer = gpu.makeBufferWith<uint32_t>(words, 0, "lamps");
    if (!buffer) return buffer.error();
    made.lamps = std::move(*buffer);
    made.lampCount = uint32_t(field.lamps.size());
    made.bytes += made.lamps.size();
    return success();
}

/// Probe headers, patches, octree, and the block that the shaders' constants are in.
Status uploadIndex(Gpu& gpu, LightField::State& made, const FieldData& field)
{
    auto probes = gpu.makeTexelBuffer<gpu::ProbeHeader>(field.probes, VK_FORMAT_R32G32B32A32_SFLOAT, "probe headers");
    if (!probes) return probes.error();
    made.probes = std::move(*probes);
    made.patchesHeld = !field.patches.empty();
    const std::vector<uint32_t> noPatches(4); // the binding still wants a buffer
    auto patches =
        gpu.makeTexelBuffer<uint32_t>(made.patchesHeld ? field.patches : noPatches, VK_FORMAT_R32G32B32A32_UINT, "probe patches");
    if (!patches) return patches.error();
    made.patches = std::move(*patches);
    auto block = gpu.makeBuffer(sizeof(gpu::FieldBlock), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, MemoryUse::device, "light field block");
    if (!block) return block.error();
    made.block = std::move(*block);
    Octree empty; // a field of the octahedral baseline has none; the binding still wants an image
    empty.bricks = glm::uvec3(1);
    empty.texels.assign(4 * 8, 0);
    auto octree = uploadOctree(gpu, field.octree.texels.empty() ? empty : field.octree);
    if (!octree) return octree.error();
    made.octree = std::move(*octree);
    made.bytes += made.probes.size() + made.patches.size() + made.block.size() + field.octree.bytes();
    return success();
}

/// Every binding whatever the field holds, so that one layout, and with it one pipeline, fits all fields.
Status bindAll(Gpu& gpu, LightField::State& made, std::span<const Part> parts)
{
    const DescriptorSet::Binding bindings[] = {{gpu::kFieldBlockBinding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                                               {gpu::kFieldProbesBinding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER},
                                               {gpu::kFieldOctreeBinding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                                               {gpu::kFieldPatchesBinding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER},
                                               {gpu::kFieldDistanceBinding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER},
                                               {gpu::kFieldRadianceBinding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER},
                                               {gpu::kFieldIrradianceBinding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER},
                                               {gpu::kFieldPrefilteredBinding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER},
                                               {gpu::kFieldSurfaceBinding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER},
                                               {gpu::kFieldSlotsBinding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
    auto set = DescriptorSet::create(gpu, bindings);
    if (!set) return set.error();
    made.set = std::move(*set);
    made.set.write(gpu::kFieldBlockBinding, made.block);
    made.set.write(gpu::kFieldProbesBinding, made.probes);
    made.set.write(gpu::kFieldPatchesBinding, made.patches);
    // What isn't there, or is read by address, is bound to something that is there.
    for (const Part& part : parts) made.set.write(part.binding, made.byTexels && part.buffer ? part.buffer : made.patches);
    made.set.write(gpu::kFieldSlotsBinding, made.maps ? made.maps->slotOfProbe : made.patches);
    made.set.write(gpu::kFieldOctreeBinding, made.octree.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    return success();
}

/// @param pool  of a field whose maps come later; null: the field has them
Result<LightField> makeField(Gpu& gpu, const FieldData& field, const Quality& quality, WordAccess access, std::unique_ptr<MapPool> pool)
{
    if (field.probes.empty()) return Error{ErrorCode::badArgument, "the light field has no probes; bake one with at least one probe"};
    const auto state = std::make_shared<LightField::State>();
    LightField::State& made = *state;
    made.gpu = gpu.shared_from_this();
    made.info = field.info;
    made.effects = field.effects;
    made.sceneName = field.sceneName;
    made.headers = field.probes;
    made.groupCount = uint32_t(field.groups.size());
    made.lightHash = lightHashOf(field);
    const auto parts = partsOf(made, field, pool.get());
    // All or none: one way of reading is compiled into each shader.
    made.byTexels =
        access == WordAccess::texelBuffers &&
        std::ranges::all_of(parts, [&](const Part& part) { return part.size() <= gpu.properties.limits.maxTexelBufferElements; });
    if (auto status = uploadParts(gpu, made, parts); !status) return status.error();
    if (auto status = uploadLamps(gpu, made, field); !status) return status.error();
    if (auto status = uploadIndex(gpu, made, field); !status) return status.error();
    made.maps = std::move(pool);
    if (made.maps) made.bytes += made.maps->slotOfProbe.size() + made.maps->asked.size();
    if (auto status = bindAll(gpu, made, parts); !status) return status.error();
    // Last: the block that it fills holds the addresses of the buffers above.
    if (auto status = made.setQuality(quality); !status) return status.error();
    return LightField(state);
}

} // namespace

Result<LightField> makeLightField(Gpu& gpu, const FieldData& field, const Quality& quality, WordAccess access)
{
    return makeField(gpu, field, quality, access, nullptr);
}

Result<LightField> makeStreamedField(Gpu& gpu, const FieldData& field, MapFile maps, uint32_t resident, const Quality& quality)
{
    const auto probes = uint32_t(field.probes.size());
    if (resident < 1 || resident > probes)
        return Error{ErrorCode::badArgument,
                     fmt::format("resident is {}; give 1 to the {} probes of the light field, or 0 for all", resident, probes)};
    auto pool = makePool(gpu, std::move(maps), resident, probes);
    if (!pool) return pool.error();
    return makeField(gpu, field, quality, WordAccess::texelBuffers, std::move(*pool));
}

Status checkDevice(const Gpu& gpu, const LightField& field)
{
    if (field.state().gpu->host.device == gpu.host.device) return success();
    return Error{ErrorCode::badArgument,
                 fmt::format("the light field of scene '{}' was loaded on another Vulkan device; load it on the one that it is used with",
                             field.sceneName())};
}

Status LightField::State::setQuality(const Quality& quality)
{
    if (const std::string wrong = checkQuality(quality.trace); !wrong.empty()) return Error{ErrorCode::badArgument, wrong};
    readsFarBounds = quality.trace.farBounds != 0;
    probeOrder = uint32_t(quality.trace.order);
    const gpu::FieldBlock values{info,
                                 quality.trace,
                                 distance.address(),
                                 radiance.address(),
                                 irradiance.address(),
                                 prefiltered.address(),
                                 surface.address(),
                                 lamps.address(),
                                 liveIncident.address(),
                                 liveAlbedo.address(),
                                 maps ? maps->asked.address() : 0,
                                 radianceWeight,
                                 lampCount};
    return gpu->upload(block, 0, std::as_bytes(std::span(&values, 1)));
}

LightField::LightField(std::shared_ptr<State> made) : shared(std::move(made)) {}

VkDescriptorSetLayout LightField::layout() const
{
    return shared->set.layout();
}

VkDescriptorSet LightField::descriptorSet() const
{
    return shared->set.handle();
}

std::array<uint32_t, 2> LightField::constants() const
{
    std::array<uint32_t, 2> values{};
    values[gpu::kFieldFlagsId] = (shared->readsFarBounds ? gpu::kReadsFarBounds : 0u) | (shared->probeOrder << gpu::kOrderShift) |
                                 (shared->info.chart == gpu::kChartOctahedral ? gpu::kOnOctahedron : 0u) |
                                 (shared->byTexels ? gpu::kByTexels : 0u) | (shared->info.refinedTexels > 0 ? gpu::kHoldsRefined : 0u) |
                                 (shared->maps ? gpu::kStreams : 0u) | (shared->liveIncident.address() != 0 ? gpu::kHoldsLive : 0u) |
                                 (shared->prefiltered.size() > 0 ? gpu::kHoldsPrefiltered : 0u) |
                                 (inBlocks(shared->info) ? gpu::kMapsInBlocks : 0u);
    values[gpu::kHoldsRadianceId] = shared->radianceHeld ? 1u : 0u;
    return values;
}

std::array<ShaderConstant, 2> shaderConstants(const LightField& field)
{
    const std::array<uint32_t, 2> values = field.constants();
    return {{{0, values[0]}, {1, values[1]}}};
}

const gpu::LightFieldInfo& LightField::info() const
{
    return shared->info;
}

uint64_t LightField::deviceBytes() const
{
    return shared->bytes;
}

bool LightField::holdsRadiance() const
{
    return shared->radianceHeld;
}

bool LightField::holdsPrefiltered() const
{
    return shared->prefiltered.size() > 0;
}

bool LightField::holdsSurfaceLight() const
{
    return shared->surface.size() > 0;
}

bool LightField::holdsPatches() const
{
    return shared->patchesHeld;
}

const std::string& LightField::sceneName() const
{
    return shared->sceneName;
}

const std::vector<std::string>& LightField::effects() const
{
    return shared->effects;
}

gpu::FrameView LightField::frameView(uint32_t width, uint32_t height) const
{
    gpu::FrameView view{};
    view.size = {width, height};
    view.glossyRays = knobs::glossyRays.value;
    view.raysBelow = knobs::raysBelow.value;
    view.normalOffset = knobs::normalOffset.value * info().diagonal * info().scale;
    view.fieldFromNormals = glm::mat3(1.0f);
    return view;
}

Result<gpu::FrameView> inFieldsWorld(gpu::FrameView view, const mat4& fieldFromHost)
{
    constexpr float kEqual = 1e-3f; // relative, of lengths and angles
    const glm::mat3 axes(fieldFromHost);
    const float scale = std::cbrt(std::abs(glm::determinant(axes)));
    const glm::mat3 squared = glm::transpose(axes) * axes;
    bool same = scale > 0.0f && scale < 1e30f && glm::row(fieldFromHost, 3) == vec4(0.0f, 0.0f, 0.0f, 1.0f);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) same = same && std::abs(squared[i][j] / (scale * scale) - (i == j ? 1.0f : 0.0f)) <= kEqual;
    if (!same)
        return Error{ErrorCode::badArgument,
                     "A world can be turned, mirrored, moved and scaled to a light field's, alike in all directions; "
                     "give inFieldsWorld() a matrix that does no more"};
    const auto moved = [&](vec3 place) { return vec3(fieldFromHost * vec4(place, 1.0f)); };
    view.worldFromClip = fieldFromHost * view.worldFromClip;
    view.eye = moved(view.eye);
    view.eyeBefore = moved(view.eyeBefore);
    view.clipFromWorldBefore = view.clipFromWorldBefore * glm::inverse(fieldFromHost);
    view.fieldFromNormals = axes / scale;
    return view;
}

IndirectEffects LightField::effectsOfFrames() const
{
    const auto called = [&](const char* name) { return std::ranges::find(shared->effects, name) != shared->effects.end(); };
    IndirectEffects effects;
    effects.diffuse = called("diffuse");
    effects.rough = called("rough") && holdsPrefiltered();
    effects.glossy = called("glossy");
    effects.mirror = called("mirror");
    effects.denoise = effects.glossy;
    return effects;
}

Status LightField::setQuality(const Quality& quality)
{
    return shared->setQuality(quality);
}

RayTracer::RayTracer(std::shared_ptr<State> made) : shared(std::move(made)) {}

Result<RayTracer> makeRayTracer(Gpu& gpu, const LightField& field, RayShaders shaders)
{
    if (auto status = checkDevice(gpu, field); !status) return status.error();
    if (shaders.plain.empty()) shaders = {trace_rays_comp, trace_rays_refilled_comp};
    const VkDescriptorSetLayout layouts[] = {field.layout()};
    const auto constants = shaderConstants(field);
    const bool refills = gpu.raysALane > 1 && !shaders.refilled.empty();
    auto pipeline = Pipeline::compute(gpu, refills ? shaders.refilled : shaders.plain, layouts, sizeof(gpu::TraceRaysPush), constants);
    if (!pipeline) return pipeline.error();
    return RayTracer(std::make_shared<RayTracer::State>(
        RayTracer::State{gpu.shared_from_this(), field, std::move(*pipeline), refills ? gpu.raysALane : 1}));
}

namespace
{

// More than a large GPU has room for (132 multiprocessors of 20 subgroups of 32), so that no lane is without a ray while others have
// several. Lists of 2,097,152 rays were timed.
constexpr uint32_t kLeastLanes = 100'000;

/// Rays and hits are named by address, not by descriptor: records of one tracer don't disturb each other.
void recordPass(const RayTracer::State& tracer, VkCommandBuffer cmd, VkDeviceAddress rays, VkDeviceAddress hits, uint32_t count)
{
    const VkDescriptorSet sets[] = {tracer.field.descriptorSet()};
    tracer.pipeline.bind(cmd, sets);
    const uint32_t raysALane = std::clamp(std::bit_floor(count / kLeastLanes), 1u, tracer.raysALane);
    const uint32_t group = gpu::kTraceRaysGroup * raysALane, most = kMostWorkgroups * group;
    for (uint32_t done = 0; done < count; done += std::min(count - done, most))
    {
        const uint32_t some = std::min(count - done, most);
        tracer.pipeline.push(cmd, gpu::TraceRaysPush{rays + done * uint64_t(sizeof(gpu::Ray)), hits + done * uint64_t(sizeof(gpu::RayHit)),
                                                     some, raysALane});
        tracer.gpu->vk.CmdDispatch(cmd, workgroupsInARow(some, group), 1, 1);
    }
}

/// Whatever reads the hits next: the host's stages are not known here.
void barrierAfterTrace(const Gpu& gpu, VkCommandBuffer cmd)
{
    // Read after write alone. Tracing into the same hits again is a write, which this doesn't order.
    memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT);
}

} // namespace

void RayTracer::record(VkCommandBuffer cmd, VkDeviceAddress rays, VkDeviceAddress hits, uint32_t count) const noexcept
{
    recordPass(*shared, cmd, rays, hits, count);
    barrierAfterTrace(*shared->gpu, cmd);
}

void recordTrace(const RayTracer& tracer, VkCommandBuffer cmd, const Buffer& rays, const Buffer& hits, uint32_t count)
{
    Gpu& gpu = *tracer.state().gpu;
    recordPass(tracer.state(), cmd, rays.address(), hits.address(), count);
    static_assert(sizeof(gpu::RayHit) == 64);
    constexpr uint32_t words = sizeof(gpu::RayHit) / 4, floats = 0x87feu; // t, position, normal, radiance, confidence
    scanBuffer(gpu, cmd, "trace rays", hits, {.count = VkDeviceSize(count) * words, .stride = words, .mask = floats});
    barrierAfterTrace(gpu, cmd);
}

Status RayTracer::trace(std::span<const gpu::Ray> rays, std::span<gpu::RayHit> hits, double* milliseconds) const
{
    if (rays.size() != hits.size())
        return Error{ErrorCode::badArgument,
                     fmt::format("there are {} rays and room for {} hits; give a hit for each ray", rays.size(), hits.size())};
    // 16 MiB of hits, as much as one staging copy takes.
    constexpr size_t kPiece = size_t(1) << 18;
    const size_t piece = std::min(rays.size(), kPiece);
    if (milliseconds) *milliseconds = 0.0;
    if (piece == 0) return success();
    Gpu& gpu = *shared->gpu;
    auto rayBuffer = gpu.makeBuffer(piece * sizeof(gpu::Ray), 0, MemoryUse::device, "rays");
    if (!rayBuffer) return rayBuffer.error();
    auto hitBuffer = gpu.makeBuffer(piece * sizeof(gpu::RayHit), 0, MemoryUse::device, "ray hits");
    if (!hitBuffer) return hitBuffer.error();
    auto timer = GpuTimer::create(gpu, 1);
    if (!timer) return timer.error();
    for (size_t first = 0; first < rays.size(); first += piece)
    {
        const size_t count = std::min(piece, rays.size() - first);
        if (auto status = gpu.upload(*rayBuffer, 0, std::as_bytes(rays.subspan(first, count))); !status) return status;
        auto status = gpu.submit(
            [&](VkCommandBuffer cmd)
            {
                timer->reset(cmd);
                timer->begin(cmd, "trace");
                recordTrace(*this, cmd, *rayBuffer, *hitBuffer, uint32_t(count));
                timer->end(cmd);
            });
        if (!status) return status;
        if (milliseconds)
            for (const GpuTimer::Scope& scope : timer->read()) *milliseconds += scope.milliseconds;
        if (auto copied = gpu.download(*hitBuffer, 0, std::as_writable_bytes(hits.subspan(first, count))); !copied) return copied;
    }
    return success();
}

} // namespace sconce
