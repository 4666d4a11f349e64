#pragma once

#include <span>
#include <string>

#include "runtime/bake/probe_faces.h"
#include "scene/exact_rays.h"
#include "shaders/shared/light_field.h"
#include "shaders/shared/scene_passes.h"

namespace sconce
{

/// A face as a host draws it, of the view by which the bake would draw the scene, which is in field units.
ProbeFace faceInWorld(const gpu::SceneView& view, const gpu::LightFieldInfo& space, uint32_t probe, uint32_t face);

/// What tells that a host drew other surfaces than the scene has, a sentence; empty where most of what a probe sees is as far away as the
/// first triangle there, to a tenth: levels of detail, displaced ground and what the scene leaves out are the host's choice.
/// @param centre  of the probe, field units
/// @param words   [6][size][size], texel.h: level 0 of the faces as they were drawn, each `stride` words after the one before
std::string faultOfDrawn(const ExactRays& rays, const gpu::LightFieldInfo& space, vec3 centre, uint32_t probe,
                         std::span<const uint32_t> words, uint32_t size, size_t stride);

} // namespace sconce
