#include "runtime/field/light_groups.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "base/parallel.h"
#include "runtime/field/light_field.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/tracer_cpu.h"
#include "shaders/shared/field_passes.h"
#include "shaders/shared/mix_passes.h"

#include "spirv/mix_groups_comp.h"

namespace sconce
{
namespace twin
{
namespace
{

/// The shared text on the host.
struct Mixer : LightFieldTwin<float>
{
    std::span<const LightGroup> groups;
    std::span<const glm::vec3> weights;
    std::vector<uint32_t> LightGroup::*part;

    Mixer(const FieldData& data, std::span<const glm::vec3> times, std::vector<uint32_t> LightGroup::*of)
        : LightFieldTwin<float>(data, {}), groups(data.groups), weights(times), part(of)
    {
    }
    uint mixGroups() const { return uint(groups.size()); }
    vec3 mixWeight(uint group) const { return weights[group]; }
    uint mixShare(uint group, uint index) const { return (groups[group].*part)[index]; }

#include "shaders/shared/group_mix.h"
};

} // namespace
} // namespace twin

namespace
{

constexpr uint32_t kKinds[] = {gpu::kMixRadiance, gpu::kMixIrradiance, gpu::kMixRadiance, gpu::kMixSurface}; // of kLightParts
static_assert(std::size(kKinds) == std::size(kLightParts));

constexpr size_t kMostShareWords = size_t(1) << 30; // of all groups, that a shader's index reaches

/// A sum of shares, each times its weight.
template <class Share> vec3 mixed(std::span<const LightGroup> groups, std::span<const vec3> weights, Share share)
{
    vec3 sum(0.0f);
    for (size_t g = 0; g < groups.size(); ++g) sum += weights[g] * share(groups[g]);
    return sum;
}

vec3 mixedLamp(std::span<const LightGroup> groups, std::span<const vec3> weights, size_t lamp)
{
    return mixed(groups, weights, [lamp](const LightGroup& group) { return group.lamps[lamp]; });
}

} // namespace

vec3 mixedSky(std::span<const LightGroup> groups, std::span<const vec3> weights)
{
    return mixed(groups, weights, [](const LightGroup& group) { return group.sky; });
}

std::vector<LightGroupDesc> groupsOf(std::span<const LightGroup> groups)
{
    std::vector<LightGroupDesc> all;
    for (const LightGroup& group : groups) all.push_back(group.which);
    return all;
}

Status mixGroups(FieldData& field, std::span<const vec3> weights)
{
    if (std::string fault = weightFault(groupsOf(field.groups), weights); !fault.empty())
        return Error{ErrorCode::badArgument, std::move(fault)};
    constexpr size_t kPiece = 4096;
    for (size_t part = 0; part < std::size(kLightParts); ++part)
    {
        const uint32_t kind = kKinds[part];
        std::vector<uint32_t>& words = field.*kLightParts[part].words;
        parallelFor((words.size() + kPiece - 1) / kPiece,
                    [&](size_t piece)
                    {
                        twin::Mixer text(field, weights, kLightParts[part].share);
                        for (size_t i = piece * kPiece; i < std::min(words.size(), (piece + 1) * kPiece); ++i)
                        {
                            if (kind == gpu::kMixIrradiance && (i & 1u) != 0) continue;
                            words[i] = kind == gpu::kMixSurface ? text.mixedSurface(uint32_t(i)) : text.mixedRadiance(uint32_t(i));
                        }
                    });
    }
    field.info.sky = mixedSky(field.groups, weights);
    for (size_t i = 0; i < field.lamps.size(); ++i) field.lamps[i].radiance = mixedLamp(field.groups, weights, i);
    return success();
}

Result<LightGroups> makeLightGroups(Gpu& gpu, const LightField& field, const FieldData& data, bool radiance)
{
    if (data.groups.empty())
        return Error{ErrorCode::badArgument,
                     fmt::format("the light field of scene '{}' has no light groups; bake it with some", data.sceneName)};
    if (auto status = checkDevice(gpu, field); !status) return status.error();
    LightField::State& of = field.state();
    if (of.mixed || of.liveIncident.address() != 0)
        return Error{ErrorCode::badArgument,
                     fmt::format("the light of the field of scene '{}' has light groups or live light already, which would write over what "
                                 "these do; use those, or load the field once more",
                                 data.sceneName)};
    MapPool* const pool = of.maps.get();
    if (pool && pool->fed)
        return Error{
            ErrorCode::badArgument,
            fmt::format("the light field of scene '{}' has a stream, which copies maps in one light; make the light groups before it",
                        data.sceneName)};
    assert(!pool || pool->file.groups() == data.groups.size());
    auto state = std::make_unique<LightGroups::State>(LightGroups::State{gpu.shared_from_this(), field});
    LightGroups::State& made = *state;
    for (const LightGroup& group : data.groups) made.groups.push_back({group.which, group.sky, group.lamps, {}, {}, {}, {}});
    made.weights.assign(data.groups.size(), vec3(1.0f));
    const Buffer* const targets[] = {&of.radiance, &of.irradiance, &of.prefiltered, &of.surface};
    for (size_t i = 0; i < std::size(kLightParts); ++i)
    {
        const bool ofMaps = kLightParts[i].words == &FieldData::radiance, streams = ofMaps && pool;
        const size_t words = streams ? pool->slots * pool->file.radianceWords() : (data.*kLightParts[i].words).size();
        if (words == 0 || (!radiance && ofMaps)) continue;
        if (words * data.groups.size() > kMostShareWords)
            return Error{ErrorCode::outOfMemory,
                         fmt::format("{} light groups of {} words each are more than the {} that a shader reaches; bake fewer groups or "
                                     "probes{}",
                                     data.groups.size(), words, kMostShareWords, streams ? ", or keep fewer maps on the device" : "")};
        LightGroups::State::Part part{kKinds[i], targets[i], uint32_t(words), {}, 0};
        auto buffer = gpu.makeBuffer(words * data.groups.size() * 4, 0, MemoryUse::device, "light groups");
        if (!buffer) return buffer.error();
        part.shares = std::move(*buffer);
        if (streams) // what no map has been copied to is mixed all the same; and what was there was in another light
        {
            auto cleared = gpu.submit(
                [&](VkCommandBuffer cmd)
                {
                    gpu.vk.CmdFillBuffer(cmd, part.shares.handle(), 0, VK_WHOLE_SIZE, 0);
                    gpu.vk.CmdFillBuffer(cmd, pool->slotOfProbe.handle(), 0, VK_WHOLE_SIZE, gpu::kNoProbe);
                });
            if (!cleared) return cleared.error();
            made.shareOfMaps = made.parts.size();
        }
        for (size_t g = 0; g < data.groups.size() && !streams; ++g)
        {
            const std::span<const uint32_t> share(data.groups[g].*kLightParts[i].share);
            if (auto status = gpu.upload(part.shares, g * words * 4, std::as_bytes(share)); !status) return status.error();
        }
        made.bytes += part.shares.size();
        made.parts.push_back(std::move(part));
    }
    auto weights = gpu.makeBuffer(kMostLightGroups * sizeof(vec3), 0, MemoryUse::device, "weights of light groups");
    if (!weights) return weights.error();
    made.weightBuffer = std::move(*weights);
    made.bytes += made.weightBuffer.size();
    // A stream may be recorded before these are.
    if (auto status = gpu.upload(made.weightBuffer, 0, std::as_bytes(std::span(made.weights))); !status) return status.error();
    const VkDescriptorSetLayout layouts[] = {field.layout()};
    auto pipeline = Pipeline::compute(gpu, mix_groups_comp, layouts, sizeof(gpu::MixPush), shaderConstants(field));
    if (!pipeline) return pipeline.error();
    made.pipeline = std::move(*pipeline);
    made.changed = true; // the field's light may be another mix than the one that set() has not been told to change yet
    of.mixed = true;
    if (pool && made.shareOfMaps) pool->groups = &made;
    made.mixes = {&of, [](LightField::State* mixed)
                  {
                      mixed->mixed = false;
                      if (mixed->maps) mixed->maps->groups = nullptr;
                  }};
    return LightGroups(std::move(state));
}

LightGroups::LightGroups(std::unique_ptr<State> made) : owned(std::move(made)) {}
LightGroups::LightGroups(LightGroups&&) noexcept = default;
LightGroups& LightGroups::operator=(LightGroups&&) noexcept = default;
LightGroups::~LightGroups() = default;

std::vector<std::string> LightGroups::names() const
{
    std::vector<std::string> all;
    for (const LightGroup& group : owned->groups) all.push_back(group.which.name);
    return all;
}

Status LightGroups::set(std::span<const vec3> weights)
{
    if (std::string fault = weightFault(groupsOf(owned->groups), weights); !fault.empty())
        return Error{ErrorCode::badArgument, std::move(fault)};
    owned->changed = owned->changed || !std::ranges::equal(weights, owned->weights);
    owned->weights.assign(weights.begin(), weights.end());
    return success();
}

void LightGroups::record(VkCommandBuffer cmd, GpuTimer* timer) noexcept
{
    if (owned->changed) recordMix(*owned, cmd, timer);
}

void recordMix(LightGroups::State& state, VkCommandBuffer cmd, GpuTimer* timer) noexcept
{
    using State = LightGroups::State;
    const bool weighed = std::exchange(state.changed, false);
    const Gpu& gpu = *state.gpu;
    LightField::State& field = state.field.state();
    if (timer) timer->begin(cmd, "light groups");
    // Whoever reads the field's light, or its weights, in work submitted before has done so, and what an earlier record wrote is written.
    memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT);
    gpu.vk.CmdUpdateBuffer(cmd, state.weightBuffer.handle(), 0, state.weights.size() * sizeof(vec3), state.weights.data());
    field.info.sky = mixedSky(state.groups, state.weights);
    gpu.vk.CmdUpdateBuffer(cmd, field.block.handle(), offsetof(gpu::FieldBlock, field) + offsetof(gpu::LightFieldInfo, sky), sizeof(vec3),
                           &field.info.sky);
    for (size_t i = 0; i < field.lampCount; ++i)
    {
        const vec3 radiance = mixedLamp(state.groups, state.weights, i);
        gpu.vk.CmdUpdateBuffer(cmd, field.lamps.handle(), i * sizeof(gpu::Lamp) + offsetof(gpu::Lamp, radiance), sizeof(vec3), &radiance);
    }
    memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                  VK_ACCESS_2_MEMORY_READ_BIT);
    const VkDescriptorSet sets[] = {state.field.descriptorSet()};
    state.pipeline.bind(cmd, sets);
    for (const State::Part& part : state.parts)
    {
        if (!weighed && part.live == 0) continue; // as it was
        state.pipeline.push(cmd, gpu::MixPush{part.target->address(), part.shares.address(), state.weightBuffer.address(), part.live,
                                              part.words, uint32_t(state.groups.size()), part.kind, part.words});
        gpu.vk.CmdDispatch(cmd, workgroupsInARow(part.words, gpu::kMixGroup), 1, 1);
    }
    // Read after write, by whatever stage of the host asks the field.
    memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT);
    if (timer) timer->end(cmd);
}

void recordSlotMix(LightGroups::State& state, VkCommandBuffer cmd, std::span<const uint32_t> slots) noexcept
{
    const LightGroups::State::Part& part = state.parts[*state.shareOfMaps];
    const MapPool& pool = *state.field.state().maps;
    const auto words = uint32_t(pool.file.radianceWords());
    const VkDescriptorSet sets[] = {state.field.descriptorSet()};
    state.pipeline.bind(cmd, sets);
    for (const uint32_t slot : slots)
    {
        const VkDeviceSize at = VkDeviceSize(slot) * words * sizeof(uint32_t);
        state.pipeline.push(cmd, gpu::MixPush{part.target->address() + at, part.shares.address() + at, state.weightBuffer.address(), 0,
                                              words, uint32_t(state.groups.size()), part.kind, part.words});
        state.gpu->vk.CmdDispatch(cmd, workgroupsInARow(words, gpu::kMixGroup), 1, 1);
    }
}

uint64_t LightGroups::deviceBytes() const
{
    return owned->bytes;
}

} // namespace sconce
