#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "scene/scene.h"

namespace sconce
{

/// Lights of a scene that are switched, dimmed and coloured together.
struct LightGroupDesc
{
    std::string name;
    std::vector<std::string> members; // `sun`: all directional lights; `punctual`: all others without area; `emitters`: all materials that
                                      // shine; `sky`; or the name of a light, or of a material that shines, where * is any letters. None:
                                      // all light that is in no other group
};
inline constexpr size_t kMostLightGroups = 16;

/// What a group is in a scene, ascending.
struct LightSelection
{
    std::vector<uint32_t> lights, materials; // of Scene
    bool sky = false;
};

/// As the command has it: NAME=MEMBER,MEMBER, or one MEMBER alone, which is the name, too. Errors: badArgument.
Result<LightGroupDesc> parseLightGroup(std::string_view text);

/// Finds the groups' lights. Each light of the scene is in one of them.
/// @param groups  gets one more, `rest`, where some of the light is in none
/// Errors: badArgument: no group or more than kMostLightGroups, two of one name, a member that the scene lacks, a light in two; by name.
Result<std::vector<LightSelection>> selectLights(const Scene& scene, std::vector<LightGroupDesc>& groups);

/// What is wrong with weights of groups' light, as a sentence; empty where there is one for each, from 0 to kMostLightWeight.
std::string weightFault(std::span<const LightGroupDesc> groups, std::span<const vec3> weights);
inline constexpr float kMostLightWeight = 1e6f;

/// Multiplies a group's light.
void dimLights(Scene& scene, const LightSelection& group, vec3 weight);

} // namespace sconce
