#include "runtime/frame/moving_shapes.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "base/random.h"

namespace sconce
{
namespace
{

std::vector<MovingShape> shapesAbout(uint32_t count)
{
    Random random(9, 0);
    std::vector<MovingShape> shapes(count);
    for (MovingShape& s : shapes)
    {
        s.kind = MovingShape::Kind(uint32_t(3.0f * random.uniform()));
        s.centre = 20.0f * vec3(random.uniform(), random.uniform(), random.uniform());
        s.half = 0.1f + vec3(random.uniform(), random.uniform(), random.uniform());
    }
    return shapes;
}

TEST(MovingShapes, EachIsPackedOnceAndInTheSphereOfItsGroup)
{
    for (const uint32_t count : {0u, 1u, 8u, 9u, 256u})
    {
        const std::vector<MovingShape> shapes = shapesAbout(count);
        const std::vector<std::byte> bytes = packShapes(shapes);
        gpu::MovingShapesHead head;
        std::memcpy(&head, bytes.data(), sizeof head);
        ASSERT_EQ(head.count, count);
        ASSERT_EQ(bytes.size(), sizeof head + count * sizeof(gpu::MovingShapeData));
        EXPECT_EQ(head.groups, (count + 7) / 8);
        std::vector<bool> found(count, false);
        for (uint32_t i = 0; i < count; ++i)
        {
            gpu::MovingShapeData s;
            std::memcpy(&s, bytes.data() + sizeof head + i * sizeof s, sizeof s);
            for (uint32_t j = 0; j < count; ++j)
                if (shapes[j].centre == s.centre) found[j] = true;
            const vec4 sphere = head.group[i / 8];
            EXPECT_LE(glm::length(s.centre - vec3(sphere)) + s.reach, sphere.w * 1.00001f) << i;
        }
        for (uint32_t j = 0; j < count; ++j) EXPECT_TRUE(found[j]) << j;
    }
}

// Else a ray would ask all of them: of shapes all over a room the spheres about groups are no larger than a part of it.
TEST(MovingShapes, GroupsAreOfNeighbours)
{
    const std::vector<MovingShape> shapes = shapesAbout(256);
    const std::vector<std::byte> bytes = packShapes(shapes);
    gpu::MovingShapesHead head;
    std::memcpy(&head, bytes.data(), sizeof head);
    double mean = 0.0;
    for (uint32_t g = 0; g < head.groups; ++g) mean += double(head.group[g].w) / head.groups;
    EXPECT_LT(mean, 8.5); // of a cube of 20 m, whose own is 17.3
}

TEST(MovingShapes, WhatIsNoneIsNamed)
{
    EXPECT_EQ(faultOf(shapesAbout(256), 256), "");
    EXPECT_EQ(faultOf(shapesAbout(3), 2), "3 shapes move, and this frame was made for 2; give Desc::movingShapes up to 256");
    const auto fault = [](auto change)
    {
        std::vector<MovingShape> shapes(2);
        change(shapes[1]);
        return faultOf(shapes, 2);
    };
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(fault([](MovingShape& s) { s.centre.y = nan; }), "shape 1: its centre is no number");
    EXPECT_EQ(fault([](MovingShape& s) { s.turn = glm::quat(0.0f, 0.0f, 0.0f, 0.0f); }), "shape 1: its turn is no unit quaternion");
    EXPECT_EQ(fault([](MovingShape& s) { s.half.x = 0.0f; }), "shape 1: its radius is not above 0, or its half length is below 0");
    EXPECT_EQ(fault([](MovingShape& s) { s.kind = MovingShape::Kind::box, s.half.z = -1.0f; }),
              "shape 1: its half sizes are not all above 0");
    EXPECT_EQ(fault([](MovingShape& s) { s.albedo.x = 1.5f; }), "shape 1: its albedo is not in [0,1]");
    EXPECT_EQ(fault([](MovingShape& s) { s.emission.x = -1.0f; }), "shape 1: its emission is below 0 or no number");
    EXPECT_EQ(fault([](MovingShape& s) { s.slack = nan; }), "shape 1: its slack is no number");
}

} // namespace
} // namespace sconce
