#include "runtime/scene/shape_meshes.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using Text = Pure<double>;

MovingShape turned(MovingShape::Kind kind)
{
    MovingShape shape;
    shape.kind = kind;
    shape.centre = {1.0f, -2.0f, 0.5f};
    shape.half = {0.3f, 0.7f, 0.2f};
    shape.turn = glm::angleAxis(0.8f, glm::normalize(vec3(1.0f, 2.0f, -0.5f)));
    return shape;
}

// What is drawn is what light is told of: every corner lies on the shape, and what lies near it has its area.
TEST(ShapeMeshes, LieOnTheirShapes)
{
    for (const auto kind : {MovingShape::Kind::sphere, MovingShape::Kind::capsule, MovingShape::Kind::box})
    {
        const MovingShape shape = turned(kind);
        const auto distance = [&](vec3 at)
        {
            const glm::dvec3 own = glm::inverse(shape.turn) * (at - shape.centre);
            const double halfLength = kind == MovingShape::Kind::capsule ? double(shape.half.y) : 0.0;
            return kind == MovingShape::Kind::box ? Text::distanceToBox(own, shape.half).away
                                                  : Text::distanceToRound(own, double(shape.half.x), halfLength).away;
        };
        Scene scene;
        addShapes(scene, std::span(&shape, 1));
        ASSERT_EQ(scene.materials.size(), 1u);
        ASSERT_TRUE(validate(scene).empty()) << validate(scene);
        double farthest = -1.0;
        for (const vec3& position : scene.positions) farthest = std::max(farthest, distance(position));
        EXPECT_NEAR(farthest, 0.0, 1e-5) << int(kind);
        double outer = 0.0; // area of what isn't within it, as an end's other half is in a capsule
        for (const glm::uvec3& corner : scene.triangles)
        {
            const vec3 a = scene.positions[corner.x], b = scene.positions[corner.y], c = scene.positions[corner.z];
            if (distance((a + b + c) / 3.0f) > -0.004 * double(shape.half.x)) outer += 0.5 * double(glm::length(glm::cross(b - a, c - a)));
        }
        const double r = double(shape.half.x), h = double(shape.half.y), d = double(shape.half.z), pi = std::numbers::pi;
        const double area = kind == MovingShape::Kind::sphere    ? 4.0 * pi * r * r
                            : kind == MovingShape::Kind::capsule ? 4.0 * pi * r * (r + h)
                                                                 : 8.0 * (r * h + h * d + d * r);
        EXPECT_NEAR(outer / area, 1.0, 0.01) << int(kind);
    }
}

TEST(ShapeMeshes, HaveTheShapesLook)
{
    std::vector<MovingShape> shapes(2, turned(MovingShape::Kind::box));
    shapes[1].albedo = {0.1f, 0.2f, 0.3f};
    shapes[1].emission = {4.0f, 5.0f, 6.0f};
    Scene scene;
    addShapes(scene, shapes);
    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(vec3(scene.materials[1].baseColor), shapes[1].albedo);
    EXPECT_EQ(scene.materials[1].emission, shapes[1].emission);
    EXPECT_EQ(scene.materials[1].metallic, 0.0f);
    EXPECT_EQ(scene.triangles.size(), 24u);
    EXPECT_EQ(scene.triangleMaterial[23], 1u);
}

} // namespace
} // namespace sconce
