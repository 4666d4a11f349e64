// What moves and is in no light field: it darkens what is about it, is met by rays, and leaves nothing behind.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "bench/reference/reference.h"
#include "runtime/scene/shape_meshes.h"
#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"
#include "tests/properties/frames/frame_test.h"

namespace sconce
{
namespace
{

constexpr uint32_t kSide = 96; // pixels

/// A room with a lamp over all of its ceiling, a matt and a mirroring wall.
Scene room()
{
    Scene scene;
    scene.name = "room for what moves";
    MeshBuilder mesh(scene);
    mesh.box({-2.0f, 0.0f, -2.0f}, {2.0f, 3.0f, 2.0f}, mesh.material("white", vec3(0.6f)));
    mesh.quad({-1.2f, 2.9f, -1.2f}, {1.2f, 2.9f, -1.2f}, {1.2f, 2.9f, 1.2f}, {-1.2f, 2.9f, 1.2f}, mesh.emitter("lamp", vec3(3.0f)));
    mesh.quad({-1.5f, 0.3f, -1.95f}, {1.5f, 0.3f, -1.95f}, {1.5f, 2.6f, -1.95f}, {-1.5f, 2.6f, -1.95f},
              mesh.material("mirror", vec3(0.9f), 0.0f, 1.0f));
    mesh.camera("view", {0.0f, 1.9f, 1.8f}, {0.0f, 0.6f, -1.0f}, 75.0f);
    return scene;
}

const std::vector<vec3> kProbes = {{0.0f, 1.5f, 1.2f}, {-1.2f, 1.0f, 0.3f}, {1.2f, 2.0f, 0.0f}, {0.3f, 1.2f, -1.3f}, {-0.8f, 2.2f, -1.0f}};

MovingShape shape(MovingShape::Kind kind, vec3 centre, vec3 half, float aboutY = 0.0f)
{
    MovingShape made;
    made.kind = kind;
    made.centre = centre;
    made.half = half;
    made.turn = glm::angleAxis(aboutY, vec3(0.0f, 1.0f, 0.0f));
    made.albedo = vec3(0.5f, 0.3f, 0.2f);
    return made;
}

/// A figure, a crate and a ball.
const std::vector<MovingShape> kCrowd = {shape(MovingShape::Kind::capsule, {-0.7f, 0.85f, -0.4f}, {0.25f, 0.6f, 0.0f}),
                                         shape(MovingShape::Kind::box, {0.7f, 0.4f, -0.5f}, {0.3f, 0.4f, 0.35f}, 0.6f),
                                         shape(MovingShape::Kind::sphere, {0.1f, 0.35f, 0.4f}, {0.3f, 0.0f, 0.0f})};

class MovingShapeFrames : public testing_support::FrameTest
{
protected:
    void SetUp() override
    {
        auto baked = bakeByTriangles(room(), kProbes, bakeOf(128, 4, 52, 64));
        ASSERT_TRUE(baked) << baked.error().message;
        field = std::move(*baked);
    }
    static RenderSettings settings()
    {
        RenderSettings made = settingsOf(kSide);
        made.effects.glossy = false; // but mirrors
        return made;
    }
    /// @param drawn   shapes that are in the picture
    /// @param told    those that the light is told of
    RenderedFrame draw(std::span<const MovingShape> drawn, std::span<const MovingShape> told)
    {
        Scene scene = room();
        addShapes(scene, drawn);
        RenderSettings made = settings();
        made.shapes.assign(told.begin(), told.end());
        auto frame = drawWith(field, scene, made);
        EXPECT_TRUE(frame) << frame.error().message;
        return std::move(*frame);
    }
    static ImageSet truthOf(std::span<const MovingShape> shapes)
    {
        Scene scene = room();
        addShapes(scene, shapes);
        ReferenceSettings reference;
        reference.width = reference.height = kSide;
        reference.samples = 256;
        reference.bounces = 8;
        reference.pixelCentre = true;
        reference.guides = false;
        reference.camera = scene.cameras.front();
        auto traced = renderReference(scene, reference);
        EXPECT_TRUE(traced) << traced.error().message;
        return std::move(traced->images);
    }

