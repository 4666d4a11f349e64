// The GPU runs the same text as the CPU: the answers must agree ray by ray.
#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "runtime/field/light_field.h"
#include "runtime/field/tracer_cpu.h"
#include "runtime/vulkan/rays_a_lane.h"
#include "shaders/shared/field_passes.h"
#include "shaders/shared/pure.h"
#include "tests/support/cornell_field.h"
#include "tests/support/device.h"

namespace sconce
{
namespace
{

using namespace testing_support;

class GpuTrace : public DeviceTest
{
};

/// Seven probes with a radiance that differs from texel to texel.
FieldData litCornell()
{
    FieldData field = cornell().field;
    for (size_t i = 0; i < field.radiance.size(); ++i)
        field.radiance[i] = Pure<float>::packRadiance(vec3(float(i % 7), float(i % 11), float(i % 5)) * 0.25f);
    return field;
}

TEST_F(GpuTrace, AgreesWithTheCpuRayByRay)
{
    const FieldData field = litCornell();
    const RaySet set = cornellRays(20000);
    auto device = makeLightField(gpu(), field);
    ASSERT_TRUE(device) << device.error().message;
    auto tracer = makeRayTracer(gpu(), *device);
    ASSERT_TRUE(tracer) << tracer.error().message;
    std::vector<gpu::Ray> rays(set.size());
    for (size_t i = 0; i < rays.size(); ++i) rays[i] = {set.origins[i], set.directions[i], i % 2 == 0 ? set.normals[i] : glm::vec3(0.0f)};
    std::vector<gpu::RayHit> hits(rays.size());
    ASSERT_TRUE(tracer->trace(rays, hits));

    twin::LightFieldTwin<float> text(field, defaultQuality());
    size_t different = 0;
    for (size_t i = 0; i < rays.size(); ++i)
    {
        const gpu::RayHit cpu = text.queryRay(rays[i].origin, rays[i].direction, rays[i].normal);
        const gpu::RayHit& got = hits[i];
        if (cpu.status != got.status || cpu.probe != got.probe || cpu.handoffs != got.handoffs || cpu.distanceReads != got.distanceReads ||
            cpu.indexReads != got.indexReads || std::abs(cpu.t - got.t) > 2e-5f * cpu.t)
        {
            ++different;
            continue;
        }
        EXPECT_NEAR(glm::distance(vec3(cpu.radiance), vec3(got.radiance)), 0.0f, 1e-3f);
        EXPECT_NEAR(glm::distance(vec3(cpu.normal), vec3(got.normal)), 0.0f, 1e-4f);
    }
    EXPECT_LE(different, rays.size() / 2000) << "0.05 %: rays that graze a texel's corner may round to its other side";
}

bool hasBallots(const Gpu& gpu)
{
    VkPhysicalDeviceSubgroupProperties subgroups{};
    subgroups.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
    VkPhysicalDeviceProperties2 all{};
    all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    all.pNext = &subgroups;
    vkGetPhysicalDeviceProperties2(gpu.host.physicalDevice, &all);
    return (subgroups.supportedOperations & VK_SUBGROUP_FEATURE_BALLOT_BIT) != 0;
}

TEST_F(GpuTrace, RefilledLanesAnswerTheSameToTheBit)
{
    if (!hasBallots(gpu())) GTEST_SKIP() << "lanes can't be refilled";
    const FieldData field = litCornell();
    const RaySet set = cornellRays(20000);
    auto device = makeLightField(gpu(), field);
    ASSERT_TRUE(device) << device.error().message;
    std::vector<gpu::Ray> rays(200'077); // enough for two a lane, in no whole number of workgroups
    for (size_t i = 0; i < rays.size(); ++i)
        rays[i] = {set.origins[i % set.size()], set.directions[i % set.size()], set.normals[i % set.size()]};
    rays[7].direction = vec3(std::nanf("")); // ends before its first turn
    const auto tracedBy = [&](uint32_t raysALane)
    {
        gpu().raysALane = raysALane;
        std::vector<gpu::RayHit> hits(rays.size());
        auto tracer = makeRayTracer(gpu(), *device);
        EXPECT_TRUE(tracer && tracer->trace(rays, hits));
        return hits;
    };
    const auto plain = tracedBy(1);
    EXPECT_GT(std::ranges::count(plain, 1u, &gpu::RayHit::status), 140000) << "hits";
    const auto refilled = tracedBy(kMostRaysALane);
    EXPECT_EQ(std::memcmp(refilled.data(), plain.data(), plain.size() * sizeof(gpu::RayHit)), 0);
}

TEST_F(GpuTrace, OddRaysEndFinite)
{
    const FieldData field = litCornell();
    auto device = makeLightField(gpu(), field);
    auto tracer = makeRayTracer(gpu(), *device);
    const float nan = std::nanf(""), inf = INFINITY;
    std::vector<gpu::Ray> rays;
    for (float a : {0.0f, -0.0f, 1.0f, nan, inf, -inf, 1e-40f, 1e30f})
        for (float b : {0.0f, 1.0f, nan, inf}) rays.push_back({vec3(a, b, 0.5f), vec3(b, a, 0.0f), vec3(0.0f)});
    std::vector<gpu::RayHit> hits(rays.size());
    ASSERT_TRUE(tracer->trace(rays, hits));
    for (const gpu::RayHit& hit : hits)
        EXPECT_TRUE(std::isfinite(hit.t + hit.position.x + hit.position.y + hit.position.z + hit.normal.x + hit.radiance.x));
}

TEST_F(GpuTrace, AnswersAlikeThroughTexelsAndAddresses)
{
    if (gpu().properties.limits.maxTexelBufferElements < 1u << 20) GTEST_SKIP() << "texel buffers don't hold the field's words";
    const FieldData field = litCornell();
    std::vector<gpu::RayHit> hits[2];
    for (const WordAccess access : {WordAccess::texelBuffers, WordAccess::addresses})
    {
        const auto device = makeLightField(gpu(), field, {}, access);
        ASSERT_TRUE(device) << device.error().message;
        EXPECT_EQ((device->constants()[gpu::kFieldFlagsId] & gpu::kByTexels) != 0, access == WordAccess::texelBuffers);
        const auto tracer = makeRayTracer(gpu(), *device);
        const RaySet set = cornellRays(4000);
        std::vector<gpu::Ray> rays;
        for (size_t i = 0; i < set.size(); ++i) rays.push_back({set.origins[i], set.directions[i], set.normals[i]});
        std::vector<gpu::RayHit>& answers = hits[int(access)];
        answers.resize(rays.size());
        ASSERT_TRUE(tracer->trace(rays, answers));
    }
    EXPECT_EQ(std::memcmp(hits[0].data(), hits[1].data(), hits[0].size() * sizeof(gpu::RayHit)), 0);
}

// As one is baked that is only asked where rays end.
TEST_F(GpuTrace, AFieldWithoutRadianceOfAnyKindAnswersInBlack)
{
    FieldData field = litCornell();
    field.radiance.clear();
    field.prefiltered.clear();
    const RaySet set = cornellRays(1000);
    std::vector<gpu::Ray> rays;
    for (size_t i = 0; i < set.size(); ++i) rays.push_back({set.origins[i], set.directions[i], set.normals[i]});
    twin::LightFieldTwin<float> text(field, defaultQuality());
    for (const WordAccess access : {WordAccess::texelBuffers, WordAccess::addresses})
    {
        const auto device = makeLightField(gpu(), field, {}, access);
        ASSERT_TRUE(device) << device.error().message;
        const auto tracer = makeRayTracer(gpu(), *device);
        std::vector<gpu::RayHit> hits(rays.size());
        ASSERT_TRUE(tracer->trace(rays, hits));
        size_t met = 0;
        for (size_t i = 0; i < rays.size(); ++i)
        {
            EXPECT_EQ(vec3(hits[i].radiance), vec3(0.0f));
            EXPECT_EQ(vec3(text.queryRay(rays[i].origin, rays[i].direction, rays[i].normal).radiance), vec3(0.0f));
            met += hits[i].status == uint32_t(TraceStatus::hit);
        }
        EXPECT_GT(met, rays.size() / 2); // the box is open
    }
}

TEST_F(GpuTrace, RefusesKnobsOutOfRangeByName)
{
    Quality quality;
    quality.trace.ranked = 9;
    const auto field = makeLightField(gpu(), cornell().field, quality);
    ASSERT_FALSE(field);
    EXPECT_NE(field.error().message.find("ranked is 9"), std::string::npos);
}

TEST_F(GpuTrace, NoRaysIsNoWork)
{
    const FieldData field = litCornell();
    auto device = makeLightField(gpu(), field);
    auto tracer = makeRayTracer(gpu(), *device);
    EXPECT_TRUE(tracer->trace({}, {}));
}

} // namespace
} // namespace sconce
