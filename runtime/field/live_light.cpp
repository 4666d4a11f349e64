#include "runtime/field/live_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "base/numbers.h"
#include "base/parallel.h"
#include "runtime/field/light_field.h"
#include "runtime/field/tracer_cpu.h"
#include "runtime/scene/lights.h"
#include "shaders/shared/field_passes.h"

#include "spirv/live_bounce_comp.h"
#include "spirv/live_direct_comp.h"
#include "spirv/live_filter_comp.h"
#include "spirv/live_fine_comp.h"
#include "spirv/live_lobes_comp.h"
#include "spirv/live_map_comp.h"
#include "spirv/live_places_comp.h"

namespace sconce
{
namespace
{

constexpr uint32_t kSettledBounces = 32;    // after which light that bounces shows no more: of albedo 0.8 a thousandth is left
constexpr VkDeviceSize kMostUpdate = 65536; // bytes of vkCmdUpdateBuffer
constexpr uint32_t kMostBouncesOfRecord = 16;
constexpr float kMostIntensity = 1e8f;

void afterPass(const Gpu& gpu, VkCommandBuffer cmd)
{
    // Each pass reads what the one before wrote; copies read and write it, too.
    memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                  VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                  VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
}

void update(const Gpu& gpu, VkCommandBuffer cmd, const Buffer& buffer, std::span<const std::byte> bytes, VkDeviceSize at = 0)
{
    for (VkDeviceSize done = 0; done < bytes.size(); done += kMostUpdate)
    {
        const VkDeviceSize size = std::min<VkDeviceSize>(bytes.size() - done, kMostUpdate);
        gpu.vk.CmdUpdateBuffer(cmd, buffer.handle(), at + done, size, bytes.data() + done);
    }
}

/// A step of one record, over the probes of a list.
struct Step
{
    const LiveLight::State& state;
    VkCommandBuffer cmd;

