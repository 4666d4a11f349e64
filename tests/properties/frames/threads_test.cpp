// What the library promises of threads. Under the preset `tsan` they are watched, too.
#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include "runtime/bake/bake.h"
#include "runtime/field/light_field_file.h"
#include "runtime/sconce.h"
#include "scene/triangle_rays.h"
#include "tests/support/cornell_field.h"
#include "tests/support/device.h"
#include "tests/support/files.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr uint32_t kRays = 2000;
constexpr int kLoads = 8;

std::vector<gpu::Ray> someRays()
{
    const RaySet set = cornellRays(kRays);
    std::vector<gpu::Ray> rays(set.size());
    for (size_t i = 0; i < rays.size(); ++i) rays[i] = {set.origins[i], set.directions[i], set.normals[i]};
    return rays;
}

bool sameBits(const std::vector<gpu::RayHit>& a, const std::vector<gpu::RayHit>& b)
{
    return std::ranges::equal(std::as_bytes(std::span(a)), std::as_bytes(std::span(b)));
}

Result<FieldData> bakedBox(Gpu& gpu, const ExactRays& rays)
{
    BakeSettings settings;
    settings.resolution = 64;
    settings.bounces = 2;
    settings.surfaceTexels = 26;
    settings.surfaceRays = 8;
    settings.rays = &rays;
    settings.octree.voxels = 16;
    BakeReport report;
    return bakeLightField(gpu, rays.scene(), std::span(kCornellProbes).first(3), settings, {}, report);
}

/// Two devices share nothing: each bakes on a thread of its own, with the same rays, what one alone does.
TEST(Threads, TwoDevicesBakeTheSameBytesAtOnce)
{
    const TriangleRays rays = std::move(*TriangleRays::build(cornell().scene));
    std::array<std::unique_ptr<ValidatedDevice>, 2> devices{std::make_unique<ValidatedDevice>(), std::make_unique<ValidatedDevice>()};
    const auto bake = [&](size_t device) { return bakedBox(devices[device]->gpu(), rays); };
    const auto alone = bake(0);
    ASSERT_TRUE(alone) << alone.error().message;
    std::array<std::optional<Result<FieldData>>, 2> made;
    {
        std::jthread first([&] { made[0] = bake(0); });
        std::jthread second([&] { made[1] = bake(1); });
    }
    for (const auto& field : made)
    {
        ASSERT_TRUE(*field) << field->error().message;
        EXPECT_EQ((*field)->distance, alone->distance);
        EXPECT_EQ((*field)->radiance, alone->radiance);
        EXPECT_EQ((*field)->surfaceLight, alone->surfaceLight);
    }
}

/// A host with one queue: a thread loads fields while another asks rays of those that are there, and lets go of them.
TEST(Threads, FieldsLoadWhileOthersAreTraced)
{
    ValidatedDevice validated;
    const TestFolder folder;
    {
        const TriangleRays triangles = std::move(*TriangleRays::build(cornell().scene));
        const auto baked = bakedBox(validated.gpu(), triangles);
        ASSERT_TRUE(baked) << baked.error().message;
        ASSERT_TRUE(saveField(*baked, folder / "box.sconce"));
    }
    const std::vector<gpu::Ray> rays = someRays();

    HostVulkan host = validated.host();
    std::mutex queue;
    const auto submit = reinterpret_cast<PFN_vkQueueSubmit>(host.getInstanceProcAddr(host.instance, "vkQueueSubmit"));
    std::atomic<int> submits = 0;
    host.submit = [&](const VkSubmitInfo& info, VkFence fence)
    {
        const std::scoped_lock lock(queue);
        ++submits;
        return submit(host.queue, 1, &info, fence);
    };
    std::optional<Device> draws = *Device::create(host);
    std::optional<Device> loads = *draws->forThread();

    std::vector<gpu::RayHit> expected(rays.size()), hits(rays.size());
    const auto trace = [&](const LightField& field)
    {
        auto tracer = RayTracer::create(*draws, field);
        return tracer ? tracer->trace(rays, hits) : Status(tracer.error());
    };
    {
        const auto field = LightField::load(*draws, folder / "box.sconce");
        ASSERT_TRUE(field && trace(*field));
        expected = hits;
    }
    // Both threads have their staging from here on.
    ASSERT_TRUE(LightField::load(*loads, folder / "box.sconce"));
    const uint64_t before = draws->bytes();
    EXPECT_EQ(loads->bytes(), before) << "one budget";

    std::mutex handing;
    std::optional<LightField> newest;
    std::atomic<bool> done = false;
    std::string fault;
    std::jthread loader(
        [&]
        {
            for (int i = 0; i < kLoads && fault.empty(); ++i)
            {
                auto field = LightField::load(*loads, folder / "box.sconce");
                if (!field) fault = field.error().message;
                const std::scoped_lock lock(handing);
                if (field) newest = std::move(*field);
            }
            done = true;
        });
    int traced = 0, others = 0;
    // Once more after the last: this thread may have had no turn before.
    for (bool last = false; !last;)
    {
        last = done;
        std::optional<LightField> field;
        {
            const std::scoped_lock lock(handing);
            field = newest;
        }
        if (!field) continue;
        std::ranges::fill(hits, gpu::RayHit{});
        ASSERT_TRUE(trace(*field));
        ++traced;
        others += !sameBits(hits, expected);
    }
    loader.join();
    EXPECT_EQ(fault, "");
    EXPECT_GT(traced, 0);
    EXPECT_EQ(others, 0) << "of " << traced;
    EXPECT_GT(submits, traced);
    newest.reset();
    EXPECT_EQ(draws->bytes(), before);

    // The one that was first may go first: what they have in common stays.
    draws.reset();
    auto field = LightField::load(*loads, folder / "box.sconce");
    ASSERT_TRUE(field) << field.error().message;
    draws = std::move(loads);
    ASSERT_TRUE(trace(*field));
    EXPECT_TRUE(sameBits(hits, expected));
}

} // namespace
} // namespace sconce
