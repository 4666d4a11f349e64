// Lights that move, against fresh bakes, closed forms, and themselves.
#include "runtime/field/live_light.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include <gtest/gtest.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "runtime/bake/group_bake.h"
#include "runtime/field/light_field.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/tracer_cpu.h"
#include "scene/mesh_builder.h"
#include "scene/triangle_rays.h"
#include "shaders/shared/brdf.h"
#include "shaders/shared/field_passes.h"
#include "tests/support/device.h"
#include "tests/support/files.h"

namespace sconce
{
namespace
{

using Text = twin::LightFieldTwin<float>;

Light bulb(vec3 position, vec3 intensity = vec3(3.0f, 4.0f, 5.0f))
{
    Light light;
    light.name = "bulb";
    light.type = LightType::point;
    light.position = position;
    light.intensity = intensity;
    return light;
}

/// A closed box, 4 x 3 x 4 m.
Scene closedBox(float albedo)
{
    Scene scene;
    scene.name = "closed box";
    MeshBuilder mesh(scene);
    const uint32_t grey = mesh.material("grey", vec3(albedo));
    scene.materials[grey].roughness = 1.0f;
    mesh.quad({-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, grey);
    mesh.quad({-2, 3, -2}, {2, 3, -2}, {2, 3, 2}, {-2, 3, 2}, grey);
    mesh.quad({-2, 0, -2}, {2, 0, -2}, {2, 3, -2}, {-2, 3, -2}, grey);
    mesh.quad({-2, 0, -2}, {-2, 3, -2}, {-2, 3, 2}, {-2, 0, 2}, grey);
    mesh.quad({2, 0, -2}, {2, 0, 2}, {2, 3, 2}, {2, 3, -2}, grey);
    mesh.quad({-2, 0, 2}, {-2, 3, 2}, {2, 3, 2}, {2, 0, 2}, grey);
    scene.lights.push_back(bulb({0.5f, 2.0f, 0.3f}));
    return scene;
}

/// The same with a red screen in its middle and a panel that shines, so that some light is fixed and some of it hidden.
Scene litRoom()
{
    Scene scene = closedBox(0.6f);
    scene.name = "lit room";
    MeshBuilder mesh(scene);
    const uint32_t red = mesh.material("red", vec3(0.7f, 0.2f, 0.1f)), panel = mesh.material("panel", vec3(0.3f));
    scene.materials[panel].emission = vec3(1.0f, 0.8f, 0.5f);
    mesh.quad({0, 0, -1}, {0, 2, -1}, {0, 2, 1}, {0, 0, 1}, red);
    mesh.quad({-1.9f, 1, -1}, {-1.9f, 2, -1}, {-1.9f, 2, 1}, {-1.9f, 1, 1}, panel);
    return scene;
}

const std::vector<vec3> kProbes = {{-1.0f, 1.4f, 0.2f}, {1.0f, 1.2f, -0.3f}};

class LiveLightTest : public testing::Test
{
protected:
    static BakeSettings settings(uint32_t links)
    {
        BakeSettings made;
        made.resolution = 64;
        made.bounces = 16;
        made.converged = 0.0f;
        made.surfaceTexels = 26;
        made.surfaceRefined = 0.0f;
        made.octree.voxels = 16;
        made.liveLinks = links;
        return made;
    }
    Result<FieldData> baked(const Scene& scene, uint32_t links, std::vector<LightGroupDesc> groups = {},
                            const std::vector<vec3>& probes = kProbes)
    {
        const auto rays = TriangleRays::build(scene);
        if (!rays) return rays.error();
        BakeSettings with = settings(links);
        with.rays = &*rays;
        BakeReport report;
        return links == 0 ? bakeLightField(device.gpu(), scene, probes, with, {}, report)
                          : bakeLightGroups(device.gpu(), scene, probes, with, std::move(groups), {}, report);
    }
    /// Baked once for all tests, by its name.
    const FieldData& field(const std::string& name, const std::function<Scene()>& scene, uint32_t links,
                           const std::vector<LightGroupDesc>& groups = {}, const std::vector<vec3>& probes = kProbes)
    {
        static std::map<std::string, FieldData> made;
        if (const auto found = made.find(name); found != made.end()) return found->second;
        auto one = baked(scene(), links, groups, probes);
        if (!one) throw std::runtime_error(one.error().message);
        return made.emplace(name, std::move(*one)).first->second;
    }
    const FieldData& room() { return field("room", litRoom, 16); }
    const FieldData& box(float albedo)
    {
        return field("box " + std::to_string(albedo), [=] { return closedBox(albedo); }, 16, {}, {{-0.3f, 1.4f, 0.2f}});
    }
    void record(LiveLight& live, const RelightBudget& budget = {})
    {
        ASSERT_TRUE(device.gpu().submit([&](VkCommandBuffer cmd) { live.record(cmd, budget); }));
    }
    std::vector<uint32_t> words(const Buffer& buffer, size_t count)
    {
        std::vector<uint32_t> found(count);
        EXPECT_TRUE(device.gpu().download(buffer, 0, std::as_writable_bytes(std::span(found))));
        return found;
    }
    /// Mean over all texels that show a surface of light as RGB9E5, luminance, by the surface's area.
    double meanOf(const Buffer& buffer, const FieldData& of)
    {
        const std::vector<uint32_t> light = words(buffer, of.live.texels.size());
        Text text(of, {});
        double sum = 0.0, area = 0.0;
        const uint32_t side = of.info.surfaceSize;
        for (uint32_t i = 0; i < light.size(); ++i)
        {
            const uint32_t probe = i / (6 * side * side), face = i / (side * side) % 6, y = i / side % side, x = i % side;
            const auto surface = text.surfacePointAt(probe, int(face), int(x), int(y));
            if (!(surface.width > 0.0f)) continue;
            const vec3 axis = Text::faceDirection(int(face), vec3(0.0f, 0.0f, 1.0f));
            const double own = double(surface.width * surface.width * glm::dot(surface.at, axis) / -glm::dot(surface.at, surface.normal));
            sum += own * double(Text::luminance(Text::unpackSharedExponent(light[i])));
            area += own;
        }
        return sum / area;
    }
    testing_support::SharedDevice device;
};

/// Mean of the luminance of surface light's texels.
double meanLight(const FieldData& field)
{
    Text text(field, {});
    double sum = 0.0;
    for (uint32_t i = 0; i < text.surfaceTexels(); ++i) sum += double(Text::luminance(Text::unpackSharedExponent(field.surfaceLight[i])));
    return sum / double(text.surfaceTexels());
}

double meanRadiance(const FieldData& field)
{
    double sum = 0.0;
    for (const uint32_t word : field.radiance) sum += double(Text::luminance(Text::unpackRadiance(word)));
    return sum / double(field.radiance.size());
}

// Geometry and material alone say what a light gives: a field that was baked under one lamp and relit by another is the bake under that, to
// the bit.
TEST_F(LiveLightTest, ARelitFieldIsTheFreshBake)
{
    Scene other = litRoom();
    other.lights[0] = bulb({-1.2f, 0.4f, -1.1f}, vec3(6.0f, 2.0f, 1.0f));
    const auto fresh = baked(other, 16);
    ASSERT_TRUE(fresh) << fresh.error().message;
    FieldData relit = room();
    ASSERT_NE(relit.radiance, fresh->radiance);
    const Status status = relightField(device.gpu(), relit, other.lights, std::vector<vec3>{vec3(1.0f)});
    ASSERT_TRUE(status) << status.error().message;
    EXPECT_EQ(relit.radiance, fresh->radiance);
    EXPECT_EQ(relit.irradiance, fresh->irradiance);
    EXPECT_EQ(relit.prefiltered, fresh->prefiltered);
    // What lies in texels and cells; which hidden surfaces have light hangs on the light that they were found by.
    const size_t common = surfaceTexelWords(relit.info) + cellWords(relit.info);
    EXPECT_TRUE(std::equal(relit.surfaceLight.begin(), relit.surfaceLight.begin() + std::ptrdiff_t(common), fresh->surfaceLight.begin()));
}

// Rays go on by glossy lobes as they would in any light.
TEST_F(LiveLightTest, ARelitFieldOfGlossySurfacesIsTheFreshBake)
{
    Scene scene = litRoom();
    for (Material& material : scene.materials) material.roughness = 0.3f;
    auto relit = baked(scene, 16);
    scene.lights[0] = bulb({-1.2f, 0.4f, -1.1f}, vec3(6.0f, 2.0f, 1.0f));
    const auto fresh = baked(scene, 16);
    ASSERT_TRUE(relit && fresh);
    EXPECT_EQ(relit->live.texelLinks, fresh->live.texelLinks);
    const Status status = relightField(device.gpu(), *relit, scene.lights, std::vector<vec3>{vec3(1.0f)});
    ASSERT_TRUE(status) << status.error().message;
    EXPECT_EQ(relit->radiance, fresh->radiance);
    EXPECT_EQ(relit->irradiance, fresh->irradiance);
}

// Passes that were made beside live light go on reading it once nobody moves it, and a field has one.
TEST_F(LiveLightTest, TheFieldKeepsItsLightOnceNobodyMovesIt)
{
    const FieldData& data = room();
    auto light = makeLightField(device.gpu(), data);
    ASSERT_TRUE(light);
    {
        const auto live = makeLiveLight(device.gpu(), *light, data);
        ASSERT_TRUE(live) << live.error().message;
    }
    EXPECT_NE(light->state().liveIncident.address(), 0u);
    EXPECT_TRUE(light->setQuality({}));
    const auto again = makeLiveLight(device.gpu(), *light, data);
    ASSERT_FALSE(again.ok());
    EXPECT_EQ(again.error().code, ErrorCode::badArgument);
}

// With every link that the bake has, what moves is lit as what stays: but for direct light, which rays through the field find.
TEST_F(LiveLightTest, AllLinksGiveTheLightOfTheStaticBake)
{
    const FieldData& all = field("room with all links", litRoom, 64);
    const auto still = baked(litRoom(), 0);
    ASSERT_TRUE(still) << still.error().message;
    EXPECT_NEAR(meanLight(all), meanLight(*still), 0.015 * meanLight(*still));
    EXPECT_NEAR(meanRadiance(all), meanRadiance(*still), 0.03 * meanRadiance(*still));
    EXPECT_NEAR(meanLight(room()), meanLight(*still), 0.03 * meanLight(*still)) << "and a quarter of them nearly so";
}

// Bounces that a bake is told to leave out are left out of the light that can move, too.
TEST_F(LiveLightTest, ABakeOfFewBouncesHasAsFewOfItsLamps)
{
    const Scene scene = closedBox(0.8f);
    const std::vector<vec3> probes{{-0.3f, 1.4f, 0.2f}};
    const auto rays = TriangleRays::build(scene);
    ASSERT_TRUE(rays);
    for (const uint32_t bounces : {0u, 1u, 3u})
    {
        BakeSettings with = settings(0);
        with.rays = &*rays;
        with.bounces = bounces;
        BakeReport report;
        const auto still = bakeLightField(device.gpu(), scene, probes, with, {}, report);
        with.liveLinks = 64;
        const auto live = bakeLightGroups(device.gpu(), scene, probes, with, {}, {}, report);
        ASSERT_TRUE(still && live);
        const double radiance = meanRadiance(*live) / meanRadiance(*still);
        RecordProperty(std::to_string(bounces) + " bounces: radiance", std::to_string(radiance));
        const double light = meanLight(*live) / meanLight(*still);
        RecordProperty(std::to_string(bounces) + " bounces: light", std::to_string(light));
        EXPECT_NEAR(radiance, 1.0, 0.03) << bounces << " bounces";
        EXPECT_NEAR(light, 1.0, 0.03) << bounces << " bounces";
    }
}

// What a metal sends of light that moves, as blunt reflections read it: to all sides, not to the rays of gathering that end on it alone.
TEST_F(LiveLightTest, PrefilteredLightOfAMetalIsTheStaticBakes)
{
    Scene scene = closedBox(0.8f);
    MeshBuilder mesh(scene);
    const uint32_t metal = mesh.material("metal", vec3(0.9f), 0.3f);
    scene.materials[metal].metallic = 1.0f;
    mesh.box({-1.5f, 0.2f, -1.5f}, {-0.5f, 1.2f, 1.5f}, metal);
    const std::vector<vec3> probes{{0.4f, 1.4f, 0.2f}};
    const auto still = baked(scene, 0, {}, probes), live = baked(scene, 64, {}, probes);
    ASSERT_TRUE(still && live);
    const auto mean = [](const FieldData& field)
    {
        double sum = 0.0;
        for (uint32_t i = 0; i < gpu::kPrefilteredSize * gpu::kPrefilteredSize; ++i)
            sum += double(Text::luminance(Text::unpackRadiance(field.prefiltered[i])));
        return sum;
    };
    const double ratio = mean(*live) / mean(*still);
    RecordProperty("ratio", std::to_string(ratio));
    EXPECT_NEAR(ratio, 1.0, 0.05);
}

// Of a bulb that moves rough metals send on as much less as of one that stays: takenAlong() of their lean, which texels keep with a sign.
TEST_F(LiveLightTest, RoughMetalsSendOnOfALiveBulbWhatTheyDoOfAStaticOne)
{
    Scene scene = closedBox(0.8f);
    for (Material& material : scene.materials) material.metallic = 1.0f, material.roughness = 1.0f;
    const std::vector<vec3> probes{{-0.3f, 1.4f, 0.2f}};
    const auto still = baked(scene, 0, {}, probes), live = baked(scene, 64, {}, probes);
    ASSERT_TRUE(still && live);
    const double light = meanLight(*live) / meanLight(*still), radiance = meanRadiance(*live) / meanRadiance(*still);
    RecordProperty("light", std::to_string(light));
    RecordProperty("radiance", std::to_string(radiance));
    EXPECT_NEAR(light, 1.0, 0.03);
    EXPECT_NEAR(radiance, 1.0, 0.03);
}

// In a closed room that reflects a share of all light everywhere, what bounces is that share of what is there (Sumpner 1892): direct light
// over one minus the share, without it. Over 4,000 bounces, in 500 frames in each of which something is lit anew, it neither grows nor
// drifts.
TEST_F(LiveLightTest, AClosedRoomHoldsItsEnergyOver4000Bounces)
{
    for (const float albedo : {0.5f, 0.95f})
    {
        const FieldData& data = box(albedo);
        auto light = makeLightField(device.gpu(), data);
        ASSERT_TRUE(light);
        auto live = makeLiveLight(device.gpu(), *light, data);
        ASSERT_TRUE(live) << live.error().message;
        const std::vector<Light> one = closedBox(albedo).lights, andNone = {one[0], bulb({1.0f, 1.0f, 1.0f}, vec3(0.0f))};
        double afterAQuarter = 0.0;
        const int frames = albedo > 0.9f ? 500 : 100;
        for (int frame = 0; frame < frames; ++frame)
        {
            ASSERT_TRUE(live->set({frame % 2 == 0 ? one : andNone, {}}));
            record(*live, {.bounces = albedo > 0.9f ? 8u : 2u});
            if (frame == frames / 4) afterAQuarter = meanOf(live->state().bounced, data);
        }
        const double direct = meanOf(live->state().direct, data), bounced = meanOf(live->state().bounced, data);
        const double share = double(hemisphericalAlbedo({vec3(albedo), 0.0f, 1.0f}).x);
        EXPECT_NEAR(bounced, direct * share / (1.0 - share), (albedo > 0.9f ? 0.10 : 0.03) * bounced) << albedo;
        EXPECT_NEAR(bounced, afterAQuarter, 2e-3 * bounced) << albedo;
    }
}

// Light that is settled is left alone, and is the same however it was reached.
TEST_F(LiveLightTest, StillLightIsStill)
{
    auto light = makeLightField(device.gpu(), room());
    ASSERT_TRUE(light);
    auto live = makeLiveLight(device.gpu(), *light, room());
    ASSERT_TRUE(live);
    int frames = 0;
    for (; !live->settled() && frames < 1000; ++frames) record(*live);
    EXPECT_EQ(frames, 16) << "two bounces a frame";
    const LightField::State& state = light->state();
    const std::vector<uint32_t> before = words(state.surface, room().surfaceLight.size());
    EXPECT_EQ(before, room().surfaceLight) << "as the bake ended";
    record(*live);
    ASSERT_TRUE(live->set({room().live.lights, {}}));
    EXPECT_TRUE(live->settled()) << "the same lights again";
    // Away and back again.
    ASSERT_TRUE(live->set({{bulb({-1.0f, 2.0f, -1.0f})}, {}}));
    for (int i = 0; i < 5; ++i) record(*live);
    EXPECT_NE(words(state.surface, before.size()), before);
    ASSERT_TRUE(live->set({room().live.lights, {}}));
    while (!live->settled()) record(*live);
    const std::vector<uint32_t> again = words(state.surface, before.size());
    double off = 0.0, all = 0.0;
    for (size_t i = 0; i < size_t(6) * 26 * 26 * 2; ++i)
    {
        const vec3 a = Text::unpackSharedExponent(again[i]), b = Text::unpackSharedExponent(before[i]);
        off += double(glm::length(a - b)), all += double(glm::length(b));
    }
    EXPECT_LT(off, 1e-3 * all);
}

// Most of a switched lamp's light is there within 8 frames at full budget; some probes a frame get there, too, later.
TEST_F(LiveLightTest, ASwitchedLampIsThereWithin8Frames)
{
    const auto framesTo95 = [&](uint32_t probes)
    {
        auto light = makeLightField(device.gpu(), room());
        auto live = makeLiveLight(device.gpu(), *light, room());
        EXPECT_TRUE(live);
        if (!live) return 0;
        std::vector<Light> off = room().live.lights;
        off[0].intensity = vec3(0.0f);
        EXPECT_TRUE(live->set({off, {}}));
        while (!live->settled()) record(*live);
        const double dark = meanOf(light->state().liveIncident, room());
        EXPECT_EQ(dark, 0.0) << "of the lamp that is off";
        std::vector<double> way;
        EXPECT_TRUE(live->set({room().live.lights, {}}));
        while (!live->settled())
        {
            record(*live, {.probes = probes, .eye = kProbes[0]});
            way.push_back(meanOf(light->state().liveIncident, room()));
        }
        for (size_t i = 0; i + 1 < way.size(); ++i) EXPECT_LE(way[i], way[i + 1] * 1.001) << "it never overshoots";
        return 1 + int(std::ranges::find_if(way, [&](double x) { return x >= 0.95 * way.back(); }) - way.begin());
    };
    EXPECT_LE(framesTo95(0), 3);
    const int half = framesTo95(1);
    EXPECT_GT(half, 1);
    EXPECT_LE(half, 8);
}

// Lit a probe at a time, whatever is near to the eye, light settles where all at once it does: each probe is lit by the others.
TEST_F(LiveLightTest, ABudgetSettlesAtTheLightOfAll)
{
    std::vector<Light> off = room().live.lights;
    off[0].intensity = vec3(0.0f);
    std::vector<std::vector<uint32_t>> settled;
    for (const RelightBudget budget : {RelightBudget{}, RelightBudget{.probes = 1}, RelightBudget{.probes = 1, .bounces = 16}})
    {
        auto light = makeLightField(device.gpu(), room());
        auto live = makeLiveLight(device.gpu(), *light, room());
        ASSERT_TRUE(live);
        ASSERT_TRUE(live->set({off, {}}));
        while (!live->settled()) record(*live);
        ASSERT_TRUE(live->set({room().live.lights, {}}));
        while (!live->settled()) record(*live, {.probes = budget.probes, .bounces = budget.bounces, .eye = kProbes[0]});
        settled.push_back(words(light->state().liveIncident, room().live.texels.size()));
    }
    for (size_t part = 1; part < settled.size(); ++part)
    {
        double off2 = 0.0, all = 0.0;
        for (size_t i = 0; i < settled[0].size(); ++i)
        {
            const vec3 a = Text::unpackSharedExponent(settled[part][i]), b = Text::unpackSharedExponent(settled[0][i]);
            off2 += double(glm::dot(a - b, a - b)), all += double(glm::dot(b, b));
        }
        EXPECT_LT(off2, 1e-6 * all) << part;
    }
}

// A light that blinks every frame gives half of its light in the mean.
TEST_F(LiveLightTest, ABlinkingLightIsRightInTheMean)
{
    auto light = makeLightField(device.gpu(), room());
    auto live = makeLiveLight(device.gpu(), *light, room());
    ASSERT_TRUE(live);
    while (!live->settled()) record(*live);
    const double steady = meanOf(light->state().liveIncident, room());
    std::vector<Light> off = room().live.lights;
    off[0].intensity = vec3(0.0f);
    double sum = 0.0;
    for (int frame = 0; frame < 60; ++frame)
    {
        ASSERT_TRUE(live->set({frame % 2 == 0 ? off : room().live.lights, {}}));
        record(*live);
        if (frame >= 20) sum += meanOf(light->state().liveIncident, room());
    }
    EXPECT_NEAR(sum / 40.0, 0.5 * steady, 0.01 * steady);
}

TEST_F(LiveLightTest, HardLights)
{
    auto light = makeLightField(device.gpu(), room());
    auto live = makeLiveLight(device.gpu(), *light, room());
    ASSERT_TRUE(live);
    const auto meanUnder = [&](const std::vector<Light>& lights)
    {
        const Status set = live->set({lights, {}});
        EXPECT_TRUE(set) << set.error().message;
        for (int i = 0; i < 3; ++i) record(*live);
        return meanOf(live->state().direct, room());
    };
    const double one = meanUnder({bulb({1.0f, 2.0f, 0.0f}, vec3(4.0f))});
    EXPECT_GT(one, 0.0);
    EXPECT_NEAR(meanUnder(std::vector<Light>(1000, bulb({1.0f, 2.0f, 0.0f}, vec3(0.004f)))), one, 0.005 * one);
    // Spread over a square, of which each texel asks 8: their mean stands for all.
    std::vector<Light> square;
    for (int i = 0; i < 1000; ++i)
        square.push_back(bulb({0.5f + float(i % 25) / 25.0f, 2.0f, -0.5f + float(i / 25) / 40.0f}, vec3(0.004f)));
    EXPECT_NEAR(meanUnder(square), one, 0.05 * one);
    EXPECT_EQ(meanUnder({}), 0.0);
    EXPECT_EQ(meanUnder({bulb({0.0f, -0.5f, 0.0f}), bulb({3.0f, 1.0f, 0.0f})}), 0.0) << "below the floor, behind a wall";
    EXPECT_LT(meanUnder({bulb({2.0f, 1.0f, 0.0f})}), 1e6 * one) << "in a wall";
    Light sun;
    sun.type = LightType::directional;
    for (const vec3 direction : {vec3(0.0f, -1.0f, 0.0f), vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, 1.0f, 0.0f)})
    {
        sun.direction = direction;
        sun.intensity = vec3(3.0f);
        EXPECT_EQ(meanUnder({sun}), 0.0) << "the room is closed";
    }
    const double bright = meanUnder({bulb({1.0f, 2.0f, 0.0f}, vec3(1e6f))});
    EXPECT_TRUE(std::isfinite(bright));
    EXPECT_GT(bright, one);
    for (const uint32_t word : words(light->state().surface, size_t(6) * 26 * 26 * 2))
        ASSERT_FALSE(Text::isRefined(word)) << "light mustn't read as another texel";
}

// What is wrong is said by name, and what was set before stays.
TEST_F(LiveLightTest, WrongStatesAreRefused)
{
    auto light = makeLightField(device.gpu(), room());
    auto live = makeLiveLight(device.gpu(), *light, room());
    ASSERT_TRUE(live);
    const float none = std::numeric_limits<float>::quiet_NaN();
    Light spot = bulb({1.0f, 2.0f, 0.0f});
    spot.type = LightType::spot;
    spot.innerCone = 1.0f, spot.outerCone = 0.5f;
    Light sun;
    sun.name = "sun";
    sun.direction = vec3(0.0f, -2.0f, 0.0f);
    Light wide = bulb({1.0f, 1.0f, 1.0f});
    wide.range = -1.0f;
    const std::pair<std::vector<Light>, const char*> wrong[] = {{{bulb(vec3(none))}, "position of light 'bulb'"},
                                                                {{bulb(vec3(1.0f), vec3(none))}, "intensity of light 'bulb'"},
                                                                {{bulb(vec3(1.0f), vec3(-1.0f))}, "intensity"},
                                                                {{sun}, "direction of light 'sun'"},
                                                                {{spot}, "cones"},
                                                                {{wide}, "range"},
                                                                {std::vector<Light>(1025, bulb(vec3(1.0f))), "1025 lights"}};
    for (const auto& [lights, said] : wrong)
    {
        const Status status = live->set({lights, {}});
        ASSERT_FALSE(status) << said;
        EXPECT_EQ(status.error().code, ErrorCode::badArgument);
        EXPECT_NE(status.error().message.find(said), std::string::npos) << status.error().message;
    }
    EXPECT_FALSE(live->set({room().live.lights, {vec3(1.0f), vec3(1.0f)}}));
    EXPECT_EQ(live->lights().size(), 1u);
    EXPECT_EQ(live->lights()[0].position, room().live.lights[0].position);
}

// Rays find a lamp's light where it is, not where it was, and groups are dimmed beside it.
TEST_F(LiveLightTest, RaysAndGroupsFollow)
{
    const FieldData& data = field("grouped room", litRoom, 16, {{"panel", {"panel"}}});
    ASSERT_EQ(data.groups.size(), 1u) << "no group for what moves";
    auto light = makeLightField(device.gpu(), data);
    auto live = makeLiveLight(device.gpu(), *light, data);
    ASSERT_TRUE(live) << live.error().message;
    const auto tracer = makeRayTracer(device.gpu(), *light);
    ASSERT_TRUE(tracer);
    std::vector<gpu::Ray> rays;
    for (int i = 0; i < 64; ++i) // down, on both sides of the screen
        rays.push_back({{i % 2 == 0 ? -1.2f : 1.2f, 1.5f, -1.0f + 0.03f * float(i)}, {0.0f, -1.0f, 0.0f}, {}});
    const auto found = [&](const std::vector<Light>& lights, vec3 panel)
    {
        EXPECT_TRUE(live->set({lights, {panel}}));
        while (!live->settled()) record(*live);
        std::vector<gpu::RayHit> hits(rays.size());
        EXPECT_TRUE(tracer->trace(rays, hits));
        glm::dvec2 sum(0.0);
        for (size_t i = 0; i < hits.size(); ++i) sum[int(i % 2)] += double(glm::dot(hits[i].radiance, vec3(0.2126f, 0.7152f, 0.0722f)));
        return sum;
    };
    const glm::dvec2 right = found({bulb({1.2f, 1.0f, 0.0f})}, vec3(0.0f)), left = found({bulb({-1.2f, 1.0f, 0.0f})}, vec3(0.0f));
    EXPECT_GT(right.y, 5.0 * right.x);
    EXPECT_GT(left.x, 5.0 * left.y);
    const glm::dvec2 dark = found({}, vec3(0.0f));
    EXPECT_LT(dark.x + dark.y, 1e-6 * left.x) << "and none of a lamp that is off: what bounced of it has died away";
    const glm::dvec2 panel = found({}, vec3(1.0f)), half = found({}, vec3(0.5f)), both = found({bulb({1.2f, 1.0f, 0.0f})}, vec3(1.0f));
    for (int side = 0; side < 2; ++side)
    {
        EXPECT_NEAR(half[side], 0.5 * panel[side], 1e-3 * panel[side]);
        EXPECT_NEAR(both[side], panel[side] + right[side], 0.02 * both[side]);
    }
    // In a frame of the field itself the same is found, so that files that are relit are what rays find.
    FieldData relit = data;
    ASSERT_TRUE(relightField(device.gpu(), relit, std::vector<Light>{bulb({1.2f, 1.0f, 0.0f})}, std::vector<vec3>{vec3(1.0f)}));
    relit.live = {};
    relit.groups.clear();
    const auto still = makeLightField(device.gpu(), relit);
    const auto stillTracer = makeRayTracer(device.gpu(), *still);
    std::vector<gpu::RayHit> hits(rays.size());
    ASSERT_TRUE(stillTracer->trace(rays, hits));
    glm::dvec2 sum(0.0);
    for (size_t i = 0; i < hits.size(); ++i) sum[int(i % 2)] += double(glm::dot(hits[i].radiance, vec3(0.2126f, 0.7152f, 0.0722f)));
    for (int side = 0; side < 2; ++side) EXPECT_NEAR(sum[side], both[side], 0.03 * both[side]);
}

// Of version 8 all 8 bits of a texel's grazing were a coat's; now one of them says that it is a metal's lean.
TEST_F(LiveLightTest, AFileWhoseGrazingHasNoSignIsRead)
{
    const testing_support::TestFolder folder;
    const std::string file = folder / "older.sconce";
    FieldData field = room();
    for (size_t i = 0; i < field.live.texels.size(); ++i)
        field.live.texels[i].normal = (field.live.texels[i].normal & 0xffffffu) | uint32_t(i % 256) << 24;
    ASSERT_TRUE(saveField(field, file));
    std::string bytes = testing_support::readText(file);
    bytes[8] = 8;
    const uint64_t sum = XXH3_64bits(bytes.data(), 32);
    std::memcpy(bytes.data() + 32, &sum, 8);
    std::memcpy(bytes.data() + bytes.size() - 16, &sum, 8); // the footer has it again
    testing_support::writeText(file, bytes);
    const Result<FieldData> older = loadField(file);
    ASSERT_TRUE(older) << older.error().message;
    ASSERT_EQ(older->live.texels.size(), field.live.texels.size());
    for (size_t i = 0; i < field.live.texels.size(); ++i)
    {
        const uint32_t before = field.live.texels[i].normal, after = older->live.texels[i].normal;
        EXPECT_EQ(before & 0xffffffu, after & 0xffffffu);
        EXPECT_NEAR(double(after >> 24) / 127.0, double(i % 256) / 255.0, 0.51 / 127.0) << i; // no lean: that would be 128 and more
    }
}

// A static field has none of it, and says so; a live one is read as it was written, and a link that leads nowhere is damage.
TEST_F(LiveLightTest, FilesAndFieldsWithout)
{
    const testing_support::TestFolder folder;
    const std::string file = folder / "live.sconce";
    ASSERT_TRUE(saveField(room(), file));
    const auto read = loadField(file);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->fileVersion, 10u);
    EXPECT_EQ(read->live.texelLinks, room().live.texelLinks);
    EXPECT_EQ(read->live.placeLinks, room().live.placeLinks);
    EXPECT_EQ(read->live.albedo, room().live.albedo);
    ASSERT_EQ(read->live.lights.size(), 1u);
    EXPECT_TRUE(sameLight(read->live.lights[0], room().live.lights[0]));
    EXPECT_EQ(read->live.lights[0].name, "bulb");
    FieldData lost = room();
    lost.live.texelLinks[100] = uint32_t(lost.live.texels.size());
    const Status refused = saveField(lost, folder / "lost.sconce");
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("leads to no texel"), std::string::npos) << refused.error().message;

    const auto still = baked(litRoom(), 0);
    ASSERT_TRUE(still);
    EXPECT_EQ(fileVersionOf(*still), 6u);
    EXPECT_EQ(bytesByPart(*still).live, 0u);
    auto light = makeLightField(device.gpu(), *still);
    EXPECT_EQ(light->constants()[gpu::kFieldFlagsId] & gpu::kHoldsLive, 0u);
    const auto none = makeLiveLight(device.gpu(), *light, *still);
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("live links"), std::string::npos);
}

} // namespace
} // namespace sconce
