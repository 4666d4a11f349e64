#include "bench/reference/reference.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/support/test_scenes.h"

namespace sconce
{
namespace
{

using test::addBox;
using test::addQuad;
using test::meanOf;
using test::plain;
using test::view;

Reference render(const Scene& scene, const ReferenceSettings& settings)
{
    Result<Reference> reference = renderReference(scene, settings);
    EXPECT_TRUE(reference.ok()) << reference.error().message;
    EXPECT_EQ(reference->nonFinitePaths, 0u);
    return *reference;
}

Scene floorUnder(float albedo, float roughness = 1.0f, float metallic = 0.0f)
{
    Scene scene;
    scene.name = "floor";
    scene.materials = {plain(vec3(albedo), roughness, metallic)};
    addQuad(scene, vec3(0.0f), {0, 0, 100}, {100, 0, 0}, 0);
    return scene;
}

// E = irradiance * cos; both lobes from the closed form at roughness 1.
TEST(Reference, SunOnAPlaneIsExact)
{
    Scene scene = floorUnder(0.5f);
    const double nl = 0.8, nv = std::sqrt(0.5);
    scene.lights.push_back(test::light(LightType::directional, vec3(0.0f), {-0.6f, -0.8f, 0.0f}, 3.0f));
    for (bool fromBelow : {false, true}) // every surface is two-sided
    {
        ReferenceSettings settings = view({0, fromBelow ? -1 : 1, 1}, vec3(0.0f), 2, 4);
        if (fromBelow) scene.lights[0].direction.y = 0.8f;
        settings.pixelCentre = true;
        settings.camera.verticalFov = 1e-4f;
        const Reference r = render(scene, settings);
        const double vh = test::RoughModel::cosineToHalf(nl, nv, std::numbers::pi / 2);
        const test::RoughModel model{0.5};
        const double expected = (model.diffuse(nl, nv) + model.specular(vh, nl, nv)) * nl * 3.0;
        EXPECT_NEAR(meanOf(r.images, "direct").value, expected, 1e-3 * expected);
        EXPECT_EQ(meanOf(r.images, "diffuse_indirect").value, 0.0);
        EXPECT_NEAR(meanOf(r.images, "depth").value, std::sqrt(2.0), 1e-3);
    }
}

// Black and white squares of 5 cm, 20 m off: a pixel's centre sees the one or the other, a pixel a mean of many, by its centre's surface
// alone.
TEST(Reference, PixelsCentresSeeTexturesFiltered)
{
    Scene scene = floorUnder(1.0f);
    scene.sky = vec3(1.0f);
    scene.images.push_back({"squares", 2, 2, {0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 255}});
    scene.materials[0].baseColorTexture.image = 0;
    for (size_t i = 0; i < scene.uvs.size(); ++i) scene.uvs[i] = 10.0f * vec2(scene.positions[i].x, scene.positions[i].z);
    ReferenceSettings settings = view({0, 10, 20}, vec3(0.0f), 8, 256, 0.6f);
    settings.pixelCentre = true;
    const Reference r = render(scene, settings);
    for (const float albedo : r.images.find("albedo")->pixels) EXPECT_NEAR(albedo, 0.5f, 0.15f); // 256 of 0 or 1: 0.03 is their deviation
    EXPECT_NEAR(meanOf(r.images, "albedo").value, 0.5, 0.02);
    for (const float depth : r.images.find("depth")->pixels) EXPECT_GT(depth, 0.0f);
}

TEST(Reference, PointLightFallsOffWithTheSquareAndIsShadowed)
{
    Scene scene = floorUnder(0.5f);
    scene.lights.push_back(test::light(LightType::point, {0, 2, 0}, {0, -1, 0}, 8.0f));
    const ReferenceSettings settings = view({0, 1, 1}, vec3(0.0f), 2, 1, 1e-4f);
    const double nv = std::sqrt(0.5), vh = test::RoughModel::cosineToHalf(1.0, nv, 0.0);
    const test::RoughModel model{0.5};
    const double expected = (model.diffuse(1.0, nv) + model.specular(vh, 1.0, nv)) * 8.0 / 4.0;
    EXPECT_NEAR(meanOf(render(scene, settings).images, "direct").value, expected, 1e-3 * expected);
    addQuad(scene, {0, 1.5f, 0}, {0, 0, 0.1f}, {0.1f, 0, 0}, 0);
    EXPECT_EQ(meanOf(render(scene, settings).images, "direct").value, 0.0);
}

// Two panes that let 0.3 and 0.5 of the light through, each by its own lot.
TEST(Reference, BlendedPanesPassLightByTheirAlpha)
{
    Scene scene = floorUnder(0.5f);
    scene.lights.push_back(test::light(LightType::directional, vec3(0.0f), {0, -1, 0}, 2.0f));
    const ReferenceSettings settings = view({0, 1, 1}, vec3(0.0f), 16, 64, 1e-3f);
    const double open = meanOf(render(scene, settings).images, "direct").value;
    for (const float passes : {0.3f, 0.5f})
    {
        Material pane = plain(vec3(0.0f), 1.0f);
        pane.baseColor.a = 1.0f - passes;
        pane.blended = true;
        scene.materials.push_back(pane);
        addQuad(scene, {0, 3.0f + passes, 0}, {0, 0, 2}, {2, 0, 0}, uint32_t(scene.materials.size() - 1));
    }
    const test::Mean through = meanOf(render(scene, settings).images, "direct");
    EXPECT_LT(through.error, 0.02 * open);
    EXPECT_NEAR(through.value, 0.15 * open, 4.0 * through.error);
}

// Under a uniform sky a convex surface shows its directional albedo times the sky.
TEST(Reference, UniformSkyGivesTheDirectionalAlbedo)
{
    Scene scene = floorUnder(0.6f);
    scene.sky = vec3(2.0f);
    const Reference r = render(scene, view({0, 1, 1}, vec3(0.0f), 32, 256));
    const test::RoughModel model{0.6};
    double albedo = 0.0;
    for (int i = 0; i < 200; ++i) albedo += model.ring((i + 0.5) / 200, std::sqrt(0.5)) * (i + 0.5) / 200 / 200;
    const test::Mean beauty = meanOf(r.images, "beauty");
    EXPECT_LT(beauty.error, 0.005);
    EXPECT_NEAR(beauty.value, 2.0 * albedo, 4.0 * beauty.error + 1e-3);
    EXPECT_EQ(meanOf(r.images, "direct").value, 0.0);
    ReferenceSettings up = view({0, 1, 0}, {0, 2, 0}, 2, 1);
    EXPECT_EQ(meanOf(render(scene, up).images, "direct").value, 2.0); // the sky itself is direct
    EXPECT_EQ(meanOf(render(scene, up).images, "depth").value, 0.0);
}

// Lambert 1760: irradiance of a uniform polygon is L/2 times the sum of its edges' angles, weighted with their normals' cosine.
double polygonIrradiance(double radiance, const std::vector<glm::dvec3>& corners, glm::dvec3 normal)
{
    double sum = 0.0;
    for (size_t i = 0; i < corners.size(); ++i)
    {
        const glm::dvec3 a = glm::normalize(corners[i]), b = glm::normalize(corners[(i + 1) % corners.size()]);
        sum += std::acos(glm::dot(a, b)) * glm::dot(glm::normalize(glm::cross(a, b)), normal);
    }
    return std::abs(0.5 * radiance * sum);
}

TEST(Reference, SquareEmitterMatchesThePolygonFormula)
{
    for (bool facingAway : {false, true}) // emission leaves both sides
    {
        Scene scene = floorUnder(0.5f);
        scene.materials.push_back(plain(vec3(0.0f), 1.0f, 0.0f, vec3(10.0f)));
        addQuad(scene, {0.2f, 2, 0}, {0.5f, 0, 0}, {0, 0, facingAway ? -0.5f : 0.5f}, 1);
        ReferenceSettings settings = view({0, 1, 1}, vec3(0.0f), 16, 256, 1e-4f);
        settings.bounces = 0;
        const Reference r = render(scene, settings);
        const double irradiance = polygonIrradiance(10.0, {{-0.3, 2, -0.5}, {0.7, 2, -0.5}, {0.7, 2, 0.5}, {-0.3, 2, 0.5}}, {0, 1, 0});
        // The emitter is seen under 5 to 23 degrees, 14 on average, over which what is left to the diffuse lobe changes by 0.001.
        const double expected = test::RoughModel{0.5}.diffuse(0.97, std::sqrt(0.5)) * irradiance;
        const test::Mean diffuse = meanOf(r.images, "diffuse_indirect");
        EXPECT_LT(diffuse.error, 0.003 * expected);
        EXPECT_NEAR(diffuse.value, expected, 4.0 * diffuse.error + 1e-3 * expected) << facingAway;
    }
}

// A wall beside the lamp throws its light on the floor: not straight.
TEST(Reference, StraightLightIsWithoutWhatSurfacesThrow)
{
    Scene scene = floorUnder(0.5f);
    scene.materials.push_back(plain(vec3(0.0f), 1.0f, 0.0f, vec3(10.0f)));
    scene.materials.push_back(plain(vec3(0.9f), 1.0f));
    addQuad(scene, {0.2f, 2, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}, 1);
    addQuad(scene, {-0.6f, 0.5f, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}, 2);
    ReferenceSettings settings = view({0, 1, 1}, vec3(0.0f), 16, 256, 1e-4f);
    const double irradiance = polygonIrradiance(10.0, {{-0.3, 2, -0.5}, {0.7, 2, -0.5}, {0.7, 2, 0.5}, {-0.3, 2, 0.5}}, {0, 1, 0});
    const double expected = test::RoughModel{0.5}.diffuse(0.97, std::sqrt(0.5)) * irradiance;
    settings.bounces = 4;
    EXPECT_GT(meanOf(render(scene, settings).images, "diffuse_indirect").value, 1.02 * expected);
    settings.straight = true;
    const test::Mean straight = meanOf(render(scene, settings).images, "diffuse_indirect");
    EXPECT_NEAR(straight.value, expected, 4.0 * straight.error + 1e-3 * expected);
}

// Two squares at one place, as exporters leave them for two sides: one of them is seen, and gives the light of one.
TEST(Reference, ADoubledLampIsOneLamp)
{
    double light[2] = {};
    for (const bool doubled : {false, true})
    {
        Scene scene = floorUnder(0.5f, 0.4f);
        scene.materials.push_back(plain(vec3(0.0f), 1.0f, 0.0f, vec3(10.0f)));
        addQuad(scene, {0.2f, 2, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}, 1);
        if (doubled) addQuad(scene, {0.2f, 2, 0}, {0.5f, 0, 0}, {0, 0, -0.5f}, 1);
        ReferenceSettings settings = view({0, 1, 1}, vec3(0.0f), 16, 512, 1e-4f);
        settings.bounces = 0;
        const Reference r = render(scene, settings);
        for (const char* layer : {"diffuse_indirect", "glossy_indirect"}) light[doubled] += meanOf(r.images, layer).value;
    }
    EXPECT_NEAR(light[1] / light[0], 1.0, 0.02);
}

TEST(Reference, MirrorShowsTheSkyExactly)
{
    Scene scene = floorUnder(1.0f, 0.0f, 1.0f);
    scene.sky = vec3(0.25f, 0.5f, 0.75f);
    const Reference r = render(scene, view({0, 1, 1}, vec3(0.0f), 4, 4, 0.5f));
    const std::vector<float>& glossy = r.images.find("glossy_indirect")->pixels;
    for (size_t i = 0; i < glossy.size(); ++i) EXPECT_FLOAT_EQ(glossy[i], scene.sky[int(i % 3)]);
    EXPECT_EQ(meanOf(r.images, "diffuse_indirect").value, 0.0);
}

// A closed box of perfect mirrors adds one emission a scattering: exact, whatever the paths do.
TEST(Reference, MirrorFurnaceCountsTheScatterings)
{
    Scene scene;
    scene.materials = {plain(vec3(1.0f), 0.0f, 1.0f, vec3(1.0f))};
    addBox(scene, vec3(0.0f), 1.0f, 0);
    for (uint32_t bounces : {0u, 1u, 3u})
    {
        ReferenceSettings settings = view({0.1f, 0.2f, 0.0f}, {1, 0.3f, 0.2f}, 8, 4, 1.0f);
        settings.bounces = bounces;
        const Reference r = render(scene, settings);
        EXPECT_NEAR(meanOf(r.images, "direct").value, 1.0, 1e-5);
        EXPECT_NEAR(meanOf(r.images, "beauty").value, bounces + 3.0, 1e-3) << bounces;
    }
}

// In a sphere both ends of a chord make the same angle with the wall, so that radiance depends on that angle alone and the rendering
// equation is a one-dimensional recursion, solved here in double.
TEST(Reference, SphereFurnaceMatchesQuadrature)
{
    Scene scene;
    scene.materials = {plain(vec3(0.7f), 1.0f, 0.0f, vec3(1.0f))};
    test::addSphere(scene, 2.0f, 48, 0);
    ReferenceSettings settings = view(vec3(0.0f), {1, 0.2f, 0.1f}, 32, 64, 1.0f);
    settings.bounces = 6;
    const test::Mean beauty = meanOf(render(scene, settings).images, "beauty");

    constexpr int kSteps = 128;
    const test::RoughModel model{0.7};
    std::vector<double> kernel(kSteps * kSteps), radiance(kSteps, 1.0);
    const auto cosine = [](int i) { return (i + 0.5) / kSteps; };
    for (int o = 0; o < kSteps; ++o)
        for (int i = 0; i < kSteps; ++i) kernel[size_t(o * kSteps + i)] = model.ring(cosine(i), cosine(o)) * cosine(i) / kSteps;
    for (uint32_t scattering = 0; scattering < settings.bounces + 2; ++scattering)
    {
        std::vector<double> next(kSteps, 1.0);
        for (int o = 0; o < kSteps; ++o)
            for (int i = 0; i < kSteps; ++i) next[size_t(o)] += kernel[size_t(o * kSteps + i)] * radiance[size_t(i)];
        radiance = next;
    }
    const double truth = radiance.back(); // straight at the wall
    EXPECT_GT(truth, 3.0);                // near 1 / (1 - albedo)
    EXPECT_LT(beauty.error, 0.01 * truth);
    EXPECT_NEAR(beauty.value, truth, 4.0 * beauty.error + 0.005 * truth); // 0.5 %: the sphere has facets
}

Scene smallRoom()
{
    Scene scene;
    scene.materials = {plain(vec3(0.6f, 0.4f, 0.3f), 0.5f), plain(vec3(0.0f), 1.0f, 0.0f, vec3(5.0f)), plain(vec3(0.9f), 0.1f, 1.0f)};
    addBox(scene, vec3(0.0f), 1.0f, 0);
    addQuad(scene, {0, 0.9f, 0}, {0.3f, 0, 0}, {0, 0, 0.3f}, 1);
    addBox(scene, {0.3f, -0.6f, -0.3f}, 0.3f, 2);
    scene.lights.push_back(test::light(LightType::spot, {-0.5f, 0.5f, 0}, {0, -1, 0}, 1.0f));
    scene.lights.push_back(test::light(LightType::point, {0.5f, 0.5f, 0}, {0, -1, 0}, 0.5f));
    return scene;
}

TEST(Reference, SameBytesForOneAndTwoThreads)
{
    const Scene scene = smallRoom();
    ReferenceSettings settings = view({0, 0, 0.9f}, vec3(0.0f), 40, 8, 1.2f);
    const auto with = [&](size_t threads)
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return render(scene, settings);
    };
    const Reference one = with(1), two = with(2);
    EXPECT_EQ(one.estimatedRelMse, two.estimatedRelMse);
    for (size_t i = 0; i < one.images.layers.size(); ++i)
        EXPECT_EQ(one.images.layers[i].pixels, two.images.layers[i].pixels) << one.images.layers[i].name;
    settings.seed = 2;
    EXPECT_NE(render(scene, settings).images.find("beauty")->pixels, one.images.find("beauty")->pixels);
}

TEST(Reference, EstimatedErrorIsTheErrorAgainstManySamples)
{
    const Scene scene = smallRoom();
    ReferenceSettings settings = view({0, 0, 0.9f}, vec3(0.0f), 24, 32, 1.2f);
    settings.pixelCentre = true;
    settings.roughness = 1.0f; // matt all over: of rare bright paths, as by a glossy box, 32 paths know nothing
    const Reference few = render(scene, settings);
    settings.samples = 2048;
    settings.seed = 99;
    const Reference many = render(scene, settings);
    double actual = 0.0;
    const auto& a = few.images.find("beauty")->pixels;
    const auto& b = many.images.find("beauty")->pixels;
    for (size_t i = 0; i < a.size(); ++i)
        actual += std::pow(double(a[i]) - b[i], 2) / (std::pow(double(b[i]), 2) + 0.01) / double(a.size());
    EXPECT_GT(few.estimatedRelMse, 0.5 * actual);
    EXPECT_LT(few.estimatedRelMse, 2.0 * actual);
}

TEST(Reference, RoughnessOverrideReachesEverySurface)
{
    ReferenceSettings settings = view({0, 0, 0.9f}, vec3(0.0f), 4, 1, 1.2f);
    settings.roughness = 0.25f;
    const Reference r = render(smallRoom(), settings);
    for (float roughness : r.images.find("roughness")->pixels) EXPECT_EQ(roughness, 0.25f);
}

// One pixel can be minutes of work; whoever waits for it must not wait to its end.
TEST(Reference, CancelsWithinAPixel)
{
    ReferenceSettings settings = view({0, 0, 0.9f}, vec3(0.0f), 1, 1048576);
    settings.bounces = 64;
    double last = 0.0;
    int asked = 0;
    const auto cancelled = renderReference(smallRoom(), settings,
                                           [&](std::string_view, double done)
                                           {
                                               EXPECT_GT(done, last);
                                               last = done;
                                               return ++asked < 3;
                                           });
    ASSERT_FALSE(cancelled.ok());
    EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
    EXPECT_EQ(asked, 3);    // and nobody is asked again
    EXPECT_LT(last, 0.001); // of the pixel's paths between one question and the next
}

TEST(Reference, RefusesBadSettingsAndCancels)
{
    ReferenceSettings settings = view({0, 0, 0.9f}, vec3(0.0f), 4, 1);
    settings.samples = 0;
    const auto refused = renderReference(smallRoom(), settings);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::badArgument);
    EXPECT_NE(refused.error().message.find("samples"), std::string::npos);
    settings.samples = 1;
    const auto cancelled = renderReference(smallRoom(), settings, [](std::string_view, double) { return false; });
    ASSERT_FALSE(cancelled.ok());
    EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
}