    gpu::LivePush push(uint32_t first) const
    {
        const float offset = knobs::normalOffset.value * state.field.info().diagonal;
        return {state.addresses.address(), state.links, state.lightCount, state.places, first, offset, 0};
    }
    void bind(const Pipeline& pipeline) const
    {
        const VkDescriptorSet sets[] = {state.field.descriptorSet()};
        pipeline.bind(cmd, sets);
    }
    /// @param first  of the list, and `count` from there
    void overTexels(const Pipeline& pipeline, uint32_t first, uint32_t count) const
    {
        bind(pipeline);
        const uint32_t side = (state.field.info().surfaceSize + 7) / 8, most = kMostWorkgroups / 6;
        for (uint32_t done = 0; done < count; done += most)
        {
            pipeline.push(cmd, push(first + done));
            state.gpu->vk.CmdDispatch(cmd, side, side, 6 * std::min(count - done, most));
        }
        afterPass(*state.gpu, cmd);
    }
    void overPlaces() const
    {
        if (state.places == 0) return;
        bind(state.placePass);
        state.placePass.push(cmd, push(0));
        state.gpu->vk.CmdDispatch(cmd, workgroupsInARow(state.places, gpu::kLiveGroup), 1, 1);
        afterPass(*state.gpu, cmd);
    }
    void overRefined() const
    {
        const uint32_t words = gpu::kFineWords * state.refinedCount;
        if (words == 0) return;
        bind(state.finePass);
        state.finePass.push(cmd, push(0));
        state.gpu->vk.CmdDispatch(cmd, workgroupsInARow(words, gpu::kLiveGroup), 1, 1);
        afterPass(*state.gpu, cmd);
    }
    void overLobes(uint32_t first, uint32_t count) const
    {
        constexpr uint32_t kSide = gpu::kPrefilteredSize / 8;
        constexpr uint32_t kOutputs =
            gpu::kPrefilteredWords - gpu::kPrefilteredSize * gpu::kPrefilteredSize + gpu::kIrradianceSize * gpu::kIrradianceSize;
        static_assert(kOutputs % gpu::kLiveGroup == 0);
        for (uint32_t done = 0; done < count; done += kMostWorkgroups)
        {
            const uint32_t some = std::min(count - done, kMostWorkgroups);
            bind(state.mapPass);
            state.mapPass.push(cmd, push(first + done));
            state.gpu->vk.CmdDispatch(cmd, kSide, kSide, some);
            afterPass(*state.gpu, cmd);
            bind(state.lobePass);
            state.lobePass.push(cmd, push(first + done));
            state.gpu->vk.CmdDispatch(cmd, kOutputs / gpu::kLiveGroup, some, 1);
        }
        afterPass(*state.gpu, cmd);
    }
};

/// Chooses the probes that are lit in a record: all that wait in this round where so many may be; else by halves those nearest to the eye
/// and those whose turn it is.
void chooseProbes(LiveLight::State& state, const RelightBudget& budget)
{
    state.turn.clear();
    const uint32_t count = uint32_t(state.probes.size()), most = budget.probes == 0 ? count : std::min(budget.probes, count);
    const auto needs = [&](uint32_t probe) { return state.bounces > 0 && !state.probes[probe].lit; };
    uint32_t needing = 0;
    for (uint32_t probe = 0; probe < count; ++probe) needing += needs(probe);
    const uint32_t byTurn = needing <= most ? most : most - most / 2;
    for (auto& probe : state.probes) probe.chosen = false;
    for (uint32_t step = 0; step < count && state.turn.size() < byTurn; ++step)
    {
        const uint32_t probe = (state.next + step) % count;
        if (!needs(probe)) continue;
        state.turn.push_back(probe);
        state.probes[probe].chosen = true;
    }
    if (!state.turn.empty()) state.next = (state.turn.back() + 1) % count;
    if (needing <= most) return;
    state.others.clear();
    for (uint32_t probe = 0; probe < count; ++probe)
        if (needs(probe) && !state.probes[probe].chosen) state.others.push_back(probe);
    const auto nearer = [&](uint32_t a, uint32_t b)
    {
        const float farA = glm::distance(state.probes[a].centre, budget.eye), farB = glm::distance(state.probes[b].centre, budget.eye);
        return farA < farB || (farA == farB && a < b);
    };
    const auto end = state.others.begin() + std::ptrdiff_t(most - state.turn.size());
    std::ranges::nth_element(state.others, end, nearer);
    state.turn.insert(state.turn.end(), state.others.begin(), end);
}

/// After a record of so many bounces: a round ends with its last probe. Where it takes several records, each probe's bounces are of what
/// the others sent before: for light that goes from one to the other such a round is one sweep, whatever its bounces.
void countRound(LiveLight::State& state, uint32_t bounces)
{
    for (const uint32_t probe : state.turn) state.probes[probe].direct = false, state.probes[probe].lit = true;
    constexpr uint32_t kOfSweep = 2;
    state.ofRound = std::min(state.ofRound, state.turn.size() == state.probes.size() ? bounces : std::min(bounces, kOfSweep));
    if (!std::ranges::all_of(state.probes, &LiveLight::State::Probe::lit)) return;
    for (auto& probe : state.probes) probe.lit = false;
    state.bounces -= std::min(state.bounces, std::exchange(state.ofRound, kMostBouncesOfRecord));
}

/// Whether a probe sees anything within a light's range.
bool reaches(const Light& light, const gpu::ProbeHeader& probe, const gpu::LightFieldInfo& info)
{
    if (light.type == LightType::directional || !(light.range > 0.0f)) return true;
    const vec3 centre = info.origin + info.scale * probe.centre;
    return glm::distance(light.position, centre) <= light.range + info.scale * probe.farthest;
}

} // namespace

bool sameLight(const Light& a, const Light& b)
{
    return a.type == b.type && a.position == b.position && a.direction == b.direction && a.intensity == b.intensity && a.range == b.range &&
           a.innerCone == b.innerCone && a.outerCone == b.outerCone;
}

std::string lightFault(std::span<const Light> lights)
{
    if (lights.size() > kMostLiveLights)
        return fmt::format("there are {} lights, and {} may move; give fewer", lights.size(), kMostLiveLights);
    for (size_t i = 0; i < lights.size(); ++i)
    {
        const Light& light = lights[i];
        const std::string name = light.name.empty() ? fmt::format("light {}", i) : fmt::format("light '{}'", light.name);
        if (!finite(light.position)) return fmt::format("the position of {} is not finite; give metres", name);
        const bool dark = glm::any(glm::lessThan(light.intensity, vec3(0.0f)));
        if (!finite(light.intensity) || dark || glm::any(glm::greaterThan(light.intensity, vec3(kMostIntensity))))
            return fmt::format("the intensity of {} is {}, {}, {}; give 0 to {:.0e}", name, light.intensity.x, light.intensity.y,
                               light.intensity.z, kMostIntensity);
        if (light.type != LightType::point && !(finite(light.direction) && std::abs(glm::length(light.direction) - 1.0f) < 1e-3f))
            return fmt::format("the direction of {} is not of length 1; normalise it", name);
        if (!std::isfinite(light.range) || light.range < 0.0f)
            return fmt::format("the range of {} is {}; give metres, or 0", name, light.range);
        if (light.type == LightType::spot && !(light.innerCone >= 0.0f && light.innerCone <= light.outerCone && light.outerCone <= 1.6f))
            return fmt::format("the cones of {} are {} and {}; give radians, the inner one first, up to a right angle", name,
                               light.innerCone, light.outerCone);
    }
    return {};
}

namespace
{

/// Makes what stands behind a LiveLight.
struct LiveMaker
{
    Gpu& gpu;
    const LightField& field;
    const FieldData& data;
    LiveLight::State& made;
    Buffer incident{}, albedo{}; // that become the field's

