#include "scene/named_scene.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <fmt/format.h>

#include "base/listed.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_gltf.h"

namespace sconce
{

Result<Scene> namedScene(const std::string& name, const Progress& progress)
{
    const std::vector<BuiltinScene> known = builtinScenes();
    if (std::ranges::find(known, name, &BuiltinScene::name) != known.end()) return makeBuiltinScene(name);
    const std::filesystem::path path(name);
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    if (extension == ".gltf" || extension == ".glb") return loadGltf(path, progress);
    return Error{ErrorCode::badInput,
                 fmt::format("'{}' is neither a .gltf or .glb file nor a built-in scene ({}).", name, listed(known, &BuiltinScene::name))};
}

} // namespace sconce
