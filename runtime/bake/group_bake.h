#pragma once

#include <span>

#include "runtime/bake/bake.h"
#include "scene/light_groups.h"

namespace sconce
{

/// Bakes a field whose light is apart by groups of the scene's lights: FieldData::groups. The bake of all light says where light is kept,
/// then each group is baked in its light alone, with all that it bounces, and the field's own light is the sum.
/// @param settings  cube faces with surface light; `rays` are of the whole scene
/// @param groups    of the scene's lights (scene/light_groups.h)
/// @param report    of the bake of all light, with the seconds of all
/// Errors: as bakeLightField(); badArgument: groups that aren't the scene's, no surface light.
/// Cost: a bake more than there are groups, and for each of them all of the field's light again.
Result<FieldData> bakeLightGroups(Gpu& gpu, const Scene& scene, std::span<const vec3> probes, const BakeSettings& settings,
                                  std::vector<LightGroupDesc> groups, const Progress& progress, BakeReport& report);

/// bakeShard() of all of these bakes.
Status bakeGroupShard(Gpu& gpu, const Scene& scene, std::span<const vec3> probes, const BakeSettings& settings,
                      std::vector<LightGroupDesc> groups, const BakeShard& shard, const Progress& progress, BakeReport& report);

} // namespace sconce
