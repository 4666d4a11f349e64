// Frames at the ends of what can be asked for: roughness 0 and 1, light of 0 and of 1e6, pictures one pixel wide or high, cameras where
// nobody stands, lights that are none.
#include <cstring>

#include <gtest/gtest.h>

#include "bench/reference/reference.h"
#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"
#include "tests/properties/frames/frame_test.h"
#include "tests/properties/hard_cases/hard_case.h"
#include "tests/properties/hard_cases/hard_frames.h"
#include "tests/support/cornell_field.h"

namespace sconce
{
namespace
{

using namespace testing_support;

const std::vector<vec3> kFewProbes = {{0.0f, 1.5f, 0.5f}, {-0.8f, 0.5f, 0.6f}, {0.8f, 0.5f, -0.4f}, {-0.75f, 1.0f, -0.8f}};

/// Calls a function with every number of a frame that may not be NaN or infinite.
template <class Each> void eachNumber(const RenderedFrame& frame, const Each& each)
{
    for (const auto* layer : {&frame.beauty, &frame.direct, &frame.diffuseIndirect, &frame.glossyIndirect, &frame.normal, &frame.albedo})
        for (const vec3& pixel : *layer)
            for (int c = 0; c < 3; ++c) each(pixel[c]);
    for (const auto* layer : {&frame.depth, &frame.roughness})
        for (float value : *layer) each(value);
}

size_t notFinite(const RenderedFrame& frame)
{
    size_t bad = 0;
    eachNumber(frame, [&](float value) { bad += !std::isfinite(value); });
    return bad;
}

/// Words of a field's radiance, irradiance and moments that hold an infinity or a NaN.
size_t notFinite(const FieldData& field)
{
    const auto small = [](uint32_t word) { return (word >> 6 & 31u) == 31u || (word >> 17 & 31u) == 31u || word >> 27 == 31u; };
    const auto half = [](uint32_t word) { return (word >> 10 & 31u) == 31u || (word >> 26 & 31u) == 31u; };
    size_t bad = 0;
    for (const auto* words : {&field.radiance, &field.prefiltered})
        for (uint32_t word : *words) bad += small(word);
    for (size_t i = 0; i + 1 < field.irradiance.size(); i += 2) bad += small(field.irradiance[i]) + half(field.irradiance[i + 1]);
    return bad;
}

class HardFrames : public FrameTest
{
protected:
    Result<FieldData> smallField(const Scene& scene)
    {
        BakeSettings bake;
        bake.resolution = 64;
        bake.bounces = 1;
        bake.scene = fewSamples();
        bake.surfaceTexels = 26;
        bake.surfaceRays = 16;
        return bakeOnce(scene, kFewProbes, bake);
    }

    /// Every effect at once, filters in space and time.
    static RenderSettings everything(uint32_t width, uint32_t height)
    {
        RenderSettings settings;
        settings.width = width;
        settings.height = height;
        settings.effects.temporal = true;
        return settings;
    }

    /// Draws a camera's frames, the last of which is returned; all of them are scanned for bad numbers.
    Result<RenderedFrame> drawFrames(const FieldData& field, const Scene& scene, const RenderSettings& settings,
                                     std::span<const Camera> cameras, size_t& bad)
    {
        auto device = DeviceScene::create(gpu(), scene, field.info, fewSamples());
        if (!device) return device.error();
        auto light = makeLightField(gpu(), field);
        if (!light) return light.error();
        auto renderer = SceneRenderer::create(gpu(), *device, *light, settings);
        if (!renderer) return renderer.error();
        Result<RenderedFrame> frame = Error{};
        for (uint32_t i = 0; i < cameras.size(); ++i)
        {
            frame = (*renderer)->render(cameras[i], i);
            if (!frame) return frame;
            bad += notFinite(*frame);
        }
        return frame;
    }

