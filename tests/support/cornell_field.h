#pragma once

#include <span>
#include <vector>

#include "bench/race/ray_sets.h"
#include "scene/builtin_scenes.h"
#include "tests/support/field_by_rays.h"

namespace sconce::testing_support
{

/// A scene, its rays and a light field cast from given probes; pinned in place, since each refers to the one before.
struct Traced
{
    Scene scene;
    RayScene rays;
    FieldData field;

    Traced(Scene made, std::span<const vec3> probes, uint32_t faceSize)
        : scene(std::move(made)), rays(std::move(*RayScene::create(scene))), field(fieldByRays(rays, probes, faceSize))
    {
    }
    Traced(const Traced&) = delete;
};

inline const std::vector<vec3> kCornellProbes = {{0.0f, 1.5f, 0.5f},    {-0.8f, 0.5f, 0.6f},  {0.8f, 0.5f, -0.4f}, {0.6f, 1.2f, 0.2f},
                                                 {-0.75f, 1.0f, -0.8f}, {0.3f, 0.9f, -0.75f}, {0.0f, 0.3f, 0.85f}};

/// The glossy Cornell box seen by seven probes of 128^2 faces.
inline Traced& cornell()
{
    static Traced made(*makeBuiltinScene("cornell-glossy"), kCornellProbes, 128);
    return made;
}

/// Reflection rays, GGX alpha 0.1 to 0.3, with Embree's truth.
inline RaySet cornellRays(uint32_t count)
{
    const std::vector<vec3> points = {{0.0f, 1.0f, 0.8f}, {0.5f, 1.6f, -0.5f}, {-0.7f, 1.5f, 0.3f}};
    return *glossyRays(cornell().rays, cornell().scene.cameras, points, {.count = count, .alphaLow = 0.1f, .alphaHigh = 0.3f, .seed = 7});
}

} // namespace sconce::testing_support
