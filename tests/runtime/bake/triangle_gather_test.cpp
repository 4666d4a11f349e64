// Light gathered by rays to the scene's triangles, against closed forms and against itself.
#include "runtime/bake/triangle_gather.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "bench/reference/path_tracer.h"
#include "runtime/bake/bake.h"
#include "runtime/field/tracer_cpu.h"
#include "scene/mesh_builder.h"
#include "scene/triangle_rays.h"
#include "shaders/shared/pure.h"
#include "tests/support/device.h"
#include "tests/support/square_lamp.h"
#include "tests/support/test_scenes.h"

namespace sconce
{
namespace
{

using Text = twin::LightFieldTwin<float>;

class TriangleGathering : public testing::Test
{
protected:
    FieldData bake(const Scene& scene, std::vector<vec3> probes, uint32_t bounces, std::string_view gather = "triangles")
    {
        BakeSettings settings;
        settings.resolution = 128;
        settings.bounces = bounces;
        settings.converged = 0.0f;
        settings.surfaceTexels = 26;
        std::optional<TriangleRays> rays;
        if (gather == knobs::kGathers[0]) settings.rays = &rays.emplace(std::move(*TriangleRays::build(scene)));
        settings.octree.voxels = 16;
        auto field = bakeLightField(device.gpu(), scene, probes, settings, {}, report);
        if (!field) throw std::runtime_error(field.error().message);
        return std::move(*field);
    }

    struct Texel
    {
        vec3 position, normal, light; // world
    };
    /// Those of one probe whose light is known.
    static std::vector<Texel> texelsOf(const FieldData& field, uint32_t probe)
    {
        Text text(field, {});
        const int side = int(field.info.surfaceSize);
        std::vector<Texel> found;
        for (int i = 0; i < 6 * side * side; ++i)
        {
            const int face = i / (side * side), y = i / side % side, x = i % side;
            const auto point = text.surfacePointAt(probe, face, x, y);
            uint32_t word = field.surfaceLight[text.surfaceIndex(probe, face, x, y)];
            if (Text::isRefined(word)) word = text.refinedWord(word, 0);
            if (!(point.width > 0.0f) || word == 0) continue;
            found.push_back({field.info.origin + field.info.scale * (field.probes[probe].centre + point.at), point.normal,
                             text.unpackSharedExponent(word)});
        }
        return found;
    }