    /// What records need no memory for afterwards.
    void reserve()
    {
        const size_t probes = data.probes.size();
        made.links = data.live.links;
        made.places = uint32_t(data.live.places.size());
        for (const gpu::ProbeHeader& probe : data.probes) made.probes.push_back({data.info.origin + data.info.scale * probe.centre});
        for (std::vector<uint32_t>* list : {&made.turn, &made.others, &made.dark}) list->reserve(probes);
        made.copies.reserve(probes);
        made.packed.reserve(kMostLiveLights);
        made.lights.reserve(kMostLiveLights);
    }

    Status uploadTransport()
    {
        const LiveTransport& live = data.live;
        std::vector<uint32_t> refined;
        for (uint32_t texel = 0; texel < live.texels.size(); ++texel)
            if (data.surfaceLight[texel] >= gpu::kRefinedWord) refined.push_back(texel);
        made.refinedCount = uint32_t(refined.size());
        std::vector<vec4> tints;
        for (const vec3& tint : live.tints) tints.emplace_back(tint, 0.0f);
        const std::vector<uint32_t> none(1); // where there is nothing, a buffer still wants a byte
        const auto some = [&](const std::vector<uint32_t>& words) { return std::as_bytes(std::span(words.empty() ? none : words)); };
        struct Given
        {
            Buffer& buffer;
            std::span<const std::byte> bytes;
            const char* what;
        };
        for (const Given& given : {Given{made.texels, std::as_bytes(std::span(live.texels)), "live texels"},
                                   Given{made.texelLinks, std::as_bytes(std::span(live.texelLinks)), "links of live texels"},
                                   Given{made.placeWords, some(live.places), "live places"},
                                   Given{made.placeLinks, some(live.placeLinks), "links of live places"},
                                   Given{made.refined, some(refined), "refined live texels"},
                                   Given{made.tints, std::as_bytes(std::span(tints)), "tints of metals"},
                                   Given{albedo, std::as_bytes(std::span(live.albedo)), "live albedo"}})
        {
            auto filled = gpu.makeBufferWith<std::byte>(given.bytes, 0, given.what);
            if (!filled) return filled.error();
            given.buffer = std::move(*filled);
            made.bytes += given.buffer.size();
        }
        return success();
    }

