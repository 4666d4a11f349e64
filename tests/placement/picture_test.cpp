#include "placement/picture.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/placement/box_scenes.h"

namespace sconce
{
namespace
{

using namespace test;

struct Drawn
{
    Scene scene = dividedRoom(); // 4 m and 2 m of a room of 6 x 3 x 4 m
    Visibility visibility = std::move(*Visibility::build(scene));
    FreeSpace space;
    Picture picture;

    explicit Drawn(const std::vector<vec3>& probes)
    {
        const vec3 inside[] = {{1, 1, 1}, {5, 1, 1}};
        space = std::move(*findFreeSpace(scene, visibility, inside, 100000));
        CoverageSettings settings;
        settings.points = 20000;
        picture = drawPlacement(space, probes, *measureCoverage(scene, visibility, space, probes, settings));
    }
    vec3 at(uint32_t x, uint32_t y) const
    {
        const float* texel = picture.rgb.data() + 3 * (size_t(y) * picture.width + x);
        return {texel[0], texel[1], texel[2]};
    }
    /// Pixels of a colour in a part of the picture, as shares of its width and height.
    template <class Is> size_t count(vec2 low, vec2 high, Is&& is) const
    {
        size_t found = 0;
        for (auto y = uint32_t(low.y * float(picture.height)); y < uint32_t(high.y * float(picture.height)); ++y)
            for (auto x = uint32_t(low.x * float(picture.width)); x < uint32_t(high.x * float(picture.width)); ++x) found += is(at(x, y));
        return found;
    }
};

bool isRed(vec3 c)
{
    return c == vec3(1, 0, 0);
}
bool isWhite(vec3 c)
{
    return c == vec3(1.0f);
}
bool isSeen(vec3 c)
{
    return c.y == 0.4f && c.z == 0.0f;
}

// A probe in the left part of a divided room: what it sees is drawn there, and the right part is red in plan and section.
TEST(PlacementPicture, ShowsWhatAProbeSeesAndWhatNoneDoes)
{
    const Drawn drawn({{2, 1.5f, 2}});
    ASSERT_EQ(drawn.picture.rgb.size(), size_t(3) * drawn.picture.width * drawn.picture.height);
    EXPECT_TRUE(std::ranges::all_of(drawn.picture.rgb, [](float v) { return v >= 0.0f && v <= 1.0f; }));
    // The plan, 4 m deep, lies above the section, 3 m high: the section begins at 4/7 of the height, the wall stands at 2/3 of the width.
    for (const auto& [top, bottom] : {std::pair{0.0f, 0.56f}, {0.58f, 1.0f}})
    {
        EXPECT_GT(drawn.count({0.0f, top}, {0.64f, bottom}, isSeen), 500u) << top;
        EXPECT_EQ(drawn.count({0.7f, top}, {1.0f, bottom}, isSeen), 0u) << top;
        EXPECT_GT(drawn.count({0.7f, top}, {1.0f, bottom}, isRed), 500u) << top;
        EXPECT_EQ(drawn.count({0.0f, top}, {0.64f, bottom}, isRed), 0u) << top;
        EXPECT_EQ(drawn.count({0.0f, top}, {1.0f, bottom}, isWhite), 49u) << "one disc of radius 4 in each view";
    }
}

TEST(PlacementPicture, GrowsToShowAProbeOutside)
{
    const Drawn inside({{2, 1.5f, 2}}), outside({{2, 1.5f, 2}, {2, 9.0f, 2}});
    EXPECT_GT(outside.picture.height, inside.picture.height);
    EXPECT_EQ(outside.count({0, 0}, {1, 1}, isWhite), 49u * 3) << "two discs in the section, one on the other in the plan";
}

} // namespace
} // namespace sconce
