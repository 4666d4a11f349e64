// One text, three machines: float against double on the CPU, and the device against float.
#include <string_view>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "runtime/field/light_field.h"
#include "tests/properties/hard_cases/hard_case.h"
#include "tests/properties/hard_cases/hard_scenes.h"
#include "tests/properties/hard_cases/walk.h"
#include "tests/support/device.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr uint32_t kRays = 10000;

class Precision : public testing::TestWithParam<const char*>
{
};

TEST_P(Precision, FloatAnswersLikeDouble)
{
    const auto scene = hardScene(GetParam());
    if (!scene) GTEST_SKIP() << "the scene " << GetParam() << " is missing; set SCONCE_SCENES";
    const RaySet set = glossyRaysOf(*scene, kRays);
    const gpu::LightFieldInfo& info = scene->field.info;
    const auto rounded = [&](vec3 p) // where float puts a ray's start in the field, in metres again
    { return glm::dvec3((p - vec3(info.origin)) / info.scale) * double(info.scale) + glm::dvec3(info.origin); };
    Walk<float> single(scene->field, defaultQuality());
    Walk<double> oracle(scene->field, defaultQuality());
    size_t status = 0, far = 0, own = 0;
    for (size_t i = 0; i < set.size(); ++i)
    {
        double t = 0.0, tRounded = 0.0;
        const TracedRay a = single.trace(set.origins[i], set.directions[i]);
        const TracedRay b = oracle.trace(glm::dvec3(set.origins[i]), glm::dvec3(set.directions[i]), &t);
        const TracedRay c = oracle.trace(rounded(set.origins[i]), glm::dvec3(set.directions[i]), &tRounded);
        status += a.status != b.status;
        // of an unknown, t is only the last point reached
        far += a.status == b.status && a.status == TraceStatus::hit && std::abs(double(a.t) - t) > 1e-4 * t;
        own += a.status != c.status || (a.status == TraceStatus::hit && std::abs(double(a.t) - tRounded) > 1e-4 * tRounded);
    }
    const std::string name = std::string("float against double, ") + GetParam();
    // Found: five rays in the town, two in Sponza, none elsewhere.
    const double most = std::string_view(GetParam()) == "town" ? 0.0005 : kHardlyAny;
    expectAtMost(name + ": share of another status", set.size(), double(status) / kRays, kHardlyAny);
    expectAtMost(name + ": share with t off by over 1e-4", set.size(), double(far) / kRays, most);
    expectAtMost(name + " from the start that float has: share of another status or t", set.size(), double(own) / kRays, 0.0001);
    expectAtMost(name + ": rays stopped by the limit, in all three", 3 * set.size(), double(single.limitReached + oracle.limitReached),
                 0.0);
    expectAtMost(name + ": t falls outside a second opinion, in all three", 3 * set.size(),
                 double(single.fallsOutsideOpinions + oracle.fallsOutsideOpinions), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Precision, testing::Values("cornell", "temple", "curtains", "town", "sponza"),
                         [](const auto& scene) { return std::string(scene.param); });

/// By the order in which probes are asked: gpu::kOrder...
class PrecisionOnDevice : public DeviceTest, public testing::WithParamInterface<int>
{
};

TEST_P(PrecisionOnDevice, AnswersLikeFloatOnTheCpu)
{
    const auto scene = hardScene("curtains");
    FieldData& field = scene->field;
    field.irradiance.assign(size_t(field.info.probeCount) * kIrradianceWordsPerProbe, 0);
    const RaySet set = glossyRaysOf(*scene, kRays);
    Quality quality;
    quality.trace.order = GetParam();
    auto device = makeLightField(gpu(), field, quality);
    ASSERT_TRUE(device) << device.error().message;
    auto tracer = makeRayTracer(gpu(), *device);
    ASSERT_TRUE(tracer) << tracer.error().message;
    std::vector<gpu::Ray> rays(set.size());
    for (size_t i = 0; i < rays.size(); ++i) rays[i] = {set.origins[i], set.directions[i], i % 2 == 0 ? set.normals[i] : glm::vec3(0.0f)};
    std::vector<gpu::RayHit> hits(rays.size());
    ASSERT_TRUE(tracer->trace(rays, hits));
    twin::LightFieldTwin<float> text(field, quality.trace);
    size_t integers = 0, far = 0;
    for (size_t i = 0; i < rays.size(); ++i)
    {
        const gpu::RayHit cpu = text.queryRay(rays[i].origin, rays[i].direction, rays[i].normal);
        const bool same = cpu.status == hits[i].status && cpu.probe == hits[i].probe && cpu.handoffs == hits[i].handoffs &&
                          cpu.distanceReads == hits[i].distanceReads && cpu.indexReads == hits[i].indexReads;
        integers += !same;
        far += same && std::abs(cpu.t - hits[i].t) > 2e-5f * cpu.t;
    }
    const std::string name = fmt::format("device against float, curtains{}", GetParam() == 0 ? "" : fmt::format(", order {}", GetParam()));
    expectAtMost(name + ": share with another integer", rays.size(), double(integers) / kRays, kHardlyAny, 0.0);
    expectAtMost(name + ": share with t off by over 2e-5", rays.size(), double(far) / kRays, kHardlyAny, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Orders, PrecisionOnDevice,
                         testing::Values(gpu::kOrderRanked, gpu::kOrderParallel, gpu::kOrderBehind, gpu::kOrderNearestLine));

} // namespace
} // namespace sconce