    Status makeRoom()
    {
        const size_t probes = data.probes.size(), texels = data.live.texels.size();
        struct Need
        {
            Buffer& buffer;
            uint64_t bytes;
            const char* what;
        };
        for (const Need& need :
             {Need{made.lightBuffer, kMostLiveLights * sizeof(gpu::GpuLight), "live lights"},
              Need{made.list, 8 * probes, "probes to be lit"}, Need{made.addresses, sizeof(gpu::LiveData), "addresses of live light"},
              Need{made.direct, 4 * texels, "direct live light"}, Need{made.bounced, 4 * texels, "bounced live light"},
              Need{made.tilts, data.info.surfaceDirections != 0 ? 4 * texels : 4, "tilts of live light"},
              Need{made.sent, 4 * texels, "live light that surfaces send"},
              Need{made.sentNext, 4 * texels, "live light that surfaces send next"}, Need{incident, 4 * texels, "incident live light"},
              Need{made.surface, 4 * data.surfaceLight.size(), "live surface light"},
              Need{made.irradiance, 4 * data.irradiance.size(), "live irradiance"},
              Need{made.prefiltered, 4 * probes * gpu::kPrefilteredWords, "live prefiltered radiance"}})
        {
            auto buffer = gpu.makeBuffer(need.bytes, 0, MemoryUse::device, need.what);
            if (!buffer) return buffer.error();
            need.buffer = std::move(*buffer);
            made.bytes += need.buffer.size();
        }
        const gpu::LiveData addresses{made.texels.address(),      made.texelLinks.address(), made.placeWords.address(),
                                      made.placeLinks.address(),  made.refined.address(),    made.tints.address(),
                                      made.lightBuffer.address(), made.list.address(),       made.direct.address(),
                                      made.bounced.address(),     made.tilts.address(),      made.sent.address(),
                                      made.sentNext.address(),    incident.address(),        made.surface.address(),
                                      made.irradiance.address(),  made.prefiltered.address()};
        if (auto status = gpu.upload(made.addresses, 0, std::as_bytes(std::span(&addresses, 1))); !status) return status;
        return gpu.submit(
            [&](VkCommandBuffer cmd)
            {
                for (const Buffer* buffer : {&made.direct, &made.bounced, &made.tilts, &made.sent, &made.sentNext, &incident, &made.surface,
                                             &made.irradiance, &made.prefiltered})
                    gpu.vk.CmdFillBuffer(cmd, buffer->handle(), 0, VK_WHOLE_SIZE, 0);
            });
    }

    Status makePasses()
    {
        const VkDescriptorSetLayout layouts[] = {field.layout()};
        const auto constants = shaderConstants(field);
        for (const auto& [pipeline, code] : {std::pair<Pipeline*, Spirv>{&made.directPass, live_direct_comp},
                                             {&made.bouncePass, live_bounce_comp},
                                             {&made.filterPass, live_filter_comp},
                                             {&made.placePass, live_places_comp},
                                             {&made.finePass, live_fine_comp},
                                             {&made.mapPass, live_map_comp},
                                             {&made.lobePass, live_lobes_comp}})
        {
            auto pass = Pipeline::compute(gpu, code, layouts, sizeof(gpu::LivePush), constants);
            if (!pass) return pass.error();
            *pipeline = std::move(*pass);
        }
        return success();
    }

