#include "bench/sweep/kept_fields.h"

#include <cmath>

#include <gtest/gtest.h>

#include "runtime/field/tracer_cpu.h"
#include "scene/builtin_scenes.h"
#include "tests/support/device.h"
#include "tests/support/files.h"

namespace sconce
{
namespace
{

PointSettings asked(const char* method)
{
    PointSettings settings;
    settings.method = method;
    settings.probes = 3;
    settings.resolution = 64;
    settings.lightResolution = 64;
    settings.surfaceTexels = 26;
    settings.surfaceRefined = 0.0f;
    return settings;
}

/// Of what surfaces reflect towards the probes, luminance.
double meanIrradiance(const FieldData& field)
{
    twin::LightFieldTwin<float> text(field, {});
    double sum = 0.0;
    for (size_t i = 0; i < field.irradiance.size(); i += 2) sum += double(text.luminance(text.unpackRadiance(field.irradiance[i])));
    return sum / double(field.irradiance.size() / 2);
}

class KeptFieldsTest : public testing::Test
{
protected:
    KeptFieldsTest()
    {
        for (const char* kind : {"cache/probes", "cache/fields"}) std::filesystem::create_directories(folder.path / kind);
    }
    FieldData fieldOf(const PointSettings& settings)
    {
        auto field = kept.fieldFor(settings, cost, {});
        if (!field) throw std::runtime_error(field.error().message);
        return std::move(*field);
    }

    testing_support::ValidatedDevice device;
    testing_support::TestFolder folder;
    Scene scene = *makeBuiltinScene("cornell-glossy");
    KeptFields kept{{device.gpu(), scene, folder.path, "device", "build"}};
    Json cost = Json::object();
};

// The same probes in the same light: octahedral maps differ from cube faces by their texels alone. Bounces by irradiance, which theirs were
// lit by, bring other light.
TEST_F(KeptFieldsTest, OpponentsMapsAreLitAsOursAre)
{
    const double ours = meanIrradiance(fieldOf(asked("ours")));
    const double bakedOurs = cost["bake_s"];
    const FieldData theirs = fieldOf(asked("b0plus-octree"));
    EXPECT_EQ(theirs.info.chart, gpu::kChartOctahedral);
    EXPECT_TRUE(theirs.surfaceLight.empty());
    EXPECT_NEAR(meanIrradiance(theirs), ours, 0.01 * ours);
    double spent = -bakedOurs;
    for (const auto& file : std::filesystem::directory_iterator(folder.path / "cache/fields"))
        if (file.path().extension() == ".json") spent += Json::parse(testing_support::readText(file.path()))["bake_s"].get<double>();
    EXPECT_NEAR(cost["bake_s"].get<double>(), spent, 1e-6 * spent) << "they pay for what lights them";
    PointSettings alone = asked("b0plus-octree");
    alone.surfaceTexels = 0;
    EXPECT_GT(std::abs(meanIrradiance(fieldOf(alone)) - ours), 0.03 * ours) << "there is something to tell";
}

// What is lent is scattered once more where it lights maps than what lends it: a bounce ahead, opponents' pictures would be too bright.
TEST_F(KeptFieldsTest, OpponentsMapsHaveAsManyBouncesAsOurs)
{
    for (const uint32_t bounces : {1u, 2u})
    {
        PointSettings ours = asked("ours"), theirs = asked("b0plus-octree");
        ours.bounces = theirs.bounces = bounces;
        const double mean = meanIrradiance(fieldOf(ours));
        EXPECT_NEAR(meanIrradiance(fieldOf(theirs)), mean, 0.01 * mean) << bounces << " bounces";
    }
}

TEST_F(KeptFieldsTest, AFieldIsBakedOnce)
{
    const FieldData first = fieldOf(asked("ours"));
    const std::string file = cost["field"];
    const auto written = std::filesystem::last_write_time(folder.path / file);
    cost = Json::object();
    const FieldData again = fieldOf(asked("ours"));
    EXPECT_EQ(cost["field"], file);
    EXPECT_EQ(std::filesystem::last_write_time(folder.path / file), written);
    EXPECT_EQ(again.radiance, first.radiance);
    EXPECT_EQ(again.surfaceLight, first.surfaceLight);
}

} // namespace
} // namespace sconce
