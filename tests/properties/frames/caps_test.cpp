// What a host caps is exactly absent: bake and picture are those of a scene that never had it.
#include <algorithm>

#include <gtest/gtest.h>

#include "runtime/frame/effect_plan.h"
#include "scene/mesh_builder.h"
#include "tests/properties/frames/frame_test.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr uint32_t kSide = 48; // pixels

/// A closed floor and box under a lamp, a sun, a point light and the sky, with a cut-out quad; every kind of light and surface at once.
Scene everything()
{
    Scene scene;
    scene.name = "everything";
    MeshBuilder mesh(scene);
    mesh.box(vec3(-2, -0.2f, -2), vec3(2, 0, 2), mesh.material("floor", vec3(0.6f), 0.6f));
    mesh.box(vec3(-1.2f, 0, -1.2f), vec3(-0.2f, 1, -0.2f), mesh.material("glossy", vec3(0.8f, 0.3f, 0.2f), 0.2f));
    mesh.box(vec3(-0.5f, 2.2f, -0.5f), vec3(0.5f, 2.3f, 0.5f), mesh.emitter("lamp", vec3(6.0f)));
    const uint32_t leaf = mesh.material("leaf", vec3(0.2f, 0.7f, 0.2f));
    scene.images.push_back({"holes", 2, 2, {255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 0, 255, 255, 255, 255}});
    scene.materials[leaf].baseColorTexture.image = 0;
    scene.materials[leaf].alphaCutoff = 0.5f;
    mesh.quad(vec3(0.4f, 0.1f, 0.3f), vec3(1.4f, 0.1f, 0.3f), vec3(1.4f, 1.1f, 0.3f), vec3(0.4f, 1.1f, 0.3f), leaf);
    mesh.camera("view", vec3(0.3f, 1.4f, 3.4f), vec3(0, 0.5f, -0.3f), 50.0f);
    Light sun;
    sun.direction = glm::normalize(vec3(-0.4f, -1.0f, -0.3f));
    sun.intensity = vec3(2.0f);
    Light point;
    point.type = LightType::point;
    point.position = vec3(1.2f, 1.5f, 1.2f);
    point.intensity = vec3(1.5f, 1.0f, 0.5f);
    scene.lights = {sun, point};
    scene.sky = vec3(0.3f, 0.4f, 0.5f);
    return scene;
}

const std::vector<vec3> kProbes = {{0.0f, 1.5f, 1.0f}, {-1.4f, 0.8f, 0.6f}, {1.2f, 0.7f, -0.6f}};

class CapsTest : public FrameTest
{
protected:
    struct Made
    {
        FieldData field;
        RenderedFrame frame;
        uint64_t sceneBytes = 0;
        uint32_t lights = 0;
    };
    Made make(const Scene& scene, const EffectPlan& plan)
    {
        Made made;
        BakeSettings bake;
        bake.resolution = 64;
        bake.bounces = 1;
        bake.prefiltered = false; // 40 ms a probe, and the plan's rough pass is left out for it
        bake.octree.voxels = 32;
        bake.surfaceTexels = 26;
        bake.surfaceRays = 16;
        bake.scene.light = {
            .emitterSamples = 6, .skySamples = 8, .sunShadow = 512, .pointShadow = 64, .emitterShadow = 64, .skyShadow = 128};
        auto field = bakeOnce(scene, kProbes, bake);
        EXPECT_TRUE(field) << field.error().message;
        made.field = std::move(*field);
        RenderSettings settings = settingsOf(kSide);
        settings.effects = plan.indirect();
        settings.effects.rough = false;
        auto device = DeviceScene::create(gpu(), scene, made.field.info, bake.scene);
        auto light = makeLightField(gpu(), made.field);
        auto renderer = SceneRenderer::create(gpu(), *device, *light, settings);
        EXPECT_TRUE(renderer);
        made.frame = std::move(*(*renderer)->render(scene.cameras.front()));
        {
            // Memory is counted in blocks, which are as large as what is asked for where the budget holds no block that is shared.
            HostVulkan host = gpu().host;
            host.memoryBudget = uint64_t(60) << 20;
            const auto alone = Gpu::create(host);
            EXPECT_TRUE(alone);
            made.sceneBytes = DeviceScene::create(**alone, scene, made.field.info, bake.scene)->deviceBytes();
        }
        made.lights = uint32_t(device->lights().lights.size());
        return made;
    }
    Made capped(const Scene& whole, std::string_view wanted)
    {
        Scene scene = whole;
        const EffectPlan plan = *planEffects(checkScene(whole), wanted);
        capScene(scene, plan);
        return make(scene, plan);
    }
    static void expectSame(const Made& a, const Made& b, const std::string& what)
    {
        EXPECT_TRUE(a.field.distance == b.field.distance) << what;
        EXPECT_TRUE(a.field.radiance == b.field.radiance) << what;
        EXPECT_TRUE(a.field.irradiance == b.field.irradiance) << what;
        EXPECT_TRUE(a.frame.beauty == b.frame.beauty) << what << ": to the bit";
        EXPECT_EQ(a.lights, b.lights) << what;
    }
    /// The same but for texels at silhouettes, where a back face may round to before its neighbour's front.
    static void expectAlike(const Made& a, const Made& b, const std::string& what)
    {
        size_t other = 0;
        for (size_t i = 0; i < a.field.distance.size(); ++i) other += a.field.distance[i] != b.field.distance[i];
        EXPECT_LT(other, a.field.distance.size() / 500) << what;
        EXPECT_TRUE(a.frame.depth == b.frame.depth && a.frame.normal == b.frame.normal) << what;
    }
};

