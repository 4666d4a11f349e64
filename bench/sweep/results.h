#pragma once

#include <filesystem>
#include <initializer_list>

#include "base/result.h"
#include "bench/sweep/settings.h"

namespace sconce
{

/// results.json (docs/formats.md) without its scenes: version, command, machine, device.
Json resultsHead(const std::string& version, const std::string& build, const std::string& command, const std::string& deviceName);

/// Writes results.json and results.csv, each whole or not at all. Errors: fileError.
Status writeResults(const Json& results, const std::filesystem::path& folder);

/// One line a point, one column a figure of docs/formats.md; empty where it wasn't measured.
std::string resultsCsv(const Json& results);

/// Whether it is an object in which each of the keys has a text.
bool holdsTexts(const Json& object, std::initializer_list<const char*> keys);

/// Reads results.json, or what has its schema. Errors: fileError, badInput (another schema).
Result<Json> readResults(const std::filesystem::path& file);

/// What the report shows of a file that bench/gpu/run.sh wrote: device, driver, size, wrong, frames and rays (results.ts). Errors:
/// fileError, badInput (not such a file).
Result<Json> readGpuRun(const std::filesystem::path& file);

/// The figures that a point is judged by, by name: frame_ms, trace_ms, reads (a ray), wrong_rays (share not right within 1 %),
/// wrong_rays_02 (0.2 %), unresolved, false, leak, bytes, probes, bake_s, {beauty,diffuse,glossy}.{mse,relmse,flip,mean}. None where it
/// wasn't measured.
std::optional<double> figureOf(const Json& point, std::string_view name);

} // namespace sconce
