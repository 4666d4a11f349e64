#include "runtime/bake/bake_key.h"

#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "runtime/bake/surface_baker.h"
#include "scene/builtin_scenes.h"
#include "scene/triangle_rays.h"
#include "tests/support/device.h"

namespace sconce
{
namespace
{

/// Each setting, changed alone.
std::vector<std::function<void(BakeSettings&)>> changes()
{
    return {[](BakeSettings& s) { s.resolution += 32; },
            [](BakeSettings& s) { s.chart = gpu::kChartOctahedral; },
            [](BakeSettings& s) { ++s.bounces; },
            [](BakeSettings& s) { s.converged *= 0.5f; },
            [](BakeSettings& s) { --s.surfaceTexels; },
            [](BakeSettings& s) { s.surfaceRefined *= 0.5f; },
            [](BakeSettings& s) { --s.lampTexels; },
            [](BakeSettings& s) { --s.surfaceRays; },
            [](BakeSettings& s) { s.liveLinks = 3; },
            [](BakeSettings& s) { s.lit = false; },
            [](BakeSettings& s) { s.radiance = false; },
            [](BakeSettings& s) { s.readsSurfaces = false; },
            [](BakeSettings& s) { s.prefiltered = false; },
            [](BakeSettings& s) { s.octree.voxels = 17; },
            [](BakeSettings& s) { ++s.octree.topShift; },
            [](BakeSettings& s) { s.effects = {"glossy"}; },
            [](BakeSettings& s) {
                s.effects = {"glos", "sy"};
            },
            [](BakeSettings& s) { s.scene.maxTextureSize /= 2; },
            [](BakeSettings& s) { ++s.scene.light.emitterSamples; },
            [](BakeSettings& s) { ++s.scene.light.skySamples; },
            [](BakeSettings& s) { s.scene.light.areaShadows = false; },
            [](BakeSettings& s) { s.scene.light.sunShadow /= 2; },
            [](BakeSettings& s) { s.scene.light.pointShadow /= 2; },
            [](BakeSettings& s) { s.scene.light.emitterShadow /= 2; },
            [](BakeSettings& s) { s.scene.light.skyShadow /= 2; },
            [](BakeSettings& s) { s.scene.light.lamps = {5}; },
            [](BakeSettings& s) {
                s.grid = ProbeGrid{{2, 1, 1}, vec3(0.0f), vec3(1.0f)};
            },
            [](BakeSettings& s) {
                s.grid = ProbeGrid{{1, 2, 1}, vec3(0.0f), vec3(1.0f)};
            },
            [](BakeSettings& s) {
                s.grid = ProbeGrid{{2, 1, 1}, vec3(0.1f), vec3(1.0f)};
            }};
}

TEST(BakeKey, EverythingThatBytesDependOnCounts)
{
    const Scene scene = *makeBuiltinScene("cornell");
    const std::vector<vec3> probes{vec3(0.0f, 1.0f, 0.0f), vec3(0.5f)};
    std::set<uint64_t> keys{bakeKey(scene, probes, {})};
    size_t count = 1;
    const auto another = [&](uint64_t key)
    {
        keys.insert(key);
        ++count;
        EXPECT_EQ(keys.size(), count);
    };
    for (const auto& change : changes())
    {
        BakeSettings settings;
        change(settings);
        another(bakeKey(scene, probes, settings));
    }
    Scene painted = scene, renamed = scene;
    painted.materials[0].roughness += 1e-6f;
    renamed.name = "another";
    another(bakeKey(painted, probes, {}));
    another(bakeKey(renamed, probes, {}));
    std::vector<vec3> moved = probes, fewer = probes;
    moved[1].x += 1e-6f;
    fewer.pop_back();
    another(bakeKey(scene, moved, {}));
    another(bakeKey(scene, fewer, {}));
    const TriangleRays rays = std::move(*TriangleRays::build(scene));
    BakeSettings exact, lent;
    exact.rays = &rays;
    another(bakeKey(scene, probes, exact));
    FieldData light;
    lent.light = &light;
    another(bakeKey(scene, probes, lent));
    light.surfaceLight = {1};
    another(bakeKey(scene, probes, lent));
    LightLayout layout;
    BakeSettings apart;
    apart.layout = &layout;
    another(bakeKey(scene, probes, apart));
    layout.lamps.emplace().triangles = {3};
    another(bakeKey(scene, probes, apart));
    layout.live.links = 8;
    another(bakeKey(scene, probes, apart));
}

TEST(BakeKey, WhatLeavesNoTraceDoesNot)
{
    const Scene scene = *makeBuiltinScene("cornell");
    const std::vector<vec3> probes{vec3(0.0f)};
    BakeSettings settings;
    settings.hostMemory = 123456789;
    EXPECT_EQ(bakeKey(scene, probes, settings), bakeKey(*makeBuiltinScene("cornell"), probes, {}));
}

TEST(BakeKey, ADeviceHasOne)
{
    testing_support::ValidatedDevice device;
    EXPECT_NE(deviceKey(device.host()), 0u);
    EXPECT_EQ(deviceKey(device.host()), deviceKey(device.host()));
}

} // namespace
} // namespace sconce
