// Grids and volumes are lit by their eight corners, with the weights of the papers: each pixel of a frame against those formulas in double.
#include <bit>
#include <cmath>
#include <numbers>

#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include "base/random.h"
#include "bench/opponents/baselines.h"
#include "bench/opponents/irradiance_volume.h"
#include "runtime/field/tracer_cpu.h"
#include "scene/mesh_builder.h"
#include "shaders/shared/brdf.h"
#include "tests/properties/frames/frame_test.h"

namespace sconce
{
namespace
{

using namespace testing_support;
using glm::dvec3;

constexpr double kMean = 0.6, kSpread = 0.04; // of the distances that every probe is told to see, metres and their square
const ProbeGrid kGrid{glm::ivec3(2), vec3(-0.6f), vec3(1.2f)};

double colourOf(int corner)
{
    return 1.0 + corner;
}

/// McGuire et al. 2017, supplement.
double weight2017(dvec3 x, dvec3 n, dvec3 centre, double trilinear)
{
    const double d = glm::distance(x, centre);
    double w = trilinear * std::max(0.05, glm::dot((centre - x) / d, n));
    if (d > kMean) w *= kSpread / (kSpread + (d - kMean) * (d - kMean));
    return std::max(w, 0.0002);
}

/// Majercik et al. 2019, section 4, with the bias and the crushed tail of 2021.
double weight2021(dvec3 x, dvec3 biased, dvec3 n, dvec3 centre, double trilinear)
{
    const double d = glm::distance(biased, centre), wrap = 0.5 * (glm::dot(glm::normalize(centre - x), n) + 1.0);
    double w = wrap * wrap + 0.2;
    if (d > kMean) w *= std::max(std::pow(kSpread / (kSpread + (d - kMean) * (d - kMean)), 3.0), 0.05);
    if (w < 0.2) w *= w * w / 0.04;
    return w * trilinear;
}

/// Majercik et al. 2019 and 2021 without what is ours: the cell is the moved point's.
double weightOfVolume(dvec3 x, dvec3 moved, dvec3 n, dvec3 centre)
{
    const double d = glm::distance(moved, centre), wrap = 0.5 * (glm::dot(glm::normalize(centre - x), n) + 1.0);
    double w = wrap * wrap + 0.2;
    if (d > kMean) w *= std::max(std::pow(kSpread / (kSpread + (d - kMean) * (d - kMean)), 3.0), 0.05);
    return w < 0.2 ? w * w * w / 0.04 : w;
}

double trilinear(dvec3 point, int corner, double least)
{
    double product = 1.0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double alpha = std::clamp((point[axis] + 0.6) / 1.2, 0.0, 1.0), part = (corner >> axis) & 1 ? alpha : 1.0 - alpha;
        product *= std::max(part, least);
    }
    return product;
}

class GridLightTest : public FrameTest
{
protected:
    GridLightTest()
    {
        MeshBuilder mesh(scene);
        mesh.box(vec3(-1.0f), vec3(1.0f), mesh.material("wall", vec3(0.5f)));
        scene.cameras.push_back({"inside", {0.2f, 0.1f, -0.15f}, {0, 0, -1}, {0, 1, 0}, 1e-3f});
        for (int i = 0; i < 8; ++i) probes.push_back(kGrid.origin + kGrid.step * vec3(i & 1, (i >> 1) & 1, i >> 2));
        settings.effects = {.diffuse = true, .rough = false, .glossy = false, .mirror = false, .denoise = false};
    }

    /// Frames through a telescope: the filter over the picture has one point's light to blend.
    /// @param blend  (point, normal, view) -> the cosine-weighted mean of the radiance that arrives
    template <class Blend> void lookAround(const FieldData& field, std::string_view what, const Blend& blend)
    {
        Camera& camera = scene.cameras.front();
        Random random(2, 3);
        for (int look = 0; look < 24; ++look)
        {
            camera.forward = random.direction();
            camera.up = glm::normalize(glm::cross(camera.forward, glm::cross(vec3(0.1f, 1.0f, 0.2f), camera.forward)));
            const auto frame = drawWith(field, scene, settings);
            ASSERT_TRUE(frame) << frame.error().message;
            const size_t pixel = 4 * 8 + 4;
            const dvec3 n = frame->normal[pixel], view = -dvec3(camera.forward);
            const dvec3 point = dvec3(camera.eye) + double(frame->depth[pixel]) * dvec3(camera.forward);
            const BrdfLobes lobes = lobesAt({vec3(0.5f), 0.0f, 1.0f}, float(glm::dot(n, view)));
            const double expected = lobes.diffuse.g * blend(point, n, view);
            EXPECT_NEAR(frame->diffuseIndirect[pixel].g, expected, 0.02 * expected) << what << ", look " << look;
        }
    }

