// Light apart by groups of lights, against bakes of each light alone and of scenes that are dimmed.
#include "runtime/bake/group_bake.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "runtime/field/light_field.h"
#include "runtime/field/light_groups.h"
#include "runtime/field/tracer_cpu.h"
#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"
#include "scene/triangle_rays.h"
#include "tests/support/device.h"

namespace sconce
{
namespace
{

using Text = twin::LightFieldTwin<float>;

/// A room of two halves with a screen between them, lit by a lamp of no extent, a panel and the sky through a window.
Scene litRoom()
{
    Scene scene;
    scene.name = "lit room";
    MeshBuilder mesh(scene);
    const uint32_t grey = mesh.material("grey", vec3(0.6f)), red = mesh.material("red", vec3(0.7f, 0.2f, 0.1f));
    const uint32_t panel = mesh.material("panel", vec3(0.3f));
    scene.materials[panel].emission = vec3(6.0f, 5.0f, 3.0f);
    mesh.quad({-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, grey);
    mesh.quad({-2, 3, -2}, {2, 3, -2}, {2, 3, 2}, {-2, 3, 2}, grey);
    mesh.quad({-2, 0, -2}, {2, 0, -2}, {2, 3, -2}, {-2, 3, -2}, red);
    mesh.quad({-2, 0, -2}, {-2, 3, -2}, {-2, 3, 2}, {-2, 0, 2}, grey);
    mesh.quad({2, 0, -2}, {2, 0, 2}, {2, 3, 2}, {2, 3, -2}, grey);
    mesh.quad({0, 0, -1}, {0, 2, -1}, {0, 2, 1}, {0, 0, 1}, red);
    mesh.quad({-1.9f, 1, -1}, {-1.9f, 2, -1}, {-1.9f, 2, 1}, {-1.9f, 1, 1}, panel); // the fourth wall is open to the sky
    Light lamp;
    lamp.name = "bulb";
    lamp.type = LightType::point;
    lamp.position = {1.0f, 2.5f, 0.5f};
    lamp.intensity = {3.0f, 4.0f, 5.0f};
    scene.lights.push_back(lamp);
    scene.sky = {0.4f, 0.5f, 0.8f};
    return scene;
}

const std::vector<vec3> kProbes = {{-1.0f, 1.4f, 0.2f}, {1.0f, 1.2f, -0.3f}};
const std::vector<LightGroupDesc> kGroups = {{"bulb", {"bulb"}}, {"panel", {"emitters"}}, {"sky", {"sky"}}};

class GroupBake : public testing::Test
{
protected:
    static BakeSettings settings()
    {
        BakeSettings made;
        made.resolution = 64;
        made.bounces = 3;
        made.converged = 0.0f;
        made.surfaceTexels = 26;
        made.octree.voxels = 16;
        return made;
    }
    Result<FieldData> baked(const Scene& scene, std::vector<LightGroupDesc> groups, BakeSettings with = settings())
    {
        const auto rays = TriangleRays::build(scene);
        if (!rays) return rays.error();
        if (with.chart == gpu::kChartCube) with.rays = &*rays;
        BakeReport report;
        return groups.empty() ? bakeLightField(device.gpu(), scene, kProbes, with, {}, report)
                              : bakeLightGroups(device.gpu(), scene, kProbes, with, std::move(groups), {}, report);
    }
    /// One of all tests, baked once.
    const FieldData& room()
    {
        static std::optional<FieldData> made;
        if (made) return *made;
        auto field = baked(litRoom(), kGroups);
        if (!field) throw std::runtime_error(field.error().message);
        return made.emplace(std::move(*field));
    }
    static FieldData mixed(FieldData field, std::vector<vec3> weights)
    {
        const Status status = mixGroups(field, weights);
        EXPECT_TRUE(status) << status.error().message;
        return field;
    }
    testing_support::SharedDevice device;
};

Scene dimmed(std::vector<vec3> weights)
{
    Scene scene = litRoom();
    std::vector<LightGroupDesc> groups = kGroups;
    const auto selected = selectLights(scene, groups);
    for (size_t g = 0; g < groups.size(); ++g) dimLights(scene, (*selected)[g], weights[g]);
    return scene;
}

/// Mean of the luminance of surface light's texels.
double meanLight(const FieldData& field)
{
    Text text(field, {});
    double sum = 0.0;
    for (uint32_t i = 0; i < text.surfaceTexels(); ++i)
    {
        uint32_t word = field.surfaceLight[i];
        if (Text::isRefined(word)) word = text.refinedWord(word, 0);
        sum += double(Text::luminance(Text::unpackSharedExponent(word)));
    }
    return sum / double(text.surfaceTexels());
}

/// How far one field's radiance is off another's in the mean, and at the root of the mean square, over the other's mean.
struct Off
{
    double mean = 0.0, rms = 0.0;
};
Off radianceOff(const FieldData& a, const FieldData& b)
{
    double sum = 0.0, difference = 0.0, square = 0.0;
    for (size_t i = 0; i < a.radiance.size(); ++i)
    {
        const double one = double(Text::luminance(Text::unpackRadiance(a.radiance[i]))),
                     other = double(Text::luminance(Text::unpackRadiance(b.radiance[i])));
        sum += other, difference += one - other, square += (one - other) * (one - other);
    }
    const double count = double(a.radiance.size());
    return {difference / sum, std::sqrt(square / count) / (sum / count)};
}

// All but one switched off is the bake of that light alone, to the bit where light isn't refined: radiance, irradiance and what is made of
// them.
TEST_F(GroupBake, AGroupAloneIsTheBakeOfItsLightAlone)
{
    for (size_t lit = 0; lit < kGroups.size(); ++lit)
    {
        std::vector<vec3> weights(kGroups.size(), vec3(0.0f));
        weights[lit] = vec3(1.0f);
        const FieldData switched = mixed(room(), weights);
        const auto alone = baked(dimmed(weights), {});
        ASSERT_TRUE(alone) << alone.error().message;
        EXPECT_EQ(switched.radiance, alone->radiance) << kGroups[lit].name;
        EXPECT_EQ(switched.irradiance, alone->irradiance) << kGroups[lit].name;
        EXPECT_EQ(switched.prefiltered, alone->prefiltered) << kGroups[lit].name;
        EXPECT_EQ(switched.info.sky, alone->info.sky) << kGroups[lit].name;
        EXPECT_NEAR(meanLight(switched), meanLight(*alone), 1e-3 * meanLight(*alone)) << kGroups[lit].name;
    }
}

// Dimmed and coloured: the bake of the scene in that light, within the steps of the words and the noise of its rays.
TEST_F(GroupBake, DimmedGroupsAreTheBakeOfTheDimmedScene)
{
    for (const std::vector<vec3>& weights :
         {std::vector<vec3>{vec3(1.0f), vec3(1.0f), vec3(1.0f)}, std::vector<vec3>{vec3(0.25f), vec3(2.0f, 1.0f, 0.5f), vec3(0.0f)},
          std::vector<vec3>{vec3(0.0f), vec3(0.1f), vec3(3.0f, 2.0f, 1.0f)}})
    {
        const FieldData switched = mixed(room(), weights);
        const auto fresh = baked(dimmed(weights), {});
        ASSERT_TRUE(fresh) << fresh.error().message;
        const Off off = radianceOff(switched, *fresh);
        EXPECT_LT(std::abs(off.mean), 5e-3);
        EXPECT_LT(off.rms, 0.03);
        EXPECT_NEAR(meanLight(switched), meanLight(*fresh), 5e-3 * meanLight(*fresh));
    }
}

TEST_F(GroupBake, AllOffIsBlackAndMoreThanWordsHoldIsNotInfinite)
{
    const FieldData black = mixed(room(), {vec3(0.0f), vec3(0.0f), vec3(0.0f)});
    EXPECT_EQ(meanLight(black), 0.0);
    EXPECT_TRUE(std::ranges::all_of(black.radiance, [](uint32_t word) { return word == 0; }));
    const FieldData bright = mixed(room(), {vec3(1e6f), vec3(1e6f), vec3(1e6f)});
    for (const uint32_t word : bright.radiance) ASSERT_LE(Text::luminance(Text::unpackRadiance(word)), 65024.0f);
    Text text(bright, {});
    const FieldData& was = room();
    for (uint32_t i = 0; i < text.surfaceTexels(); ++i)
        ASSERT_EQ(Text::isRefined(bright.surfaceLight[i]), Text::isRefined(was.surfaceLight[i])) << "light mustn't read as another texel";
}

// What the field holds as it is baked is what its groups give at 1, and mixing keeps nothing of what was mixed before.
TEST_F(GroupBake, MixingBeginsFromTheSharesEachTime)
{
    const std::vector<vec3> once(3, vec3(1.0f));
    FieldData field = mixed(room(), {vec3(0.3f), vec3(0.0f), vec3(7.0f)});
    field = mixed(std::move(field), once);
    EXPECT_EQ(field.surfaceLight, room().surfaceLight);
    EXPECT_EQ(field.radiance, room().radiance);
    EXPECT_EQ(field.info.sky, room().info.sky);
}

// The device writes the host's words, when it is told, and nothing where nothing changed.
TEST_F(GroupBake, TheDeviceMixesTheHostsWords)
{
    Gpu& gpu = device.gpu();
    auto field = makeLightField(gpu, room());
    ASSERT_TRUE(field) << field.error().message;
    auto groups = makeLightGroups(gpu, *field, room());
    ASSERT_TRUE(groups) << groups.error().message;
    EXPECT_EQ(groups->names(), (std::vector<std::string>{"bulb", "panel", "sky"}));
    const size_t words = room().radiance.size() + room().irradiance.size() + room().prefiltered.size() + room().surfaceLight.size();
    EXPECT_GE(groups->deviceBytes(), 3 * 4 * words);
    EXPECT_LT(groups->deviceBytes(), 3 * 4 * words + 4096);
    const auto wordsOf = [&](const Buffer& buffer, size_t count)
    {
        std::vector<uint32_t> found(count);
        const Status status = gpu.download(buffer, 0, std::as_writable_bytes(std::span(found)));
        EXPECT_TRUE(status);
        return found;
    };
    for (const std::vector<vec3>& weights :
         {std::vector<vec3>{vec3(0.25f), vec3(2.0f, 1.0f, 0.5f), vec3(0.0f)}, std::vector<vec3>{vec3(0.0f), vec3(0.0f), vec3(0.0f)},
          std::vector<vec3>{vec3(1e6f), vec3(1e-6f), vec3(1.0f)}})
    {
        ASSERT_TRUE(groups->set(weights));
        ASSERT_TRUE(gpu.submit([&](VkCommandBuffer cmd) { groups->record(cmd); }));
        const FieldData host = mixed(room(), weights);
        const LightField::State& state = field->state();
        EXPECT_EQ(wordsOf(state.radiance, host.radiance.size()), host.radiance);
        EXPECT_EQ(wordsOf(state.irradiance, host.irradiance.size()), host.irradiance);
        EXPECT_EQ(wordsOf(state.prefiltered, host.prefiltered.size()), host.prefiltered);
        EXPECT_EQ(wordsOf(state.surface, host.surfaceLight.size()), host.surfaceLight);
        EXPECT_EQ(field->info().sky, host.info.sky);
    }
    // Twice in one command buffer: the later counts.
    ASSERT_TRUE(gpu.submit(
        [&](VkCommandBuffer cmd)
        {
            for (const float lamp : {0.0f, 3.0f})
            {
                EXPECT_TRUE(groups->set(std::vector<vec3>{vec3(lamp), vec3(1.0f), vec3(1.0f)}));
                groups->record(cmd);
            }
        }));
    EXPECT_EQ(wordsOf(field->state().radiance, room().radiance.size()), mixed(room(), {vec3(3.0f), vec3(1.0f), vec3(1.0f)}).radiance);
    const std::vector<uint32_t> before = wordsOf(field->state().surface, room().surfaceLight.size());
    EXPECT_FALSE(groups->set(std::vector<vec3>{vec3(1.0f), vec3(-1.0f), vec3(1.0f)}));
    ASSERT_TRUE(gpu.submit([&](VkCommandBuffer cmd) { groups->record(cmd); }));
    EXPECT_EQ(wordsOf(field->state().surface, room().surfaceLight.size()), before) << "what was refused changes nothing";
}

// Where textures bend normals, light leans: a group's own way while it is alone on, and by how bright each is where several are.
TEST_F(GroupBake, LightLeansAsTheGroupsThatAreOn)
{
    const auto bent = [](Scene scene)
    {
        scene.images.push_back({"flat", 1, 1, {128, 128, 255, 255}});
        scene.materials[0].normalTexture.image = 0;
        return scene;
    };
    const auto field = baked(bent(litRoom()), kGroups);
    ASSERT_TRUE(field) << field.error().message;
    ASSERT_EQ(field->info.surfaceDirections, 1u);
    for (const std::vector<vec3>& weights :
         {std::vector<vec3>{vec3(1.0f), vec3(0.0f), vec3(0.0f)}, std::vector<vec3>{vec3(0.0f), vec3(1.0f), vec3(0.0f)},
          std::vector<vec3>{vec3(0.5f), vec3(0.2f), vec3(2.0f, 1.0f, 1.0f)}})
    {
        const FieldData switched = mixed(*field, weights);
        const auto fresh = baked(bent(dimmed(weights)), {});
        ASSERT_TRUE(fresh) << fresh.error().message;
        const bool alone = weights[2] == vec3(0.0f);
        Text ours(switched, {}), theirs(*fresh, {});
        double off = 0.0, all = 0.0;
        for (uint32_t i = 0; i < ours.surfaceTexels(); ++i)
        {
            const uint32_t word = switched.surfaceLight[i];
            if (word == 0 || word == Text::kBlackWord || Text::isRefined(word) || Text::isRefined(fresh->surfaceLight[i])) continue;
            const double light = double(Text::luminance(Text::unpackSharedExponent(word)));
            const double apart = double(glm::length(ours.tiltOf(i) - theirs.tiltOf(i)));
            if (alone)
            {
                ASSERT_EQ(apart, 0.0) << i;
            }
            off += light * apart;
            all += light;
        }
        EXPECT_GT(all, 0.0);
        EXPECT_LT(off / all, 0.03) << "steps of a tilt are 0.016";
    }
    auto light = makeLightField(device.gpu(), *field);
    ASSERT_TRUE(light);
    auto groups = makeLightGroups(device.gpu(), *light, *field);
    ASSERT_TRUE(groups);
    const std::vector<vec3> weights{vec3(0.5f), vec3(0.2f), vec3(2.0f, 1.0f, 1.0f)};
    ASSERT_TRUE(groups->set(weights));
    ASSERT_TRUE(device.gpu().submit([&](VkCommandBuffer cmd) { groups->record(cmd); }));
    std::vector<uint32_t> found(field->surfaceLight.size());
    ASSERT_TRUE(device.gpu().download(light->state().surface, 0, std::as_writable_bytes(std::span(found))));
    EXPECT_EQ(found, mixed(*field, weights).surfaceLight);
}

// A lamp that is no part of surface light is dimmed with its group, too.
TEST_F(GroupBake, LampsAreDimmedWithTheirGroup)
{
    Scene scene; // a floor under a square that is small from there
    MeshBuilder mesh(scene);
    mesh.quad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}, mesh.material("floor", vec3(0.5f)));
    mesh.quad({9.5f, 25, -0.5f}, {10.5f, 25, -0.5f}, {10.5f, 25, 0.5f}, {9.5f, 25, 0.5f}, mesh.emitter("lamp", vec3(2000.0f)));
    auto field = baked(scene, {{"lamp", {"emitters"}}});
    ASSERT_TRUE(field) << field.error().message;
    ASSERT_EQ(field->groups.size(), 1u);
    ASSERT_EQ(field->lamps.size(), 1u);
    std::vector<vec3> radiance;
    for (const gpu::Lamp& lamp : field->lamps) radiance.push_back(lamp.radiance);
    EXPECT_EQ(field->groups[0].lamps, radiance);
    const FieldData half = mixed(*field, {vec3(0.5f)});
    EXPECT_EQ(half.lamps[0].radiance, 0.5f * radiance[0]);
    auto light = makeLightField(device.gpu(), *field);
    ASSERT_TRUE(light);
    auto groups = makeLightGroups(device.gpu(), *light, *field);
    ASSERT_TRUE(groups);
    ASSERT_TRUE(groups->set(std::vector<vec3>{vec3(0.5f)}));
    ASSERT_TRUE(device.gpu().submit([&](VkCommandBuffer cmd) { groups->record(cmd); }));
    gpu::Lamp found;
    ASSERT_TRUE(device.gpu().download(light->state().lamps, 0, std::as_writable_bytes(std::span(&found, 1))));
    EXPECT_EQ(found.radiance, half.lamps[0].radiance);
}

// Two would write over one another; and who comes after one that is gone finds the light as that has left it.
TEST_F(GroupBake, AFieldIsSwitchedByOneAtATime)
{
    Gpu& gpu = device.gpu();
    auto field = makeLightField(gpu, room());
    ASSERT_TRUE(field);
    {
        auto first = makeLightGroups(gpu, *field, room());
        ASSERT_TRUE(first) << first.error().message;
        const auto second = makeLightGroups(gpu, *field, room());
        ASSERT_FALSE(second);
        EXPECT_EQ(second.error().code, ErrorCode::badArgument);
        EXPECT_NE(second.error().message.find("has light groups"), std::string::npos) << second.error().message;
        ASSERT_TRUE(first->set(std::vector<vec3>(3, vec3(0.0f))));
        ASSERT_TRUE(gpu.submit([&](VkCommandBuffer cmd) { first->record(cmd); }));
    }
    auto next = makeLightGroups(gpu, *field, room());
    ASSERT_TRUE(next) << next.error().message;
    ASSERT_TRUE(gpu.submit([&](VkCommandBuffer cmd) { next->record(cmd); })) << "as it was baked, without a call of set()";
    std::vector<uint32_t> found(room().surfaceLight.size());
    ASSERT_TRUE(gpu.download(field->state().surface, 0, std::as_writable_bytes(std::span(found))));
    EXPECT_EQ(found, room().surfaceLight);
}

TEST_F(GroupBake, AKeptDimmedFieldComesBackToWhatWasBaked)
{
    Gpu& gpu = device.gpu();
    const FieldData dark = mixed(room(), std::vector<vec3>(3, vec3(0.0f))); // as `relight --keep --dim` leaves it
    auto field = makeLightField(gpu, dark);
    ASSERT_TRUE(field);
    auto groups = makeLightGroups(gpu, *field, dark);
    ASSERT_TRUE(groups);
    ASSERT_TRUE(groups->set(std::vector<vec3>(3, vec3(1.0f))));
    ASSERT_TRUE(gpu.submit([&](VkCommandBuffer cmd) { groups->record(cmd); }));
    std::vector<uint32_t> found(room().surfaceLight.size());
    ASSERT_TRUE(gpu.download(field->state().surface, 0, std::as_writable_bytes(std::span(found))));
    EXPECT_EQ(found, room().surfaceLight);
}

// Before hours of bakes, whose field could not be lit or kept.
TEST_F(GroupBake, LightsThatCannotMoveAreRefusedBeforeTheBake)
{
    Scene many = litRoom(), bright = litRoom();
    many.lights.resize(kMostLiveLights + 1, many.lights[0]);
    bright.lights[0].intensity = vec3(1e9f);
    for (const Scene& scene : {many, bright})
    {
        const auto rays = TriangleRays::build(scene);
        ASSERT_TRUE(rays);
        BakeSettings moving = settings();
        moving.rays = &*rays;
        moving.liveLinks = 8;
        int begun = 0;
        BakeReport report;
        const auto refused = bakeLightGroups(
            device.gpu(), scene, kProbes, moving, {}, [&](std::string_view, double) { return ++begun, true; }, report);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ErrorCode::badArgument);
        EXPECT_EQ(begun, 0) << refused.error().message;
    }
}

