// The door: handles that keep alive what they need.
#include "runtime/sconce.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include <gtest/gtest.h>

#include "runtime/bake/bake.h"
#include "runtime/field/light_field.h"
#include "runtime/field/light_field_file.h"
#include "runtime/frame/indirect_light.h"
#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"
#include "scene/triangle_rays.h"
#include "tests/support/device.h"
#include "tests/support/files.h"

namespace sconce
{
namespace
{

using testing_support::TestFolder;
using testing_support::ValidatedDevice;

class Door : public testing::Test
{
protected:
    static void SetUpTestSuite()
    {
        folder = new TestFolder;
        ValidatedDevice owner;
        const auto device = Device::create(owner.host());
        ASSERT_TRUE(device) << device.error().message;
        const auto scene = makeBuiltinScene("cornell-glossy");
        ASSERT_TRUE(scene);
        const std::vector<vec3> probes = {{0.0f, 1.0f, 0.0f}, {0.3f, 0.5f, 0.3f}};
        BakeDesc desc;
        desc.resolution = 64;
        desc.bounces = 1;
        const Status baked = bakeLightField(*device, *scene, probes, desc, file());
        ASSERT_TRUE(baked) << baked.error().message;
    }
    static void TearDownTestSuite() { delete folder; }
    static std::string file() { return *folder / "field.sconce"; }

    static std::vector<gpu::Ray> rays(uint32_t count, float turn)
    {
        std::vector<gpu::Ray> made(count);
        for (uint32_t i = 0; i < count; ++i)
        {
            const float angle = turn + 0.1f * float(i);
            made[i] = {vec3(0.0f, 1.0f, 0.0f), glm::normalize(vec3(std::cos(angle), 0.3f * std::sin(3.0f * angle), std::sin(angle))),
                       vec3(0.0f)};
        }
        return made;
    }

    static TestFolder* folder;
};
TestFolder* Door::folder = nullptr;

TEST_F(Door, BakesTheBytesOfTheBakeBehindIt)
{
    ValidatedDevice owner;
    auto scene = makeBuiltinScene("cornell-glossy");
    ASSERT_TRUE(scene);
    const auto plan = planEffects(checkScene(*scene));
    ASSERT_TRUE(plan);
    BakeSettings settings;
    settings.resolution = 64;
    settings.bounces = 1;
    settings.take(*plan);
    BakeReport report;
    const std::vector<vec3> probes = {{0.0f, 1.0f, 0.0f}, {0.3f, 0.5f, 0.3f}};
    const auto field = bakeLightField(owner.gpu(), *scene, probes, settings, {}, report);
    ASSERT_TRUE(field) << field.error().message;
    ASSERT_TRUE(saveField(*field, *folder / "behind.sconce"));
    EXPECT_EQ(testing_support::readText(*folder / "behind.sconce"), testing_support::readText(file()));
}

// The rays are a host's own, of its scene, in which the lamp still shines.
TEST_F(Door, EmittersThatAreLeftOutShineThroughNoRays)
{
    ValidatedDevice owner;
    const auto device = Device::create(owner.host());
    ASSERT_TRUE(device);
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.quad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}, mesh.material("floor", vec3(0.5f)));
    mesh.quad({9.5f, 16, -0.5f}, {10.5f, 16, -0.5f}, {10.5f, 16, 0.5f}, {9.5f, 16, 0.5f}, mesh.emitter("lamp", vec3(2000.0f)));
    const auto rays = TriangleRays::build(scene);
    ASSERT_TRUE(rays);
    BakeDesc desc;
    desc.resolution = 64;
    desc.bounces = 1;
    desc.rays = &*rays;
    const std::vector<vec3> probes = {{0.0f, 1.0f, 0.0f}};
    for (const char* effects : {"auto", "auto,-emitters"})
    {
        desc.effects = effects;
        const Status baked = bakeLightField(*device, scene, probes, desc, *folder / "rays.sconce");
        ASSERT_TRUE(baked) << baked.error().message;
        const auto field = loadField(*folder / "rays.sconce");
        ASSERT_TRUE(field);
        const bool shines = desc.effects == "auto";
        EXPECT_EQ(std::ranges::any_of(field->lamps, [](const gpu::Lamp& lamp) { return lamp.radiance != vec3(0.0f); }), shines);
        uint32_t light = 0;
        for (size_t i = 0; i < field->irradiance.size(); i += 2) light |= field->irradiance[i];
        EXPECT_EQ(light != 0, shines);
    }
}

TEST_F(Door, AsManyHitsAsRaysAreTraced)
{
    ValidatedDevice owner;
    const auto device = Device::create(owner.host());
    ASSERT_TRUE(device);
    const auto field = LightField::load(*device, file());
    ASSERT_TRUE(field);
    const auto tracer = RayTracer::create(*device, *field);
    ASSERT_TRUE(tracer);
    std::vector<gpu::RayHit> hits(9);
    const Status status = tracer->trace(rays(10, 0.0f), hits);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ErrorCode::badArgument);
}

