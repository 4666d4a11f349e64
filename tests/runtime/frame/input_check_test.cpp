#include "runtime/frame/input_check.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "runtime/field/light_field.h"
#include "scene/builtin_scenes.h"
#include "scene/view_rays.h"
#include "tests/properties/frames/frame_test.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr uint32_t kSide = 96;
constexpr float kNear = 0.05f; // metres

/// A frame as a host hands it over.
struct Frame
{
    std::vector<vec4> depth, normal, base;
    gpu::FrameView view{};

    template <class Change> void each(std::vector<vec4> Frame::*image, const Change& change)
    {
        for (vec4& pixel : this->*image) change(pixel);
    }
};

using Sabotage = std::function<void(Frame&)>;

float decoded(float c)
{
    return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

float encoded(float c)
{
    return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f;
}

/// Axes by rows.
mat4 rows(vec3 x, vec3 y, vec3 z)
{
    return glm::transpose(mat4(vec4(x, 0), vec4(y, 0), vec4(z, 0), vec4(0, 0, 0, 1)));
}

/// The whole world of a frame as another host would have it.
Sabotage inWorld(const mat4& turn)
{
    return [=](Frame& frame)
    {
        frame.view.worldFromClip = turn * frame.view.worldFromClip;
        frame.view.eye = frame.view.eyeBefore = vec3(turn * vec4(frame.view.eye, 1));
        frame.view.clipFromWorldBefore = frame.view.clipFromWorldBefore * glm::inverse(turn);
        frame.each(&Frame::normal, [&](vec4& n) { n = vec4(glm::normalize(glm::mat3(turn) * vec3(n)), n.w); });
    };
}

class InputCheckTest : public FrameTest
{
protected:
    void SetUp() override
    {
        Scene scene = *makeBuiltinScene("cornell-glossy");
        camera.eye = vec3(0.6f, 1.3f, 0.9f); // looks along no axis: its own axes are not the world's
        camera.forward = glm::normalize(vec3(-0.8f, -0.45f, -1.0f));
        camera.up = glm::normalize(glm::cross(glm::cross(camera.forward, vec3(0, 1, 0)), camera.forward));
        camera.verticalFov = 1.2f;
        scene.cameras = {camera};
        const std::vector<vec3> probes = {{0.0f, 1.5f, 0.5f}, {-0.7f, 0.5f, 0.6f}, {0.7f, 1.2f, -0.3f}, {0.75f, 0.4f, 0.8f}};
        auto baked = bakeField(scene, probes, 256, 2);
        ASSERT_TRUE(baked) << baked.error().message;
        auto made = makeLightField(gpu(), *baked);
        ASSERT_TRUE(made) << made.error().message;
        field.emplace(std::move(*made));
        const auto drawn = drawWith(*baked, scene, settingsOf(kSide));
        ASSERT_TRUE(drawn) << drawn.error().message;
        right = frameOf(*drawn);
    }

    Frame frameOf(const RenderedFrame& drawn) const
    {
        Frame frame;
        for (size_t i = 0; i < drawn.depth.size(); ++i)
        {
            frame.depth.emplace_back(drawn.depth[i] > 0.0f ? kNear / drawn.depth[i] : 0.0f);
            frame.normal.emplace_back(drawn.normal[i], drawn.roughness[i]);
            frame.base.emplace_back(drawn.albedo[i], 0.0f);
        }
        const Pinhole seen(camera, kSide, kSide);
        frame.view = field->frameView(kSide, kSide);
        frame.view.worldFromClip =
            mat4(vec4(kNear * seen.right, 0), vec4(-kNear * seen.up, 0), vec4(seen.eye, 1), vec4(kNear * seen.forward, 0));
        frame.view.eye = frame.view.eyeBefore = seen.eye;
        const vec3 x = seen.right / glm::dot(seen.right, seen.right), y = -seen.up / glm::dot(seen.up, seen.up), w = seen.forward;
        frame.view.clipFromWorldBefore = mat4(vec4(x.x, y.x, 0, w.x), vec4(x.y, y.y, 0, w.y), vec4(x.z, y.z, 0, w.z),
                                              vec4(-glm::dot(x, seen.eye), -glm::dot(y, seen.eye), 0, -glm::dot(w, seen.eye)));
        frame.view.follows = 1;
        return frame;
    }

    Result<std::vector<std::string>> check(const Frame& frame)
    {
        const GpuImage depth = image(frame.depth, kSide, "depth"), normal = image(frame.normal, kSide, "normals"),
                       base = image(frame.base, kSide, "base colours");
        return checkInputs(gpu(), *field, {depth.view(), normal.view(), base.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}, frame.view);
    }

    /// All that is said of a sabotaged frame, a sentence a line.
    std::string saidOf(const Sabotage& sabotage)
    {
        Frame frame = right;
        sabotage(frame);
        const auto found = check(frame);
        if (!found) return "error: " + found.error().message;
        std::string lines;
        for (const std::string& fault : *found) lines += fault + "\n";
        return lines;
    }

    Camera camera;
    std::optional<LightField> field;
    Frame right;
};

TEST_F(InputCheckTest, EachMistakeIsNamedAndNoneWhereThereIsNone)
{
    EXPECT_EQ(saidOf([](Frame&) {}), "");
    EXPECT_EQ(saidOf([](Frame& frame) { frame.each(&Frame::normal, [](vec4& n) { n.w += gpu::kRetro; }); }), "") << "retroreflective";
    const auto view = [](auto&& change) { return [=](Frame& frame) { change(frame.view); }; };
    const auto metres = [](const vec4& depth) { return depth.x > 0.0f ? kNear / depth.x : 0.0f; };
    const Pinhole seen(camera, kSide, kSide);
    const auto ofView = [&](float towards)
    {
        const mat4 turn = rows(glm::normalize(seen.right), glm::normalize(seen.up), -towards * seen.forward);
        return [=](Frame& frame) { frame.each(&Frame::normal, [&](vec4& n) { n = vec4(glm::mat3(turn) * vec3(n), n.w); }); };
    };
    const struct
    {
        const char* what;
        Sabotage sabotage;
        const char* said;
    } table[] = {
        {"depth not reversed", [](Frame& f) { f.each(&Frame::depth, [](vec4& d) { d = vec4(1.0f - d.x); }); }, "0 at the near plane"},
        {"depth in metres", [&](Frame& f) { f.each(&Frame::depth, [&](vec4& d) { d = vec4(metres(d)); }); },
         "metres along the camera's axis"},
        {"matrix of forward depth",
         view(
             [](gpu::FrameView& v)
             {
                 mat4 flip(1.0f); // depth to 1 - depth
                 flip[2][2] = -1.0f;
                 flip[3][2] = 1.0f;
                 v.worldFromClip = v.worldFromClip * flip;
             }),
         "of a depth that grows with distance"},
        {"all of forward depth",
         [](Frame& f)
         {
             f.each(&Frame::depth, [](vec4& d) { d = vec4(1.0f - d.x); });
             mat4 flip(1.0f);
             flip[2][2] = -1.0f;
             flip[3][2] = 1.0f;
             f.view.worldFromClip = f.view.worldFromClip * flip;
         },
         "of a depth that grows with distance"},
        {"y up in clip space", view([](gpu::FrameView& v) { v.worldFromClip[1] *= -1.0f; }), "upside down"},
        {"mirrored", view([](gpu::FrameView& v) { v.worldFromClip[0] *= -1.0f; }), "mirrored"},
        {"transposed", view([](gpu::FrameView& v) { v.worldFromClip = glm::transpose(v.worldFromClip); }), "transposed"},
        {"inverse", view([](gpu::FrameView& v) { v.worldFromClip = glm::inverse(v.worldFromClip); }), "give its inverse"},
        {"centimetres",
         view(
             [](gpu::FrameView& v)
             {
                 for (int i = 0; i < 4; ++i) v.worldFromClip[i] *= vec4(100, 100, 100, 1);
                 v.eye *= 100.0f;
             }),
         "centimetres"},
        {"millimetres",
         view(
             [](gpu::FrameView& v)
             {
                 for (int i = 0; i < 4; ++i) v.worldFromClip[i] *= vec4(1000, 1000, 1000, 1);
                 v.eye *= 1000.0f;
             }),
         "millimetres"},
        {"z up", inWorld(rows({1, 0, 0}, {0, 0, -1}, {0, 1, 0})), "z up"},
        {"left-handed", inWorld(rows({1, 0, 0}, {0, 1, 0}, {0, 0, -1})), "left-handed"},
        {"another place", inWorld(mat4(vec4(1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0), vec4(0.6f, 0.45f, 0.55f, 1))),
         "the field of this scene"},
        {"eye at the origin", view([](gpu::FrameView& v) { v.eye = vec3(0.0f); }), "FrameView::eye is 0,0,0"},
        {"eye of two frames before", view([](gpu::FrameView& v) { v.eyeBefore += vec3(0.3f, 0.0f, 0.2f); }), "eyeBefore"},
        {"matrix before transposed", view([](gpu::FrameView& v) { v.clipFromWorldBefore = glm::transpose(v.clipFromWorldBefore); }),
         "clipFromWorldBefore"},
        {"cut that follows",
         view(
             [](gpu::FrameView& v)
             {
                 v.eyeBefore = v.eye + vec3(20.0f, 0.0f, 0.0f);
                 v.clipFromWorldBefore[3] -= v.clipFromWorldBefore * vec4(20.0f, 0.0f, 0.0f, 0.0f);
             }),
         "follows to 0"},
        {"size of the window",
         view(
             [](gpu::FrameView& v) {
                 v.size = {2 * kSide, kSide};
             }),
         "96 x 96 pixels and FrameView::size says 192 x 96"},
        {"no view of the field's", view([](gpu::FrameView& v) { v.normalOffset = 0.0f; }), "normalOffset is 0 m"},
        {"no rays", view([](gpu::FrameView& v) { v.glossyRays = 0; }), "glossyRays"},
        {"a roughness in per cent", view([](gpu::FrameView& v) { v.raysBelow = 40.0f; }), "raysBelow"},
        {"G-buffer not drawn", [](Frame& f) { f.each(&Frame::depth, [](vec4& d) { d = vec4(0.0f); }); }, "make it visible by a barrier"},
        {"numbers that are none",
         [](Frame& f)
         {
             for (size_t i = 0; i < f.base.size(); i += 3) f.base[i].x = NAN;
         },
         "NaN"},
        {"normals packed", [](Frame& f) { f.each(&Frame::normal, [](vec4& n) { n = vec4(0.5f * vec3(n) + 0.5f, n.w); }); }, "packed"},
        {"normals inward", [](Frame& f) { f.each(&Frame::normal, [](vec4& n) { n = vec4(-vec3(n), n.w); }); }, "into the surface"},
        {"normals of the view", ofView(1.0f), "in view space, z towards"},
        {"normals of the view, z away", ofView(-1.0f), "in view space, z away"},
        {"normals not unit", [](Frame& f) { f.each(&Frame::normal, [](vec4& n) { n = vec4(0.6f * vec3(n), n.w); }); }, "aren't unit"},
        {"roughness in bytes", [](Frame& f) { f.each(&Frame::normal, [](vec4& n) { n.w *= 255.0f; }); }, "roughness"},
        {"metallic in bytes", [](Frame& f) { f.each(&Frame::base, [](vec4& b) { b.w = 255.0f; }); }, "metallic"},
        {"base colour in bytes", [](Frame& f) { f.each(&Frame::base, [](vec4& b) { b = vec4(255.0f * vec3(b), b.w); }); },
         "base colour outside"},
        {"sRGB not decoded",
         [](Frame& f) { f.each(&Frame::base, [](vec4& b) { b = vec4(encoded(b.x), encoded(b.y), encoded(b.z), b.w); }); },
         "is sRGB-encoded"},
        {"sRGB decoded twice",
         [](Frame& f) { f.each(&Frame::base, [](vec4& b) { b = vec4(decoded(b.x), decoded(b.y), decoded(b.z), b.w); }); }, "sRGB twice"},
    };
    for (const auto& [what, sabotage, said] : table)
    {
        const std::string lines = saidOf(sabotage);
        EXPECT_NE(lines.find(said), std::string::npos) << what << ":\n" << lines;
        EXPECT_LE(std::ranges::count(lines, '\n'), 2) << what << ":\n" << lines; // one mistake is not ten
    }

    // What cannot be asked is refused.
    EXPECT_NE(saidOf([](Frame& f) { f.view.size = {0, 0}; }).find("error: A FrameView of 0 x 0 pixels"), std::string::npos);
    EXPECT_NE(saidOf([](Frame& f) { f.view.worldFromClip[2][1] = NAN; }).find("error: "), std::string::npos);
    const auto missing = checkInputs(gpu(), *field, {}, right.view);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::badArgument);
}

