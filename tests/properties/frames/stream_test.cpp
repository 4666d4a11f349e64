// A light field whose maps come from its file while frames are drawn.
#include <cmath>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "runtime/bake/group_bake.h"
#include "runtime/field/field_stream.h"
#include "runtime/field/light_groups.h"
#include "runtime/field/map_blocks.h"
#include "scene/builtin_scenes.h"
#include "tests/properties/frames/frame_test.h"
#include "tests/properties/hard_cases/hard_case.h"
#include "tests/support/files.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr uint32_t kSide = 64; // pixels

class Streaming : public FrameTest
{
protected:
    void SetUp() override
    {
        scene = *makeBuiltinScene("hall");
        camera = scene.cameras.front();
        for (int x = 0; x < 4; ++x)
            for (int z = 0; z < 4; ++z) probes.push_back(glm::mix(low(), high(), vec3(float(x) / 3.0f, 0.5f, float(z) / 3.0f)));
        auto made = bakeField(scene, probes);
        ASSERT_TRUE(made) << made.error().message;
        baked = std::move(*made);
        file = folder / "hall.sconce";
        ASSERT_TRUE(saveField(baked, file));
        settings = settingsOf(kSide);
        settings.effects.temporal = false;
    }

    /// Of where probes may stand.
    vec3 low() const { return glm::mix(scene.bounds().low, scene.bounds().high, 0.15f); }
    vec3 high() const { return glm::mix(scene.bounds().low, scene.bounds().high, 0.85f); }

    struct Streamed
    {
        LightField field;
        FieldStream stream;
        std::unique_ptr<SceneRenderer> renderer;
    };
    std::optional<LightGroups> groups; // of a field that has some

    Result<Streamed> open(uint32_t resident, FieldStream::Desc desc = {})
    {
        auto opened = openField(file);
        if (!opened) return opened.error();
        device.emplace(std::move(*DeviceScene::create(gpu(), scene, opened->field.info)));
        auto field = makeStreamedField(gpu(), opened->field, std::move(opened->maps), resident);
        if (!field) return field.error();
        if (!opened->field.groups.empty())
        {
            auto made = makeLightGroups(gpu(), *field, opened->field);
            if (!made) return made.error();
            groups = std::move(*made);
        }
        auto stream = makeFieldStream(gpu(), *field, desc);
        if (!stream) return stream.error();
        auto renderer = SceneRenderer::create(gpu(), *device, *field, settings);
        if (!renderer) return renderer.error();
        return Streamed{std::move(*field), std::move(*stream), std::move(*renderer)};
    }

    /// A frame, after what has been read until then.
    Result<RenderedFrame> step(Streamed& streamed)
    {
        if (auto status = gpu().submit([&](VkCommandBuffer cmd) { streamed.stream.record(cmd, camera.eye); }); !status)
            return status.error();
        return streamed.renderer->render(camera);
    }

    /// Frames until nothing more comes.
    Result<RenderedFrame> settle(Streamed& streamed)
    {
        for (int still = 0;;)
        {
            auto frame = step(streamed);
            if (!frame) return frame;
            const FieldStream::Counts counts = streamed.stream.counts();
            still =
                streamed.stream.state().reader->reads() || (counts.missing > 0 && !counts.full && streamed.stream.status()) ? 0 : still + 1;
            if (still > 4) return frame;
            std::this_thread::yield();
        }
    }

    RenderedFrame whole()
    {
        auto frame = drawWith(baked, scene, settings);
        EXPECT_TRUE(frame);
        return std::move(*frame);
    }

    static double meanOf(const std::vector<vec3>& picture)
    {
        double sum = 0.0;
        for (const vec3& c : picture) sum += c.x + c.y + c.z;
        return sum / (3.0 * double(picture.size()));
    }

    /// Mean squared error over the squared mean of the truth.
    static double errorOf(const std::vector<vec3>& picture, const std::vector<vec3>& truth)
    {
        double sum = 0.0;
        for (size_t i = 0; i < truth.size(); ++i) sum += glm::dot(picture[i] - truth[i], picture[i] - truth[i]);
        return sum / (3.0 * double(truth.size()) * meanOf(truth) * meanOf(truth));
    }