TEST_F(CapsTest, WithoutACapNothingChanges)
{
    const Scene scene = everything();
    expectSame(capped(scene, "auto"), make(scene, *planEffects(checkScene(scene))), "auto");
}

TEST_F(CapsTest, TheLightOfWhatIsCappedIsExactlyAbsent)
{
    const Scene whole = everything();
    const Made before = capped(whole, "auto");
    Scene noSun = whole, noPoint = whole, noLamp = whole, noSky = whole;
    noSun.lights.erase(noSun.lights.begin());
    noPoint.lights.pop_back();
    for (Material& material : noLamp.materials) material.emission = vec3(0.0f);
    noSky.sky = vec3(0.0f);
    for (const auto& [name, without] : {std::pair{"sun", &noSun}, {"punctual", &noPoint}, {"emitters", &noLamp}, {"sky", &noSky}})
    {
        const Made with = capped(whole, std::string("auto,-") + name);
        expectSame(with, make(*without, *planEffects(checkScene(*without))), name);
        EXPECT_FALSE(with.field.irradiance == before.field.irradiance) << name << " changes the bake";
        EXPECT_FALSE(with.frame.beauty == before.frame.beauty) << name;
        EXPECT_LT(with.sceneBytes, before.sceneBytes) << name << " keeps no shadow map";
        EXPECT_LT(with.lights, before.lights) << name;
    }
    const Made dark = capped(whole, "auto,-sun,-punctual,-emitters,-sky");
    for (const vec3& pixel : dark.frame.beauty) ASSERT_EQ(pixel, vec3(0.0f));
    EXPECT_TRUE(std::ranges::none_of(dark.frame.times, [](const auto& scope) { return std::string(scope.name) == "area light"; }));
}

TEST_F(CapsTest, WithoutMaskedHolesAreSolid)
{
    const Scene whole = everything();
    Scene solid = whole;
    for (Material& material : solid.materials) material.alphaCutoff = 0.0f;
    const Made with = capped(whole, "auto,-masked");
    expectSame(with, make(solid, *planEffects(checkScene(solid))), "masked");
    EXPECT_FALSE(with.frame.depth == capped(whole, "auto").frame.depth);
    Scene glass = whole;
    for (Material& material : glass.materials)
        if (material.alphaCutoff > 0.0f) material.blended = true;
    expectSame(capped(glass, "auto,-masked"), make(solid, *planEffects(checkScene(solid))), "blended");
}

TEST_F(CapsTest, WithoutTwoSidedSheetsAreThereFromTheirFrontOnly)
{
    Scene closed = everything(); // without the leaf every mesh is closed
    closed.triangles.resize(closed.triangles.size() - 2);
    closed.triangleMaterial.resize(closed.triangles.size());
    const EffectPlan closedPlan = *planEffects(checkScene(closed));
    ASSERT_FALSE(closedPlan.called("thin-two-sided"));
    const Made none = make(closed, closedPlan);
    Scene one = closed;
    one.twoSided = false;
    expectAlike(make(one, closedPlan), none, "closed meshes show no back face");

    // A big sheet with probes and eye behind it is as if it were not there, but for its shadow; turned round it is all there.
    for (const bool front : {false, true})
    {
        Scene sheet = closed;
        sheet.lights.clear();
        sheet.sky = vec3(0.0f);
        Scene bare = sheet;
        bare.twoSided = false;
        MeshBuilder mesh(sheet);
        const uint32_t material = mesh.material("sheet", vec3(0.9f));
        const vec3 a(-1.9f, 0.05f, -1.5f), b(1.9f, 0.05f, -1.5f), c(1.9f, 2.25f, -1.5f), d(-1.9f, 2.25f, -1.5f);
        if (front)
            mesh.quad(a, b, c, d, material); // seen from +z, where everything is
        else
            mesh.quad(b, a, d, c, material);
        const Made with = capped(sheet, "auto,-thin-two-sided");
        if (front)
            expectAlike(with, capped(sheet, "auto"), "from the front");
        else
        {
            const Made without = make(bare, *planEffects(checkScene(bare)));
            EXPECT_TRUE(with.field.distance == without.field.distance) << "from behind no probe sees it";
            EXPECT_TRUE(with.frame.depth == without.frame.depth && with.frame.normal == without.frame.normal);
        }
    }
}

} // namespace
} // namespace sconce