    /// cornell-glossy with a small field, baked once for all tests.
    const FieldData& cornellField()
    {
        static const FieldData field = *smallField(cornell());
        return field;
    }
    static const Scene& cornell()
    {
        static const Scene scene = *makeBuiltinScene("cornell-glossy");
        return scene;
    }
};

TEST_F(HardFrames, RoughnessExactlyZeroAndOneAgainstThePathTracer)
{
    for (const float roughness : {0.0f, 1.0f})
    {
        // Of the scene itself, so that what surfaces throw on others has it, too: the frame's own setting is of what the eye sees alone.
        Scene scene = cornell();
        for (Material& material : scene.materials) material.roughness = roughness;
        // As users bake: rays to triangles, default maps and texels, one of which would be as wide as what a mirror of this box shows.
        const auto field = bakeByTriangles(scene, kCornellProbes, bakeOf(knobs::resolution.value, 2, knobs::surfaceTexels.value));
        ASSERT_TRUE(field) << field.error().message;
        RenderSettings settings = settingsOf(64);
        settings.glossyRays = 8;
        settings.areaSamples = 64;
        const auto frame = drawWith(*field, scene, settings);
        ASSERT_TRUE(frame) << frame.error().message;
        ReferenceSettings reference;
        reference.bounces = 2;
        reference.width = reference.height = 64;
        reference.samples = 128;
        reference.pixelCentre = true;
        reference.camera = scene.cameras.front();
        const ImageSet truth = std::move(renderReference(scene, reference)->images);
        const std::string name = roughness > 0.0f ? "every roughness exactly 1" : "every roughness exactly 0";
        const size_t pixels = frame->beauty.size();
        const double asked = mean(truth.find("beauty")->pixels), glossy = mean(truth.find("glossy_indirect")->pixels);
        expectAtMost(name + ": numbers that are not finite", pixels, double(notFinite(*frame)), 0.0);
        expectAtMost(name + ": mean light against the path tracer, relative", pixels, std::abs(mean(frame->beauty) / asked - 1.0), 0.008);
        expectAtMost(name + ": mean of reflections against the path tracer, relative", pixels,
                     std::abs(mean(frame->glossyIndirect) / glossy - 1.0), roughness > 0.0f ? 0.08 : 0.07, 0.03);
    }
}

TEST_F(HardFrames, BlackLightIsBlackToTheBit)
{
    Scene black = cornell();
    for (Material& material : black.materials) material.emission = vec3(0.0f);
    black.sky = vec3(0.0f);
    black.lights.clear();
    Scene zero = black; // lights that are there and give nothing
    for (const LightType type : {LightType::directional, LightType::point, LightType::spot})
    {
        Light light;
        light.type = type;
        light.position = vec3(0.0f, 1.5f, 0.0f);
        zero.lights.push_back(light);
    }
    Scene coal = cornell(); // light, and nothing that reflects it
    for (Material& material : coal.materials) material.baseColor = vec4(0.0f, 0.0f, 0.0f, 1.0f);
    size_t lit = 0, inField = 0, bad = 0, numbers = 0;
    for (const Scene* scene : {&black, &zero})
    {
        const auto field = smallField(*scene);
        ASSERT_TRUE(field) << field.error().message;
        for (const auto* words : {&field->radiance, &field->prefiltered})
            for (uint32_t word : *words) inField += word != 0;
        for (size_t i = 0; i < field->irradiance.size(); i += 2) inField += field->irradiance[i] != 0;
        inField += notFinite(*field);
        const std::vector<Camera> still(3, scene->cameras.front());
        const auto frame = drawFrames(*field, *scene, everything(64, 36), still, bad);
        ASSERT_TRUE(frame) << frame.error().message;
        for (const auto* layer : {&frame->beauty, &frame->direct, &frame->diffuseIndirect, &frame->glossyIndirect})
            for (const vec3& pixel : *layer) lit += pixel != vec3(0.0f);
        numbers += 4 * frame->beauty.size();
    }
    const std::vector<Camera> still(3, coal.cameras.front());
    const auto frame = drawFrames(cornellField(), coal, everything(64, 36), still, bad);
    ASSERT_TRUE(frame) << frame.error().message;
    size_t scattered = 0;
    for (const vec3& pixel : frame->diffuseIndirect) scattered += pixel != vec3(0.0f);
    expectAtMost("black light, no light: pixels that are not exactly 0", numbers, double(lit), 0.0);
    expectAtMost("black light, no light: words of the field's light that are not exactly 0", 2 * cornellField().radiance.size(),
                 double(inField), 0.0);
    expectAtMost("black surfaces: pixels of diffuse light that are not exactly 0", frame->beauty.size(), double(scattered), 0.0);
    expectAtMost("black light, no light, black surfaces: numbers that are not finite", numbers, double(bad), 0.0);
}

TEST_F(HardFrames, LightOfAMillionIsFiniteEverywhere)
{
    std::pair<const char*, Scene> scenes[] = {{"emitter and sky", cornell()}, {"sun, spot and point lights", cornell()}};
    for (Material& material : scenes[0].second.materials) material.emission *= 1e6f;
    scenes[0].second.sky = vec3(1e6f);
    for (const LightType type : {LightType::directional, LightType::point, LightType::spot, LightType::point})
    {
        Light light;
        light.type = type;
        light.position = vec3(0.3f, scenes[1].second.lights.size() == 3 ? 0.0f : 1.5f, 0.2f); // the last one in the floor's plane
        light.direction = glm::normalize(vec3(0.1f, -1.0f, -0.2f));
        light.intensity = vec3(1e6f);
        scenes[1].second.lights.push_back(light);
    }
    for (const auto& [name, scene] : scenes)
    {
        const auto field = smallField(scene);
        ASSERT_TRUE(field) << field.error().message;
        const std::vector<Camera> still(3, scene.cameras.front());
        size_t bad = 0;
        const auto frame = drawFrames(*field, scene, everything(64, 36), still, bad);
        ASSERT_TRUE(frame) << frame.error().message;
        const std::string row = std::string("light of 1e6, ") + name;
        expectAtMost(row + ": words of the field that are not finite", field->radiance.size(), double(notFinite(*field)), 0.0);
        expectAtMost(row + ": numbers of three frames that are not finite", 3 * 20 * frame->beauty.size(), double(bad), 0.0);
        double brightest = 0.0, asked = 0.0;
        for (const vec3& pixel : frame->beauty) brightest = std::max(brightest, double(pixel.x));
        for (const Material& material : scene.materials) asked = std::max(asked, double(material.emission.x));
        EXPECT_GT(mean(frame->beauty), 1.0) << name;
        if (asked > 1e5)
            expectAtMost(row + ": brightest pixel against what the lamp emits, relative", frame->beauty.size(),
                         std::abs(brightest / asked - 1.0), 1.0 / 2048.0); // half of a half float's step
    }
}

TEST_F(HardFrames, PicturesOnePixelWideOrHighAreStripsOfWiderOnes)
{
    struct Size
    {
        uint32_t width, height;
        bool column; // compared with the middle column of a picture thrice as wide, else with the middle rows of one thrice as high
    };
    for (const Size size : {Size{1, 1, true}, Size{1, 4096, true}, Size{4096, 1, false}, Size{4093, 3, false}})
    {
        // A strip as long as the scene's own picture, whichever side is the longer.
        Camera camera = cornell().cameras[1];
        camera.forward = glm::normalize(vec3(-1.75f, 0.15f, -0.6f)); // at the red wall, clear of the boxes
        const float tangent = std::tan(0.5f * camera.verticalFov);
        camera.verticalFov = 2.0f * std::atan(tangent * std::min(1.0f, float(size.height) / float(size.width)));
        Camera wide = camera;
        Size around{size.column ? 3 * size.width : size.width, size.column ? size.height : 3 * size.height, size.column};
        if (!size.column) wide.verticalFov = 2.0f * std::atan(3.0f * std::tan(0.5f * camera.verticalFov));
        size_t bad = 0;
        const size_t pixels = size_t(size.width) * size.height,
                     frames = pixels == 1 ? 32 : 2; // one pixel's noise is blended away over time
        const std::vector<Camera> narrow(frames, camera), wider(frames, wide);
        const auto strip = drawFrames(cornellField(), cornell(), everything(size.width, size.height), narrow, bad);
        const auto picture = drawFrames(cornellField(), cornell(), everything(around.width, around.height), wider, bad);
        ASSERT_TRUE(strip) << strip.error().message;
        ASSERT_TRUE(picture) << picture.error().message;
        // G-buffer and direct light of a pixel don't depend on what is around it, but for rounding; noise and its filters do.
        size_t other = 0;
        double own = 0.0, theirs = 0.0;
        for (uint32_t y = 0; y < size.height; ++y)
            for (uint32_t x = 0; x < size.width; ++x)
            {
                const size_t a = size_t(y) * size.width + x;
                const size_t b = size.column ? size_t(y) * around.width + size.width + x : size_t(size.height + y) * around.width + x;
                const vec3 lit = strip->direct[a] - picture->direct[b];
                other += std::abs(strip->depth[a] - picture->depth[b]) > 1e-4f * picture->depth[b] ||
                         glm::length(lit) > 1e-3f * (glm::length(picture->direct[b]) + 0.01f) || strip->albedo[a] != picture->albedo[b];
                own += double(strip->diffuseIndirect[a].y + strip->glossyIndirect[a].y);
                theirs += double(picture->diffuseIndirect[b].y + picture->glossyIndirect[b].y);
            }
        const std::string row = "picture of " + std::to_string(size.width) + " x " + std::to_string(size.height);
        expectAtMost(row + ": numbers that are not finite", pixels, double(bad), 0.0);
        expectAtMost(row + ": share of pixels whose surface or direct light is another than in a wider picture", pixels,
                     double(other) / double(pixels), 5e-4); // two of 4,096: none was found, and edges hang on the driver's rounding
        expectAtMost(row + ": indirect light against the wider picture's, relative", pixels, std::abs(own / theirs - 1.0),
                     pixels == 1 ? 0.15 : 0.035); // noise: twice the most that was found of a pixel, and of thousands
    }
}

TEST_F(HardFrames, CamerasWhereNobodyStands)
{
    const struct
    {
        const char* name;
        vec3 eye, forward;
        float fov = 1.0f; // radians, vertical
    } places[] = {{"in a box", {-0.33f, 0.3f, -0.3f}, {0.0f, 0.0f, -1.0f}},
                  {"in a probe's centre", kFewProbes[1], {1.0f, 0.0f, 0.0f}},
                  {"in the plane of a wall", {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}},
                  {"just off a wall", {0.0f, 1e-5f, 0.0f}, {0.0f, -1.0f, 0.0f}},
                  {"outside", {0.0f, 1.0f, 30.0f}, {0.0f, 0.0f, -1.0f}},
                  {"outside, looking away", {0.0f, 1.0f, 30.0f}, {0.0f, 0.0f, 1.0f}},
                  {"through a telescope", {0.0f, 1.0f, 0.9f}, {0.0f, 0.0f, -1.0f}, 1e-3f},
                  {"through a larger one, just off a wall", {0.5f, 1.0f, -0.999f}, {0.0f, 0.0f, -1.0f}, 1e-6f},
                  {"with nearly a half space", {0.0f, 1.0f, 0.9f}, {0.0f, 0.0f, -1.0f}, 3.09f},
                  {"1e6 m outside", {1e6f, 1e6f, 1e6f}, {-0.57735027f, -0.57735027f, -0.57735027f}}};
    std::vector<Camera> cameras;
    for (const auto& place : places)
    {
        Camera camera;
        camera.eye = place.eye;
        camera.forward = place.forward;
        camera.verticalFov = place.fov;
        camera.up = std::abs(place.forward.y) > 0.9f ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 1.0f, 0.0f);
        cameras.push_back(camera);
        cameras.push_back(camera); // history of its own place, too
    }
    size_t bad = 0;
    const auto frame = drawFrames(cornellField(), cornell(), everything(61, 37), cameras, bad);
    ASSERT_TRUE(frame) << frame.error().message;
    expectAtMost("cameras in walls, in a probe, outside: numbers that are not finite", cameras.size() * 20 * frame->beauty.size(),
                 double(bad), 0.0);
    double brightest = 0.0;
    for (const Material& material : cornell().materials) brightest = std::max(brightest, double(material.emission.x));
    double worst = 0.0;
    for (const vec3& pixel : frame->beauty) worst = std::max(worst, double(pixel.x));
    // From there the scene is less than a pixel: what that shows, if anything, hangs on the driver's rounding.
    expectAtMost("camera 1e6 m outside: brightest pixel, share of the lamp", frame->beauty.size(), worst / brightest, 1.0);
}

TEST_F(HardFrames, CamerasThatAreNoneAreRefusedWithASentence)
{
    const auto device = DeviceScene::create(gpu(), cornell(), cornellField().info, fewSamples());
    const auto light = makeLightField(gpu(), cornellField());
    ASSERT_TRUE(device && light);
    const auto renderer = SceneRenderer::create(gpu(), *device, *light, settingsOf(16));
    ASSERT_TRUE(renderer);
    const Camera good = cornell().cameras.front();
    std::vector<Camera> cameras(6, good);
    cameras[0].eye.x = NAN;
    cameras[1].forward = vec3(0.0f);
    cameras[2].up = cameras[2].forward;
    cameras[3].verticalFov = 0.0f;
    cameras[4].verticalFov = 3.2f;
    cameras[5].eye.y = INFINITY;
    size_t drawn = 0;
    for (const Camera& camera : cameras)
    {
        const auto frame = (*renderer)->render(camera);
        drawn += bool(frame);
        if (!frame)
        {
            EXPECT_EQ(frame.error().code, ErrorCode::badArgument);
            EXPECT_NE(frame.error().message.find("camera"), std::string::npos) << frame.error().message;
        }
    }
    expectAtMost("cameras with NaN, infinity, no direction, no field of view: drawn all the same", cameras.size(), double(drawn), 0.0);
    EXPECT_TRUE((*renderer)->render(good)) << "a refused camera leaves nothing behind";
}

TEST_F(HardFrames, AnotherSizeFromFrameToFrame)
{
    const auto device = DeviceScene::create(gpu(), cornell(), cornellField().info, fewSamples());
    const auto light = makeLightField(gpu(), cornellField());
    ASSERT_TRUE(device && light);
    const std::pair<uint32_t, uint32_t> sizes[] = {{64, 36}, {1, 1}, {127, 3}, {9, 65}, {64, 36}};
    std::optional<RenderedFrame> first;
    size_t bad = 0, other = 0;
    std::unique_ptr<SceneRenderer> before; // as a host keeps the old size's until the new one is there
    for (const auto& [width, height] : sizes)
    {
        auto renderer = SceneRenderer::create(gpu(), *device, *light, everything(width, height));
        ASSERT_TRUE(renderer) << renderer.error().message;
        const auto frame = (*renderer)->render(cornell().cameras.front());
        ASSERT_TRUE(frame) << frame.error().message;
        bad += notFinite(*frame);
        if (!first)
            first = *frame;
        else if (frame->beauty.size() == first->beauty.size())
            for (size_t i = 0; i < frame->beauty.size(); ++i) other += frame->beauty[i] != first->beauty[i];
        before = std::move(*renderer);
    }
    expectAtMost("another size from frame to frame: numbers that are not finite", 5, double(bad), 0.0);
    expectAtMost("back at the first size: pixels with another bit", first->beauty.size(), double(other), 0.0);
}

TEST_F(HardFrames, EmittersWithoutAreaGiveNothing)
{
    const auto withEmptyLamps = [](Scene scene)
    {
        MeshBuilder mesh(scene);
        const uint32_t lamp = mesh.emitter("lamp without area", vec3(1e5f));
        mesh.triangle({0.1f, 1.0f, 0.0f}, {0.2f, 1.0f, 0.0f}, {0.3f, 1.0f, 0.0f}, lamp); // a line
        mesh.triangle({0.1f, 0.5f, 0.2f}, {0.1f, 0.5f, 0.2f}, {0.1f, 0.5f, 0.2f}, lamp); // a point
        for (size_t i = scene.normals.size() - 6; i < scene.normals.size(); ++i) scene.normals[i] = vec3(0.0f, 1.0f, 0.0f);
        return scene;
    };
    Scene dark = cornell();
    for (Material& material : dark.materials) material.emission = vec3(0.0f);
    size_t bad = 0, lit = 0, other = 0;
    const Scene beside = withEmptyLamps(cornell()), alone = withEmptyLamps(dark);
    const auto field = smallField(beside), darkField = smallField(alone);
    ASSERT_TRUE(field) << field.error().message;
    ASSERT_TRUE(darkField) << darkField.error().message;
    bad += notFinite(*field) + notFinite(*darkField);
    EXPECT_EQ(cornellField().irradiance, field->irradiance) << "to the bit";
    for (size_t i = 0; i < darkField->irradiance.size(); i += 2) lit += darkField->irradiance[i] != 0;
    const std::vector<Camera> still(2, beside.cameras.front());
    const auto without = drawFrames(cornellField(), cornell(), everything(64, 36), still, bad);
    const auto frame = drawFrames(*field, beside, everything(64, 36), still, bad);
    ASSERT_TRUE(without && frame);
    for (size_t i = 0; i < frame->beauty.size(); ++i) other += frame->beauty[i] != without->beauty[i];
    expectAtMost("emitters without area: numbers that are not finite", 2 * 64 * 36, double(bad), 0.0);
    expectAtMost("emitters without area: pixels with another bit than without them", 2 * 64 * 36, double(other), 0.0);
    expectAtMost("emitters without area alone: texels of irradiance that are not exactly 0", darkField->irradiance.size() / 2, double(lit),
                 0.0);
}

TEST_F(HardFrames, EmptySceneIsRefusedWithASentenceByEveryStage)
{
    Scene empty;
    empty.name = "nothing";
    const auto field = smallField(empty);
    ASSERT_FALSE(field);
    EXPECT_EQ(field.error().code, ErrorCode::badInput);
    EXPECT_NE(field.error().message.find("no triangles"), std::string::npos) << field.error().message;
    const auto device = DeviceScene::create(gpu(), empty, cornellField().info);
    ASSERT_FALSE(device);
    EXPECT_EQ(device.error().code, ErrorCode::badInput);
    EXPECT_NE(device.error().message.find("no triangles"), std::string::npos) << device.error().message;
}

} // namespace
} // namespace sconce