// A shader numbers links by a word.
TEST_F(GroupBake, MoreLiveLinksThanAWordNamesAreRefusedBeforeTheBake)
{
    const Scene scene = litRoom();
    const auto rays = TriangleRays::build(scene);
    ASSERT_TRUE(rays);
    BakeSettings moving = settings();
    moving.rays = &*rays;
    moving.resolution = 128;
    moving.surfaceTexels = 52;
    moving.surfaceRays = moving.liveLinks = 64;
    constexpr uint64_t kLinksAProbe = 6 * 52 * 52 * 64, kTooMany = (1ull << 32) / kLinksAProbe + 1;
    const std::vector<vec3> probes(kTooMany, kProbes[0]);
    BakeReport report;
    int begun = 0;
    const auto refused = bakeLightGroups(
        device.gpu(), scene, probes, moving, {}, [&](std::string_view, double) { return ++begun, true; }, report);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::badArgument);
    EXPECT_NE(refused.error().message.find(std::to_string(kTooMany * kLinksAProbe)), std::string::npos) << refused.error().message;
    EXPECT_EQ(begun, 0);
}

TEST_F(GroupBake, WhatHasNoSurfaceLightIsRefused)
{
    BakeSettings bare = settings();
    bare.surfaceTexels = 0;
    const auto without = baked(litRoom(), kGroups, bare);
    ASSERT_FALSE(without);
    EXPECT_EQ(without.error().code, ErrorCode::badArgument);
    EXPECT_NE(without.error().message.find("surface"), std::string::npos);
    const auto unknown = baked(litRoom(), {{"a", {"moon"}}});
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message.find("'moon'"), std::string::npos);
    const auto plain = baked(litRoom(), {});
    ASSERT_TRUE(plain);
    auto field = makeLightField(device.gpu(), *plain);
    ASSERT_TRUE(field);
    const auto groups = makeLightGroups(device.gpu(), *field, *plain);
    ASSERT_FALSE(groups);
    EXPECT_NE(groups.error().message.find("no light groups"), std::string::npos);
}

} // namespace
} // namespace sconce
