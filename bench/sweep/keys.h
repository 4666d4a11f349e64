#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "base/result.h"
#include "runtime/scene/content_key.h" // of scenes and of this build

namespace sconce
{

/// 16 hexadecimal digits that tell two settings apart: what cached files are named by (XXH3, 64 bits, of the text).
std::string keyOf(const nlohmann::ordered_json& json);

/// The same of a file's bytes. Errors: fileError.
Result<std::string> keyOfFile(const std::filesystem::path& file);

} // namespace sconce