    Status dim(LightGroups& lights, std::span<const vec3> weights)
    {
        if (auto status = lights.set(weights); !status) return status;
        return gpu().submit([&](VkCommandBuffer cmd) { lights.record(cmd); });
    }

    TestFolder folder;
    Scene scene;
    Camera camera;
    std::vector<vec3> probes;
    FieldData baked;
    std::filesystem::path file;
    RenderSettings settings;
    std::optional<DeviceScene> device;
};

TEST_F(Streaming, AllMapsAreThePictureOfTheWholeField)
{
    const RenderedFrame truth = whole();
    auto streamed = open(uint32_t(baked.probes.size()));
    ASSERT_TRUE(streamed) << streamed.error().message;
    const auto first = streamed->renderer->render(camera);
    ASSERT_TRUE(first);
    EXPECT_GT(meanOf(first->diffuseIndirect), 0.5 * meanOf(truth.diffuseIndirect)) << "without a map yet, light of the open";
    const auto frame = settle(*streamed);
    ASSERT_TRUE(frame) << frame.error().message;
    const FieldStream::Counts counts = streamed->stream.counts();
    EXPECT_EQ(counts.missing, 0u);
    EXPECT_EQ(counts.resident, baked.probes.size());
    EXPECT_EQ(counts.read, baked.probes.size()) << "each once";
    EXPECT_EQ(frame->diffuseIndirect, truth.diffuseIndirect);
    EXPECT_EQ(frame->glossyIndirect, truth.glossyIndirect);
    EXPECT_TRUE(streamed->stream.status());
}

TEST_F(Streaming, MapsInBlocksComeTheSameWayAndMakeNearlyThePictureOfTexels)
{
    const RenderedFrame texels = whole();
    ASSERT_TRUE(putInBlocks(baked));
    ASSERT_TRUE(saveField(baked, file));
    const RenderedFrame blocks = whole();
    EXPECT_LT(errorOf(blocks.diffuseIndirect, texels.diffuseIndirect), 1e-4);
    EXPECT_LT(errorOf(blocks.glossyIndirect, texels.glossyIndirect), 1e-3);
    auto streamed = open(uint32_t(baked.probes.size()));
    ASSERT_TRUE(streamed) << streamed.error().message;
    const auto frame = settle(*streamed);
    ASSERT_TRUE(frame) << frame.error().message;
    EXPECT_EQ(frame->diffuseIndirect, blocks.diffuseIndirect);
    EXPECT_EQ(frame->glossyIndirect, blocks.glossyIndirect);
}

// Of light in groups the maps come as shares, which are mixed by the weights of now: those that are there when the light changes, and those
// that come later.
TEST_F(Streaming, LightGroupsAreMixedAsTheirMapsCome)
{
    BakeReport report;
    const std::span few = std::span(probes).first(8);
    auto grouped = bakeLightGroups(gpu(), scene, few, bakeOf(64, 1), {{"warm", {"warm panel"}}}, {}, report);
    ASSERT_TRUE(grouped) << grouped.error().message;
    ASSERT_EQ(grouped->groups.size(), 2u);
    ASSERT_TRUE(saveField(*grouped, file));
    const std::vector<vec3> evening = {vec3(1.5f, 1.0f, 0.5f), vec3(0.1f)}, day = {vec3(0.0f), vec3(1.0f)};
    const auto wholeField = makeLightField(gpu(), *grouped);
    ASSERT_TRUE(wholeField);
    auto wholeGroups = makeLightGroups(gpu(), *wholeField, *grouped);
    ASSERT_TRUE(wholeGroups) << wholeGroups.error().message;

    for (const uint32_t resident : {uint32_t(few.size()), 3u})
    {
        groups.reset();
        auto streamed = open(resident);
        ASSERT_TRUE(streamed) << streamed.error().message;
        const auto full = SceneRenderer::create(gpu(), *device, *wholeField, settings);
        ASSERT_TRUE(full);
        std::optional<RenderedFrame> before;
        for (const std::vector<vec3>& weights : {evening, day})
        {
            ASSERT_TRUE(dim(*groups, weights) && dim(*wholeGroups, weights));
            const auto frame = settle(*streamed), truth = (*full)->render(camera);
            ASSERT_TRUE(frame && truth);
            if (resident == few.size())
            {
                EXPECT_EQ(frame->diffuseIndirect, truth->diffuseIndirect);
                EXPECT_EQ(frame->glossyIndirect, truth->glossyIndirect);
            }
            else
            {
                EXPECT_LT(errorOf(frame->glossyIndirect, truth->glossyIndirect), 0.5);
                EXPECT_NEAR(meanOf(frame->glossyIndirect) / meanOf(truth->glossyIndirect), 1.0, 0.2);
            }
            if (before)
            {
                EXPECT_GT(errorOf(frame->glossyIndirect, before->glossyIndirect), 0.01) << "the light has a say";
            }
            before = std::move(*frame);
        }
        EXPECT_TRUE(streamed->stream.status());
        // Groups that go leave the picture in their last light.
        groups.reset();
        const auto last = settle(*streamed);
        ASSERT_TRUE(last);
        EXPECT_EQ(last->glossyIndirect, before->glossyIndirect);
    }
}

