#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/light_groups.h"
#include "tools/common.h"

namespace sconce::tools
{

/// --group, any number of times. @param what  what the command does with them
void addGroups(CLI::App* command, std::vector<std::string>& groups, const std::string& what);
/// Errors: badArgument.
Result<std::vector<LightGroupDesc>> groupsOf(std::span<const std::string> texts);

/// --dim NAME=W or NAME=R,G,B, of light groups, any number of times. @param then  what the command does besides
void addDims(CLI::App* command, std::vector<std::string>& dims, const std::string& then = {});

/// Weights of all groups; 1 where none is given. Errors: badArgument: what isn't as above, a group that the field lacks.
Result<std::vector<vec3>> weightsOf(std::span<const std::string> dims, std::span<const LightGroupDesc> groups);

/// A scene in the light that some groups of its lights have by such weights, which are returned. Errors: as selectLights() and weightsOf().
Result<std::vector<vec3>> dimScene(Scene& scene, std::vector<LightGroupDesc> groups, std::span<const std::string> dims);

} // namespace sconce::tools
