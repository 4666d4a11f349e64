#pragma once

// Baking by this renderer: it draws what the probes see. With sconce_bake.cpp and probe_face.frag all that a host writes for that.
#include <filesystem>
#include <span>

#include "drawn_scene.h"

/// Bakes a light field of a scene, in its sun and its lamps, and writes it. Waits until it is done.
/// @param probes  in the field's world, which is glTF's
void bakeField(const Vulkan& vulkan, Allocators& lent, const DrawnScene& scene, Convention convention, std::span<const glm::vec3> probes,
               const std::filesystem::path& file);