TEST_F(Streaming, LightGroupsAreMadeBeforeTheStream)
{
    BakeSettings few = bakeOf(64, 0);
    BakeReport report;
    const auto grouped = bakeLightGroups(gpu(), scene, std::span(probes).first(2), few, {{"warm", {"warm panel"}}}, {}, report);
    ASSERT_TRUE(grouped) << grouped.error().message;
    ASSERT_TRUE(saveField(*grouped, file));
    auto opened = openField(file);
    ASSERT_TRUE(opened);
    const auto field = makeStreamedField(gpu(), opened->field, std::move(opened->maps), 1);
    ASSERT_TRUE(field);
    const auto stream = makeFieldStream(gpu(), *field, {});
    ASSERT_TRUE(stream) << "in the light that it was baked in";
    const auto late = makeLightGroups(gpu(), *field, opened->field);
    ASSERT_FALSE(late);
    EXPECT_EQ(late.error().code, ErrorCode::badArgument);
    EXPECT_NE(late.error().message.find("before"), std::string::npos) << late.error().message;
}

// A quarter of the probes: those that the picture asks for most.
TEST_F(Streaming, MapsThatAreAskedForMakeNearlyTheSamePicture)
{
    const RenderedFrame truth = whole();
    auto streamed = open(uint32_t(baked.probes.size()) / 4);
    ASSERT_TRUE(streamed);
    const auto none = streamed->renderer->render(camera);
    const auto frame = settle(*streamed);
    ASSERT_TRUE(none && frame);
    EXPECT_EQ(streamed->stream.counts().resident, baked.probes.size() / 4);
    const double without = errorOf(none->diffuseIndirect, truth.diffuseIndirect),
                 with = errorOf(frame->diffuseIndirect, truth.diffuseIndirect);
    expectAtMost("a quarter of the maps on the device: error of diffuse light, of that without any", kSide * kSide, with / without, 0.25);
    expectAtMost("a quarter of the maps on the device: mean of diffuse light, relative", kSide * kSide,
                 std::abs(meanOf(frame->diffuseIndirect) / meanOf(truth.diffuseIndirect) - 1.0), 0.02);
}

// The camera goes through the hall: no frame is black, the pool is never over its size, and bytes on the device stay.
TEST_F(Streaming, ACameraThatFliesThroughIsNeverWithoutLight)
{
    auto streamed = open(5, {.probesAFrame = 1, .framesInFlight = 2});
    ASSERT_TRUE(streamed);
    const auto field = makeLightField(gpu(), baked);
    const auto full = SceneRenderer::create(gpu(), *device, *field, settings);
    ASSERT_TRUE(field && full);
    const uint64_t bytes = gpu().memory().used();
    double worst = 0.0, darkest = 1.0;
    for (int i = 0; i < 40; ++i)
    {
        const Camera &from = scene.cameras[0], &to = scene.cameras[1];
        camera.eye = glm::mix(from.eye, to.eye, float(i) / 39.0f);
        camera.forward = glm::normalize(glm::mix(from.forward, to.forward, float(i) / 39.0f));
        const auto frame = step(*streamed), truth = (*full)->render(camera);
        ASSERT_TRUE(frame && truth);
        EXPECT_LE(streamed->stream.counts().resident, 5u);
        worst = std::max(worst, errorOf(frame->diffuseIndirect, truth->diffuseIndirect));
        darkest = std::min(darkest, meanOf(frame->diffuseIndirect) / meanOf(truth->diffuseIndirect));
    }
    EXPECT_EQ(gpu().memory().used(), bytes) << "streaming allocates nothing";
    RecordProperty("worst", std::to_string(worst));
    EXPECT_GT(darkest, 0.7);
    EXPECT_GT(streamed->stream.counts().read, 5u) << "the pool has followed";
}

