// The volumes of irradiance hold the light they should: against a furnace's closed form, and around solids that are known.
#include <cmath>

#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include "bench/opponents/irradiance_volume.h"
#include "scene/mesh_builder.h"
#include "tests/support/test_scenes.h"

namespace sconce
{
namespace
{

constexpr float kHalf = 2.0f; // metres, of the room's sides
const ProbeGrid kGrid{glm::ivec3(3), vec3(-1.0f), vec3(1.0f)};

/// A cube seen from within: its front faces look inwards.
void addRoom(MeshBuilder& mesh, Scene& scene, uint32_t material)
{
    mesh.box(vec3(-kHalf), vec3(kHalf), material);
    for (uvec3& triangle : scene.triangles) std::swap(triangle.y, triangle.z);
    for (vec3& normal : scene.normals) normal = -normal;
}

/// All of whose surfaces emit 1 W/(m^2 sr) and reflect half of what arrives.
Scene furnace()
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t wall = mesh.material("wall", vec3(test::RoughModel::baseColorOf(0.5)));
    scene.materials[wall].emission = vec3(1.0f);
    addRoom(mesh, scene, wall);
    return scene;
}

/// With a block in it, [low, high].
Scene roomWith(vec3 low, vec3 high)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t grey = mesh.material("grey", vec3(0.5f));
    addRoom(mesh, scene, grey);
    mesh.box(low, high, grey);
    scene.lights.push_back(test::light(LightType::point, {-1.5f, 1.5f, -1.5f}, {0, -1, 0}, 10.0f));
    return scene;
}

FieldData filled(const Scene& scene, const ProbeGrid& grid, Volume volume, const VolumeSettings& settings)
{
    const RayScene rays = std::move(*RayScene::create(scene));
    auto made = irradianceVolume(bareGrid(scene, grid), volume, rays, settings, {});
    EXPECT_TRUE(made) << made.error().message;
    return std::move(*made);
}

std::span<const uint32_t> wordsOf(const FieldData& field, Volume volume, size_t probe)
{
    const uint32_t words = volumeWordsPerProbe(volume);
    return std::span(field.irradiance).subspan(gpu::kVolumeHeaderWords + probe * words, words);
}

vec3 placeOf(const FieldData& field, size_t probe)
{
    return field.probes[probe].centre * field.info.scale + field.info.origin;
}

bool inSolid(const FieldData& field, Volume volume, size_t probe)
{
    return glm::unpackHalf2x16(wordsOf(field, volume, probe)[volume == Volume::sh ? gpu::kShWords - 1 : 1]).y != gpu::kVolumeValid;
}

/// In a furnace every bounce brings half of the one before, whatever the direction: 1/2 + 1/4 + 1/8 without what is emitted.
TEST(IrradianceVolume, HoldsAFurnacesLightWithoutItsEmission)
{
    const Scene scene = furnace();
    const double expected = 0.5 + 0.25 + 0.125;
    const VolumeSettings settings{.rays = 4096, .bounces = 2, .relocate = false};
    const FieldData maps = filled(scene, kGrid, Volume::ddgi, settings);
    for (size_t probe : {0u, 13u, 22u})
    {
        const auto words = wordsOf(maps, Volume::ddgi, probe);
        for (uint32_t texel = 0; texel < gpu::kDdgiIrradianceSide * gpu::kDdgiIrradianceSide; ++texel)
        {
            const double light = std::pow(double(glm::unpackHalf2x16(words[2 * texel]).x), double(gpu::kDdgiGamma));
            EXPECT_NEAR(light, expected, 0.04 * expected) << "probe " << probe << ", texel " << texel;
        }
    }
    const FieldData harmonics = filled(scene, kGrid, Volume::sh, settings);
    const vec2 first = glm::unpackHalf2x16(wordsOf(harmonics, Volume::sh, 13)[0]);
    EXPECT_NEAR(first.x * 0.282095, expected, 0.01 * expected);
    for (uint32_t half = 3; half < 27; ++half)
    {
        const vec2 pair = glm::unpackHalf2x16(wordsOf(harmonics, Volume::sh, 13)[half / 2]);
        EXPECT_NEAR(half & 1 ? pair.y : pair.x, 0.0, 0.02) << "coefficient " << half / 3; // the middle of a cube has no direction
    }
}

