#include <cmath>
#include <cstring>
#include <numbers>

#include <numeric>

#include <gtest/gtest.h>

#include "runtime/bake/bake.h"
#include "runtime/field/map_blocks.h"
#include "runtime/field/tracer_cpu.h"
#include "scene/mesh_builder.h"
#include "shaders/shared/pure.h"
#include "tests/support/chain_bounds.h"
#include "tests/support/device.h"
#include "tests/support/test_scenes.h"

namespace sconce
{
namespace
{

using testing_support::ValidatedDevice;

constexpr float kPi = std::numbers::pi_v<float>;
using Text = Pure<float>;

void addQuad(Scene& scene, vec3 corner, vec3 u, vec3 v, uint32_t material = 0)
{
    const auto first = uint32_t(scene.positions.size());
    const vec3 normal = glm::normalize(glm::cross(u, v));
    for (const vec3 p : {corner, corner + u, corner + u + v, corner + v})
    {
        scene.positions.push_back(p);
        scene.normals.push_back(normal);
        scene.uvs.emplace_back(p == corner || p == corner + v ? 0.0f : 1.0f, p == corner || p == corner + u ? 0.0f : 1.0f);
    }
    scene.triangles.push_back({first, first + 1, first + 2});
    scene.triangles.push_back({first, first + 2, first + 3});
    scene.triangleMaterial.insert(scene.triangleMaterial.end(), 2, material);
}

void addBox(Scene& scene, vec3 low, vec3 high, uint32_t material = 0)
{
    const vec3 s = high - low, x(s.x, 0, 0), y(0, s.y, 0), z(0, 0, s.z);
    addQuad(scene, low, y, x, material);
    addQuad(scene, low + z, x, y, material);
    addQuad(scene, low, z, y, material);
    addQuad(scene, low + x, y, z, material);
    addQuad(scene, low, x, z, material);
    addQuad(scene, low + y, z, x, material);
}

Scene emptyScene()
{
    Scene scene;
    scene.name = "test";
    Material grey;
    grey.baseColor = {0.5f, 0.25f, 0.75f, 1.0f};
    scene.materials.push_back(grey);
    return scene;
}

/// What a matt dielectric of this base colour reflects of irradiance / pi to all sides.
vec3 reflectedBy(vec3 baseColor)
{
    vec3 albedo;
    for (int c = 0; c < 3; ++c) albedo[c] = float(test::RoughModel{baseColor[c]}.hemisphericalAlbedo());
    return albedo;
}
vec3 albedoOf(const Material& material)
{
    return reflectedBy(vec3(material.baseColor));
}

Light sun(vec3 direction, vec3 irradiance)
{
    Light light;
    light.direction = glm::normalize(direction);
    light.intensity = irradiance;
    return light;
}

BakeSettings settingsFor(uint32_t resolution, uint32_t bounces = 0, uint32_t chart = gpu::kChartCube)
{
    BakeSettings settings;
    settings.resolution = resolution;
    settings.bounces = bounces;
    settings.chart = chart;
    settings.octree.voxels = 16;
    settings.surfaceTexels = 0; // tests/runtime/bake/surface_baker_test.cpp has what that changes
    settings.scene.light.sunShadow = 1024;
    settings.scene.light.skyShadow = 256;
    return settings;
}

class Bake : public testing::Test
{
protected:
    FieldData bake(const Scene& scene, std::vector<vec3> probes, const BakeSettings& settings)
    {
        auto field = bakeLightField(device.gpu(), scene, probes, settings, {}, cost);
        if (!field) throw std::runtime_error(field.error().message);
        return std::move(*field);
    }
    testing_support::SharedDevice device;
    BakeReport cost;
};

struct Texel
{
    int face;
    uint32_t x, y;
};

vec3 towards(const FieldData& field, Texel t)
{
    const float n = float(field.info.faceSize);
    return Text::faceDirection(t.face, {(float(t.x) + 0.5f) * 2.0f / n - 1.0f, (float(t.y) + 0.5f) * 2.0f / n - 1.0f, 1.0f});
}

/// The texel of probe 0 that looks in a direction.
Texel texelAt(const FieldData& field, vec3 direction)
{
    const int face = Text::dominantFace(direction);
    const vec3 uvw = Text::faceCoordinates(face, direction);
    const auto pixel = [&](float u)
    { return std::min(uint32_t((0.5f * u / uvw.z + 0.5f) * float(field.info.faceSize)), field.info.faceSize - 1); };
    return {face, pixel(uvw.x), pixel(uvw.y)};
}

uint32_t wordAt(const FieldData& field, Texel t)
{
    return field.distance[size_t(t.face) * (field.info.wordsPerProbe / 6) + size_t(t.y) * field.info.faceSize + t.x];
}

vec3 radianceAt(const FieldData& field, Texel t)
{
    return Text::unpackRadiance(field.radiance[(size_t(t.face) * field.info.faceSize + t.y) * field.info.faceSize + t.x]);
}

template <class Visit> void forEachTexel(const FieldData& field, const Visit& visit)
{
    for (int face = 0; face < 6; ++face)
        for (uint32_t y = 0; y < field.info.faceSize; ++y)
            for (uint32_t x = 0; x < field.info.faceSize; ++x) visit(Texel{face, x, y});
}

/// W/(m^2 sr), rounded as R11G11B10F rounds: 1/128 relative in red and green, 1/64 in blue.
void expectRadiance(vec3 value, vec3 expected, float tolerance, const char* what)
{
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(value[c], expected[c], (tolerance + (c == 2 ? 1 / 64.0f : 1 / 128.0f)) * expected[c] + 1e-6f)
            << what << " channel " << c;
}

// From the point c inside a box [low, high] the wall met in direction d lies at the smallest positive slab distance.
TEST_F(Bake, BoxDistancesAndGradientsEqualTheClosedForm)
{
    Scene scene = emptyScene();
    const vec3 low(-1.0f, -2.0f, -1.5f), high(2.0f, 1.0f, 2.5f), centre(0.3f, -0.4f, 0.2f);
    addBox(scene, low, high);
    const FieldData field = bake(scene, {centre}, settingsFor(128));
    ASSERT_EQ(field.info.faceSize, 64u);
    int wrongGradients = 0, texels = 0;
    forEachTexel(field,
                 [&](Texel t)
                 {
                     const vec3 d = towards(field, t);
                     int wall = 0;
                     float w = INFINITY, second = INFINITY;
                     for (int axis = 0; axis < 3; ++axis)
                     {
                         const float to = ((d[axis] > 0.0f ? high[axis] : low[axis]) - centre[axis]) / d[axis];
                         if (to < w)
                             second = w, w = to, wall = axis;
                         else
                             second = std::min(second, to);
                     }
                     const uint32_t word = wordAt(field, t);
                     const float q = field.info.scale / w;
                     ASSERT_NEAR(Text::halfToReal(word), q, q * 5.2e-4f)
                         << "face " << t.face << " texel " << t.x << "," << t.y; // half a step of a half
                     if (second < 1.02f * w) return;                             // the texel straddles an edge of the box
                     ++texels;
                     const vec3 n = Text::faceCoordinates(t.face, vec3(wall == 0, wall == 1, wall == 2));
                     const vec3 uvw = Text::faceCoordinates(t.face, d);
                     for (int i = 0; i < 2; ++i)
                     {
                         const float g = glm::clamp(n[i] / glm::dot(n, uvw) * 2.0f / 64.0f, -0.15f, 0.15f);
                         const float stored = Text::unpackGradient(word >> (16 + 8 * i));
                         // A step of the byte at s = sqrt(g / 0.15) is 0.15 * 2 s / 127; half of it, and the root's rounding near zero.
                         if (std::abs(stored - g) > 0.6f * 0.15f * (2.0f * std::sqrt(std::abs(g) / 0.15f) + 1.0f / 127.0f) / 127.0f + 2e-5f)
                             ++wrongGradients;
                     }
                 });
    EXPECT_GT(texels, 20000);
    EXPECT_EQ(wrongGradients, 0);
    EXPECT_LE(field.probes[0].freeRadius * field.info.scale, 1.301f);
}

TEST_F(Bake, ChainBoundsEveryTexelBelow)
{
    Scene scene = emptyScene();
    addBox(scene, vec3(-2.0f), vec3(2.0f));
    addBox(scene, {0.5f, -1.0f, -0.2f}, {0.9f, 1.0f, 0.3f});
    addQuad(scene, {-1.5f, -1.5f, -1.0f}, {0.7f, 0.2f, 0.1f}, {0.1f, 1.0f, 0.4f});
    for (const uint32_t resolution : {128u, 160u}) // 160: faces of 80, no power of two
    {
        const FieldData field = bake(scene, {vec3(0.1f, 0.2f, -0.3f)}, settingsFor(resolution));
        const size_t faceWords = field.info.wordsPerProbe / 6;
        for (size_t face = 0; face < 6; ++face)
            testing_support::expectChainBounds(std::span(field.distance).subspan(face * faceWords, faceWords), field.info.faceSize);
    }
}

TEST_F(Bake, SunOnAPlaneGivesAlbedoTimesIrradianceOverPi)
{
    Scene scene = emptyScene();
    addQuad(scene, {-5, 0, -5}, {0, 0, 10}, {10, 0, 0});
    const vec3 irradiance(3.0f, 2.0f, 1.0f);
    scene.lights.push_back(sun({0.3f, -1.0f, 0.2f}, irradiance));
    const FieldData field = bake(scene, {vec3(0.0f, 1.0f, 0.0f)}, settingsFor(64));
    const float cosine = -scene.lights[0].direction.y;
    for (const vec3 d : {vec3(0, -1, 0), vec3(0.6f, -1, 0.3f), vec3(-2, -1, 1)})
        expectRadiance(radianceAt(field, texelAt(field, d)), albedoOf(scene.materials[0]) * irradiance * cosine / kPi, 0.01f, "lit plane");
    EXPECT_EQ(wordAt(field, texelAt(field, {0, 1, 0})), 0u) << "the sky has no distance";
    EXPECT_EQ(radianceAt(field, texelAt(field, {0, 1, 0})), vec3(0.0f)) << "a scene without a sky is black above";
}

TEST_F(Bake, SunFromBehindOrBehindABlockerLeavesBlack)
{
    Scene scene = emptyScene();
    addQuad(scene, {-5, 0, -5}, {0, 0, 10}, {10, 0, 0});
    addQuad(scene, {-1, 2, -1}, {0, 0, 2}, {2, 0, 0}); // its shadow is the square below it
    scene.lights.push_back(sun({0.0f, -1.0f, 0.0f}, vec3(3.0f)));
    const FieldData field = bake(scene, {vec3(0.0f, 1.0f, 0.0f)}, settingsFor(128));
    for (const vec3 d : {vec3(0, -1, 0), vec3(0.8f, -1, 0.8f), vec3(-0.8f, -1, 0.5f)})
        EXPECT_EQ(radianceAt(field, texelAt(field, d)), vec3(0.0f)) << "under the blocker";
    EXPECT_EQ(radianceAt(field, texelAt(field, {0.2f, 1, 0.2f})), vec3(0.0f)) << "the blocker's lower side faces away from the sun";
    expectRadiance(radianceAt(field, texelAt(field, {1.3f, -1, 0.0f})), albedoOf(scene.materials[0]) * 3.0f / kPi, 0.01f,
                   "beside the shadow");
}

TEST_F(Bake, PointLightFallsOffWithTheSquare)
{
    Scene scene = emptyScene();
    addQuad(scene, {-50, 0, -50}, {0, 0, 100}, {100, 0, 0});
    Light light;
    light.type = LightType::point;
    light.position = {0.0f, 3.0f, 0.0f};
    light.intensity = vec3(20.0f);
    scene.lights.push_back(light);
    const FieldData field = bake(scene, {vec3(0.0f, 1.0f, 0.0f)}, settingsFor(256));
    for (const vec3 d : {vec3(0.01f, -1, 0.01f), vec3(1.01f, -1, 0.51f), vec3(-3, -1, 1.01f)})
    {
        const Texel t = texelAt(field, d);
        const vec3 at = vec3(0, 1, 0) + towards(field, t) / std::abs(towards(field, t).y);
        const vec3 away = light.position - at;
        const float distance = glm::length(away);
        expectRadiance(radianceAt(field, t), albedoOf(scene.materials[0]) * 20.0f * (away.y / distance) / (distance * distance) / kPi,
                       0.01f, "point light");
    }
}

// Under a uniform sky an open plane receives pi times the sky's radiance.
TEST_F(Bake, SkyOnAnOpenPlaneGivesAlbedoTimesItsRadiance)
{
    Scene scene = emptyScene();
    addQuad(scene, {-5, 0, -5}, {0, 0, 10}, {10, 0, 0});
    scene.sky = {0.5f, 0.75f, 1.0f};
    const FieldData field = bake(scene, {vec3(0.0f, 1.0f, 0.0f)}, settingsFor(64));
    EXPECT_EQ(cost.lights, 48u);
    expectRadiance(radianceAt(field, texelAt(field, {0.1f, -1, 0.2f})), albedoOf(scene.materials[0]) * scene.sky, 0.03f,
                   "plane under the sky");
    expectRadiance(radianceAt(field, texelAt(field, {0, 1, 0})), scene.sky, 0.0f, "sky");
    // The probe's irradiance holds what surfaces reflect, not the sky.
    const FieldData whole = field;
    twin::LightFieldTwin<float> text(whole, {});
    EXPECT_EQ(text.probeIrradiance(0, vec3(0, 1, 0)), vec3(0.0f)) << "irradiance from above";
    expectRadiance(text.probeIrradiance(0, vec3(0, -1, 0)), radianceAt(field, texelAt(field, {0.1f, -1, 0.2f})), 0.12f,
                   "irradiance from below");
}

// Irradiance under the centre of a parallel a x a square at height h (Howell, configuration factor B-4, four quarters).
TEST_F(Bake, EmitterAboveAPlaneEqualsTheConfigurationFactor)
{
    Scene scene = emptyScene();
    Material lamp;
    lamp.baseColor = vec4(0.0f, 0.0f, 0.0f, 1.0f);
    lamp.emission = {5.0f, 4.0f, 3.0f};
    scene.materials.push_back(lamp);
    addQuad(scene, {-10, 0, -10}, {0, 0, 20}, {20, 0, 0});
    addQuad(scene, {-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, 1);
    const FieldData field = bake(scene, {vec3(0.0f, 1.0f, 0.0f)}, settingsFor(64));
    const float half = 1.0f, height = 2.0f, x = half / height, y = half / height;
    const float quarter =
        (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) + y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) /
        (2 * kPi);
    expectRadiance(radianceAt(field, texelAt(field, {0.02f, -1, 0.02f})), albedoOf(scene.materials[0]) * lamp.emission * 4.0f * quarter,
                   0.05f, "under the lamp");
    expectRadiance(radianceAt(field, texelAt(field, {0.02f, 1, 0.02f})), lamp.emission, 0.02f, "the lamp itself");
}

// In a closed box of constant albedo a, with walls that emit e, the radiance after b bounces is e (1 + a + ... + a^b): the lamps reach
// every wall evenly by direct light, too, so that L0 = e (1 + a).
TEST_F(Bake, FurnaceConvergesGeometrically)
{
    Scene scene = emptyScene();
    scene.materials[0].baseColor = vec4(vec3(test::RoughModel::baseColorOf(0.5)), 1.0f); // reflects one half
    scene.materials[0].emission = vec3(1.0f);
    addBox(scene, vec3(-1.0f), vec3(1.0f));
    for (const uint32_t resolution : {64u, 96u}) // 96: faces of 48, no power of two
    {
        BakeSettings settings = settingsFor(resolution, 3);
        settings.scene.light.emitterSamples = 320;
        const FieldData field = bake(scene, {vec3(0.0f)}, settings);
        double mean = 0.0, weights = 0.0;
        forEachTexel(field,
                     [&](Texel t)
                     {
                         const float l = glm::length(towards(field, t));
                         mean += radianceAt(field, t).g / (l * l * l);
                         weights += 1.0f / (l * l * l);
                     });
        EXPECT_NEAR(mean / weights, 1.0 + 0.5 + 0.25 + 0.125 + 0.0625, 0.065) << "resolution " << resolution;
    }
}

// An integrating sphere with a light of intensity I in its middle: every point of it has irradiance I / r^2 from the light and reflects it
// evenly to all others, so each bounce adds its albedo's share of the one before, and all light is the first over 1 - albedo.
TEST_F(Bake, ReportsTheEnergyOfEachBounceUntilItConverges)
{
    for (const float reflects : {0.3f, 0.5f, 0.8f})
    {
        Scene scene;
        MeshBuilder mesh(scene);
        mesh.sphere(vec3(0.0f), 2.0f, 64, 32, mesh.material("white", vec3(test::RoughModel::baseColorOf(reflects))));
        Light light;
        light.type = LightType::point;
        light.intensity = vec3(8.0f);
        scene.lights.push_back(light);
        BakeSettings settings = settingsFor(64, 60);
        settings.converged = 1e-3f;
        const FieldData field = bake(scene, {vec3(0.3f, 0.2f, 0.1f), vec3(-0.5f, -0.3f, 0.4f)}, settings);
        ASSERT_EQ(cost.energy.size(), size_t(field.bounces) + 1);
        EXPECT_LT(field.bounces, 40u) << "it stops when a bounce adds next to nothing";
        const double first = reflects * 8.0 / (4.0 * std::numbers::pi);
        EXPECT_NEAR(cost.energy[0], first, 0.02 * first);
        for (size_t b = 1; b < 4; ++b) EXPECT_NEAR(cost.energy[b] / cost.energy[b - 1], reflects, 0.03 * reflects) << "bounce " << b;
        const double sum = std::accumulate(cost.energy.begin(), cost.energy.end(), 0.0);
        EXPECT_NEAR(sum, first / (1.0 - reflects), 0.02 * first / (1.0 - reflects)) << "reflects " << reflects;
    }
}

TEST_F(Bake, AlphaMaskedHoleLetsTheViewAndTheSunThrough)
{
    Scene scene = emptyScene();
    Image picture{"hole", 64, 64, std::vector<uint8_t>(64 * 64 * 4, 255)};
    for (size_t y = 0; y < 64; ++y)
        for (size_t x = 0; x < 32; ++x) picture.rgba[(y * 64 + x) * 4 + 3] = 0; // u < 0.5 is not there
    scene.images.push_back(picture);
    Material masked;
    masked.alphaCutoff = 0.5f;
    masked.baseColorTexture.image = 0;
    masked.baseColorTexture.wrapU = Wrap::clamp;
    scene.materials.push_back(masked);
    addQuad(scene, {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
    addQuad(scene, {-2, 2, -2}, {4, 0, 0}, {0, 0, 4}, 1); // u runs along x: its half with x < 0 is a hole
    scene.lights.push_back(sun({0.0f, -1.0f, 0.0f}, vec3(3.0f)));
    const FieldData field = bake(scene, {vec3(0.0f, 1.0f, 0.0f)}, settingsFor(128));
    EXPECT_EQ(wordAt(field, texelAt(field, {-0.5f, 1, 0.1f})), 0u) << "the hole shows the sky";
    EXPECT_NE(wordAt(field, texelAt(field, {0.5f, 1, 0.1f})), 0u);
    expectRadiance(radianceAt(field, texelAt(field, {-1.0f, -1, 0.1f})), albedoOf(scene.materials[0]) * 3.0f / kPi, 0.01f,
                   "below the hole");
    EXPECT_EQ(radianceAt(field, texelAt(field, {1.0f, -1, 0.1f})), vec3(0.0f)) << "below the cloth";
}

TEST_F(Bake, BlendedPaneLetsTheViewAndTheSunThroughByItsAlpha)
{
    Scene scene = emptyScene();
    Material pane;
    pane.baseColor = {0.0f, 0.0f, 0.0f, 0.3f};
    pane.blended = true;
    scene.materials.push_back(pane);
    addQuad(scene, {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
    addQuad(scene, {-4, 2, -4}, {8, 0, 0}, {0, 0, 8}, 1);
    scene.lights.push_back(sun({0.0f, -1.0f, 0.0f}, vec3(3.0f)));
    const FieldData field = bake(scene, {vec3(0.0f, 1.0f, 0.0f)}, settingsFor(128));
    const vec3 open = albedoOf(scene.materials[0]) * 3.0f / kPi;
    int above = 0, glass = 0, below = 0;
    double lit = 0.0;
    forEachTexel(field,
                 [&](Texel t)
                 {
                     const vec3 d = towards(field, t);
                     const float reach = std::max(std::abs(d.x), std::abs(d.z));
                     if (d.y > 0.4f * reach) ++above, glass += wordAt(field, t) != 0u;
                     if (d.y < -0.4f * reach) ++below, lit += radianceAt(field, t).g / open.g;
                 });
    EXPECT_NEAR(double(glass) / above, 0.3, 0.02);
    EXPECT_NEAR(lit / below, 0.7, 0.03);
}

TEST_F(Bake, TexturedSurfaceShowsItsDecodedColour)
{
    Scene scene = emptyScene();
    Image picture{"halves", 16, 8, {}};
    for (int i = 0; i < 16 * 8; ++i)
        for (const int code : {i % 16 < 8 ? 188 : 64, 100, 0, 255}) picture.rgba.push_back(uint8_t(code));
    scene.images.push_back(picture);
    scene.materials[0].baseColor = vec4(1.0f);
    scene.materials[0].baseColorTexture.image = 0;
    addQuad(scene, {-2, 0, -2}, {4, 0, 0}, {0, 0, 4});
    scene.lights.push_back(sun({0.0f, -1.0f, 0.0f}, vec3(kPi)));
    const FieldData field = bake(scene, {vec3(0.0f, 1.0f, 0.0f)}, settingsFor(128));
    // 188, 100 and 64 decode to 0.5029, 0.1274 and 0.0513 (IEC 61966-2-1).
    expectRadiance(radianceAt(field, texelAt(field, {-1.0f, -1, 0.1f})), reflectedBy({0.5029f, 0.1274f, 0.0f}), 0.02f, "left half");
    expectRadiance(radianceAt(field, texelAt(field, {1.0f, -1, 0.1f})), reflectedBy({0.0513f, 0.1274f, 0.0f}), 0.02f, "right half");
}

TEST_F(Bake, FacesMeetWithoutASeam)
{
    Scene scene = emptyScene();
    addBox(scene, vec3(-1.0f, -1.1f, -1.2f), vec3(1.3f, 1.0f, 1.2f));
    scene.lights.push_back(sun({0.0f, -1.0f, 0.0f}, vec3(1.0f)));
    const FieldData field = bake(scene, {vec3(0.1f)}, settingsFor(128));
    // Along the border u = 1 of face +x (towards +y) the last texel and its neighbour on face +y lie one texel apart on the same wall.
    const uint32_t n = field.info.faceSize;
    for (uint32_t i = 4; i < n - 4; ++i)
    {
        const Texel a{0, n - 1, i};
        const vec3 across = towards(field, a) + vec3(0.0f, 2.0f / float(n), 0.0f); // over the edge
        const Texel b = texelAt(field, across);
        ASSERT_EQ(b.face, 2);
        const vec3 pa = towards(field, a) / Text::halfToReal(wordAt(field, a)), pb = towards(field, b) / Text::halfToReal(wordAt(field, b));
        EXPECT_LT(glm::length(pa - pb), 6.0f / float(n)) << "row " << i;
    }
}

TEST_F(Bake, OctahedralDistancesEqualTheClosedForm)
{
    Scene scene = emptyScene();
    const vec3 low(-1.0f, -2.0f, -1.5f), high(2.0f, 1.0f, 2.5f), centre(0.3f, -0.4f, 0.2f);
    addBox(scene, low, high);
    const FieldData field = bake(scene, {centre}, settingsFor(128, 1, gpu::kChartOctahedral));
    const uint32_t n = field.info.faceSize, width = n / gpu::kLowFactor;
    ASSERT_EQ(n, 128u);
    ASSERT_EQ(field.radiance.size(), size_t(n) * n);
    int wrong = 0;
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x)
        {
            const vec3 d = Text::directionFromOctahedral({(float(x) + 0.5f) / float(n), (float(y) + 0.5f) / float(n)});
            float r = INFINITY, second = INFINITY;
            for (int axis = 0; axis < 3; ++axis)
            {
                if (d[axis] == 0.0f) continue; // runs along the walls
                const float to = ((d[axis] > 0.0f ? high[axis] : low[axis]) - centre[axis]) / d[axis];
                second = to < r ? r : std::min(second, to);
                r = std::min(r, to);
            }
            const uint32_t word = field.distance[y * n + x],
                           low16 = field.distance[n * n + (y / gpu::kLowFactor) * width + x / gpu::kLowFactor];
            if (second > 1.1f * r && std::abs(Text::halfToReal(word) * field.info.scale - r) > 1.5e-3f * r) ++wrong;
            EXPECT_LE(low16 & 0xffffu, word & 0xffffu);
            EXPECT_GE(low16 >> 16, word & 0xffffu);
        }
    EXPECT_EQ(wrong, 0);
}

Scene litRoom()
{
    Scene scene = emptyScene();
    Material lamp;
    lamp.emission = vec3(6.0f);
    scene.materials.push_back(lamp);
    addBox(scene, vec3(-2.0f), vec3(2.0f));
    addBox(scene, {0.5f, -2.0f, -0.2f}, {1.1f, 0.0f, 0.6f});
    addQuad(scene, {-0.5f, 1.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, 1);
    return scene;
}

TEST_F(Bake, SameInputGivesTheSameBytes)
{
    const Scene scene = litRoom();
    const std::vector<vec3> probes = {vec3(0.0f), vec3(1.0f, 1.0f, 1.0f), vec3(-1.0f, -1.0f, 0.5f)};
    const FieldData a = bake(scene, probes, settingsFor(64, 2)), b = bake(scene, probes, settingsFor(64, 2));
    EXPECT_EQ(a.distance, b.distance);
    EXPECT_EQ(a.radiance, b.radiance);
    EXPECT_EQ(a.irradiance, b.irradiance);
    EXPECT_EQ(a.octree.texels, b.octree.texels);
    EXPECT_EQ(std::memcmp(a.probes.data(), b.probes.data(), a.probes.size() * sizeof(gpu::ProbeHeader)), 0);
}

// However a bake is cut into submissions, and however little its device is held at once; of either chart, and gathered through the field.
TEST_F(Bake, SubmissionsOfAnyLengthGiveTheSameBytes)
{
    const Scene scene = litRoom();
    const std::vector<vec3> probes = {vec3(0.0f), vec3(1.0f, 1.0f, 1.0f)};
    for (const uint32_t chart : {gpu::kChartCube, gpu::kChartOctahedral})
    {
        BakeSettings settings = settingsFor(64, 1);
        settings.chart = chart;
        settings.surfaceTexels = chart == gpu::kChartCube ? 26 : 0;
        settings.submissionMs = knobs::submissionMs.most;
        const FieldData whole = bake(scene, probes, settings);
        EXPECT_GT(cost.longestSubmission, 0.0);
        settings.submissionMs = knobs::submissionMs.least;
        const FieldData cut = bake(scene, probes, settings);
        for (const auto words :
             {&FieldData::distance, &FieldData::radiance, &FieldData::irradiance, &FieldData::prefiltered, &FieldData::surfaceLight})
            EXPECT_TRUE(whole.*words == cut.*words);
        EXPECT_EQ(whole.octree.texels, cut.octree.texels);
        EXPECT_EQ(whole.surfaceLight.empty(), chart != gpu::kChartCube);
    }
}

TEST_F(Bake, ProbeAloneEqualsItselfAmongMany)
{
    const Scene scene = litRoom();
    const std::vector<vec3> probes = {vec3(0.0f), vec3(1.0f, 1.0f, 1.0f), vec3(-1.0f, -1.0f, 0.5f)};
    const FieldData many = bake(scene, probes, settingsFor(64)), one = bake(scene, {probes[1]}, settingsFor(64));
    EXPECT_TRUE(std::equal(one.distance.begin(), one.distance.end(), many.distance.begin() + ptrdiff_t(one.distance.size())));
    EXPECT_TRUE(std::equal(one.radiance.begin(), one.radiance.end(), many.radiance.begin() + ptrdiff_t(one.radiance.size())));
    EXPECT_TRUE(std::equal(one.irradiance.begin(), one.irradiance.end(), many.irradiance.begin() + ptrdiff_t(one.irradiance.size())));
}

// The same room a thousand times larger and far away: the words are the same but for the rounding of the moved positions.
TEST_F(Bake, ScaledByAPowerOfTwoKeepsEveryWord)
{
    Scene scene = litRoom();
    const FieldData a = bake(scene, {vec3(0.25f, 0.5f, 0.0f)}, settingsFor(64));
    for (vec3& p : scene.positions) p *= 1024.0f;
    const FieldData b = bake(scene, {1024.0f * vec3(0.25f, 0.5f, 0.0f)}, settingsFor(64));
    EXPECT_EQ(a.distance, b.distance);
    EXPECT_EQ(a.radiance, b.radiance);
}

TEST_F(Bake, BadSettingsAreNamed)
{
    const Scene scene = litRoom();
    const auto refusal = [&](std::vector<vec3> probes, const BakeSettings& settings)
    {
        auto field = bakeLightField(device.gpu(), scene, probes, settings, {}, cost);
        return field ? std::string("was accepted") : field.error().message;
    };
    EXPECT_NE(refusal({}, settingsFor(64)).find("0 probes"), std::string::npos);
    EXPECT_NE(refusal({vec3(0.0f)}, settingsFor(100)).find("resolution is 100"), std::string::npos);
    EXPECT_NE(refusal({vec3(0.0f)}, settingsFor(64, 65)).find("bounces is 65"), std::string::npos);
    BakeSettings never = settingsFor(64);
    never.submissionMs = 0.0f;
    EXPECT_NE(refusal({vec3(0.0f)}, never).find("submission is 0"), std::string::npos);
    EXPECT_NE(refusal({vec3(0.0f), vec3(NAN)}, settingsFor(64)).find("probe 1"), std::string::npos);
}

TEST_F(Bake, CancelEndsWithItsCode)
{
    const Scene scene = litRoom();
    const std::vector<vec3> probes(3, vec3(0.0f));
    auto field = bakeLightField(
        device.gpu(), scene, probes, settingsFor(64), [](std::string_view stage, double done) { return stage != "probes" || done < 0.5; },
        cost);
    ASSERT_FALSE(field);
    EXPECT_EQ(field.error().code, ErrorCode::cancelled);
}

TEST(BakeBudget, TooSmallIsRefusedWithTheNumbers)
{
    ValidatedDevice device(uint64_t(24) << 20);
    BakeReport cost;
    const std::vector<vec3> probes = {vec3(0.0f)};
    auto field = bakeLightField(device.gpu(), litRoom(), probes, settingsFor(1024), {}, cost);
    ASSERT_FALSE(field);
    EXPECT_EQ(field.error().code, ErrorCode::outOfMemory);
    EXPECT_NE(field.error().message.find("24 MiB"), std::string::npos) << field.error().message;
}

TEST_F(Bake, MoreMainMemoryThanItMayHaveIsRefusedWithTheNumbers)
{
    const std::vector<vec3> probes(3, vec3(0.0f));
    BakeSettings settings = settingsFor(256);
    settings.hostMemory = uint64_t(1) << 20;
    const auto field = bakeLightField(device.gpu(), litRoom(), probes, settings, {}, cost);
    ASSERT_FALSE(field);
    EXPECT_EQ(field.error().code, ErrorCode::outOfMemory);
    for (const char* part : {"3 probes", "256 texels", "1 MiB"})
        EXPECT_NE(field.error().message.find(part), std::string::npos) << field.error().message;
}

TEST_F(Bake, MoreMainMemoryThanAnyMachineHasIsRefused)
{
    const std::vector<vec3> probes(65535, vec3(0.0f)); // about 9 TiB
    const auto field = bakeLightField(device.gpu(), litRoom(), probes, settingsFor(2048), {}, cost);
    ASSERT_FALSE(field);
    EXPECT_EQ(field.error().code, ErrorCode::outOfMemory);
    EXPECT_NE(field.error().message.find("65535 probes"), std::string::npos) << field.error().message;
}

TEST_F(Bake, CompactIsTheSameBakePutInBlocks)
{
    const std::vector<vec3> probes(2, vec3(0.0f));
    BakeSettings settings = settingsFor(64, 1);
    auto texels = bakeLightField(device.gpu(), litRoom(), probes, settings, {}, cost);
    settings.compact = true;
    const auto blocks = bakeLightField(device.gpu(), litRoom(), probes, settings, {}, cost);
    ASSERT_TRUE(texels && blocks);
    ASSERT_TRUE(putInBlocks(*texels));
    EXPECT_EQ(texels->distance, blocks->distance);
    EXPECT_EQ(texels->radiance, blocks->radiance);
    EXPECT_EQ(texels->surfaceLight, blocks->surfaceLight);
    settings.chart = gpu::kChartOctahedral;
    const auto refused = bakeLightField(device.gpu(), litRoom(), probes, settings, {}, cost);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("compact"), std::string::npos) << refused.error().message;
}

TEST_F(Bake, WithoutShadowMapsOfAreaLightIsRefused)
{
    const std::vector<vec3> probes = {vec3(0.0f)};
    BakeSettings settings = settingsFor(64);
    settings.scene.light.areaShadows = false; // as frames with shadow rays have it
    const auto field = bakeLightField(device.gpu(), litRoom(), probes, settings, {}, cost);
    ASSERT_FALSE(field);
    EXPECT_EQ(field.error().code, ErrorCode::badArgument);
    EXPECT_NE(field.error().message.find("areaShadows"), std::string::npos) << field.error().message;
}

TEST_F(Bake, SceneWithoutTrianglesIsRefused)
{
    const std::vector<vec3> probes = {vec3(0.0f)};
    auto field = bakeLightField(device.gpu(), emptyScene(), probes, settingsFor(64), {}, cost);
    ASSERT_FALSE(field);
    EXPECT_EQ(field.error().code, ErrorCode::badInput);
}

} // namespace
} // namespace sconce