TEST_F(Door, HandlesOutliveWhatTheyWereMadeFrom)
{
    ValidatedDevice owner;
    std::optional<RayTracer> tracer;
    std::optional<IndirectLight> light;
    std::vector<gpu::RayHit> before(50), after(50);
    {
        auto device = Device::create(owner.host());
        ASSERT_TRUE(device) << device.error().message;
        auto field = LightField::load(*device, file());
        ASSERT_TRUE(field) << field.error().message;
        auto madeTracer = RayTracer::create(*device, *field);
        ASSERT_TRUE(madeTracer);
        ASSERT_TRUE(madeTracer->trace(rays(50, 0.0f), before));
        tracer = *madeTracer;
        auto madeLight = IndirectLight::create(*device, *field, {.width = 16, .height = 16, .effects = field->effectsOfFrames()});
        ASSERT_TRUE(madeLight) << madeLight.error().message;
        light.emplace(std::move(*madeLight));
        LightField moved = std::move(*field); // what a tracer or a frame keeps doesn't follow the handle
        EXPECT_EQ(moved.info().probeCount, 2u);
    }
    ASSERT_TRUE(tracer->trace(rays(50, 0.0f), after));
    for (size_t i = 0; i < before.size(); ++i) EXPECT_EQ(before[i].t, after[i].t) << i;
    EXPECT_NE(light->glossy().view, VkImageView{});
    const auto submitted = light->state().gpu->submit([&](VkCommandBuffer) {});
    EXPECT_TRUE(submitted);
}

// Two records in one command buffer, with other rays, hits and counts: the first must not get the second's.
TEST_F(Door, RecordsOfOneTracerDoNotDisturbEachOther)
{
    ValidatedDevice owner;
    const auto device = Device::create(owner.host());
    ASSERT_TRUE(device);
    const auto field = LightField::load(*device, file());
    ASSERT_TRUE(field);
    const auto tracer = RayTracer::create(*device, *field);
    ASSERT_TRUE(tracer);
    Gpu& gpu = device->gpu();
    const uint32_t counts[2] = {70, 130};
    std::vector<gpu::Ray> asked[2] = {rays(70, 0.0f), rays(130, 1.0f)};
    std::vector<gpu::RayHit> alone[2], together[2];
    Buffer rayBuffers[2], hitBuffers[2];
    for (int i = 0; i < 2; ++i)
    {
        alone[i].resize(counts[i]), together[i].resize(counts[i]);
        ASSERT_TRUE(tracer->trace(asked[i], alone[i]));
        auto in = gpu.makeBufferWith<gpu::Ray>(asked[i], 0, "rays");
        auto out = gpu.makeBuffer(counts[i] * sizeof(gpu::RayHit), 0, MemoryUse::device, "hits");
        ASSERT_TRUE(in && out);
        rayBuffers[i] = std::move(*in), hitBuffers[i] = std::move(*out);
    }
    ASSERT_TRUE(gpu.submit(
        [&](VkCommandBuffer cmd)
        {
            for (int i = 0; i < 2; ++i) tracer->record(cmd, rayBuffers[i].address(), hitBuffers[i].address(), counts[i]);
        }));
    for (int i = 0; i < 2; ++i)
    {
        ASSERT_TRUE(gpu.download(hitBuffers[i], 0, std::as_writable_bytes(std::span(together[i]))));
        EXPECT_EQ(std::memcmp(alone[i].data(), together[i].data(), counts[i] * sizeof(gpu::RayHit)), 0) << i;
    }
}

TEST_F(Door, ABakeIsAsItsDescSays)
{
    ValidatedDevice owner;
    const auto device = Device::create(owner.host());
    ASSERT_TRUE(device);
    const auto scene = makeBuiltinScene("cornell-glossy");
    ASSERT_TRUE(scene);
    const std::vector<vec3> probes = {{0.0f, 1.0f, 0.0f}};
    BakeDesc desc;
    desc.resolution = 64;
    desc.bounces = 0;
    desc.compact = true;
    desc.surfaceTexels = 26;
    desc.surfaceRays = 8;
    const auto rays = TriangleRays::build(*scene);
    ASSERT_TRUE(rays);
    desc.rays = &*rays;
    desc.surfaceRefined = 0.1f;
    desc.lampTexels = 512;
    const std::string at = *folder / "asked.sconce";
    ASSERT_TRUE(bakeLightField(*device, *scene, probes, desc, at));
    auto field = loadField(at);
    ASSERT_TRUE(field) << field.error().message;
    EXPECT_EQ(field->info.surfaceSize, 26u);
    EXPECT_TRUE(inBlocks(field->info));
    EXPECT_NEAR(field->info.refinedTexels, 0.1f * 6 * 26 * 26, 1.0f);
    for (const gpu::Lamp& lamp : field->lamps) EXPECT_EQ(lamp.size, 512u);
    desc.surfaceRays = 2000;
    EXPECT_NE(bakeLightField(*device, *scene, probes, desc, at).error().message.find("surfaceRays"), std::string::npos);
    desc.surfaceRays = 8;
    desc.compact = false;
    desc.surfaceTexels = 0;
    ASSERT_TRUE(bakeLightField(*device, *scene, probes, desc, at));
    field = loadField(at);
    ASSERT_TRUE(field) << field.error().message;
    EXPECT_EQ(field->info.surfaceSize, 0u);
    EXPECT_FALSE(inBlocks(field->info));
    desc.surfaceTexels = 27;
    const Status refused = bakeLightField(*device, *scene, probes, desc, at);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::badArgument);
    EXPECT_NE(refused.error().message.find("surfaceTexels"), std::string::npos) << refused.error().message;
}