    Scene scene;
    std::vector<vec3> probes;
    RenderSettings settings = settingsOf(8);
};

TEST_F(GridLightTest, EachPixelIsThePapersBlendOfEightCorners)
{
    BakeSettings bake;
    bake.resolution = 64;
    bake.chart = gpu::kChartOctahedral;
    bake.bounces = 0;
    bake.grid = kGrid;
    auto field = bakeOnce(scene, probes, bake);
    ASSERT_TRUE(field) << field.error().message;
    twin::LightFieldTwin<float> text(*field, {});
    const double unit = field->info.scale;
    for (size_t i = 0; i < field->irradiance.size(); i += 2)
    {
        field->irradiance[i] = text.packRadiance(vec3(float(colourOf(int(i / (2 * gpu::kIrradianceSize * gpu::kIrradianceSize))))));
        field->irradiance[i + 1] = text.realToHalf(float(kMean / unit)) | (text.realToHalf(float(kSpread / (unit * unit))) << 16);
    }
    struct Look
    {
        Baseline baseline;
        float bias, view; // metres along the normal, times as far to the viewer
    };
    for (const Look& look : {Look{Baseline::b0, 0.1f, 1.0f}, {Baseline::b0Plus, 0.1f, 1.0f}, {Baseline::b0Plus, 0.05f, 4.0f}})
    {
        const Baseline baseline = look.baseline;
        settings.lightShaders = lightPasses(baseline, look.bias, look.view);
        lookAround(*field, baselineName(baseline),
                   [&](dvec3 point, dvec3 n, dvec3 view)
                   {
                       double sum = 0.0, weights = 0.0;
                       for (int i = 0; i < 8; ++i)
                       {
                           const dvec3 centre(probes[size_t(i)]), biased = point + double(look.bias) * (n + double(look.view) * view);
                           const double w = baseline == Baseline::b0 ? weight2017(point, n, centre, trilinear(point, i, 0.0))
                                                                     : weight2021(point, biased, n, centre, trilinear(biased, i, 0.001));
                           sum += w * colourOf(i), weights += w;
                       }
                       return sum / weights;
                   });
    }
}

constexpr double kBias = 0.15;
constexpr int kSolid = 5; // the corner that stands in a solid

/// Half floats.
uint32_t words(double low, double high)
{
    return glm::packHalf2x16({float(low), float(high)});
}

TEST_F(GridLightTest, EachPixelIsTheVolumesPublishedBlend)
{
    FieldData field = bareGrid(scene, kGrid);
    const double unit = field.info.scale;
    const uint32_t bias = std::bit_cast<uint32_t>(float(kBias / unit));
    field.irradiance = {bias, bias};
    for (int i = 0; i < 8; ++i)
    {
        const double encoded = std::pow(colourOf(i), 0.2);
        for (uint32_t t = 0; t < gpu::kDdgiIrradianceSide * gpu::kDdgiIrradianceSide; ++t)
            field.irradiance.insert(field.irradiance.end(),
                                    {words(encoded, encoded), words(encoded, i == kSolid ? 0.0 : gpu::kVolumeValid)});
        for (uint32_t t = 0; t < gpu::kDdgiDistanceSide * gpu::kDdgiDistanceSide; ++t)
            field.irradiance.push_back(words(kMean / unit, (kMean * kMean + kSpread) / (unit * unit)));
    }
    settings.lightShaders.gather = volumePass(Volume::ddgi);
    lookAround(field, "ddgi",
               [&](dvec3 point, dvec3 n, dvec3 view)
               {
                   const dvec3 moved = point + kBias * (n + view);
                   double sum = 0.0, weights = 0.0;
                   for (int i = 0; i < 8; ++i)
                   {
                       if (i == kSolid) continue;
                       const double w = trilinear(moved, i, 0.001) * weightOfVolume(point, moved, n, dvec3(probes[size_t(i)]));
                       sum += w * std::sqrt(colourOf(i)), weights += w;
                   }
                   return sum * sum / (weights * weights);
               });

    // Harmonics: a constant that differs from corner to corner, and all of them brighter towards -z.
    field.irradiance = {bias, bias};
    for (int i = 0; i < 8; ++i)
    {
        double halves[28] = {};
        for (int channel = 0; channel < 3; ++channel) halves[channel] = colourOf(i), halves[6 + channel] = -0.4;
        halves[27] = i == kSolid ? 0.0 : gpu::kVolumeValid;
        for (int w = 0; w < 14; ++w) field.irradiance.push_back(words(halves[2 * w], halves[2 * w + 1]));
    }
    settings.lightShaders.gather = volumePass(Volume::sh);
    lookAround(field, "sh-grid",
               [&](dvec3 point, dvec3 n, dvec3 view)
               {
                   const dvec3 moved = point + kBias * (n + view);
                   double sum = 0.0, weights = 0.0;
                   for (int i = 0; i < 8; ++i)
                   {
                       if (i == kSolid) continue;
                       const double w = trilinear(moved, i, 0.0);
                       sum += w * (0.5 * std::sqrt(1.0 / std::numbers::pi) * colourOf(i) - 0.4 * std::sqrt(0.75 / std::numbers::pi) * n.z);
                       weights += w;
                   }
                   return sum / weights;
               });
}

} // namespace
} // namespace sconce