    FieldData field;
};

double luminanceAt(std::span<const float> pixels, size_t i)
{
    return 0.2126 * pixels[3 * i] + 0.7152 * pixels[3 * i + 1] + 0.0722 * pixels[3 * i + 2];
}

double luminanceAt(std::span<const vec3> pixels, size_t i)
{
    return 0.2126 * pixels[i].x + 0.7152 * pixels[i].y + 0.0722 * pixels[i].z;
}

// Of the pixels of still surfaces whose light the shapes change by over a twentieth: the error is at most half of what it is untold.
TEST_F(MovingShapeFrames, ShadowsAndReflectionsHaveHalfTheErrorAtMost)
{
    const ImageSet with = truthOf(kCrowd), without = truthOf({});
    const RenderedFrame told = draw(kCrowd, kCrowd), untold = draw(kCrowd, {}), empty = draw({}, {});
    const auto& terms = {std::tuple{"diffuse_indirect", &RenderedFrame::diffuseIndirect, 0.5},
                         std::tuple{"glossy_indirect", &RenderedFrame::glossyIndirect, 0.5}};
    for (const auto& [name, of, most] : terms)
    {
        const std::vector<float>&truth = with.find(name)->pixels, &before = without.find(name)->pixels;
        double gone = 0.0, left = 0.0;
        size_t pixels = 0;
        for (size_t i = 0; i < told.depth.size(); ++i)
        {
            if (std::abs(told.depth[i] - empty.depth[i]) > 1e-4f) continue; // a shape's own
            const double asked = luminanceAt(truth, i);
            if (std::abs(asked - luminanceAt(before, i)) < 0.05 * std::max(asked, 0.05)) continue;
            ++pixels;
            gone += std::abs(luminanceAt(untold.*of, i) - asked);
            left += std::abs(luminanceAt(told.*of, i) - asked);
        }
        ASSERT_GT(pixels, 100u) << name;
        RecordProperty(name, std::to_string(left / gone));
        EXPECT_LT(left, most * gone) << name << ": " << left / gone << " of the error, " << pixels << " pixels";
    }
}

// A shape doesn't hide its own surface, and is lit as whatever no probe knows.
TEST_F(MovingShapeFrames, AShapeIsNotInItsOwnShadow)
{
    const std::span<const MovingShape> one = std::span(kCrowd).first(1);
    const RenderedFrame told = draw(one, one), untold = draw(one, {}), empty = draw({}, {});
    size_t pixels = 0;
    for (size_t i = 0; i < told.depth.size(); ++i)
    {
        if (std::abs(told.depth[i] - empty.depth[i]) < 1e-4f) continue;
        ++pixels;
        EXPECT_EQ(told.diffuseIndirect[i], untold.diffuseIndirect[i]) << i;
    }
    EXPECT_GT(pixels, 200u);
}

TEST_F(MovingShapeFrames, WithoutShapesAllBitsAreThoseOfAFrameThatKnowsNone)
{
    const RenderedFrame plain = draw({}, {});
    // Behind the walls: no ray comes there, and no light that it could hide.
    MovingShape away = kCrowd[0];
    away.centre = vec3(0.0f, 1.0f, 60.0f);
    const RenderedFrame told = draw({}, std::span(&away, 1));
    EXPECT_EQ(plain.beauty, told.beauty);
}

// The same object frame after frame: what has gone is gone, to the bit.
TEST_F(MovingShapeFrames, NothingIsLeftBehind)
{
    const Scene scene = room();
    auto device = DeviceScene::create(gpu(), scene, field.info);
    ASSERT_TRUE(device);
    auto light = makeLightField(gpu(), field);
    ASSERT_TRUE(light);
    RenderSettings made = settings();
    made.shapes = kCrowd;
    auto renderer = SceneRenderer::create(gpu(), *device, *light, made);
    ASSERT_TRUE(renderer) << renderer.error().message;
    const auto there = (*renderer)->render(scene.cameras.front());
    ASSERT_TRUE(there);
    ASSERT_TRUE((*renderer)->setShapes({}));
    const auto gone = (*renderer)->render(scene.cameras.front());
    ASSERT_TRUE(gone);
    EXPECT_NE(there->beauty, gone->beauty);
    EXPECT_EQ(gone->beauty, draw({}, {}).beauty);
    std::vector<MovingShape> many(4, kCrowd[0]);
    EXPECT_EQ((*renderer)->setShapes(many).error().message,
              "Moving shapes: 4 shapes move, and this frame was made for 3; give Desc::movingShapes up to 256");
}

// A host may be wrong about where its shapes are: surfaces that go through their middles have light, or none, but no NaN.
TEST_F(MovingShapeFrames, SurfacesWithinShapesStayFinite)
{
    std::vector<MovingShape> within;
    for (int i = 0; i < 30; ++i)
        within.push_back(
            shape(MovingShape::Kind(uint32_t(i) % 3), {-1.5f + 0.1f * float(i), 0.0f, -1.0f + 0.05f * float(i)}, vec3(0.4f), float(i)));
    const RenderedFrame frame = draw({}, within);
    for (const vec3& pixel : frame.beauty) ASSERT_TRUE(std::isfinite(pixel.x + pixel.y + pixel.z) && pixel.x >= 0.0f);
}

// As many as there may be, and one more.
TEST_F(MovingShapeFrames, ManyShapesAreDrawnAndFinite)
{
    std::vector<MovingShape> many;
    for (uint32_t i = 0; i < 256; ++i)
        many.push_back(
            shape(MovingShape::Kind(i % 3), {-1.8f + 0.24f * float(i % 16), 0.1f, -1.8f + 0.24f * float(i / 16)}, vec3(0.08f), float(i)));
    Scene crowded = room();
    addShapes(crowded, many);
    RenderSettings few = settings();
    few.width = few.height = 32;
    few.shapes = many;
    const auto frame = drawWith(field, crowded, few);
    ASSERT_TRUE(frame) << frame.error().message;
    for (const vec3& pixel : frame->beauty) ASSERT_TRUE(std::isfinite(pixel.x + pixel.y + pixel.z) && pixel.x >= 0.0f);
    many.push_back(many.front());
    Scene scene = room();
    RenderSettings made = settings();
    made.shapes = many;
    const auto refused = drawWith(field, scene, made);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("movingShapes is 257; give at most 256"), std::string::npos) << refused.error().message;
}

} // namespace
} // namespace sconce