// A host's own scene: what is wrong with it is said before anything reads it.
TEST_F(Door, ASceneThatIsNotWholeIsRefused)
{
    ValidatedDevice owner;
    const auto device = Device::create(owner.host());
    ASSERT_TRUE(device);
    auto scene = makeBuiltinScene("cornell-glossy");
    ASSERT_TRUE(scene);
    scene->triangles[3].x = 1u << 30;
    const std::vector<vec3> probes = {{0.0f, 1.0f, 0.0f}};
    for (const char* effects : {"auto", "glossy"})
    {
        BakeDesc desc;
        desc.effects = effects;
        const Status refused = bakeLightField(*device, *scene, probes, desc, *folder / "none.sconce");
        ASSERT_FALSE(refused) << effects;
        EXPECT_EQ(refused.error().code, ErrorCode::badInput) << refused.error().message;
        EXPECT_NE(refused.error().message.find("riangle 3"), std::string::npos) << refused.error().message;
    }
    BakeReport report;
    const auto refused = bakeLightField(device->gpu(), *scene, probes, BakeSettings{}, {}, report);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::badInput) << refused.error().message;
}

// A lamp and the sky, each of which a host switches: in the command buffer in which it is recorded, at the rays that are traced after it.
TEST_F(Door, LightGroupsAreSwitchedInTheFrameThatRecordsIt)
{
    ValidatedDevice owner;
    const auto device = Device::create(owner.host());
    ASSERT_TRUE(device);
    auto scene = makeBuiltinScene("cornell-glossy");
    ASSERT_TRUE(scene);
    scene->sky = vec3(0.5f);
    BakeDesc desc;
    desc.resolution = 64;
    desc.bounces = 1;
    desc.groups = {{"lamp", {"emitters"}}, {"sky", {"sky"}}};
    const std::string grouped = *folder / "grouped.sconce";
    const std::vector<vec3> probes = {{0.0f, 1.0f, 0.0f}, {0.3f, 0.5f, 0.3f}};
    const Status baked = bakeLightField(*device, *scene, probes, desc, grouped);
    ASSERT_TRUE(baked) << baked.error().message;
    const auto field = LightField::load(*device, grouped);
    ASSERT_TRUE(field) << field.error().message;
    const auto other = LightField::load(*device, file());
    ASSERT_TRUE(other);
    EXPECT_FALSE(LightGroups::load(*device, *field, file()));
    EXPECT_FALSE(LightGroups::load(*device, *other, grouped)) << "of another field";
    auto brighter = loadField(grouped); // of as many probes at the same places
    ASSERT_TRUE(brighter);
    brighter->irradiance[0] ^= 1u;
    const std::string again = *folder / "again.sconce";
    ASSERT_TRUE(saveField(*brighter, again));
    const auto another = LightGroups::load(*device, *field, again);
    ASSERT_FALSE(another);
    EXPECT_NE(another.error().message.find("of another bake"), std::string::npos) << another.error().message;
    const auto streamed = LightField::load(*device, grouped, {}, 1);
    ASSERT_TRUE(streamed) << streamed.error().message;
    EXPECT_FALSE(LightGroups::load(*device, *streamed, again)) << "of another bake";
    EXPECT_TRUE(LightGroups::load(*device, *streamed, grouped));
    auto groups = LightGroups::load(*device, *field, grouped);
    ASSERT_TRUE(groups) << groups.error().message;
    EXPECT_EQ(groups->names(), (std::vector<std::string>{"lamp", "sky"}));
    EXPECT_EQ(groups->set(std::vector<vec3>{vec3(1.0f)}).error().code, ErrorCode::badArgument);

    const auto tracer = RayTracer::create(*device, *field);
    ASSERT_TRUE(tracer);
    const std::vector<gpu::Ray> asked = rays(200, 0.0f);
    const auto lightBy = [&](vec3 lamp, vec3 sky)
    {
        EXPECT_TRUE(groups->set(std::vector<vec3>{lamp, sky}));
        EXPECT_TRUE(device->gpu().submit([&](VkCommandBuffer cmd) { groups->record(cmd); }));
        std::vector<gpu::RayHit> hits(asked.size());
        EXPECT_TRUE(tracer->trace(asked, hits));
        glm::dvec3 sum(0.0);
        for (const gpu::RayHit& hit : hits) sum += glm::dvec3(hit.radiance);
        return sum;
    };
    const glm::dvec3 both = lightBy(vec3(1.0f), vec3(1.0f)), lamp = lightBy(vec3(1.0f), vec3(0.0f)), sky = lightBy(vec3(0.0f), vec3(1.0f));
    for (int c = 0; c < 3; ++c)
    {
        EXPECT_GT(lamp[c], 0.0);
        EXPECT_GT(sky[c], 0.0);
        EXPECT_NEAR(lamp[c] + sky[c], both[c], 0.02 * both[c]) << "steps of R11G11B10F";
    }
    EXPECT_EQ(lightBy(vec3(0.0f), vec3(0.0f)), glm::dvec3(0.0));
    EXPECT_EQ(lightBy(vec3(0.0f, 1.0f, 0.0f), vec3(0.0f)).x, 0.0);
}

