#include "bench/sweep/point_json.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "scene/mesh_builder.h"

namespace sconce
{
namespace
{

TEST(PointJson, WhatJsonHasNoWordForIsNull)
{
    EXPECT_EQ(numberOrNull(0.5), 0.5);
    for (const double value : {double(NAN), double(INFINITY), -double(INFINITY)}) EXPECT_TRUE(numberOrNull(value).is_null());
    EXPECT_EQ(toJson({1, 2, 3}), Json::array({1.0, 2.0, 3.0}));
}

// A room 4 m wide and 6 m deep, with a table of 1 m by 2 m, 0.8 m high: sections are as long as what they cut is round.
TEST(SectionAt, IsAsLongAsTheWallsThatItCuts)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t grey = mesh.material("grey", vec3(0.5f));
    mesh.box({0, 0, 0}, {4, 3, 6}, grey);
    mesh.box({1, 0, 1}, {2, 0.8f, 3}, grey);
    const auto lengthAt = [&](float height)
    {
        double sum = 0.0;
        for (const Json& s : sectionAt(scene, height))
            sum += std::hypot(s[2].get<double>() - s[0].get<double>(), s[3].get<double>() - s[1].get<double>());
        return sum;
    };
    EXPECT_NEAR(lengthAt(1.7f), 20.0, 1e-4);
    EXPECT_NEAR(lengthAt(0.5f), 26.0, 1e-4);
    EXPECT_EQ(sectionAt(scene, 3.5f), Json::array());
    for (const Json& s : sectionAt(scene, 1.7f))
        for (const size_t end : {size_t(0), size_t(2)})
        {
            const double x = s[end], z = s[end + 1];
            EXPECT_TRUE(x == 0.0 || x == 4.0 || z == 0.0 || z == 6.0) << s.dump();
        }
}

TEST(SectionAt, OfTooManyKeepsTheLongest)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t grey = mesh.material("grey", vec3(0.5f));
    mesh.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, grey, 15000); // 30,000 pieces of 1/30,000 m
    mesh.quad({0, 0, 1}, {0, 1, 1}, {9, 1, 1}, {9, 0, 1}, grey);
    const Json section = sectionAt(scene, 0.5f);
    EXPECT_EQ(section.size(), 20000u);
    double longest = 0.0;
    for (const Json& s : section) longest = std::max(longest, std::abs(s[2].get<double>() - s[0].get<double>()));
    EXPECT_NEAR(longest, 4.5, 1e-5);
}

Json measured(double mse, double right)
{
    return {{"error", {{"beauty", {{"mse", mse}}}}}, {"rays", {{"right_1", right}}}};
}

TEST(Wrongness, IsASentenceForWhatIsOfNoUse)
{
    const std::vector<float> reference(30, 2.0f); // a black picture's MSE is 4
    EXPECT_TRUE(wrongness(measured(3.9, 0.9), reference).is_null());
    EXPECT_TRUE(wrongness(measured(0.0, 0.5), reference).is_null());
    EXPECT_NE(wrongness(measured(4.0, 0.9), reference).get<std::string>().find("that of a black one 4.0"), std::string::npos);
    EXPECT_NE(wrongness(measured(0.1, 0.49), reference).get<std::string>().find("0.49 are right"), std::string::npos);
    Json broken = measured(0.0, 1.0);
    broken["error"]["beauty"]["mse"] = nullptr;
    EXPECT_NE(wrongness(broken, reference).get<std::string>().find("not finite"), std::string::npos);
    Json untraced = measured(0.1, 0.0);
    untraced.erase("rays");
    EXPECT_TRUE(wrongness(untraced, reference).is_null());
}

} // namespace
} // namespace sconce
