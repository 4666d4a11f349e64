// Rays on one pixel of some, the rest from those that show the same surface; and the filter's respect for a metal's texture.
#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "scene/mesh_builder.h"
#include "tests/properties/frames/frame_test.h"

namespace sconce
{
namespace
{

using namespace testing_support;

const std::vector<vec3> kProbes = {{0, 0, 2}, {-1, 1, 1.5f}, {1, -1, 1.5f}};

class SparseTest : public FrameTest
{
protected:
    /// @param slat  (MeshBuilder&, int i) -> its material; slats stand side by side in the plane z = depth(i), the camera before them
    template <class Material, class Depth> static Scene slats(int count, Material material, Depth depth)
    {
        Scene scene;
        scene.name = "slats";
        MeshBuilder mesh(scene);
        const float width = 4.0f / float(count);
        for (int i = 0; i < count; ++i)
        {
            const float x = -2.0f + width * float(i), z = depth(i);
            mesh.box(vec3(x, -2, z - 0.1f), vec3(x + width, 2, z), material(mesh, i));
        }
        mesh.camera("view", vec3(0, 0, 3), vec3(0.0f), 45.0f); // sees 2.5 m of the 4
        scene.sky = vec3(1.0f);
        return scene;
    }

    static Scene wall(float roughness)
    {
        return slats(
            1, [roughness](MeshBuilder& mesh, int) { return mesh.material("wall", vec3(0.9f), roughness, 1.0f); },
            [](int) { return 0.0f; });
    }

    /// With the field of the first scene of a test: there is but the sky to see.
    Result<std::vector<RenderedFrame>> draw(const Scene& scene, const RenderSettings& settings, uint32_t frames)
    {
        if (!field)
        {
            auto baked = bakeField(scene, kProbes, 64, 0);
            if (!baked) return baked.error();
            field = std::move(*baked);
        }
        auto device = DeviceScene::create(gpu(), scene, field->info);
        auto light = makeLightField(gpu(), *field);
        auto renderer = SceneRenderer::create(gpu(), *device, *light, settings);
        if (!renderer) return renderer.error();
        std::vector<RenderedFrame> drawn;
        for (uint32_t i = 0; i < frames; ++i)
        {
            auto frame = (*renderer)->render(scene.cameras.front(), i);
            if (!frame) return frame.error();
            drawn.push_back(std::move(*frame));
        }
        return drawn;
    }

    std::optional<FieldData> field;