TEST_F(InputCheckTest, AHostsOwnWorldIsRightOnceItsViewIsTurned)
{
    mat4 moved = rows({0.6f, 0.0f, -0.8f}, {0.0f, 1.0f, 0.0f}, {0.8f, 0.0f, 0.6f});
    moved[3] = vec4(3.0f, -2.0f, 5.0f, 1.0f);
    mat4 centimetres = 100.0f * rows({1, 0, 0}, {0, 0, 1}, {0, 1, 0}); // z up, left-handed
    centimetres[3][3] = 1.0f;
    for (const mat4& hostFromField : {rows({1, 0, 0}, {0, 1, 0}, {0, 0, -1}), centimetres, moved})
    {
        Frame frame = right;
        inWorld(hostFromField)(frame);
        const auto wrong = check(frame);
        ASSERT_TRUE(wrong.ok()) << wrong.error().message;
        EXPECT_FALSE(wrong->empty());
        const auto turned = inFieldsWorld(frame.view, glm::inverse(hostFromField));
        ASSERT_TRUE(turned.ok()) << turned.error().message;
        frame.view = *turned;
        const auto found = check(frame);
        ASSERT_TRUE(found.ok()) << found.error().message;
        EXPECT_EQ(*found, std::vector<std::string>());
    }
}

TEST_F(InputCheckTest, AWorldThatIsStretchedIsNoWorld)
{
    mat4 stretched(1.0f), sheared(1.0f), projected(1.0f);
    stretched[1][1] = 2.0f;
    sheared[1][0] = 0.3f;
    projected[2][3] = 1.0f;
    for (const mat4& matrix : {stretched, sheared, projected, mat4(0.0f), mat4(std::nanf(""))})
    {
        const auto turned = inFieldsWorld(right.view, matrix);
        ASSERT_FALSE(turned.ok());
        EXPECT_EQ(turned.error().code, ErrorCode::badArgument);
    }
}

} // namespace
} // namespace sconce