// A disk goes bad while frames are drawn.
TEST_F(Streaming, ADamagedBlockIsASentenceAndAPictureWithoutThatProbe)
{
    auto streamed = open(uint32_t(baked.probes.size()));
    ASSERT_TRUE(streamed);
    // Among the maps, which are most of the file.
    const auto third = std::streamoff(std::filesystem::file_size(file) / 3);
    std::fstream(file, std::ios::binary | std::ios::in | std::ios::out).seekp(third).write("damage", 6);
    const auto frame = settle(*streamed);
    ASSERT_TRUE(frame);
    const Status status = streamed->stream.status();
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ErrorCode::badInput);
    EXPECT_NE(status.error().message.find("does not match its checksum"), std::string::npos) << status.error().message;
    EXPECT_NE(status.error().message.find("The maps of probe "), std::string::npos) << status.error().message;
    EXPECT_LT(streamed->stream.counts().resident, baked.probes.size());
    EXPECT_GT(streamed->stream.counts().resident, baked.probes.size() / 2);
    EXPECT_GT(meanOf(frame->diffuseIndirect), 0.0);
}

// The table on the device is the host's: what a stream before had brought is nowhere, until this one has brought it.
TEST_F(Streaming, AStreamBeginsWithoutTheMapsOfTheOneBefore)
{
    auto streamed = open(3);
    ASSERT_TRUE(streamed) << streamed.error().message;
    ASSERT_TRUE(settle(*streamed));
    ASSERT_EQ(streamed->stream.counts().resident, 3u);
    {
        const auto gone = std::move(streamed->stream);
    }
    auto next = makeFieldStream(gpu(), streamed->field, {.probesAFrame = 1});
    ASSERT_TRUE(next) << next.error().message;
    streamed->stream = std::move(*next);
    for (int frame = 0; frame < 6; ++frame)
    {
        ASSERT_TRUE(step(*streamed));
        std::vector<uint32_t> found(baked.probes.size());
        ASSERT_TRUE(gpu().download(streamed->field.state().maps->slotOfProbe, 0, std::as_writable_bytes(std::span(found))));
        EXPECT_EQ(found, streamed->stream.state().slotOfProbe) << "frame " << frame;
    }
}

TEST_F(Streaming, WhatCannotStreamIsRefusedWithASentence)
{
    const auto said = [](const auto& result) { return result ? std::string("nothing") : result.error().message; };
    auto opened = openField(file);
    ASSERT_TRUE(opened);
    const auto field = makeStreamedField(gpu(), opened->field, std::move(opened->maps), 3);
    ASSERT_TRUE(field);
    EXPECT_EQ(said(makeFieldStream(gpu(), *field, {.probesAFrame = 0})), "probesAFrame is 0; give 1 to 64");
    EXPECT_EQ(said(makeFieldStream(gpu(), *field, {.framesInFlight = 9})), "framesInFlight is 9; give 1 to 8");
    {
        const auto one = makeFieldStream(gpu(), *field, {});
        ASSERT_TRUE(one);
        EXPECT_NE(said(makeFieldStream(gpu(), *field, {})).find("has a stream"), std::string::npos);
    }
    EXPECT_TRUE(makeFieldStream(gpu(), *field, {})) << "the one before is gone";
    const auto whole = makeLightField(gpu(), baked);
    ASSERT_TRUE(whole);
    EXPECT_NE(said(makeFieldStream(gpu(), *whole, {})).find("is whole"), std::string::npos);
    auto again = openField(file);
    ASSERT_TRUE(again);
    EXPECT_EQ(said(makeStreamedField(gpu(), again->field, std::move(again->maps), 17)),
              "resident is 17; give 1 to the 16 probes of the light field, or 0 for all");
}

} // namespace
} // namespace sconce
