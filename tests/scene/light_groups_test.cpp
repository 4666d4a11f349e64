#include "scene/light_groups.h"

#include <limits>

#include <gtest/gtest.h>

#include "scene/mesh_builder.h"

namespace sconce
{
namespace
{

/// A sun, two desk lamps and a spot, two materials that shine, and a sky.
Scene litScene()
{
    Scene scene;
    scene.name = "lit";
    for (const auto& [name, type] : {std::pair{"noon", LightType::directional}, std::pair{"desk left", LightType::point},
                                     std::pair{"desk right", LightType::point}, std::pair{"stage", LightType::spot}})
    {
        Light light;
        light.name = name;
        light.type = type;
        light.intensity = vec3(4.0f);
        scene.lights.push_back(light);
    }
    MeshBuilder mesh(scene);
    for (const auto& [name, emission] : {std::pair{"wall", 0.0f}, std::pair{"bulb", 8.0f}, std::pair{"sign", 2.0f}})
    {
        mesh.material(name, vec3(0.5f));
        scene.materials.back().emission = vec3(emission);
    }
    scene.sky = vec3(1.0f);
    return scene;
}

std::string refusalOf(const Scene& scene, std::vector<LightGroupDesc> groups)
{
    const auto found = selectLights(scene, groups);
    return found ? "" : found.error().message;
}

TEST(LightGroups, AreParsedAsTheyAreSpelled)
{
    const auto some = parseLightGroup("room=desk*,bulb");
    ASSERT_TRUE(some);
    EXPECT_EQ(some->name, "room");
    EXPECT_EQ(some->members, (std::vector<std::string>{"desk*", "bulb"}));
    const auto one = parseLightGroup("sky");
    ASSERT_TRUE(one);
    EXPECT_EQ(one->name, "sky");
    EXPECT_EQ(one->members, std::vector<std::string>{"sky"});
    for (const char* bad : {"", "=sun", "room=", "room=,sun", "room=sun,", "room=sun,,sky"})
    {
        const auto refused = parseLightGroup(bad);
        ASSERT_FALSE(refused) << bad;
        EXPECT_EQ(refused.error().code, ErrorCode::badArgument);
        EXPECT_NE(refused.error().message.find(bad), std::string::npos);
    }
}

TEST(LightGroups, HoldTheLightThatTheirMembersNameAndTheRest)
{
    const Scene scene = litScene();
    std::vector<LightGroupDesc> groups = {{"day", {"sun", "sky"}}, {"desks", {"desk*"}}, {"sign", {"sign"}}};
    const auto found = selectLights(scene, groups);
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_EQ(groups.size(), 4u);
    EXPECT_EQ(groups[3].name, "rest");
    EXPECT_TRUE((*found)[0].sky);
    EXPECT_EQ((*found)[0].lights, std::vector<uint32_t>{0});
    EXPECT_EQ((*found)[1].lights, (std::vector<uint32_t>{1, 2}));
    EXPECT_EQ((*found)[2].materials, std::vector<uint32_t>{2});
    EXPECT_EQ((*found)[3].lights, std::vector<uint32_t>{3});
    EXPECT_EQ((*found)[3].materials, std::vector<uint32_t>{1});
    // The same list again, as a light field keeps it.
    EXPECT_TRUE(selectLights(scene, groups));
    EXPECT_EQ(groups.size(), 4u);
    std::vector<LightGroupDesc> all = {{"day", {"sun", "sky"}}, {"lamps", {"punctual", "emitters"}}};
    ASSERT_TRUE(selectLights(scene, all));
    EXPECT_EQ(all.size(), 2u) << "no light is left";
}

TEST(LightGroups, PatternsMatchWholeNames)
{
    Scene scene = litScene();
    const auto lightsOf = [&](const char* pattern)
    {
        std::vector<LightGroupDesc> groups = {{"a", {pattern}}};
        const auto found = selectLights(scene, groups);
        return found ? (*found)[0].lights : std::vector<uint32_t>();
    };
    EXPECT_EQ(lightsOf("desk"), std::vector<uint32_t>());
    EXPECT_EQ(lightsOf("*left"), std::vector<uint32_t>{1});
    EXPECT_EQ(lightsOf("*s*k*t"), (std::vector<uint32_t>{1, 2}));
    EXPECT_EQ(lightsOf("d*g*"), std::vector<uint32_t>{2});
    EXPECT_EQ(lightsOf("desk left*"), std::vector<uint32_t>{1});
    scene.lights[1].name = std::string(2000, 'a');
    std::string stars;
    for (int i = 0; i < 500; ++i) stars += "*a";
    EXPECT_EQ(lightsOf((stars + "*b").c_str()), std::vector<uint32_t>()) << "at once, too";
    EXPECT_EQ(lightsOf(stars.c_str()), std::vector<uint32_t>{1});
}

TEST(LightGroups, ThatAreNotTheScenesAreRefusedByName)
{
    const Scene scene = litScene();
    EXPECT_NE(refusalOf(scene, {}).find("no light group"), std::string::npos);
    const std::string lacks = refusalOf(scene, {{"a", {"moon"}}});
    EXPECT_NE(lacks.find("no light 'moon'"), std::string::npos) << lacks;
    EXPECT_NE(lacks.find("sky, sun 'noon', light 'desk left'"), std::string::npos) << lacks;
    EXPECT_NE(refusalOf(scene, {{"a", {"desk*"}}, {"b", {"punctual"}}}).find("light 'desk left' is in the light groups 'a' and 'b'"),
              std::string::npos);
    EXPECT_NE(refusalOf(scene, {{"a", {"sun"}}, {"a", {"sky"}}}).find("two light groups are called 'a'"), std::string::npos);
    EXPECT_NE(refusalOf(scene, {{"rest", {"sun"}}}).find("'rest'"), std::string::npos) << "which is what is left";
    Scene many = scene;
    std::vector<LightGroupDesc> groups;
    for (size_t i = 0; i < kMostLightGroups; ++i)
    {
        many.lights.push_back(many.lights[1]);
        many.lights.back().name = "lamp " + std::to_string(i);
        groups.push_back({many.lights.back().name, {many.lights.back().name}});
    }
    EXPECT_NE(refusalOf(many, groups).find("17 light groups"), std::string::npos) << refusalOf(many, groups);
}

TEST(LightGroups, AreDimmedAlone)
{
    Scene scene = litScene();
    std::vector<LightGroupDesc> groups = {{"some", {"desk left", "bulb", "sky"}}};
    const auto found = selectLights(scene, groups);
    ASSERT_TRUE(found);
    dimLights(scene, (*found)[0], vec3(0.5f, 1.0f, 0.0f));
    EXPECT_EQ(scene.sky, vec3(0.5f, 1.0f, 0.0f));
    EXPECT_EQ(scene.lights[1].intensity, vec3(2.0f, 4.0f, 0.0f));
    EXPECT_EQ(scene.materials[1].emission, vec3(4.0f, 8.0f, 0.0f));
    EXPECT_EQ(scene.lights[0].intensity, vec3(4.0f));
    EXPECT_EQ(scene.lights[2].intensity, vec3(4.0f));
    EXPECT_EQ(scene.materials[2].emission, vec3(2.0f));
}

TEST(LightGroups, WeightsThatAreNoneAreRefusedByTheirGroup)
{
    const std::vector<LightGroupDesc> groups = {{"sun", {"sun"}}, {"sky", {"sky"}}};
    EXPECT_EQ(weightFault(groups, std::vector<vec3>{vec3(0.0f), vec3(1e6f)}), "");
    EXPECT_NE(weightFault(groups, std::vector<vec3>{vec3(1.0f)}).find("2 light groups and 1 weights"), std::string::npos);
    for (const float bad : {-0.1f, 1.1e6f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
        EXPECT_NE(weightFault(groups, std::vector<vec3>{vec3(1.0f), vec3(1.0f, bad, 1.0f)}).find("light group 'sky'"), std::string::npos)
            << bad;
}

} // namespace
} // namespace sconce
