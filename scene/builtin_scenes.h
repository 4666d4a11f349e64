#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "scene/scene.h"

namespace sconce
{

struct BuiltinScene
{
    std::string name;
    std::string description; // one line
};

/// The scenes that need no file, in the order of growing size.
std::vector<BuiltinScene> builtinScenes();

/// Makes one of them: deterministic, validated by tests, lit and with at least one camera in free space. Errors: badArgument for a name
/// that builtinScenes() doesn't list.
Result<Scene> makeBuiltinScene(std::string_view name);

} // namespace sconce