TEST_F(Door, RefusesAHeaderOfAnotherVersion)
{
    ValidatedDevice owner;
    const Version mine = libraryVersion();
    for (const Version other : {Version{mine.major + 1, mine.minor, 0}, Version{mine.major, mine.minor + 1, 0}})
    {
        const auto refused = Device::create(owner.host(), other);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ErrorCode::badArgument);
        EXPECT_NE(refused.error().message.find(std::to_string(other.major) + "." + std::to_string(other.minor)), std::string::npos);
    }
    EXPECT_TRUE(Device::create(owner.host(), {mine.major, mine.minor, mine.patch + 1}));
}

// Before the work of hours, not after it.
TEST_F(Door, AFileThatCannotBeWrittenIsRefusedBeforeTheBake)
{
    ValidatedDevice owner;
    const auto device = Device::create(owner.host());
    ASSERT_TRUE(device);
    const auto scene = makeBuiltinScene("cornell-glossy");
    ASSERT_TRUE(scene);
    bool begun = false;
    const Progress progress = [&](std::string_view, double) { return begun = true; };
    const std::vector<vec3> probes = {{0.0f, 1.0f, 0.0f}};
    const Status status = bakeLightField(*device, *scene, probes, {}, *folder / "nowhere/field.sconce", progress);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ErrorCode::fileError);
    EXPECT_FALSE(begun);
}

TEST_F(Door, WhatIsOfAnotherDeviceIsRefused)
{
    ValidatedDevice owner, stranger;
    const auto device = Device::create(owner.host()), other = Device::create(stranger.host());
    ASSERT_TRUE(device && other);
    const auto field = LightField::load(*device, file());
    ASSERT_TRUE(field);
    const auto said = [](const auto& result) { return result ? std::string("nothing") : result.error().message; };
    IndirectLight::Desc desc;
    desc.width = desc.height = 8;
    EXPECT_NE(said(IndirectLight::create(*other, *field, desc)).find("another Vulkan device"), std::string::npos);
    EXPECT_NE(said(RayTracer::create(*other, *field)).find("another Vulkan device"), std::string::npos);
}

TEST_F(Door, SaysWhatAFramesEffectsAre)
{
    ValidatedDevice owner;
    const auto device = Device::create(owner.host());
    ASSERT_TRUE(device);
    const auto field = LightField::load(*device, file());
    ASSERT_TRUE(field);
    const auto scene = makeBuiltinScene("cornell-glossy");
    const IndirectEffects called = planEffects(checkScene(*scene))->indirect(), told = field->effectsOfFrames();
    EXPECT_EQ(told.diffuse, called.diffuse);
    EXPECT_EQ(told.rough, called.rough);
    EXPECT_EQ(told.glossy, called.glossy);
    EXPECT_EQ(told.mirror, called.mirror);
    EXPECT_EQ(told.denoise, called.denoise);
    EXPECT_GT(device->bytes(), field->deviceBytes());
}

TEST_F(Door, SaysWhatIsWrongWithAFileOrAKnob)
{
    ValidatedDevice owner;
    const auto device = Device::create(owner.host());
    ASSERT_TRUE(device);
    const auto missing = LightField::load(*device, *folder / "none.sconce");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::fileError);
    Quality quality;
    quality.trace.ranked = 9;
    const auto refused = LightField::load(*device, file(), quality);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("ranked"), std::string::npos);
}

} // namespace
} // namespace sconce