TEST(Reference, EmptySceneIsSky)
{
    Scene scene;
    scene.sky = vec3(0.5f);
    EXPECT_EQ(meanOf(render(scene, view(vec3(0.0f), {0, 0, -1}, 3, 1)).images, "beauty").value, 0.5);
}

/// A quarter, a quarter and a half of the paths: their mean is the picture, whether or not the number divides.
TEST(Reference, PartsMakeTheWhole)
{
    const Scene scene = smallRoom();
    for (const uint32_t paths : {8u, 11u})
    {
        ReferenceSettings settings = view({0, 0, 0.9f}, vec3(0.0f), 24, paths, 1.2f);
        settings.parts = true;
        const auto reference = renderReference(scene, settings);
        ASSERT_TRUE(reference) << reference.error().message;
        const float counts[] = {float((paths + 3) / 4), float((paths + 2) / 4), float(paths / 4 + (paths + 1) / 4)};
        for (const std::string name : {"beauty", "diffuse_indirect", "glossy_indirect"})
        {
            const auto& whole = reference->images.find(name)->pixels;
            size_t differ = 0;
            for (size_t i = 0; i < whole.size(); ++i)
            {
                float sum = 0.0f, part[3];
                for (size_t p = 0; p < 3; ++p) sum += counts[p] * (part[p] = reference->images.find(name + kParts[p])->pixels[i]);
                EXPECT_NEAR(whole[i], sum / float(paths), 1e-5f * (1.0f + whole[i])) << name << " " << i;
                differ += part[0] != part[1] && part[1] != part[2] ? 1 : 0;
            }
            EXPECT_GT(differ, 0u) << name;
        }
    }
    ReferenceSettings few = view({0, 0, 0.9f}, vec3(0.0f), 4, 3, 1.2f);
    few.parts = true;
    const auto refused = renderReference(scene, few);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("parts"), std::string::npos) << refused.error().message;
}