/// At the middle of a cube, towards a face: its half side over the cosine, averaged under cos^50.
TEST(IrradianceVolume, DistancesAreTheLobesMeans)
{
    const FieldData maps = filled(furnace(), kGrid, Volume::ddgi, {.rays = 8192, .relocate = false});
    const auto distances = wordsOf(maps, Volume::ddgi, 13).subspan(2 * gpu::kDdgiIrradianceSide * gpu::kDdgiIrradianceSide);
    // The four texels about +z, whose middles are off it by the same angle.
    const double side = gpu::kDdgiDistanceSide, uv = 1.0 / side; // of the octahedron, from its middle
    const double length = std::sqrt(2.0 * uv * uv + (1.0 - 2.0 * uv) * (1.0 - 2.0 * uv)), off = std::acos((1.0 - 2.0 * uv) / length);
    double mean = 0.0, square = 0.0, weights = 0.0;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j)
        {
            const double z = 1.0 - 0.4 * (i + 0.5) / kSteps, phi = 2.0 * std::numbers::pi * (j + 0.5) / kSteps; // up to 53 degrees off
            const double x = std::sqrt(1.0 - z * z) * std::cos(phi), y = std::sqrt(1.0 - z * z) * std::sin(phi);
            // The lobe's axis is +z, the face's normal is off it.
            const glm::dvec3 tilted(x * std::cos(off) + z * std::sin(off), y, z * std::cos(off) - x * std::sin(off));
            const glm::dvec3 turned(tilted.x * std::sqrt(0.5) - tilted.y * std::sqrt(0.5),
                                    tilted.x * std::sqrt(0.5) + tilted.y * std::sqrt(0.5), tilted.z);
            const double r = std::min(kHalf / std::max({std::abs(turned.x), std::abs(turned.y), std::abs(turned.z)}), 1.5 * std::sqrt(3.0));
            const double weight = std::pow(z, 50.0);
            mean += weight * r, square += weight * r * r, weights += weight;
        }
    mean /= weights, square /= weights;
    const float scale = maps.info.scale;
    for (uint32_t texel : {6u * 14u + 6u, 6u * 14u + 7u, 7u * 14u + 6u, 7u * 14u + 7u})
    {
        const vec2 moments = glm::unpackHalf2x16(distances[texel]);
        EXPECT_NEAR(moments.x * scale, mean, 0.005 * mean);
        EXPECT_NEAR(moments.y * scale * scale, square, 0.01 * square);
    }
}

/// The middle probe stands in a thin block, 0.1 m from its side: it is moved out, and no other is in a solid.
TEST(IrradianceVolume, MovesProbesOutOfThinSolids)
{
    const Scene scene = roomWith({-0.1f, -1.5f, -1.5f}, {0.1f, 1.5f, 1.5f});
    const FieldData moved = filled(scene, kGrid, Volume::ddgi, {.rays = 64});
    EXPECT_GT(std::abs(placeOf(moved, 13).x), 0.1f);
    EXPECT_LT(glm::length(placeOf(moved, 13)), 0.45f);
    for (size_t probe = 0; probe < 27; ++probe) EXPECT_FALSE(inSolid(moved, Volume::ddgi, probe)) << probe;
    const FieldData left = filled(scene, kGrid, Volume::ddgi, {.rays = 64, .relocate = false});
    EXPECT_EQ(placeOf(left, 13), vec3(0.0f));
    EXPECT_TRUE(inSolid(left, Volume::ddgi, 13));
    EXPECT_FALSE(inSolid(filled(scene, kGrid, Volume::ddgi, {.rays = 64, .relocate = false, .solids = false}), Volume::ddgi, 13));
}

/// In a block too thick to leave a probe of DDGI has no say, and one of harmonics has its neighbours' mean.
TEST(IrradianceVolume, ProbesInThickSolidsHaveNoLightOfTheirOwn)
{
    const Scene scene = roomWith(vec3(-0.8f), vec3(0.8f));
    EXPECT_TRUE(inSolid(filled(scene, kGrid, Volume::ddgi, {.rays = 64}), Volume::ddgi, 13));
    const FieldData harmonics = filled(scene, kGrid, Volume::sh, {.rays = 256});
    EXPECT_FALSE(inSolid(harmonics, Volume::sh, 13));
    double sum = 0.0;
    for (size_t probe = 0; probe < 27; ++probe)
        if (probe != 13) sum += glm::unpackHalf2x16(wordsOf(harmonics, Volume::sh, probe)[0]).x / 26.0;
    EXPECT_NEAR(glm::unpackHalf2x16(wordsOf(harmonics, Volume::sh, 13)[0]).x, sum, 2e-3 * sum);
}

TEST(IrradianceVolume, SaysWhatItLacks)
{
    const Scene scene = furnace();
    const RayScene rays = std::move(*RayScene::create(scene));
    FieldData scattered = bareGrid(scene, kGrid);
    scattered.info.gridX = 0;
    const auto noGrid = irradianceVolume(scattered, Volume::ddgi, rays, {}, {});
    ASSERT_FALSE(noGrid);
    EXPECT_NE(noGrid.error().message.find("needs a grid of probes"), std::string::npos) << noGrid.error().message;
    const auto noOctree = irradianceVolume(scattered, Volume::ddgiPlaced, rays, {}, {});
    ASSERT_FALSE(noOctree);
    EXPECT_NE(noOctree.error().message.find("octree"), std::string::npos) << noOctree.error().message;
    const auto cancelled = irradianceVolume(bareGrid(scene, kGrid), Volume::sh, rays, {}, [](std::string_view, double) { return false; });
    ASSERT_FALSE(cancelled);
    EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
}

TEST(IrradianceVolume, IsFoundByItsName)
{
    for (const Volume volume : kVolumes) EXPECT_EQ(volumeNamed(volumeName(volume)), volume);
    EXPECT_FALSE(volumeNamed("b0plus"));
}

} // namespace
} // namespace sconce