    testing_support::SharedDevice device;
    BakeReport report;
};

// In a closed box that glows and reflects alike everywhere, what arrives is the emission over what is not reflected, whatever the lobes.
TEST_F(TriangleGathering, AGlowingBoxKeepsItsLight)
{
    struct Surface
    {
        float base, roughness, metallic;
    };
    for (const Surface& surface :
         {Surface{0.6f, 1.0f, 0.0f}, {0.6f, 0.2f, 0.0f}, {0.6f, 0.3f, 1.0f}, {0.6f, 0.5f, 0.7f}, {0.9f, 0.2f, 1.0f}})
    {
        Scene scene;
        MeshBuilder mesh(scene);
        const uint32_t material = mesh.material("glowing", vec3(surface.base), surface.roughness, surface.metallic);
        scene.materials[material].emission = vec3(2.0f);
        mesh.box(vec3(-1.0f), vec3(1.0f), material);
        const FieldData field = bake(scene, {vec3(0.1f, 0.2f, 0.15f)}, 64);
        const float albedo = Pure<float>::hemisphericalAlbedo({vec3(surface.base), surface.metallic, surface.roughness}).g;
        const double truth = 2.0 / (1.0 - albedo);
        double mean = 0.0;
        const std::vector<Texel> texels = texelsOf(field, 0);
        for (const Texel& texel : texels) mean += texel.light.g / double(texels.size());
        // Lobes are sampled without their weight at grazing angles: bright metal, reflected on and on, is the hardest.
        EXPECT_NEAR(mean / truth, 1.0, surface.base > 0.8f ? 0.06 : 0.02)
            << "base " << surface.base << ", roughness " << surface.roughness << ", metallic " << surface.metallic;
    }
}

/// Mean radiance, green, that paths bring to the place that a probe sees towards `towards`, weighted as a texel's light is: by the cosine,
/// and by what the diffuse lobe below a dielectric's coat takes.
double arrivingByPaths(const RayScene& rays, const PathTracer& paths, vec3 probe, vec3 towards, uint64_t stream)
{
    constexpr int kAcross = 4, kUp = 2; // strata of the paths' first direction
    const auto hit = rays.closest(probe, towards);
    if (!hit) return NAN;
    const ShadingPoint at = paths.shade(*hit, -towards);
    const TangentFrame tangents = tangentFrame(at.normal);
    double sum = 0.0;
    for (int k = 0; k < kAcross * kUp; ++k)
    {
        Random random(11, stream, uint64_t(k));
        const vec2 u = (vec2(k % kAcross, k / kAcross) + random.uniform2()) / vec2(kAcross, kUp);
        const vec3 direction = glm::normalize(toWorld(tangents, sampleCosine(u)));
        if (!(glm::dot(direction, at.geometricNormal) > 0.0f)) continue; // below the facet that stands for the curve
        const float taken = Pure<float>::diffuseAlong(glm::dot(direction, at.normal), at.surface.roughness);
        const PathLight light = paths.trace(at.position + rays.offset() * at.geometricNormal, direction, random);
        sum += double(glm::mix(taken, 1.0f, at.surface.metallic)) * double(light.direct.g + light.diffuse.g + light.glossy.g);
    }
    return sum / (kAcross * kUp);
}

// A sphere about a point light, and one that glows, after as many bounces as the path tracer has. Rays that meet rough walls end there;
// smoother walls send some of them on by their specular lobe, and what these bring is of a bounce earlier for each time.
TEST_F(TriangleGathering, EachBounceInASphereIsThePathTracers)
{
    struct Surface
    {
        float base, metallic, roughness;
        double lamp, glow; // relative error allowed, with the point light and where the walls glow
    };
    const vec3 probe(0.3f, 0.2f, 0.1f);
    // SHORT: 0.01 is aimed at for each. Half-metals reflect rays more often than is counted (gpu::kReflectionsCounted), and their coats are
    // told in 11 steps (probe_face.glsl). Of light that falls
    // steeply a rough metal sends a quarter less than of light from all sides: its gain is its viewer's side's alone. leanOfRoughness()
    // (brdf_text.h) leaves 0.03 of that.
    for (const Surface& surface : {Surface{0.7f, 0.0f, 1.0f, 0.01, 0.01},
                                   {0.7f, 0.5f, 0.5f, 0.02, 0.015},
                                   {0.9f, 1.0f, 1.0f, 0.035, 0.01},
                                   {0.7f, 0.0f, 0.15f, 0.01, 0.01}})
        for (const bool glows : {false, true})
        {
            Scene scene;
            MeshBuilder mesh(scene);
            const uint32_t wall = mesh.material("wall", vec3(surface.base), surface.roughness, surface.metallic);
            mesh.sphere(vec3(0.0f), 2.0f, 64, 32, wall);
            if (glows)
                scene.materials[wall].emission = vec3(1.0f);
            else
                scene.lights.push_back(test::light(LightType::point, {0.4f, -0.3f, 0.5f}, {0, -1, 0}, 8.0f));
            const RayScene rays = std::move(*RayScene::create(scene));
            for (const uint32_t bounces : {1u, 2u, 4u, 8u, 64u})
            {
                if (bounces == 64 && surface.base > 0.8f) continue; // paths say too little of bright metal then
                const std::vector<Texel> texels = texelsOf(bake(scene, {probe}, bounces), 0);
                const PathTracer paths(rays, {}, bounces - 1);
                std::vector<double> traced(texels.size());
                parallelFor(texels.size(), [&](size_t i)
                            { traced[i] = arrivingByPaths(rays, paths, probe, glm::normalize(texels[i].position - probe), i); });
                double sum = 0.0, squares = 0.0;
                for (const Texel& texel : texels) sum += texel.light.g;
                const double all = std::accumulate(traced.begin(), traced.end(), 0.0), count = double(texels.size());
                for (const double one : traced) squares += (one - all / count) * (one - all / count);
                const double ratio = sum / all, unsure = std::sqrt(squares) / all; // standard error of the paths
                const double allowed = (glows ? surface.glow : surface.lamp) + 3.0 * unsure;
                EXPECT_LT(unsure, 0.02);
                const std::string name = "base " + std::to_string(surface.base) + ", metallic " + std::to_string(surface.metallic) +
                                         ", roughness " + std::to_string(surface.roughness) + (glows ? ", glowing, " : ", point light, ") +
                                         std::to_string(bounces) + " bounces";
                RecordProperty(name, std::to_string(ratio) + " +- " + std::to_string(unsure));
                EXPECT_NEAR(ratio, 1.0, allowed) << name;
            }
        }
}

// Tilted this way and that by a normal texture, too fine to be seen, a floor gets the mean of what its normals get: of a sun above it the
// cosine of their tilt, of the sky the mean of what is over both of their planes. What it sends shows on the underside of a slab over it.
TEST_F(TriangleGathering, AFloorOfManyNormalsSendsTheMeanOfTheirs)
{
    constexpr double kTilt = 40.0 * std::numbers::pi / 180.0;
    const auto underside = [&](bool tilted, bool sunlit)
    {
        Scene scene;
        MeshBuilder mesh(scene);
        const uint32_t floor = mesh.material("floor", vec3(0.6f)), slab = mesh.material("slab", vec3(0.0f));
        mesh.quad({-10, 0, -10}, {-10, 0, 10}, {10, 0, 10}, {10, 0, -10}, floor);
        mesh.box({-0.5f, 1.0f, -0.5f}, {0.5f, 1.1f, 0.5f}, slab);
        constexpr uint32_t kSide = 512;
        Image image{"tilts", kSide, kSide, {}};
        for (uint32_t i = 0; i < kSide * kSide; ++i)
        {
            const double x = tilted ? (i % 2 == 0 ? std::sin(kTilt) : -std::sin(kTilt)) : 0.0, z = tilted ? std::cos(kTilt) : 1.0;
            for (const double value : {x, 0.0, z}) image.rgba.push_back(uint8_t(std::lround(127.5 * (value + 1.0))));
            image.rgba.push_back(255);
        }
        scene.images.push_back(std::move(image));
        scene.materials[floor].normalTexture.image = 0;
        if (sunlit)
            scene.lights.push_back(test::light(LightType::directional, {}, {0, -1, 0}, 3.0f));
        else
            scene.sky = vec3(1.0f);
        double sum = 0.0;
        int count = 0;
        for (const Texel& texel : texelsOf(bake(scene, {vec3(0.1f, 0.5f, 0.2f), vec3(1.5f, 1.2f, 0.1f)}, 1), 0))
            if (texel.normal.y < -0.9f) sum += double(texel.light.g), ++count;
        EXPECT_GT(count, 100);
        EXPECT_GT(report.gatherRays, uint64_t(count) * knobs::surfaceRays.value);
        return sum / count;
    };
    EXPECT_NEAR(underside(true, true) / underside(false, true), std::cos(kTilt), 0.02);
    EXPECT_NEAR(underside(true, false) / underside(false, false), 0.5 + 0.5 * std::cos(kTilt), 0.02);
}

// A mirror as floor before a black wall: the wall has the lamp's light and that of its image, and below a screen that keeps the lamp from
// it the image's alone. Taken as scattered, what the mirror throws on falls where it doesn't.
TEST_F(TriangleGathering, AMirrorThrowsLightOn)
{
    constexpr float kReflected = 0.7f, kHalf = 0.4f;
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t black = mesh.material("black", vec3(0.0f), 1.0f);
    mesh.box(vec3(-6.0f, -0.2f, -6.0f), vec3(6.0f, 0.0f, 6.0f), mesh.material("mirror", vec3(kReflected), 0.0f, 1.0f));
    mesh.box(vec3(3.0f, 0.0f, -6.0f), vec3(3.2f, 4.0f, 6.0f), black);
    const vec3 lamp(0.0f, 1.5f, 0.0f), image(0.0f, -1.5f, 0.0f);
    mesh.quad(lamp + vec3(-kHalf, 0, -kHalf), lamp + vec3(kHalf, 0, -kHalf), lamp + vec3(kHalf, 0, kHalf), lamp + vec3(-kHalf, 0, kHalf),
              mesh.emitter("lamp", vec3(10.0f)));
    const FieldData field = bake(scene, {vec3(1.8f, 1.0f, 0.3f)}, 4);
    double sum = 0.0, truth = 0.0, direct = 0.0;
    for (const Texel& texel : texelsOf(field, 0))
    {
        if (texel.normal.x > -0.99f || texel.position.y < 0.2f || texel.position.y > 2.0f || std::abs(texel.position.z) > 1.5f) continue;
        const double own = 10.0 * testing_support::fromSquareLamp(lamp, kHalf, texel.position, texel.normal);
        sum += texel.light.g;
        direct += own;
        truth += own + 10.0 * testing_support::fromSquareLamp(image, kHalf, texel.position, texel.normal, kReflected);
    }
    EXPECT_GT(truth, 1.4 * direct) << "the mirror has a say";
    EXPECT_NEAR(sum / truth, 1.0, 0.04); // the black wall itself reflects 4 %, which the mirror sends back
}

// Of a lamp three quarters of which alpha cuts out, a floor gets what the quarter gives that is there.
TEST_F(TriangleGathering, AMaskedLampGivesTheLightOfWhatIsThere)
{
    constexpr float kHalf = 0.5f; // texture coordinates are metres
    constexpr uint32_t kSide = 64;
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box(vec3(-6.0f, -0.2f, -6.0f), vec3(6.0f, 0.0f, 6.0f), mesh.material("black", vec3(0.0f), 1.0f));
    const uint32_t lamp = mesh.emitter("lamp", vec3(10.0f));
    mesh.quad({-kHalf, 1.5f, -kHalf}, {kHalf, 1.5f, -kHalf}, {kHalf, 1.5f, kHalf}, {-kHalf, 1.5f, kHalf}, lamp);
    Image image{"quarter", kSide, kSide, std::vector<uint8_t>(kSide * kSide * 4, 255)};
    for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) image.rgba[(y * kSide + x) * 4 + 3] = x < kSide / 2 && y < kSide / 2 ? 255 : 0;
    scene.images.push_back(std::move(image));
    scene.materials[lamp].baseColorTexture.image = 0;
    scene.materials[lamp].alphaCutoff = 0.5f;
    const vec3 middle(-0.5f * kHalf, 1.5f, -0.5f * kHalf);
    for (const std::string_view gather : knobs::kGathers)
    {
        double sum = 0.0, truth = 0.0;
        for (const Texel& texel : texelsOf(bake(scene, {vec3(1.2f, 0.8f, 0.3f)}, 0, gather), 0))
        {
            if (texel.normal.y < 0.99f || std::hypot(texel.position.x, texel.position.z) > 2.0f) continue;
            sum += texel.light.g;
            truth += 10.0 * testing_support::fromSquareLamp(middle, 0.5f * kHalf, texel.position, texel.normal);
        }
        ASSERT_GT(truth, 0.0);
        RecordProperty(std::string(gather), std::to_string(sum / truth));
        EXPECT_NEAR(sum / truth, 1.0, 0.01) << gather;
    }
}

// A smooth dielectric's coat reflects light along its plane, so that its diffuse lobe takes less of it, and more of what falls steeply.
TEST_F(TriangleGathering, SmoothDielectricsTakeLessOfGrazingLight)
{
    constexpr float kHalf = 0.3f, kHeight = 1.0f;
    constexpr int kSteps = 16; // of the lamp, along each side
    for (const float roughness : {0.05f, 0.3f, 1.0f})
    {
        Scene scene;
        MeshBuilder mesh(scene);
        mesh.box(vec3(-8.0f, -0.2f, -8.0f), vec3(8.0f, 0.0f, 8.0f), mesh.material("coat", vec3(0.0f), roughness));
        mesh.quad({-kHalf, kHeight, -kHalf}, {kHalf, kHeight, -kHalf}, {kHalf, kHeight, kHalf}, {-kHalf, kHeight, kHalf},
                  mesh.emitter("lamp", vec3(10.0f)));
        struct
        {
            double got = 0.0, truth = 0.0, even = 0.0;
        } below, away;
        for (const Texel& texel : texelsOf(bake(scene, {vec3(0.4f, 0.7f, 0.5f)}, 0), 0))
        {
            const double far = std::hypot(texel.position.x, texel.position.z);
            if (texel.normal.y < 0.99f || (far > 0.5 && far < 2.5) || far > 5.0) continue;
            auto& where = far < 1.0 ? below : away;
            where.got += texel.light.g;
            for (int i = 0; i < kSteps * kSteps; ++i)
            {
                const double x = kHalf * (2.0 * (i % kSteps + 0.5) / kSteps - 1.0) - texel.position.x;
                const double z = kHalf * (2.0 * (i / kSteps + 0.5) / kSteps - 1.0) - texel.position.z;
                const double d2 = x * x + z * z + kHeight * kHeight, cosine = kHeight / std::sqrt(d2);
                const double given = 10.0 * cosine * cosine / d2 * 4.0 * kHalf * kHalf / (kSteps * kSteps) / glm::pi<double>();
                where.even += given;
                where.truth += given * Pure<double>::diffuseAlong(cosine, double(roughness));
            }
        }
        ASSERT_GT(away.truth, 0.0);
        EXPECT_NEAR(below.got / below.truth, 1.0, 0.02) << "roughness " << roughness;
        EXPECT_NEAR(away.got / away.truth, 1.0, 0.035) << "roughness " << roughness;
        if (roughness < 0.1f)
        {
            EXPECT_LT(away.truth, 0.9 * away.even) << "the coat has a say";
        }
    }
}

// Below a small plate over a mirror of gold the white sky is golden: of each colour by Schlick's mean over the hemisphere, c + (1 - c)
// / 21.
TEST_F(TriangleGathering, TheSkyInAMetalHasItsColour)
{
    const vec3 gold(0.8f, 0.6f, 0.2f);
    Scene scene;
    scene.sky = vec3(1.0f);
    MeshBuilder mesh(scene);
    mesh.box(vec3(-40.0f, -0.2f, -40.0f), vec3(40.0f, 0.0f, 40.0f), mesh.material("gold", gold, 0.0f, 1.0f));
    mesh.box(vec3(-0.2f, 1.5f, -0.2f), vec3(0.2f, 1.6f, 0.2f), mesh.material("black", vec3(0.0f), 1.0f));
    const FieldData field = bake(scene, {vec3(0.1f, 0.8f, 0.05f)}, 2);
    vec3 sum(0.0f);
    int below = 0;
    for (const Texel& texel : texelsOf(field, 0))
        if (texel.normal.y < -0.99f) sum += texel.light, ++below;
    ASSERT_GT(below, 5);
    const vec3 truth = gold + (1.0f - gold) / 21.0f;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / float(below) / truth[c], 1.0f, 0.05f) << c;
}

