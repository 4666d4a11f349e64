#include "bench/sparse/edge_image.h"

#include <array>

#include <gtest/gtest.h>

#include "tests/support/test_scenes.h"

namespace sconce
{
namespace
{

using Pieces = std::vector<std::array<vec2, 2>>;
using Kind = EdgeImage::Kind;

TEST(EdgeImage, ALineDividesItsPixelsAndNoOthers)
{
    const EdgeImage image(8, 6, Pieces{{vec2(3.25f, -1.0f), vec2(3.25f, 7.0f)}});
    EXPECT_EQ(image.counts().simple, 6u);
    EXPECT_EQ(image.counts().empty, 42u);
    for (uint32_t y = 0; y < 6; ++y)
    {
        ASSERT_EQ(image.kind(3, y), Kind::simple);
        EXPECT_FALSE(image.joined(3, y, -1, 0)); // its centre is to the right of the line
        EXPECT_FALSE(image.joined(2, y, 1, 0));
        EXPECT_TRUE(image.joined(3, y, 1, 0));
        EXPECT_TRUE(image.joined(1, y, 1, 0));
        EXPECT_NEAR(image.shareOfCentre(3, y), 0.75f, 1e-6f);
    }
    EXPECT_TRUE(image.joined(3, 2, 0, 1));
    EXPECT_TRUE(image.joined(2, 2, 0, 1));
}

TEST(EdgeImage, PiecesOfOneLineAreOneEdgeAndACornerIsNone)
{
    const EdgeImage chain(
        4, 4, Pieces{{vec2(0.0f, 1.5f), vec2(1.3f, 1.5f)}, {vec2(1.3f, 1.5f), vec2(1.7f, 1.52f)}, {vec2(1.7f, 1.52f), vec2(4.0f, 1.5f)}});
    EXPECT_EQ(chain.counts().simple, 4u);
    EXPECT_EQ(chain.counts().complex, 0u);
    const EdgeImage corner(4, 4, Pieces{{vec2(1.5f, 0.0f), vec2(1.5f, 1.5f)}, {vec2(1.5f, 1.5f), vec2(4.0f, 1.5f)}});
    EXPECT_EQ(corner.kind(1, 1), Kind::complex);
    EXPECT_EQ(corner.counts().complex, 1u);
    EXPECT_FALSE(corner.joined(1, 1, 0, 1));
    EXPECT_FALSE(corner.joined(1, 2, 0, -1));
}

TEST(EdgeImage, AreaOfTheCentresSideIsThatOfManyPoints)
{
    for (const auto& [a, b] : {std::pair(vec2(0.1f, 0.0f), vec2(0.8f, 1.0f)), std::pair(vec2(0.0f, 0.3f), vec2(1.0f, 0.45f)),
                               std::pair(vec2(0.0f, 0.9f), vec2(0.1f, 1.0f))})
    {
        const EdgeImage image(1, 1, Pieces{{a, b}});
        ASSERT_EQ(image.kind(0, 0), Kind::simple);
        const EdgeImage::Line line = image.line(0, 0);
        EXPECT_NEAR(glm::dot(line.normal, a - 0.5f), line.offset, 1e-6f);
        EXPECT_NEAR(glm::dot(line.normal, b - 0.5f), line.offset, 1e-6f);
        constexpr int kPoints = 512;
        int same = 0;
        for (int i = 0; i < kPoints * kPoints; ++i)
        {
            const vec2 p = (vec2(i % kPoints, i / kPoints) + 0.5f) / float(kPoints) - 0.5f;
            same += (glm::dot(line.normal, p) < line.offset) == (0.0f < line.offset) ? 1 : 0;
        }
        EXPECT_NEAR(image.shareOfCentre(0, 0), double(same) / (kPoints * kPoints), 2.0 / kPoints);
    }
}

Camera toward(vec3 eye)
{
    Camera camera;
    camera.eye = eye;
    camera.forward = glm::normalize(-eye);
    return camera;
}

TEST(SeenPieces, LieWhereTheCameraHasThemAndPassItsEye)
{
    Scene scene;
    scene.materials = {Material{}};
    test::addSphere(scene, 0.01f, 8, 0); // rays need a scene
    const auto rays = RayScene::create(scene);
    ASSERT_TRUE(rays.ok());
    const Camera camera = toward({0.0f, 0.0f, 4.0f});
    // A line at a height, into the depth and behind the eye: it begins in the middle and leaves the picture upwards.
    const EdgePiece long_{{0.0f, 1.0f, -1000.0f}, {0.0f, 1.0f, 10.0f}};
    const auto pieces = seenPieces(std::span(&long_, 1), *rays, camera, 64, 48);
    ASSERT_FALSE(pieces.empty());
    float length = 0.0f;
    for (const auto& [a, b] : pieces)
    {
        EXPECT_NEAR(a.x, 32.0f, 1e-3f);
        EXPECT_LE(glm::distance(a, b), 1.001f);
        length += glm::distance(a, b);
    }
    EXPECT_NEAR(length, 24.0f, 0.1f);
}

TEST(SeenPieces, WhatAWallHidesIsNotSeen)
{
    Scene scene;
    scene.materials = {Material{}};
    test::addBox(scene, vec3(0.0f), 1.0f, 0);
    const auto rays = RayScene::create(scene);
    ASSERT_TRUE(rays.ok());
    const Camera camera = toward({0.0f, 0.0f, 4.0f});
    const std::vector<EdgePiece> back = {{{-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, -1.0f}}},
                                 front = {{{-1.0f, -1.0f, 1.0f}, {1.0f, 1.0f, 1.0f}}};
    EXPECT_TRUE(seenPieces(back, *rays, camera, 64, 64).empty());
    EXPECT_FALSE(seenPieces(front, *rays, camera, 64, 64).empty());
}

TEST(SeenPieces, OutlineOfABoxIsWhereItsPixelsEnd)
{
    Scene scene;
    scene.materials = {Material{}};
    test::addBox(scene, vec3(0.0f), 1.0f, 0);
    const auto rays = RayScene::create(scene);
    ASSERT_TRUE(rays.ok());
    const Camera camera = toward({3.0f, 2.5f, 4.0f});
    constexpr uint32_t kWidth = 96, kHeight = 64;
    const EdgeImage image(kWidth, kHeight, seenPieces(edgesSeenFrom(edgesOf(scene), camera.eye), *rays, camera, kWidth, kHeight));
    const Pinhole pinhole(camera, kWidth, kHeight);
    const auto seen = [&](uint32_t x, uint32_t y)
    { return rays->closest(camera.eye, pinhole.direction(float(x) + 0.5f, float(y) + 0.5f, kWidth, kHeight)).has_value(); };
    size_t borders = 0;
    for (uint32_t y = 0; y + 1 < kHeight; ++y)
        for (uint32_t x = 0; x + 1 < kWidth; ++x)
            for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(0, 1)})
            {
                const bool differ = seen(x, y) != seen(x + uint32_t(dx), y + uint32_t(dy));
                borders += differ ? 1 : 0;
                EXPECT_FALSE(differ && image.joined(x, y, dx, dy)) << x << " " << y << " " << dx;
            }
    EXPECT_GE(borders, 100u);
    EXPECT_LE(image.counts().complex, 20u); // corners
}

} // namespace
} // namespace sconce
