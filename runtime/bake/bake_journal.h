#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace sconce
{

/// What of a bake is kept on the way.
enum class BakeStage : uint32_t
{
    command = 0, // how the bake was called, for whoever finishes it: written by the command alone
    maps = 1,    // a probe's maps of direct light
    octree = 2,  // the octree and the probes' summaries; index 0
    cells = 3,   // what cells in the open gather; index 0
    gather = 4,  // what a probe's texels of surface light gather
    end = 5      // nothing: a finished file's last, without which it is cut off; JournalFile alone writes it
};

/// A piece of finished work by what it depends on.
struct BakePart
{
    uint64_t bake = 0; // bakeKey(): one journal may be of several bakes that make one field
    BakeStage stage = BakeStage::maps;
    uint32_t index = 0; // the probe
    auto operator<=>(const BakePart&) const = default;
};

/// Where bakeLightField() keeps what is finished and looks for it before it works. Called from one thread.
class BakeJournal
{
public:
    using Pieces = std::span<const std::span<const std::byte>>; // bytes that follow each other

    virtual ~BakeJournal();
    /// The bytes that were kept of a part; none: it wasn't, or is damaged.
    virtual std::optional<std::vector<std::byte>> find(const BakePart& part) const = 0;
    /// When this returns, the end of the process loses nothing of it. An error ends the bake.
    virtual Status keep(const BakePart& part, Pieces pieces) = 0;
};

/// What a journal's file is of.
struct JournalHead
{
    uint64_t build = 0;   // keyOfThisBuild()
    uint64_t content = 0; // of scene, probes, settings and device
    uint32_t probes = 0;
    uint32_t shard = 0, shards = 0; // shards 0: a whole bake's journal
    BakeStage stage = BakeStage::maps;
    bool operator==(const JournalHead&) const = default;
};

/// A journal in a file, which is also the part file of a shard: a head of 64 bytes, then records, each with its length and XXH3 checksum,
/// only ever appended. Little-endian; raw words, since packing them would cost more of a bake's time than it saves:
///   head    magic[8], u64 build, u64 content, u32 probes, u32 shard, u32 shards, u32 stage, u64 0, u64 checksum of these 48 bytes, u64 pid
///   record  u32 mark, u32 stage, u32 index, u32 0, u64 bake, u64 bytes, u64 checksum of these 32 bytes and the content; then the content
/// A killed process loses the record that it was writing; what the disk lacks after a power cut is found by the checksums, and so is any
/// damage: the records before it hold. Its one writer has it locked (flock), and has written its pid into it.
class JournalFile : public BakeJournal
{
public:
    /// Opens or makes the journal of a bake, alone.
    /// @param demanded  that it be there, of this bake: else badInput, and what stands there stays as it is
    /// Errors: fileError: another process has it (named by its pid), or it can't be read or written; badInput: as above.
    static Result<JournalFile> open(const std::filesystem::path& file, const JournalHead& head, bool demanded = false);
    /// Reads a finished part file. Errors: fileError: it can't be read; badInput: it isn't one, or damaged.
    static Result<JournalFile> read(const std::filesystem::path& file);
    /// Beside an output file: `.NAME.journal`.
    static std::filesystem::path besides(const std::filesystem::path& output);

    JournalFile(JournalFile&& other) noexcept;
    JournalFile& operator=(JournalFile&&) = delete;
    ~JournalFile() override; // leaves the file

    std::optional<std::vector<std::byte>> find(const BakePart& part) const override;
    Status keep(const BakePart& part, Pieces pieces) override;

    const JournalHead& head() const { return own; }
    const std::filesystem::path& path() const { return name; }
    size_t records() const { return places.size(); }
    uint64_t bytes() const { return end; }
    bool holds(const BakePart& part) const { return places.contains(part); }
    std::vector<BakePart> parts() const; // that it holds, ascending
    /// What was found in the file that is none of this bake's, a sentence; empty: nothing.
    const std::string& note() const { return found; }
    /// Makes it a finished file under a name: synced, renamed, the folder synced.
    Status commitAs(const std::filesystem::path& target);
    Status remove(); // when all that it holds is in the output

private:
    struct Place
    {
        uint64_t offset, bytes; // of the content
        uint64_t checksum;
    };
    JournalFile() = default;
    Status lock();
    Status begin();
    Result<std::string> scan(); // the good records; why what follows them isn't; empty: nothing follows
    Result<std::optional<std::pair<BakePart, Place>>> recordAt(uint64_t offset, uint64_t size) const; // none: it is damaged
    Status failure(std::string_view what) const;

    std::filesystem::path name;
    JournalHead own;
    int descriptor = -1;
    bool writable = false;
    uint64_t end = 0; // of the good records
    std::map<BakePart, Place> places;
    std::string found;
};

} // namespace sconce