TEST(Reference, APixelAloneIsThePicturesPixel)
{
    const Scene scene = smallRoom();
    ReferenceSettings settings = view({0, 0, 0.9f}, vec3(0.0f), 24, 64, 1.2f);
    settings.parts = true;
    const auto picture = renderReference(scene, settings);
    ASSERT_TRUE(picture) << picture.error().message;
    const auto rays = RayScene::create(scene);
    ASSERT_TRUE(rays);
    for (const glm::uvec2 at : {glm::uvec2(0, 0), glm::uvec2(7, 11), glm::uvec2(23, 23)})
    {
        const auto alone = pixelReference(*rays, settings, at);
        ASSERT_TRUE(alone) << alone.error().message;
        const auto of = [&](const char* layer, uint32_t c) { return picture->images.find(layer)->pixels[3 * (24 * at.y + at.x) + c]; };
        for (uint32_t c = 0; c < 3; ++c)
        {
            EXPECT_EQ(alone->direct[int(c)], of("direct", c));
            EXPECT_EQ(alone->diffuse[int(c)], of("diffuse_indirect", c));
            EXPECT_EQ(alone->glossy[int(c)], of("glossy_indirect", c));
        }
    }
    const auto outside = pixelReference(*rays, settings, {24, 0});
    ASSERT_FALSE(outside);
    EXPECT_NE(outside.error().message.find("24,0"), std::string::npos) << outside.error().message;
}

