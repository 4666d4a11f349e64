// Radiance and irradiance lookups of the shared text, on fields whose light is known.
#include <cmath>
#include <numbers>
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

constexpr uint32_t kToldFace = 32; // texels

/// What a probe is told of its light and of the distances that it sees, field units; halves and packed colours hold these exactly.
struct ToldProbe
{
    double light, mean, variance, harmonic; // the last as the header has it, 0: not known
};

/// The say of a probe as it is published: wrapped cosine (Majercik et al. 2019, section 4), Chebyshev's bound (McGuire et al. 2017, section
/// 5.2) cubed, the inverse square of the distance; and what is ours: a probe close to surfaces reaches four times their harmonic distance,
/// and one that a wall hides has next to none.
double publishedWeight(const ToldProbe& probe, glm::dvec3 toProbe, glm::dvec3 normal, double voxel, bool hidden)
{
    const double distance = glm::length(toProbe), wrap = 0.5 * glm::dot(toProbe / distance, normal) + 0.5;
    double weight = hidden ? 0.0 : wrap * wrap + 0.02;
    if (distance > probe.mean)
    {
        const double variance = probe.variance + 1e-6;
        weight *= std::pow(variance / (variance + (distance - probe.mean) * (distance - probe.mean)), 3.0);
    }
    if (probe.harmonic > 0.0) weight /= 1.0 + std::pow(distance / (4.0 * probe.harmonic), 4.0);
    return std::max(weight, 1e-6) / (distance * distance + voxel * voxel);
}

// Light that differs from probe to probe, since of uniform light no weight is wrong: each look-up against the published blend, in double.
TEST(LightLookup, LightOfUnequalProbesIsThePublishedBlend)
{
    // Two rooms without an opening: what stands in one is hidden from the probes of the other.
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t white = mesh.material("white", vec3(0.5f));
    mesh.box(vec3(-1.0f), vec3(1.0f), white);
    mesh.box(vec3(-0.02f, -1.0f, -1.0f), vec3(0.02f, 1.0f, 1.0f), white);
    const RayScene rays = std::move(*RayScene::create(scene));
    const std::vector<vec3> places = {{-0.5f, 0.2f, -0.1f}, {-0.35f, -0.3f, 0.4f}, {0.45f, 0.1f, 0.3f}, {0.6f, -0.4f, -0.2f}};
    const std::vector<ToldProbe> told = {{1.0, 0.0625, 0.00390625, 0.25},
                                         {2.0, 0.125, 0.0078125, 0.03125},
                                         {4.0, 0.1875, 0.001953125, 0.0},
                                         {8.0, 0.125, 0.0078125, 0.0625}};
    FieldData field = testing_support::fieldByRays(rays, places, kToldFace);
    twin::LightFieldTwin<float> text(field, testing_support::defaultQuality());
    field.irradiance.clear();
    for (size_t probe = 0; probe < told.size(); ++probe)
    {
        field.probes[probe].harmonic = float(told[probe].harmonic);
        for (uint32_t i = 0; i < gpu::kIrradianceSize * gpu::kIrradianceSize; ++i)
        {
            field.irradiance.push_back(text.packRadiance(vec3(float(told[probe].light))));
            field.irradiance.push_back(text.realToHalf(float(told[probe].mean)) | (text.realToHalf(float(told[probe].variance)) << 16));
        }
    }
    // A texel's angle is the root of its share of the sphere: by so much of the distance a point is taken to be off its surface.
    const double texel = std::sqrt(4.0 * std::numbers::pi / (6.0 * kToldFace * kToldFace));
    std::mt19937 random(6);
    std::normal_distribution<float> towards;
    std::uniform_real_distribution<float> across(0.15f, 0.85f), along(-0.6f, 0.6f);
    int blended = 0, walled = 0;
    for (int i = 0; i < 3000; ++i)
    {
        const vec3 normal = glm::normalize(vec3(towards(random), towards(random), towards(random)));
        vec3 world(across(random), along(random), along(random));
        if (i % 2 == 0) world.x = -world.x;
        const auto inField = [&](vec3 p) { return (p - field.info.origin) / field.info.scale; };
        const vec3 point = inField(world);
        // Every third asks the leaf of the point beyond the wall, whose probes it is hidden from.
        const vec3 lookUp = inField(i % 3 == 0 ? vec3(-world.x, world.y, world.z) : world);
        int reads = 0;
        const glm::uvec4 ranked = text.rankedProbesAt(lookUp, reads);
        double sum = 0.0, weights = 0.0;
        int asked = 0;
        for (int k = 0; k < gpu::kRanked; ++k)
        {
            bool repeated = false;
            for (int j = 0; j < k; ++j) repeated = repeated || ranked[j] == ranked[k];
            if (repeated) continue;
            const uint32_t probe = ranked[k];
            const glm::dvec3 straight = glm::dvec3(vec3(field.probes[probe].centre)) - glm::dvec3(point);
            const glm::dvec3 toProbe = straight - texel * glm::length(straight) * glm::dvec3(normal);
            const bool hidden = (places[probe].x < 0.0f) != (world.x < 0.0f);
            const double weight = publishedWeight(told[probe], toProbe, normal, field.info.voxel, hidden);
            sum += weight * told[probe].light;
            weights += weight;
            ++asked;
            walled += hidden;
        }
        blended += asked > 1;
        const double expected = sum / weights;
        EXPECT_NEAR(text.irradianceAt(point, normal, lookUp, reads).g, expected, 1e-3 * expected)
            << "at " << world.x << ' ' << world.y << ' ' << world.z << " of " << asked << " probes";
    }
    EXPECT_GT(blended, 1000) << "blends of several probes";
    EXPECT_GT(walled, 300) << "probes behind the wall";
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
