#include "runtime/field/field_stream.h"

#include <algorithm>
#include <atomic>
#include <cstring>

#include <fmt/format.h>

#include "runtime/field/light_groups.h"

namespace sconce
{
namespace
{

constexpr float kKept =
    0.875f; // of what was asked for before, a record later: passes note it while they run, which is seen some records later
constexpr float kLeastAsked = 0.5f; // below it a probe isn't asked for any longer
constexpr float kNearby = 1e12f;    // as often as nothing is asked for
constexpr float kRecordsAhead = 8.0f;
constexpr float kMoreAsked = 1.25f; // times what another is, that a probe must be asked for to take its place: or two would take turns

} // namespace

MapReader::MapReader(MapFile& maps, uint32_t ahead, bool shares) : file(maps), ofShares(shares)
{
    wanted.reserve(kMostWanted);
    ready.reserve(ahead);
    const size_t words = maps.distanceWords() + maps.radianceWords() * (shares ? maps.groups() : 1);
    for (uint32_t i = 0; i < ahead; ++i) free.push_back({gpu::kNoProbe, std::vector<uint32_t>(words)});
    thread = std::jthread([this](std::stop_token stop) { run(stop); });
}

MapReader::~MapReader()
{
    thread.request_stop();
    changed.notify_all();
}

void MapReader::want(std::span<const uint32_t> probes)
{
    const std::scoped_lock lock(mutex);
    wanted.clear();
    for (const uint32_t probe : probes)
    {
        const bool there = probe == reading || std::ranges::find(ready, probe, &Maps::probe) != ready.end();
        if (!there && wanted.size() < kMostWanted) wanted.push_back(probe);
    }
    std::ranges::reverse(wanted);
    changed.notify_all();
}

std::optional<MapReader::Maps> MapReader::take()
{
    const std::scoped_lock lock(mutex);
    if (ready.empty()) return std::nullopt;
    Maps maps = std::move(ready.front());
    ready.erase(ready.begin());
    return maps;
}

void MapReader::giveBack(Maps maps)
{
    const std::scoped_lock lock(mutex);
    free.push_back(std::move(maps));
    changed.notify_all();
}

bool MapReader::reads() const
{
    const std::scoped_lock lock(mutex);
    return !wanted.empty() || !ready.empty() || reading != gpu::kNoProbe;
}

Status MapReader::status() const
{
    const std::scoped_lock lock(mutex);
    if (fault) return *fault;
    return success();
}

uint64_t MapReader::read() const
{
    const std::scoped_lock lock(mutex);
    return count;
}

void MapReader::markLost(std::span<uint8_t> of)
{
    if (!losing.load(std::memory_order_acquire)) return;
    const std::scoped_lock lock(mutex);
    for (const uint32_t probe : lost) of[probe] = 1;
    lost.clear();
    losing.store(false, std::memory_order_release);
}

void MapReader::run(std::stop_token stop)
{
    std::unique_lock lock(mutex);
    // wait() says what there is to do after a stop, too: what nobody waits for any more isn't read.
    while (changed.wait(lock, stop, [&] { return !wanted.empty() && !free.empty(); }) && !stop.stop_requested())
    {
        Maps maps = std::move(free.back());
        free.pop_back();
        maps.probe = reading = wanted.back();
        wanted.pop_back();
        lock.unlock();
        const auto distance = std::span(maps.words).first(file.distanceWords()), light = std::span(maps.words).subspan(distance.size());
        const Status status = ofShares ? file.readShares(maps.probe, distance, light) : file.read(maps.probe, distance, light);
        lock.lock();
        reading = gpu::kNoProbe;
        if (status)
        {
            ++count;
            ready.push_back(std::move(maps));
            continue;
        }
        lost.push_back(maps.probe);
        losing.store(true, std::memory_order_release);
        if (!fault)
            fault = Error{status.error().code, fmt::format("The maps of probe {} are not there: {}", maps.probe, status.error().message)};
        free.push_back(std::move(maps));
    }
}

/// Takes what passes have noted since the last record. They may be running: what they note meanwhile is taken by the next one.
void FieldStream::State::noteAsked()
{
    const std::span noted(reinterpret_cast<uint32_t*>(field.state().maps->asked.mapped()), asked.size());
    for (size_t probe = 0; probe < asked.size(); ++probe)
    {
        const auto now = float(std::atomic_ref(noted[probe]).exchange(0u, std::memory_order_relaxed));
        asked[probe] = std::max(now, kKept * asked[probe]);
        if (asked[probe] < kLeastAsked) asked[probe] = 0.0f;
    }
}

/// Where the eye comes to, its picture asks for maps when it is too late: those nearest to it, and to where it goes on to, come first.
void FieldStream::State::follow(vec3 eye)
{
    const vec3 ahead = records > 1 ? eye + kRecordsAhead * (eye - eyeBefore) : eye;
    eyeBefore = eye;
    const auto nearestTo = [&](vec3 place)
    {
        uint32_t nearest = 0;
        for (uint32_t probe = 1; probe < asked.size(); ++probe)
            if (distanceTo(probe, place) < distanceTo(nearest, place)) nearest = probe;
        return nearest;
    };
    nearby = {nearestTo(eye), nearestTo(ahead)};
}

/// Metres.
float FieldStream::State::distanceTo(uint32_t probe, vec3 place) const
{
    const LightField::State& of = field.state();
    return glm::distance(of.info.origin + of.info.scale * of.headers[probe].centre, place);
}

FieldStream::State::Worth FieldStream::State::worthOf(uint32_t probe, vec3 eye) const
{
    const bool isNearby = probe == nearby[0] || probe == nearby[1];
    return {isNearby ? -kNearby : -asked[probe], distanceTo(probe, eye)};
}

/// A slot that is empty, or that of the least worthy probe, where the new one is worthier; not one that this record has filled.
/// @return  kNoProbe: the new one has to wait
uint32_t FieldStream::State::slotFor(uint32_t probe, vec3 eye) const
{
    uint32_t found = gpu::kNoProbe;
    Worth least;
    for (uint32_t slot = 0; slot < probeOfSlot.size(); ++slot)
    {
        if (probeOfSlot[slot] == gpu::kNoProbe) return slot;
        if (filledAt[slot] == records) continue;
        const Worth worth = worthOf(probeOfSlot[slot], eye);
        if (found == gpu::kNoProbe || worth > least) least = worth, found = slot;
    }
    if (found == gpu::kNoProbe) return found;
    const Worth own = worthOf(probe, eye);
    const bool worthier = least.first < 0.0f ? own.first < kMoreAsked * least.first : own < least;
    return worthier ? found : gpu::kNoProbe;
}

FieldStream::FieldStream(std::unique_ptr<State> made) : owned(std::move(made)) {}
FieldStream::FieldStream(FieldStream&&) noexcept = default;
FieldStream& FieldStream::operator=(FieldStream&&) noexcept = default;
FieldStream::~FieldStream() = default;

Result<FieldStream> FieldStream::create(const Device& device, const LightField& field, const Desc& desc)
{
    return makeFieldStream(device.gpu(), field, desc);
}

Result<FieldStream> makeFieldStream(Gpu& gpu, const LightField& field, const FieldStream::Desc& desc)
{
    if (auto status = checkDevice(gpu, field); !status) return status.error();
    MapPool* const pool = field.state().maps.get();
    if (!pool) return Error{ErrorCode::badArgument, "the light field is whole; load it with `resident` above 0, or leave the stream out"};
    if (pool->fed) return Error{ErrorCode::badArgument, "the light field has a stream; one is enough for all views of it"};
    if (desc.probesAFrame < 1 || desc.probesAFrame > MapReader::kMostWanted)
        return Error{ErrorCode::badArgument, fmt::format("probesAFrame is {}; give 1 to {}", desc.probesAFrame, MapReader::kMostWanted)};
    if (desc.framesInFlight < 1 || desc.framesInFlight > 8)
        return Error{ErrorCode::badArgument, fmt::format("framesInFlight is {}; give 1 to 8", desc.framesInFlight)};
    using State = FieldStream::State;
    auto state = std::make_unique<State>(State{gpu.shared_from_this(), field, desc, {nullptr, [](MapPool* of) { of->fed = false; }}});
    state->mixes = pool->groups != nullptr;
    state->shares = state->mixes ? pool->file.groups() : 1;
    state->filled.reserve(desc.probesAFrame);
    const uint64_t bytes = 4 * (pool->file.distanceWords() + pool->file.radianceWords() * state->shares);
    auto staging = gpu.makeBuffer(bytes * desc.probesAFrame * desc.framesInFlight, 0, MemoryUse::upload, "maps on their way");
    if (!staging) return staging.error();
    state->staging = std::move(*staging);
    const size_t probes = field.state().headers.size();
    state->probeOfSlot.assign(pool->slots, gpu::kNoProbe);
    state->slotOfProbe.assign(probes, gpu::kNoProbe);
    state->asked.assign(probes, 0.0f);
    state->order.reserve(probes);
    state->names.reserve(probes);
    state->reader = std::make_unique<MapReader>(pool->file, 2 * desc.probesAFrame, state->mixes);
    state->filledAt.assign(pool->slots, 0);
    state->lost.assign(probes, 0);
    pool->fed = true;
    state->fed.reset(pool);
    state->forgets = std::exchange(pool->used, true);
    return FieldStream(std::move(state));
}

void FieldStream::record(VkCommandBuffer cmd, vec3 eye, GpuTimer* timer) noexcept
{
    State& state = *owned;
    const Gpu& gpu = *state.gpu;
    LightField::State& field = state.field.state();
    MapPool& pool = *field.maps;
    ++state.records;
    state.noteAsked();
    state.follow(eye);

    const size_t distanceBytes = 4 * pool.file.distanceWords(), radianceBytes = 4 * pool.file.radianceWords();
    const size_t mapBytes = distanceBytes + state.shares * radianceBytes;
    // Shares of groups that are gone can't be mixed: what is there stays in their last light, and nothing comes.
    const bool orphaned = state.mixes && !pool.groups;
    const VkBuffer light =
        state.mixes && !orphaned ? pool.groups->parts[*pool.groups->shareOfMaps].shares.handle() : field.radiance.handle();
    state.filled.clear();
    const size_t first = (state.records % state.desc.framesInFlight) * state.desc.probesAFrame;
    const auto set = [&](uint32_t probe, uint32_t slot)
    {
        state.slotOfProbe[probe] = slot;
        gpu.vk.CmdUpdateBuffer(cmd, pool.slotOfProbe.handle(), probe * sizeof(uint32_t), sizeof(uint32_t), &slot);
    };
    bool begun = false;
    const auto begin = [&]
    {
        if (std::exchange(begun, true)) return;
        if (timer) timer->begin(cmd, "stream maps");
        // Write after read: whoever traced through the maps in work submitted before has done so.
        memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                      VK_ACCESS_2_TRANSFER_WRITE_BIT);
    };
    if (std::exchange(state.forgets, false))
    {
        begin();
        gpu.vk.CmdFillBuffer(cmd, pool.slotOfProbe.handle(), 0, VK_WHOLE_SIZE, gpu::kNoProbe);
        // Write after write: slots are set below.
        memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                      VK_ACCESS_2_TRANSFER_WRITE_BIT);
    }
    uint32_t copied = 0;
    while (copied < state.desc.probesAFrame)
    {
        auto maps = state.reader->take();
        if (!maps) break;
        const bool comes = !orphaned && state.slotOfProbe[maps->probe] == gpu::kNoProbe;
        const uint32_t slot = comes ? state.slotFor(maps->probe, eye) : gpu::kNoProbe;
        if (slot != gpu::kNoProbe)
        {
            begin();
            const VkDeviceSize from = (first + copied) * mapBytes;
            std::memcpy(state.staging.mapped() + from, maps->words.data(), mapBytes);
            const VkBufferCopy distance{from, slot * distanceBytes, distanceBytes};
            gpu.vk.CmdCopyBuffer(cmd, state.staging.handle(), field.distance.handle(), 1, &distance);
            for (VkDeviceSize share = 0; share < state.shares && radianceBytes > 0; ++share)
            {
                const VkBufferCopy radiance{from + distanceBytes + share * radianceBytes, (share * pool.slots + slot) * radianceBytes,
                                            radianceBytes};
                gpu.vk.CmdCopyBuffer(cmd, state.staging.handle(), light, 1, &radiance);
            }
            state.filled.push_back(slot);
            if (const uint32_t before = state.probeOfSlot[slot]; before != gpu::kNoProbe) set(before, gpu::kNoProbe);
            state.probeOfSlot[slot] = maps->probe;
            state.filledAt[slot] = state.records;
            set(maps->probe, slot);
            ++copied;
        }
        state.reader->giveBack(std::move(*maps));
    }
    if (begun)
    {
        // Read after write, by whatever stage of the host asks the field, and by what mixes shares.
        memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                      VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
        if (state.mixes && !state.filled.empty())
        {
            recordSlotMix(*pool.groups, cmd, state.filled);
            // Read after write, by whatever stage asks the field, and write after write, by what mixes all of it.
            memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                          VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
        }
        if (timer) timer->end(cmd);
    }

    // What to read next: the worthiest, as far as there is room.
    state.order.clear();
    Counts& counts = state.counts;
    counts = {};
    state.reader->markLost(state.lost);
    for (uint32_t probe = 0; probe < state.slotOfProbe.size(); ++probe)
    {
        const bool there = state.slotOfProbe[probe] != gpu::kNoProbe;
        counts.resident += there ? 1 : 0;
        if (there || state.lost[probe] != 0) continue;
        counts.missing += state.asked[probe] > 0.0f ? 1 : 0;
        state.order.emplace_back(state.worthOf(probe, eye), probe);
    }
    const size_t most = std::min(MapReader::kMostWanted, state.order.size());
    std::ranges::partial_sort(state.order, state.order.begin() + std::ptrdiff_t(most));
    state.names.clear();
    for (size_t i = 0; i < most; ++i)
        if (state.slotFor(state.order[i].second, eye) != gpu::kNoProbe) state.names.push_back(state.order[i].second);
    if (orphaned) state.names.clear();
    counts.full = counts.missing > 0 && std::ranges::none_of(state.names, [&](uint32_t probe) { return state.asked[probe] > 0.0f; });
    state.reader->want(state.names);
    counts.read = state.reader->read();
}

FieldStream::Counts FieldStream::counts() const
{
    return owned->counts;
}

Status FieldStream::status() const
{
    return owned->reader->status();
}

uint64_t FieldStream::deviceBytes() const
{
    return owned->staging.size();
}

} // namespace sconce