    /// Live light becomes a share of the field's.
    Status join()
    {
        LightField::State& of = field.state();
        for (LightGroups::State::Part& part : made.groups.state().parts)
            part.live = part.target == &of.irradiance    ? made.irradiance.address()
                        : part.target == &of.prefiltered ? made.prefiltered.address()
                        : part.target == &of.surface     ? made.surface.address()
                                                         : 0;
        // What rays find is the radiance of the groups, and live light by the albedo.
        if (data.groups.size() == 1 && !data.radiance.empty())
            if (auto status = gpu.upload(of.radiance, 0, std::as_bytes(std::span(data.groups[0].radiance))); !status) return status;
        made.groups.state().changed = true; // all light of the field is to be mixed
        const VkDeviceAddress hits[] = {incident.address(), albedo.address()};
        if (auto status = gpu.upload(of.block, offsetof(gpu::FieldBlock, liveAddress), std::as_bytes(std::span(hits))); !status)
            return status;
        of.liveIncident = std::move(incident);
        of.liveAlbedo = std::move(albedo);
        return success();
    }
};

} // namespace

Result<LiveLight> makeLiveLight(Gpu& gpu, const LightField& field, const FieldData& data)
{
    if (data.live.links == 0)
        return Error{ErrorCode::badArgument,
                     fmt::format("the lights of the field of scene '{}' can't move; bake it with live links", data.sceneName)};
    if (field.state().liveIncident.address() != 0)
        return Error{ErrorCode::badArgument,
                     fmt::format("the lights of the field of scene '{}' move already; use its live light, or load the field once more",
                                 data.sceneName)};
    auto groups = makeLightGroups(gpu, field, data, data.groups.size() > 1);
    if (!groups) return groups.error();
    std::unique_ptr<LiveLight::State> state(new LiveLight::State{gpu.shared_from_this(), field, std::move(*groups)});
    LiveMaker maker{gpu, field, data, *state};
    maker.reserve();
    for (Status (LiveMaker::*step)() : {&LiveMaker::uploadTransport, &LiveMaker::makeRoom, &LiveMaker::makePasses, &LiveMaker::join})
        if (auto status = (maker.*step)(); !status) return status.error();
    LiveLight light(std::move(state));
    if (auto status = light.set({data.live.lights, {}}); !status) return status.error();
    return light;
}

LiveLight::LiveLight(std::unique_ptr<State> made) : owned(std::move(made)) {}
LiveLight::LiveLight(LiveLight&&) noexcept = default;
LiveLight& LiveLight::operator=(LiveLight&&) noexcept = default;
LiveLight::~LiveLight() = default;

std::span<const Light> LiveLight::lights() const
{
    return owned->lights;
}

std::vector<std::string> LiveLight::groups() const
{
    return owned->groups.names();
}

Status LiveLight::set(const LightState& wanted)
{
    State& state = *owned;
    if (std::string fault = lightFault(wanted.lights); !fault.empty()) return Error{ErrorCode::badArgument, std::move(fault)};
    const std::vector<vec3> weights = wanted.groups.empty() ? std::vector<vec3>(state.groups.names().size(), vec3(1.0f)) : wanted.groups;
    if (auto status = state.groups.set(weights); !status) return status;
    if (std::ranges::equal(wanted.lights, state.lights, sameLight)) return success();
    const LightField::State& field = state.field.state();
    state.bounces = kSettledBounces;
    state.ofRound = kMostBouncesOfRecord;
    for (auto& probe : state.probes) probe.lit = false;
    const auto touch = [&](const Light& light)
    {
        for (size_t probe = 0; probe < state.probes.size(); ++probe)
            state.probes[probe].direct = state.probes[probe].direct || reaches(light, field.headers[probe], field.info);
    };
    for (size_t i = 0; i < std::max(wanted.lights.size(), state.lights.size()); ++i)
    {
        const bool before = i < state.lights.size(), after = i < wanted.lights.size();
        if (before && after && sameLight(state.lights[i], wanted.lights[i])) continue;
        if (before) touch(state.lights[i]);
        if (after) touch(wanted.lights[i]);
    }
    state.lights.assign(wanted.lights.begin(), wanted.lights.end());
    state.packed.clear();
    for (const Light& light : state.lights) state.packed.push_back(deltaLight(light, field.info));
    state.moved = true;
    return success();
}

bool LiveLight::settled() const
{
    return !owned->groups.state().changed && owned->bounces == 0;
}

void LiveLight::record(VkCommandBuffer cmd, const RelightBudget& budget, GpuTimer* timer) noexcept
{
    if (settled()) return;
    State& state = *owned;
    const Gpu& gpu = *state.gpu;
    LightField::State& field = state.field.state();
    const auto timed = [&](const char* scope, auto&& pass)
    {
        if (timer) timer->begin(cmd, scope);
        pass();
        if (timer) timer->end(cmd);
    };
    // Whoever reads the field's light in work submitted before has done so, and what an earlier record wrote is written.
    memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                  VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
    chooseProbes(state, budget);
    state.dark.clear();
    for (const uint32_t probe : state.turn)
        if (state.probes[probe].direct) state.dark.push_back(probe);
    const uint32_t bounces = std::clamp(budget.bounces, 1u, kMostBouncesOfRecord);
    const auto count = uint32_t(state.turn.size()), darkCount = uint32_t(state.dark.size());
    if (state.moved)
    {
        update(gpu, cmd, state.lightBuffer, std::as_bytes(std::span(state.packed)));
        state.lightCount = uint32_t(state.packed.size());
        state.moved = false;
    }
    update(gpu, cmd, state.list, std::as_bytes(std::span(state.turn)));
    update(gpu, cmd, state.list, std::as_bytes(std::span(state.dark)), 4 * VkDeviceSize(count));
    // Of one group rays scale the radiance themselves.
    if (state.groups.state().groups.size() == 1)
    {
        field.radianceWeight = state.groups.state().weights[0];
        gpu.vk.CmdUpdateBuffer(cmd, field.block.handle(), offsetof(gpu::FieldBlock, radianceWeight), sizeof(vec3), &field.radianceWeight);
    }
    afterPass(gpu, cmd);
    const Step step{state, cmd};
    if (darkCount > 0) timed("live direct", [&] { step.overTexels(state.directPass, count, darkCount); });
    const VkDeviceSize texels = VkDeviceSize(24) * field.info.surfaceSize * field.info.surfaceSize;
    state.copies.clear();
    for (const uint32_t probe : state.turn) state.copies.push_back({probe * texels, probe * texels, texels});
    if (count > 0)
    {
        timed("live bounces",
              [&]
              {
                  for (uint32_t bounce = 0; bounce < bounces; ++bounce)
                  {
                      step.overTexels(state.bouncePass, 0, count);
                      gpu.vk.CmdCopyBuffer(cmd, state.sentNext.handle(), state.sent.handle(), count, state.copies.data());
                      afterPass(gpu, cmd);
                  }
              });
        timed("live filter",
              [&]
              {
                  step.overTexels(state.filterPass, 0, count);
                  step.overRefined();
              });
        timed("live places", [&] { step.overPlaces(); });
        timed("live lobes", [&] { step.overLobes(0, count); });
    }
    countRound(state, bounces);
    recordMix(state.groups.state(), cmd, timer);
}

uint64_t LiveLight::deviceBytes() const
{
    return owned->bytes + owned->groups.deviceBytes();
}

Status relightField(Gpu& gpu, FieldData& field, std::span<const Light> lights, std::span<const vec3> weights, uint32_t mostBounces)
{
    if (std::string fault = lightFault(lights); !fault.empty()) return Error{ErrorCode::badArgument, std::move(fault)};
    if (auto status = mixGroups(field, weights); !status) return status;
    field.live.lights.assign(lights.begin(), lights.end());
    field.live.lit = true;
    std::vector<uint32_t> incident(field.live.texels.size());
    {
        auto device = makeLightField(gpu, field);
        if (!device) return device.error();
        auto live = makeLiveLight(gpu, *device, field);
        if (!live) return live.error();
        if (auto status = live->set({{lights.begin(), lights.end()}, {weights.begin(), weights.end()}}); !status) return status;
        const auto bounce = [&] { return gpu.submit([&](VkCommandBuffer cmd) { live->record(cmd, {.bounces = 1}); }); };
        const auto take = [&](const Buffer& from, std::vector<uint32_t>& to)
        { return to.empty() ? success() : gpu.download(from, 0, std::as_writable_bytes(std::span(to))); };
        const LightField::State& of = device->state();
        for (uint32_t done = 0; !live->settled() && done <= mostBounces; ++done) // first what they light alone
            if (auto status = bounce(); !status) return status;
        for (const auto& [from, to] :
             {std::pair{&of.irradiance, &field.irradiance}, {&of.prefiltered, &field.prefiltered}, {&of.liveIncident, &incident}})
            if (auto status = take(*from, *to); !status) return status;
        // What arrives at surfaces has been scattered once more than what rays find there, as a bake leaves it.
        if (!live->settled())
            if (auto status = bounce(); !status) return status;
        if (auto status = take(of.surface, field.surfaceLight); !status) return status;
    }
    if (field.radiance.empty()) return success();
    const uint32_t side = field.info.faceSize;
    parallelFor(size_t(6) * side * field.info.probeCount,
                [&](size_t row)
                {
                    twin::LightFieldTwin<float> text(field, {});
                    text.live = incident;
                    const auto probe = uint32_t(row / (size_t(6) * side));
                    const int face = int(row / side % 6), y = int(row % side);
                    for (int x = 0; x < int(side); ++x)
                    {
                        decltype(text)::TraceResult hit{};
                        hit.probe = probe;
                        hit.face = face;
                        hit.pixel = vec2(float(x) + 0.5f, float(y) + 0.5f);
                        hit.word = text.distanceWord(text.mapWords(probe, face) + uint32_t(y) * side + uint32_t(x));
                        if ((hit.word & 0xffffu) == 0) continue; // sky
                        uint32_t& word = field.radiance[text.radianceIndex(probe, face, x, y)];
                        word = text.packRadianceDithered(text.unpackRadiance(word) + text.liveRadiance(hit),
                                                         text.ditherOf(text.radianceIndex(probe, face, x, y)));
                    }
                });
    return success();
}

} // namespace sconce
