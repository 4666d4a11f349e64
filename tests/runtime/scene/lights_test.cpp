#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "base/numbers.h"
#include "runtime/field/field_space.h"
#include "runtime/scene/lights.h"
#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"

namespace sconce
{
namespace
{

Scene cornell()
{
    auto scene = makeBuiltinScene("cornell");
    if (!scene) throw std::runtime_error(scene.error().message);
    return std::move(*scene);
}

TEST(LightList, EmitterPatchesCarryTheScenesWholePower)
{
    const Scene scene = cornell();
    const gpu::LightFieldInfo space = fieldSpace(scene.bounds());
    double power = 0.0; // area times luminance, field units
    for (size_t t = 0; t < scene.triangles.size(); ++t)
    {
        const uvec3 c = scene.triangles[t];
        const vec3 cross = glm::cross(scene.positions[c.y] - scene.positions[c.x], scene.positions[c.z] - scene.positions[c.x]);
        power += 0.5 * glm::length(cross) / (space.scale * space.scale) * luminance(scene.materials[scene.triangleMaterial[t]].emission);
    }
    const LightList list = buildLightList(scene, space, {});
    ASSERT_EQ(list.header.emitterCount, 64u);
    double carried = 0.0;
    for (const gpu::GpuLight& light : list.lights) carried += double(light.area) * luminance(light.intensity);
    EXPECT_NEAR(carried, power, 1e-4 * power);
}

// Patches of equal power once left a lamp of less than a 64th of the scene's power without any: the room that it lights was black.
TEST(LightList, ADimLampInTheNextRoomHasPatchesThatCarryItsPower)
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.quad({0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, mesh.emitter("bright", vec3(30.0f)));
    mesh.quad({5, 0, 0}, {6, 0, 0}, {6, 0, 1}, {5, 0, 1}, mesh.emitter("dim", vec3(0.1f)));
    const gpu::LightFieldInfo space = fieldSpace(scene.bounds());
    double bright = 0.0, dim = 0.0; // area times radiance, m^2
    for (const gpu::GpuLight& light : buildLightList(scene, space, {}).lights)
        (light.intensity.g > 1.0f ? bright : dim) += double(light.area) * space.scale * space.scale * light.intensity.g;
    EXPECT_NEAR(bright, 30.0, 0.03 * 30.0);
    EXPECT_NEAR(dim, 0.1, 0.05 * 0.1);
}

// Samples fall on lamps by whole numbers: of lamps that get 2.56 of them each, some once had 0.78 of their light and others 1.17; of more
// lamps than samples half had none, and lit nothing beyond some of their widths.
TEST(LightList, EachOfManyEqualLampsCarriesItsOwnPower)
{
    struct Case
    {
        uint32_t lamps, samples;
        bool maps;
    };
    for (const Case& of : {Case{400, 1024, false}, {700, 1024, false}, {2000, 1024, false}, {20, 64, true}})
    {
        Scene scene;
        MeshBuilder mesh(scene);
        const uint32_t lamp = mesh.emitter("lamp", vec3(2.0f));
        for (uint32_t i = 0; i < of.lamps; ++i)
        {
            const vec3 at(5.0f * float(i % 50), 0.0f, 5.0f * float(i / 50));
            mesh.quad(at, at + vec3(1, 0, 0), at + vec3(1, 0, 1), at + vec3(0, 0, 1), lamp);
        }
        const gpu::LightFieldInfo space = fieldSpace(scene.bounds());
        const LightList list = buildLightList(scene, space, {.emitterSamples = of.samples, .skySamples = 0, .areaShadows = of.maps});
        EXPECT_GE(list.header.emitterCount, of.samples);
        EXPECT_EQ(list.header.emitterCount, of.maps ? of.samples : std::min(4 * of.samples, std::max(of.samples, 16 * of.lamps)));
        std::vector<double> carried(of.lamps);
        for (const gpu::GpuLight& light : list.lights)
        {
            const vec3 at = space.origin + space.scale * light.position;
            carried[size_t(at.x / 5.0f) + 50 * size_t(at.z / 5.0f)] += double(light.area) * space.scale * space.scale;
        }
        EXPECT_NEAR(*std::ranges::min_element(carried), 1.0, 1e-3) << of.lamps << " lamps";
        EXPECT_NEAR(*std::ranges::max_element(carried), 1.0, 1e-3) << of.lamps << " lamps";
    }
}

TEST(LightList, AskedForNoSamplesItKnowsThatSomethingShines)
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box({0, 0, 0}, {1, 1, 1}, mesh.emitter("lamp", vec3(2.0f)));
    const LightList list = buildLightList(scene, fieldSpace(scene.bounds()), {.emitterSamples = 0, .skySamples = 0});
    EXPECT_TRUE(list.shines);
    EXPECT_TRUE(list.lights.empty());
    EXPECT_TRUE(list.emitters.empty()) << "each would stand for an infinite area";
}

TEST(LightList, ALampWithoutAreaHasNoSample)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t lamp = mesh.emitter("lamp", vec3(2.0f));
    mesh.quad({0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, lamp);
    mesh.quad({5, 0, 0}, {6, 0, 0}, {6, 0, 0}, {5, 0, 0}, lamp);
    const gpu::LightFieldInfo space = fieldSpace(scene.bounds());
    const LightList list = buildLightList(scene, space, {.emitterSamples = 1024, .skySamples = 0, .areaShadows = false});
    EXPECT_EQ(list.header.emitterCount, 1024u);
    EXPECT_EQ(list.emitters.size(), 2u);
    double area = 0.0;
    for (const gpu::GpuLight& light : list.lights) area += double(light.area) * space.scale * space.scale;
    EXPECT_NEAR(area, 1.0, 1e-3);
}

TEST(LightList, EmitterPatchesLieInsideTheLampAndAverageToItsCentre)
{
    const Scene scene = cornell();
    const gpu::LightFieldInfo space = fieldSpace(scene.bounds());
    Bounds lamp;
    for (size_t t = 0; t < scene.triangles.size(); ++t)
        if (scene.materials[scene.triangleMaterial[t]].emission != vec3(0.0f))
            for (int k = 0; k < 3; ++k) lamp.add(scene.positions[scene.triangles[t][k]]);
    vec3 mean(0.0f);
    const LightList list = buildLightList(scene, space, {});
    for (const gpu::GpuLight& light : list.lights)
    {
        const vec3 p = space.origin + space.scale * light.position;
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(p, lamp.low - 1e-4f)) && glm::all(glm::lessThanEqual(p, lamp.high + 1e-4f)));
        mean += p / float(list.lights.size());
    }
    EXPECT_LT(glm::length(mean - lamp.centre()), 0.03f * lamp.diagonal());
}

