#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/random.h"
#include "bench/race/ray_sets.h"
#include "tests/support/field_by_rays.h"

namespace sconce::testing_support
{

/// A scene, its rays, and a light field of coarse maps cast from given probes; pinned in place, since each refers to the one before.
struct HardScene
{
    Scene scene;
    RayScene rays;
    FieldData field;

    HardScene(Scene made, std::span<const vec3> probes, uint32_t faceSize = 64, int voxels = 32);
    HardScene(Scene made, uint32_t probesPerCamera); // at the middle of random views of the scene's cameras
    HardScene(const HardScene&) = delete;
};

/// A closed box about a centre, half extents scale * (1, 0.75, 0.5): its borders are exact in binary.
Scene closedBox(float scale = 1.0f, vec3 centre = vec3(0.0f));
inline constexpr vec3 kBoxHalf{1.0f, 0.75f, 0.5f};

/// Three wavy sheets without thickness across a closed room of 4 x 3 x 4 m.
Scene curtains();
inline constexpr int kCurtainStrips = 48; // flat pieces of a sheet, along z

/// Sponza of the folder of real scenes; nothing where that is missing.
std::optional<Scene> sponza();

/// A built-in scene, "curtains" or "sponza" with probes of its own; null where a file is missing.
std::unique_ptr<HardScene> hardScene(const std::string& name);

/// Glossy rays off the surfaces that the scene's cameras see.
RaySet glossyRaysOf(const HardScene& scene, uint32_t count);

/// A direction spread evenly over the sphere.
vec3 unitVector(Random& random);
/// A point spread evenly over a box.
vec3 pointIn(Random& random, vec3 low, vec3 high);

/// The exit of a ray from the box centre +- half, from inside: t in double precision, direction not necessarily unit.
double boxExit(glm::dvec3 origin, glm::dvec3 direction, glm::dvec3 half);

} // namespace sconce::testing_support
