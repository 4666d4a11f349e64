#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "runtime/field/light_field.h"
#include "runtime/sconce.h"

namespace sconce
{

/// Reads maps on a thread of its own: what it is told to, in that order, into a few buffers that wait to be taken.
class MapReader
{
public:
    struct Maps
    {
        uint32_t probe = gpu::kNoProbe;
        std::vector<uint32_t> words; // distance, then radiance, or the shares of it
    };

    /// @param ahead  buffers
    /// @param shares  the groups' shares of radiance are read, not their sum
    MapReader(MapFile& file, uint32_t ahead, bool shares = false);
    ~MapReader();
    /// What is to be read from now on, in place of what was to be before; what has been read stays.
    /// @param probes  at most kMostWanted of them count, the first ones
    void want(std::span<const uint32_t> probes);
    static constexpr size_t kMostWanted = 64;
    /// What has been read, once; nothing where nothing has. Give it back when it has been copied.
    std::optional<Maps> take();
    void giveBack(Maps maps);
    /// Whether there is something to read, or that has been read and not taken.
    bool reads() const;
    Status status() const;
    uint64_t read() const;
    /// Marks probes whose maps could not be read, each once. Waits for nothing where there are none.
    /// @param of  a flag for each probe
    void markLost(std::span<uint8_t> of);

private:
    void run(std::stop_token stop);

    MapFile& file;
    bool ofShares;
    mutable std::mutex mutex;
    std::condition_variable_any changed;
    std::vector<uint32_t> wanted; // the next one last
    std::vector<Maps> free, ready;
    std::vector<uint32_t> lost; // could not be read, and isn't marked yet
    std::atomic<bool> losing{false};
    std::optional<Error> fault;
    uint32_t reading = gpu::kNoProbe;
    uint64_t count = 0;
    std::jthread thread; // last: it uses all of the above
};

/// What stands behind the handle FieldStream.
struct FieldStream::State
{
    /// What a probe's maps are worth: first by how often they are asked for, then, of those that aren't, by how near they are. Less is
    /// worthier.
    using Worth = std::pair<float, float>;

    std::shared_ptr<Gpu> gpu;
    LightField field;
    Desc desc;
    std::unique_ptr<MapPool, void (*)(MapPool*)> fed; // the field's, which may have another stream when this one goes
    Buffer staging;                                   // [frame in flight][probe a frame] maps
    std::unique_ptr<MapReader> reader;
    std::vector<uint32_t> probeOfSlot, slotOfProbe;
    std::vector<uint64_t> filledAt;                // of each slot, by record
    std::vector<uint8_t> lost;                     // of each probe: its maps could not be read
    std::vector<float> asked;                      // of each probe: how often it was asked for in a frame, less the longer ago
    std::vector<std::pair<Worth, uint32_t>> order; // of a record: missing probes, the worthiest first
    std::vector<uint32_t> names;                   // the same, for the reader
    vec3 eyeBefore{0.0f};                          // of the last record
    std::array<uint32_t, 2> nearby{};              // probes nearest to the eye, and to where it will be: worthier than all
    uint64_t records = 0;
    bool forgets = false;         // the next record clears the slots that another stream has filled
    uint32_t shares = 1;          // of radiance, that are copied for a probe
    bool mixes = false;           // they are of the pool's groups
    std::vector<uint32_t> filled; // slots of this record, to be mixed
    Counts counts;

    void noteAsked();
    void follow(vec3 eye);
    float distanceTo(uint32_t probe, vec3 place) const;
    Worth worthOf(uint32_t probe, vec3 eye) const;
    uint32_t slotFor(uint32_t probe, vec3 eye) const;
};

/// FieldStream::create() for the library's own folders.
Result<FieldStream> makeFieldStream(Gpu& gpu, const LightField& field, const FieldStream::Desc& desc);

} // namespace sconce