// What no probe sees scatters light all the same: a probe below a shelf knows what comes from the lamp above it, whether another probe sees
// the lamp's surroundings or none.
TEST_F(TriangleGathering, LightFromWhereNoProbeSeesArrives)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t white = mesh.material("white", vec3(0.8f), 1.0f);
    mesh.box(vec3(-2.0f, 0.0f, -2.0f), vec3(2.0f, 3.0f, 2.0f), white);
    mesh.box(vec3(-1.5f, 1.9f, -1.5f), vec3(1.5f, 2.0f, 1.5f), white);
    mesh.quad({-0.5f, 2.3f, -0.5f}, {0.5f, 2.3f, -0.5f}, {0.5f, 2.3f, 0.5f}, {-0.5f, 2.3f, 0.5f}, mesh.emitter("lamp", vec3(5.0f)));
    const vec3 below(0.1f, 1.0f, 0.2f), above(0.0f, 2.65f, 0.0f);
    const RayScene rays = std::move(*RayScene::create(scene));
    const PathTracer paths(rays, {}, 64);
    for (const std::vector<vec3>& probes : {std::vector<vec3>{below}, {below, above}})
    {
        const std::vector<Texel> texels = texelsOf(bake(scene, probes, 64), 0);
        std::vector<double> traced(texels.size());
        parallelFor(texels.size(),
                    [&](size_t i) { traced[i] = arrivingByPaths(rays, paths, below, glm::normalize(texels[i].position - below), i); });
        double sum = 0.0;
        for (const Texel& texel : texels) sum += texel.light.g;
        const double ratio = sum / std::accumulate(traced.begin(), traced.end(), 0.0);
        RecordProperty(std::to_string(probes.size()) + " probes", std::to_string(ratio));
        // SHORT: 0.03 is aimed at, and with the probe below alone 0.048 is missing at all bounces.
        EXPECT_NEAR(ratio, 1.0, probes.size() == 1 ? 0.055 : 0.02) << probes.size() << " probes";
    }
}