/// The standard errors of pixels, against how far they are from a picture of many more paths.
TEST(Reference, APixelKnowsHowUnsureItIs)
{
    const Scene scene = smallRoom();
    ReferenceSettings settings = view({0, 0, 0.9f}, vec3(0.0f), 24, 2048, 1.2f);
    const auto truth = renderReference(scene, settings);
    ASSERT_TRUE(truth) << truth.error().message;
    const auto rays = RayScene::create(scene);
    ASSERT_TRUE(rays);
    settings.samples = 128;
    settings.seed = 9;
    int within = 0, withinThrice = 0;
    for (uint32_t i = 0; i < 24 * 24; ++i)
    {
        const auto pixel = pixelReference(*rays, settings, {i % 24, i / 24});
        ASSERT_TRUE(pixel) << pixel.error().message;
        const float off = std::abs(pixel->diffuse.g - truth->images.find("diffuse_indirect")->pixels[3 * i + 1]);
        within += off <= pixel->unsureDiffuse.g ? 1 : 0;
        withinThrice += off <= 3.0f * pixel->unsureDiffuse.g ? 1 : 0;
    }
    // 0.683 and 0.997 of a normal distribution; rare bright paths, which some pixels have missed, take from both.
    EXPECT_NEAR(within / 576.0, 0.64, 0.08);
    EXPECT_GT(withinThrice / 576.0, 0.9);
}

} // namespace
} // namespace sconce
