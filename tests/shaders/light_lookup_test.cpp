// Radiance and irradiance lookups of the shared text, on fields whose light is known.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "runtime/bake/patches.h"
#include "runtime/field/tracer_cpu.h"
#include "scene/mesh_builder.h"
#include "tests/support/field_by_rays.h"

namespace sconce
{
namespace
{

struct LitBox
{
    Scene scene;
    FieldData field;
};

/// A closed box whose probes hold one radiance everywhere.
LitBox uniformBox(float radiance)
{
    LitBox box;
    MeshBuilder mesh(box.scene);
    mesh.box(vec3(-1.0f), vec3(1.0f), mesh.material("wall", vec3(0.5f)));
    const RayScene rays = std::move(*RayScene::create(box.scene));
    const std::vector<vec3> probes = {{0.3f, 0.2f, -0.1f}, {-0.4f, -0.3f, 0.2f}, {0.1f, -0.5f, -0.5f}};
    box.field = testing_support::fieldByRays(rays, probes, 32);
    twin::LightFieldTwin<float> text(box.field, testing_support::defaultQuality());
    const uint32_t light = text.packRadiance(vec3(radiance));
    box.field.radiance.assign(size_t(radianceWordsPerProbe(gpu::kChartCube, 32)) * probes.size(), light);
    box.field.irradiance.clear();
    for (size_t i = 0; i < probes.size() * gpu::kIrradianceSize * gpu::kIrradianceSize; ++i)
    {
        box.field.irradiance.push_back(light);
        box.field.irradiance.push_back(text.realToHalf(0.4f) | (text.realToHalf(0.01f) << 16));
    }
    return box;
}

TEST(LightLookup, UniformRadianceComesBackFromEveryHit)
{
    LitBox box = uniformBox(3.0f);
    twin::LightFieldTwin<float> text(box.field, testing_support::defaultQuality());
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 2000; ++i)
    {
        const auto hit = text.queryRay(vec3(0.1f), glm::normalize(vec3(normal(random), normal(random), normal(random))));
        ASSERT_EQ(hit.status, 1u);
        EXPECT_NEAR(hit.radiance.g, 3.0f, 0.03f);
    }
}

TEST(LightLookup, UniformRadianceGivesThatCosineMeanWhicheverWayASurfaceFaces)
{
    LitBox box = uniformBox(3.0f);
    twin::LightFieldTwin<float> text(box.field, testing_support::defaultQuality());
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> across(-0.28f, 0.28f);
    for (int i = 0; i < 2000; ++i)
    {
        const vec3 n = glm::normalize(vec3(normal(random), normal(random), normal(random))),
                   p(across(random), across(random), across(random));
        int reads = 0;
        EXPECT_NEAR(text.irradianceAt(p, n, p, reads).g, 3.0f, 0.03f);
    }
}

// Lobes were once looked up where the probe's surroundings lie in the lobe's direction, which is another place by as much as the probe is
// away: reflections on a metal floor of roughness 0.5 were wrong by a third.
TEST(LightLookup, ALobeMeetsTheWallThatItsAxisMeets)
{
    LitBox box = uniformBox(3.0f);
    twin::LightFieldTwin<float> text(box.field, testing_support::defaultQuality());
    std::mt19937 random(4);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> inside(-0.95f, 0.95f);
    const gpu::LightFieldInfo& space = box.field.info;
    double seen = 0.0, guessed = 0.0; // sums of errors, metres
    int found = 0, near = 0, count = 0;
    for (int i = 0; i < 2000; ++i)
    {
        const vec3 d = glm::normalize(vec3(normal(random), normal(random), normal(random)));
        const vec3 from(inside(random), inside(random), inside(random));
        float wall = 1e30f; // metres, of the box's inside
        for (int axis = 0; axis < 3; ++axis) wall = std::min(wall, ((d[axis] < 0.0f ? -1.0f : 1.0f) - from[axis]) / d[axis]);
        for (uint32_t probe = 0; probe < box.field.probes.size(); ++probe, ++count)
        {
            const vec3 fromProbe = (from - space.origin) / space.scale - box.field.probes[probe].centre;
            const float t = text.seenAlong(probe, fromProbe, d) * space.scale;
            guessed += std::abs(text.guessedAlong(probe, fromProbe, d) * space.scale - wall);
            if (!(t > 0.0f)) continue;
            ++found;
            seen += std::abs(t - wall);
            near += std::abs(t - wall) < 0.05f ? 1 : 0;
        }
    }
    EXPECT_GT(found, count * 95 / 100);
    EXPECT_GT(near, found * 98 / 100) << "of a box of 2 m, whose walls have 32 texels a side";
    EXPECT_LT(seen / found, 0.05 * guessed / count) << "what the moments alone would give";
}

// Of a closed box of one radiance every point of its walls gets just that, wherever the probe is: the patches' form factors sum to 1.
TEST(LightLookup, PatchesOfAUniformBoxLightItsWallsUniformly)
{
    LitBox box = uniformBox(3.0f);
    makePatches(box.field, std::vector<uint32_t>(box.field.radiance.size(), 1u), {});
    twin::LightFieldTwin<float> text(box.field, testing_support::defaultQuality());
    twin::LightFieldTwin<double> oracle(box.field, testing_support::defaultQuality());
    std::mt19937 random(5);
    std::uniform_real_distribution<float> across(-0.9f, 0.9f);
    const gpu::LightFieldInfo& space = box.field.info;
    double sum = 0.0, worst = 0.0;
    constexpr int kPoints = 3000;
    for (int i = 0; i < kPoints; ++i)
    {
        vec3 p(across(random), across(random), across(random)), n(0.0f);
        const int axis = i % 3;
        p[axis] = (i / 3) % 2 ? 1.0f : -1.0f;
        n[axis] = -p[axis];
        const uint32_t probe = uint32_t(i / 6) % uint32_t(box.field.probes.size());
        const vec3 fromProbe = (p - space.origin) / space.scale - vec3(box.field.probes[probe].centre);
        const float light = text.patchIrradiance(probe, fromProbe, n).g;
        EXPECT_NEAR(light, oracle.patchIrradiance(probe, fromProbe, n).g, 1e-4 * light);
        sum += light;
        worst = std::max(worst, std::abs(double(light) / 3.0 - 1.0));
    }
    RecordProperty("worst", std::to_string(worst));
    EXPECT_NEAR(sum / kPoints, 3.0, 0.18) << "discs leave the edges of a box a little dark";
    EXPECT_LT(worst, 0.33);
}

TEST(LightLookup, PatchesLeaveOutEmissionAndSky)
{
    LitBox box = uniformBox(3.0f);
    std::ranges::fill(box.field.irradiance, 0u);
    makePatches(box.field, std::vector<uint32_t>(box.field.radiance.size(), 1u), box.field.radiance);
    twin::LightFieldTwin<float> text(box.field, testing_support::defaultQuality());
    EXPECT_EQ(text.patchIrradiance(0, vec3(0.1f), vec3(0.0f, 1.0f, 0.0f)), vec3(0.0f)) << "all of it is emission";
    makePatches(box.field, std::vector<uint32_t>(box.field.radiance.size(), 0u), {});
    EXPECT_EQ(text.patchIrradiance(0, vec3(0.1f), vec3(0.0f, 1.0f, 0.0f)), vec3(0.0f)) << "all of it is sky";
}

TEST(LightLookup, OctahedralMapWrapsWithoutASeam)
{
    // A map that holds a smooth function of direction reads smoothly across the square's border.
    LitBox box = uniformBox(1.0f);
    twin::LightFieldTwin<float> text(box.field, testing_support::defaultQuality());
    const uint32_t n = gpu::kIrradianceSize;
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x)
        {
            const vec3 d = text.directionFromOctahedral(glm::vec2((float(x) + 0.5f) / float(n), (float(y) + 0.5f) / float(n)));
            box.field.irradiance[2 * (y * n + x)] = text.packRadiance(vec3(2.0f + d.x, 2.0f + d.y, 2.0f + d.z));
        }
    std::mt19937 random(4);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 5000; ++i)
    {
        const vec3 d = glm::normalize(vec3(normal(random), normal(random), i % 2 ? -std::abs(normal(random)) : 0.02f * normal(random)));
        const vec3 read = text.probeIrradiance(0, d);
        EXPECT_NEAR(read.x, 2.0f + d.x, 0.1f);
        EXPECT_NEAR(read.y, 2.0f + d.y, 0.1f);
        EXPECT_NEAR(read.z, 2.0f + d.z, 0.12f);
    }
}

} // namespace
} // namespace sconce