// What no probe sees throws on light without extent, whatever it is made of: as much as where a probe sees it, metals as if they were
// diffuse.
TEST_F(TriangleGathering, MetalsAndCoatsThatNoProbeSeesThrowOnABulb)
{
    struct Case
    {
        float base, metallic, roughness;
    };
    for (const Case& of : {Case{0.7f, 1.0f, 0.5f}, {0.9f, 1.0f, 0.6f}, {0.05f, 0.0f, 0.5f}, {0.5f, 0.0f, 0.6f}})
    {
        Scene scene; // a slab hides the bulb and the ceiling that it lights from the probe below
        MeshBuilder mesh(scene);
        const uint32_t white = mesh.material("white", vec3(0.8f), 1.0f), other = mesh.material("other", vec3(of.base), of.roughness);
        scene.materials[other].metallic = of.metallic;
        mesh.quad({-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, white);
        mesh.quad({-2, 3, -2}, {2, 3, -2}, {2, 3, 2}, {-2, 3, 2}, other);
        mesh.quad({-2, 0, -2}, {2, 0, -2}, {2, 3, -2}, {-2, 3, -2}, white);
        mesh.quad({-2, 0, -2}, {-2, 3, -2}, {-2, 3, 2}, {-2, 0, 2}, white);
        mesh.quad({2, 0, -2}, {2, 0, 2}, {2, 3, 2}, {2, 3, -2}, white);
        mesh.quad({-2, 0, 2}, {-2, 3, 2}, {2, 3, 2}, {2, 0, 2}, white);
        mesh.box(vec3(-1.5f, 1.9f, -1.5f), vec3(1.5f, 2.0f, 1.5f), mesh.material("black", vec3(0.0f), 1.0f));
        scene.lights.push_back(test::light(LightType::point, vec3(0.0f, 2.3f, 0.0f), vec3(0.0f, -1.0f, 0.0f), 10.0f));
        const vec3 below(0.1f, 1.0f, 0.2f), above(0.0f, 2.6f, 0.0f);
        double light[2] = {};
        for (const bool seen : {false, true})
            for (const Texel& texel : texelsOf(bake(scene, seen ? std::vector<vec3>{below, above} : std::vector<vec3>{below}, 1), 0))
                light[seen] += double(texel.light.g);
        const std::string name = "base " + std::to_string(of.base) + ", metallic " + std::to_string(of.metallic);
        RecordProperty(name, std::to_string(light[0] / light[1]));
        EXPECT_NEAR(light[0] / light[1], 1.0, 0.05) << name;
    }
}

// Rays that meet a lamp have met what is there of it: half of it is there, and half of the rays go on.
TEST_F(TriangleGathering, AHalfTransparentLampIsAsBrightNearAsFar)
{
    double light[2] = {};
    for (const bool blended : {false, true})
    {
        Scene scene;
        MeshBuilder mesh(scene);
        mesh.quad({-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, mesh.material("black", vec3(0.0f), 1.0f));
        const uint32_t lamp = mesh.emitter("lamp", vec3(blended ? 4.0f : 2.0f));
        scene.materials[lamp].blended = blended;
        scene.materials[lamp].baseColor.a = blended ? 0.5f : 1.0f;
        mesh.quad({-0.5f, 0.04f, -0.5f}, {0.5f, 0.04f, -0.5f}, {0.5f, 0.04f, 0.5f}, {-0.5f, 0.04f, 0.5f}, lamp);
        size_t count = 0;
        for (const Texel& texel : texelsOf(bake(scene, {vec3(0.0f, 0.02f, 0.0f)}, 0), 0))
            if (texel.normal.y > 0.9f && std::max(std::abs(texel.position.x), std::abs(texel.position.z)) < 0.4f)
                light[blended] += double(texel.light.g), ++count;
        EXPECT_GT(count, 5u);
        light[blended] /= double(std::max<size_t>(count, 1));
    }
    RecordProperty("ratio", std::to_string(light[1] / light[0]));
    EXPECT_NEAR(light[1] / light[0], 1.0, 0.05);
}

// The foot of a wall before which the sun lights a strip of ground, and nothing else: most rays leave the scene, and tell nothing of how
// far light is the same. The strip's form factor at a height is Howell's, "A Catalog of Radiation Heat Transfer Configuration Factors", B-5
// (infinite along).
TEST_F(TriangleGathering, LightOfAStripOfGroundIsNotBlendedUpTheWall)
{
    constexpr float kWide = 0.25f;
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t white = mesh.material("white", vec3(0.8f), 1.0f);
    mesh.quad({-6, 0, 0}, {6, 0, 0}, {6, 1.5f, 0}, {-6, 1.5f, 0}, white);
    mesh.quad({-6, 0, 0}, {6, 0, 0}, {6, 0, kWide}, {-6, 0, kWide}, white);
    scene.lights.push_back(test::light(LightType::directional, vec3(0.0f), vec3(0.0f, -1.0f, 0.0f), 10.0f));
    const FieldData field = bake(scene, {vec3(0.1f, 0.7f, 0.5f)}, 1);
    std::vector<double> ratios;
    for (const Texel& texel : texelsOf(field, 0))
    {
        const float height = texel.position.y;
        if (std::abs(texel.position.z) > 0.01f || std::abs(texel.position.x) > 1.0f || height < 0.02f || height > 0.6f) continue;
        ratios.push_back(texel.light.g / (0.5f * (1.0f - height / std::hypot(height, kWide))));
    }
    ASSERT_GT(ratios.size(), 100u);
    const double mean = std::accumulate(ratios.begin(), ratios.end(), 0.0) / double(ratios.size());
    double squares = 0.0;
    for (const double ratio : ratios) squares += (ratio / mean - 1.0) * (ratio / mean - 1.0);
    const double off = std::sqrt(squares / double(ratios.size()));
    RecordProperty("off", std::to_string(off));
    EXPECT_LT(off, 0.065); // found: 0.051; blended as far as all rays say, 0.099
}

TEST_F(TriangleGathering, RaysOfAnotherSceneAndTooManyTexelsAreRefused)
{
    Scene scene, other;
    MeshBuilder mesh(scene), otherMesh(other);
    mesh.box(vec3(-1.0f), vec3(1.0f), mesh.material("white", vec3(0.5f)));
    otherMesh.quad({0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, otherMesh.material("white", vec3(0.5f)));
    const auto rays = TriangleRays::build(other);
    BakeSettings settings;
    settings.rays = &*rays;
    const auto strange = bakeLightField(device.gpu(), scene, std::vector<vec3>{vec3(0.0f)}, settings, {}, report);
    ASSERT_FALSE(strange);
    EXPECT_EQ(strange.error().code, ErrorCode::badArgument);
    EXPECT_NE(strange.error().message.find("rays are of a scene of 2 triangles"), std::string::npos) << strange.error().message;
    settings.rays = nullptr;
    const auto many = bakeLightField(device.gpu(), scene, std::vector<vec3>(17000, vec3(0.0f)), settings, {}, report);
    ASSERT_FALSE(many);
    EXPECT_EQ(many.error().code, ErrorCode::badArgument);
    EXPECT_NE(many.error().message.find("275808000 texels"), std::string::npos) << many.error().message;
}

} // namespace
} // namespace sconce