    static double tracedShare(const RenderedFrame& frame)
    {
        return double(std::ranges::count_if(frame.counts, [](const glm::uvec4& c) { return c.z > 0; })) / double(frame.counts.size());
    }
};

TEST_F(SparseTest, EveryPixelIsTracedOnceInAsManyFramesAsPixelsShareARay)
{
    const Scene scene = wall(0.2f);
    for (const uint32_t every : {2u, 4u, 8u, 16u})
    {
        RenderSettings settings = settingsOf(64);
        settings.traceEvery = every;
        const auto frames = draw(scene, settings, every);
        ASSERT_TRUE(frames) << frames.error().message;
        long met = 0;
        for (uint32_t y = 8; y < 56; ++y)
            for (uint32_t x = 8; x < 56; ++x)
            {
                const long traced = std::ranges::count_if(*frames, [&](const RenderedFrame& f) { return f.counts[64 * y + x].z > 0; });
                EXPECT_LE(traced, 1) << "pixel " << x << ", " << y << ", one of " << every;
                met += traced;
            }
        EXPECT_GT(met, 0.99 * 48 * 48) << every; // GGX's tail sends a few rays into the wall, which are not traced
        for (const RenderedFrame& frame : *frames) EXPECT_LT(tracedShare(frame), 1.3 / every); // the border has some rays more
    }
}

TEST_F(SparseTest, WhatNothingIsLikeIsTraced)
{
    // Slats two pixels wide, every other one a metre behind: rows of a lattice of four pixels meet one kind only.
    const auto metal = [](MeshBuilder& mesh, int) { return mesh.material("slat", vec3(0.9f), 0.3f, 1.0f); };
    const Scene scene = slats(51, metal, [](int i) { return i % 2 == 0 ? 0.0f : -1.0f; });
    RenderSettings settings = settingsOf(64);
    settings.traceEvery = 16;
    const auto slatted = draw(scene, settings, 1), flat = draw(wall(0.3f), settings, 1);
    ASSERT_TRUE(slatted && flat);
    EXPECT_GT(tracedShare(slatted->front()), 3.0 * tracedShare(flat->front()));
}

TEST_F(SparseTest, SharpReflectionsAreTracedAtEveryPixel)
{
    for (const float roughness : {0.0f, 0.05f})
    {
        RenderSettings settings = settingsOf(40);
        const auto every = draw(wall(roughness), settings, 1);
        settings.traceEvery = 16;
        const auto sparse = draw(wall(roughness), settings, 1);
        ASSERT_TRUE(every && sparse);
        EXPECT_EQ(every->front().beauty, sparse->front().beauty) << roughness;
    }
}

TEST_F(SparseTest, FillsEveryPixelAndKeepsTheMean)
{
    Scene scene;
    scene.name = "ball";
    MeshBuilder mesh(scene);
    mesh.sphere(vec3(0.0f), 1.0f, 48, 24, mesh.material("metal", vec3(0.9f, 0.5f, 0.2f), 0.3f, 1.0f));
    mesh.camera("view", vec3(0, 0, 3.5f), vec3(0.0f), 30.0f);
    scene.sky = vec3(1.0f);
    for (const bool tiles : {true, false})
        for (const bool tracedDiffuse : {true, false})
        {
            scene.materials.front().metallic = tracedDiffuse ? 0.0f : 1.0f;
            RenderSettings settings = settingsOf(61);
            settings.effects.tracedDiffuse = tracedDiffuse;
            settings.effects.tiles = tiles;
            settings.glossyRays = 4;
            settings.normalOffset = 1e-3f;
            const auto full = draw(scene, settings, 1);
            ASSERT_TRUE(full) << full.error().message;
            settings.traceEvery = 16;
            const auto sparse = draw(scene, settings, 1);
            ASSERT_TRUE(sparse);
            double sum[2] = {};
            for (size_t i = 0; i < full->front().depth.size(); ++i)
            {
                if (!(full->front().depth[i] > 0.0f)) continue;
                EXPECT_GT(sparse->front().beauty[i].x, 0.5f * full->front().beauty[i].x) << "pixel " << i;
                sum[0] += full->front().beauty[i].x;
                sum[1] += sparse->front().beauty[i].x;
            }
            EXPECT_NEAR(sum[1] / sum[0], 1.0, 0.01) << "tiles " << tiles << ", traced diffuse " << tracedDiffuse;
        }
}

TEST_F(SparseTest, TheFilterLeavesTheTextureOfAMetalAlone)
{
    const auto stripes = [](MeshBuilder& mesh, int i)
    {
        return i % 2 == 0 ? mesh.material("red", vec3(0.9f, 0.2f, 0.1f), 0.35f, 1.0f)
                          : mesh.material("blue", vec3(0.1f, 0.2f, 0.9f), 0.35f, 1.0f);
    };
    const Scene scene = slats(41, stripes, [](int) { return 0.0f; });
    for (const uint32_t every : {1u, 4u})
    {
        RenderSettings settings = settingsOf(64);
        settings.traceEvery = every;
        const auto frames = draw(scene, settings, 1);
        ASSERT_TRUE(frames) << frames.error().message;
        const RenderedFrame& frame = frames->front();
        for (size_t i = 0; i < frame.albedo.size(); ++i)
        {
            const vec3 light = frame.glossyIndirect[i], own = frame.albedo[i];
            EXPECT_NEAR(light.x / light.z, own.x / own.z, 0.05 * own.x / own.z) << "pixel " << i << ", one of " << every;
        }
    }
}

TEST_F(SparseTest, RefusesOtherShares)
{
    for (const uint32_t every : {0u, 3u, 32u})
    {
        RenderSettings settings = settingsOf(16);
        settings.traceEvery = every;
        const auto frames = draw(wall(0.3f), settings, 1);
        ASSERT_FALSE(frames);
        EXPECT_NE(frames.error().message.find("give 1, 2, 4, 8, 16"), std::string::npos) << frames.error().message;
    }
}

} // namespace
} // namespace sconce
