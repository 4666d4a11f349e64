#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "runtime/field/field_data.h"

namespace sconce
{

/// The .sconce format's version that is written, and the oldest that is read; others are refused with a sentence. Version 3 added the
/// section `prefiltered` and lets `radiance` be empty; version 4 added `patches`. A field with light groups is written as version 7, one
/// whose maps are in blocks as 9, others as 6, which is the same without their sections; one whose lights may move as 10: of version 8 its
/// texels' grazing had no sign.
inline constexpr uint32_t kFieldFileVersion = 10, kOldestFieldFileVersion = 2;
inline constexpr uint32_t kLiveFileVersion = 10, kBlocksFileVersion = 9, kGroupedFileVersion = 7, kUngroupedFileVersion = 6;
inline uint32_t fileVersionOf(const FieldData& field)
{
    if (inBlocks(field.info)) return kBlocksFileVersion;
    if (field.live.links > 0) return kLiveFileVersion;
    return field.groups.empty() ? kUngroupedFileVersion : kGroupedFileVersion;
}

/// Writes a light field: whole under its name or not at all; the same field gives the same bytes.
/// Errors: badArgument (arrays disagree with info), fileError (names file and reason).
Status saveField(const FieldData& field, const std::filesystem::path& file);

/// Reads it back; every checksum and every size is verified, and every octree index, before anything relies on it.
/// Errors: fileError (cannot be read), badInput (names the damaged block, or the version), outOfMemory.
Result<FieldData> loadField(const std::filesystem::path& file);

/// Of the light and the places of a field's probes, but for what rays find: tells whether two are of one bake.
uint64_t lightHashOf(const FieldData& field);

/// The maps of an open .sconce file, read a probe at a time: distance and radiance, which are nearly all of it. Move-only; one thread at a
/// time.
class MapFile
{
public:
    MapFile(MapFile&&) noexcept;
    MapFile& operator=(MapFile&&) noexcept;
    ~MapFile();
    size_t distanceWords() const; // of a probe
    size_t radianceWords() const; // 0: the field has none
    uint32_t groups() const;      // of lights, each with a share of the radiance
    /// Reads and checks one probe's. Cost: the blocks that they are in, each of one probe where a file was written for it, else of up to 16
    /// MiB. Errors: fileError, badInput (names the damaged block), outOfMemory.
    Status read(uint32_t probe, std::span<uint32_t> distance, std::span<uint32_t> radiance);
    /// The same with the groups' shares of radiance, [group][word], in place of their sum.
    Status readShares(uint32_t probe, std::span<uint32_t> distance, std::span<uint32_t> shares);

    struct State;
    explicit MapFile(std::unique_ptr<State> made);

private:
    std::unique_ptr<State> owned;
};

/// A light field without its maps: `field` has neither distance nor radiance words, its groups no shares of radiance.
struct FieldAndMaps
{
    FieldData field;
    MapFile maps;
};

/// Reads all but the maps, whose blocks are checked when they are read. Errors: as loadField(), and badArgument for a field that has no
/// cube faces, or whose lights may move.
Result<FieldAndMaps> openField(const std::filesystem::path& file);

struct BlockReport
{
    std::string name; // header, table, meta, info, probes, distance 0, ..., footer
    uint64_t offset = 0;
    uint64_t storedBytes = 0;
    uint64_t rawBytes = 0;
    std::string problem; // empty: the checksum holds
};

struct VerifyReport
{
    uint32_t version = 0;
    uint64_t fileBytes = 0;
    std::vector<BlockReport> blocks;
    std::string problem; // of the content as a whole, when each block alone is sound
    bool ok() const;
};

/// Checks every block and goes on after a damaged one. Errors: fileError only; damage is in the report.
Result<VerifyReport> verifyField(const std::filesystem::path& file);

} // namespace sconce
