#pragma once

#include <filesystem>

#include "base/progress.h"
#include "base/result.h"
#include "scene/scene.h"

namespace sconce
{

/// Imports the default scene of a .gltf or .glb (glTF 2.0) with its instances expanded to world space. What is ignored or mended is said
/// in Scene::warnings, a sentence each. Reads only files in the scene's own folder (gltf_guard.h, limits there).
/// Extensions: KHR_mesh_quantization, KHR_texture_transform, KHR_lights_punctual (lux and candela taken as W/m^2 and W/sr),
/// KHR_materials_emissive_strength, EXT_mesh_gpu_instancing, EXT_texture_webp; any other that the file requires is refused by name.
/// Errors: fileError (can't be read), badInput (names the accessor, node or image that is wrong), cancelled.
Result<Scene> loadGltf(const std::filesystem::path& file, const Progress& progress = {});

} // namespace sconce
