// Texels of fewer bits: what is rounded, that chains still bound it, and that rays get no better.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "bench/race/distance_format.h"
#include "bench/race/traced_method.h"
#include "runtime/field/quality.h"
#include "runtime/field/tracer_cpu.h"
#include "tests/support/cornell_field.h"

namespace sconce
{
namespace
{

using namespace testing_support;

TraceScore scoreOf(const FieldData& field)
{
    const RaySet set = cornellRays(10000);
    twin::LightFieldTwin<float> text(field, defaultQuality());
    std::vector<gpu::RayHit> hits;
    for (size_t i = 0; i < set.size(); ++i) hits.push_back(text.queryRay(set.origins[i], set.directions[i], set.normals[i]));
    return scoreTraces(set, tracedRays(hits));
}

TEST(DistanceFormat, RoundsEachPartByAtMostHalfAStep)
{
    const FieldData& faces = cornell().field;
    twin::LightFieldTwin<double> text(faces, {});
    const size_t texels = size_t(faces.info.faceSize) * faces.info.faceSize;
    for (const DistanceFormat& format : distanceFormats())
    {
        const Result<FieldData> narrow = narrowedField(faces, format.bits);
        ASSERT_TRUE(narrow) << narrow.error().message;
        const double qStep = std::ldexp(1.0, 6 - format.q); // of a half's 10 bits, relative
        const double side = double((1 << std::max(format.gradient - 1, 0)) - 1);
        for (size_t face = 0; face < 6 * faces.probes.size(); ++face)
            for (size_t i = 0; i < texels; ++i)
            {
                const uint32_t was = faces.distance[face * (faces.info.wordsPerProbe / 6) + i];
                const uint32_t is = narrow->distance[face * (faces.info.wordsPerProbe / 6) + i];
                ASSERT_EQ((was & 0xffffu) == 0, (is & 0xffffu) == 0) << "sky stays sky, and nothing else becomes it";
                ASSERT_NEAR(text.halfToReal(is), text.halfToReal(was), 0.5 * qStep * text.halfToReal(was) + 1e-12);
                const double share = double(int8_t(was >> 24)) / 127.0, got = double(int8_t(is >> 24)) / 127.0;
                if (format.gradient == 0)
                    ASSERT_EQ(is >> 16, 0u);
                else
                    ASSERT_NEAR(got, share, 0.5 / side + 0.5 / 127.0);
            }
    }
}

TEST(DistanceFormat, ChainsBoundWhatWasRounded)
{
    const Result<FieldData> narrow = narrowedField(cornell().field, 12);
    ASSERT_TRUE(narrow);
    // The same answers whether coarse levels are used or not.
    gpu::TraceQuality fine = defaultQuality(), coarse = fine;
    fine.startLevel = fine.coarsestLevel = 0;
    const RaySet set = cornellRays(3000);
    twin::LightFieldTwin<float> without(*narrow, fine), with(*narrow, coarse);
    for (size_t i = 0; i < set.size(); ++i)
    {
        const gpu::RayHit a = without.queryRay(set.origins[i], set.directions[i], set.normals[i]);
        const gpu::RayHit b = with.queryRay(set.origins[i], set.directions[i], set.normals[i]);
        EXPECT_EQ(a.status, b.status) << i;
        EXPECT_NEAR(a.t, b.t, 1e-3 * (1.0 + a.t)) << i;
    }
}

TEST(DistanceFormat, PlanesAreWorthTheirBits)
{
    const TraceScore ours = scoreOf(cornell().field);
    double before = ours.right1 + 0.002; // rounding may help a ray or two
    for (const int bits : {24, 16, 12})
    {
        const Result<FieldData> narrow = narrowedField(cornell().field, bits);
        ASSERT_TRUE(narrow);
        const TraceScore score = scoreOf(*narrow);
        EXPECT_LT(score.right1, before + 0.002) << bits;
        before = score.right1;
    }
    EXPECT_LT(before, ours.right1 - 0.01) << "flat texels of 12 bits must show";
}

TEST(DistanceFormat, SaysWhatThereIsAndWhatItSaves)
{
    const FieldData& faces = cornell().field;
    const Result<FieldData> none = narrowedField(faces, 17);
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("32, 24, 20, 16, 12"), std::string::npos) << none.error().message;
    EXPECT_EQ(bytesSaved(faces, 32), 0u);
    EXPECT_EQ(bytesSaved(faces, 16), uint64_t(2) * 6 * faces.info.faceSize * faces.info.faceSize * faces.probes.size());
}

} // namespace
} // namespace sconce