// Over the sphere a constant radiance L sums to 4 pi L, and its cosine over any hemisphere to pi L.
TEST(LightList, SkyDirectionsIntegrateConstantsAndCosines)
{
    Scene scene = cornell();
    scene.sky = {1.0f, 2.0f, 0.5f};
    const LightList list = buildLightList(scene, fieldSpace(scene.bounds()), {.emitterSamples = 0});
    ASSERT_EQ(list.header.skyCount, 48u);
    const vec3 normals[] = {{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0.6f, 0.8f, 0}, {-0.48f, 0.6f, 0.64f}};
    vec3 total(0.0f);
    for (const gpu::GpuLight& light : list.lights) total += light.intensity;
    EXPECT_NEAR(total.g, 8.0f * std::numbers::pi_v<float>, 1e-3f);
    for (const vec3 n : normals)
    {
        float irradiance = 0.0f;
        for (const gpu::GpuLight& light : list.lights) irradiance += std::max(glm::dot(n, -light.direction), 0.0f) * light.intensity.r;
        EXPECT_NEAR(irradiance, std::numbers::pi_v<float>, 0.03f * std::numbers::pi_v<float>) << n.x << " " << n.y << " " << n.z;
    }
}

TEST(LightList, DeltaLightsComeFirstInFieldUnits)
{
    Scene scene = cornell();
    Light point;
    point.type = LightType::point;
    point.position = {0.1f, 0.2f, 0.3f};
    point.intensity = vec3(8.0f);
    point.range = 4.0f;
    scene.lights = {point, Light{}};
    const gpu::LightFieldInfo space = fieldSpace(scene.bounds());
    const LightList list = buildLightList(scene, space, {});
    ASSERT_EQ(list.header.deltaCount, 2u);
    // Irradiance intensity / distance^2 must not depend on the unit of length.
    EXPECT_FLOAT_EQ(list.lights[0].intensity.r * space.scale * space.scale, 8.0f);
    EXPECT_FLOAT_EQ(list.lights[0].range * space.scale, 4.0f);
    EXPECT_EQ(list.lights[1].type, gpu::kLightDirectional);
    EXPECT_EQ(list.lights[2].type, gpu::kLightEmitter);
    EXPECT_EQ(list.pointLayers, 6u);
    EXPECT_EQ(list.sunLayers, 1u);
}

TEST(LightList, SceneWithoutLightHasNoEntries)
{
    Scene scene = cornell();
    for (Material& material : scene.materials) material.emission = vec3(0.0f);
    const LightList list = buildLightList(scene, fieldSpace(scene.bounds()), {});
    EXPECT_TRUE(list.lights.empty());
}

