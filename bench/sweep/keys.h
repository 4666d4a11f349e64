#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "base/result.h"
#include "scene/scene.h"

namespace sconce
{

/// 16 hexadecimal digits that tell two settings apart: what cached files are named by (XXH3, 64 bits, of the text).
std::string keyOf(const nlohmann::ordered_json& json);

/// The same of a file's bytes. Errors: fileError.
Result<std::string> keyOfFile(const std::filesystem::path& file);

/// The same of the running program, shaders and all that is linked into it: what two builds measured is never taken for one's. Two commits
/// that make the same program are one build. Errors: fileError.
Result<std::string> keyOfThisBuild();
uint64_t keyWithoutCommit(std::string program); // of a program's bytes

/// The same of everything in a scene that light depends on: triangles, materials, images, lights, sky; not its cameras or its name.
std::string keyOf(const Scene& scene);

} // namespace sconce
