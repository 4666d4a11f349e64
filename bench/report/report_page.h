#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "base/result.h"

namespace sconce
{

/// Writes folder/report/index.html: one page that needs no other file and no network. It holds the results and the images they name.
/// @param results  results.json, schema 2 (docs/formats.md); the page keeps the order of settings
/// @param folder  where results.json lies; its image files are named relative to it
/// Errors: badInput names an image file that is no report image or that lies outside the folder; fileError.
Status writeReportPage(const nlohmann::ordered_json& results, const std::filesystem::path& folder);

} // namespace sconce