TEST(LightList, ManyShadowMapsShrinkUntilTheyFit)
{
    Scene scene = cornell();
    Light lamp;
    lamp.type = LightType::point;
    lamp.intensity = vec3(1.0f);
    scene.lights.assign(100, lamp);
    const LightList list = buildLightList(scene, fieldSpace(scene.bounds()), {});
    EXPECT_LT(list.settings.pointShadow, 512u);
    EXPECT_LE(uint64_t(list.pointLayers) * list.settings.pointShadow * list.settings.pointShadow * 4, kShadowBytes);
}

// The map of a directional light covers the scene: every corner of its bounds has x, y and depth in [0,1].
TEST(LightList, DirectionalMapsCoverTheScene)
{
    Scene scene = cornell();
    scene.sky = vec3(1.0f);
    const gpu::LightFieldInfo space = fieldSpace(scene.bounds());
    for (const gpu::GpuLight& light : buildLightList(scene, space, {.emitterSamples = 0}).lights)
        for (int corner = 0; corner < 8; ++corner)
        {
            const vec3 p(corner & 1 ? space.sceneLow.x : space.sceneHigh.x, corner & 2 ? space.sceneLow.y : space.sceneHigh.y,
                         corner & 4 ? space.sceneLow.z : space.sceneHigh.z);
            for (const vec4 row : {light.shadowX, light.shadowY, light.shadowDepth})
            {
                EXPECT_GE(glm::dot(row, vec4(p, 1.0f)), 0.0f);
                EXPECT_LE(glm::dot(row, vec4(p, 1.0f)), 1.0f);
            }
            // Depth falls along the way the light travels.
            EXPECT_LT(glm::dot(vec3(light.shadowDepth), light.direction), 0.0f);
        }
}

// Of a large scene a directional light has maps about the eye, too, each of a sixth of the width of the one before and of the same depth.
TEST(LightList, DirectionalMapsAboutAnEyeLieInOneAnother)
{
    Scene scene = cornell();
    scene.lights.assign(2, Light{});
    scene.lights[1].direction = glm::normalize(vec3(0.3f, -0.4f, 0.5f));
    const gpu::LightFieldInfo small = fieldSpace(scene.bounds());
    EXPECT_EQ(buildLightList(scene, small, {.eye = vec3(0.0f)}).header.sunLevels, 1u) << "its texels are fine enough";
    MeshBuilder(scene).quad({-100, 0, 100}, {100, 0, 100}, {100, 0, -100}, {-100, 0, -100}, 0);
    const gpu::LightFieldInfo space = fieldSpace(scene.bounds());
    EXPECT_EQ(buildLightList(scene, space, {}).header.sunLevels, 1u) << "nobody looks";
    const vec3 eye(20.0f, 1.7f, -3.0f), beside(21.0f, 0.0f, -2.5f);
    EXPECT_EQ(buildLightList(scene, space, {.eye = eye}).header.sunLevels, 1u) << "two suns' maps of that size are all there is room for";
    Scene one = scene;
    one.lights.pop_back();
    EXPECT_EQ(buildLightList(one, space, {.eye = eye}).header.sunLevels, 2u);
    const LightList halved = buildLightList(one, space, {.sunShadow = 8192, .eye = eye});
    EXPECT_EQ(halved.settings.sunShadow, 4096u) << "a map of the size asked for is too large";
    EXPECT_EQ(halved.header.sunLevels, 2u);
    Scene many = scene;
    many.lights.assign(100, Light{});
    EXPECT_EQ(buildLightList(many, space, {.sunShadow = 256, .eye = eye}).sunLayers, 100u);
    const LightList list = buildLightList(scene, space, {.sunShadow = 2048, .eye = eye});
    EXPECT_EQ(list.settings.sunShadow, 2048u) << "no map is smaller for it";
    ASSERT_EQ(list.header.sunLevels, 3u);
    EXPECT_EQ(list.sunLayers, 6u);
    EXPECT_EQ(list.lights[1].shadowLayer, 3);
    EXPECT_LE(uint64_t(list.sunLayers) * list.settings.sunShadow * list.settings.sunShadow * 4, kShadowBytes);
    for (int sun = 0; sun < 2; ++sun)
    {
        const auto views = shadowViews(list.lights[size_t(sun)], list.header);
        ASSERT_EQ(views.size(), 3u);
        const auto through = [&](size_t view, vec3 at) { return views[view].clip * vec4((at - space.origin) / space.scale, 1.0f); };
        const vec4 off = through(0, beside) - through(0, eye);
        for (const auto& [view, finer] : {std::pair(size_t(1), 6.0f), std::pair(size_t(2), 36.0f)})
        {
            EXPECT_LT(glm::length(vec2(through(view, eye))), 1e-4f);
            EXPECT_LT(glm::distance(vec2(through(view, beside)), finer * vec2(off)), 1e-4f * finer);
            EXPECT_FLOAT_EQ(through(view, beside).z, through(0, beside).z);
        }
    }
}

} // namespace
} // namespace sconce
