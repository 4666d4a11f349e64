#pragma once

#include <string>

#include "base/progress.h"
#include "base/result.h"
#include "scene/scene.h"

namespace sconce
{

/// A scene as programs are given one: a built-in scene's name, or a .gltf or .glb file. Errors: badInput (neither of them; names what there
/// is), those of loadGltf().
Result<Scene> namedScene(const std::string& name, const Progress& progress = {});

} // namespace sconce
