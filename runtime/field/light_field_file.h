#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "runtime/field/field_data.h"

namespace sconce
{

/// The .sconce format's version that is written, and the oldest that is read; others are refused with a sentence. Version 3 added the
/// section `prefiltered` and lets `radiance` be empty; version 4 added `patches`. A field with light groups is written as version 7, one
/// whose lights may move as 8, others as 6, which is the same without their sections.
inline constexpr uint32_t kFieldFileVersion = 8, kOldestFieldFileVersion = 2;
inline constexpr uint32_t kGroupedFileVersion = 7, kUngroupedFileVersion = 6;
inline uint32_t fileVersionOf(const FieldData& field)
{
    if (field.live.links > 0) return kFieldFileVersion;
    return field.groups.empty() ? kUngroupedFileVersion : kGroupedFileVersion;
}

/// Writes a light field: whole under its name or not at all; the same field gives the same bytes.
/// Errors: badArgument (arrays disagree with info), fileError (names file and reason).
Status saveField(const FieldData& field, const std::filesystem::path& file);

/// Reads it back; every checksum and every size is verified, and every octree index, before anything relies on it.
/// Errors: fileError (cannot be read), badInput (names the damaged block, or the version), outOfMemory.
Result<FieldData> loadField(const std::filesystem::path& file);

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
