#include "scene/furniture.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace sconce
{

TownMaterials makeTownMaterials(MeshBuilder& mesh)
{
    TownMaterials m{};
    m.oak = mesh.material("oak", vec3(0.46f, 0.28f, 0.13f), 0.5f);
    m.walnut = mesh.material("walnut", vec3(0.19f, 0.10f, 0.055f), 0.35f);
    m.birch = mesh.material("birch", vec3(0.66f, 0.52f, 0.34f), 0.6f);
    m.darkMetal = mesh.material("dark metal", vec3(0.10f, 0.10f, 0.11f), 0.4f, 1.0f);
    m.steel = mesh.material("steel", vec3(0.62f, 0.63f, 0.65f), 0.2f, 1.0f);
    m.brass = mesh.material("brass", vec3(0.88f, 0.66f, 0.30f), 0.25f, 1.0f);
    m.ceramic = mesh.material("ceramic", vec3(0.80f, 0.80f, 0.77f), 0.15f);
    m.white = mesh.material("white paint", vec3(0.80f, 0.79f, 0.76f), 0.9f);
    m.linen = mesh.material("linen", vec3(0.78f, 0.74f, 0.66f), 1.0f);
    m.screen = mesh.material("screen", vec3(0.02f), 0.05f);
    m.soil = mesh.material("soil", vec3(0.10f, 0.06f, 0.035f));
    const vec3 cloths[4] = {{0.45f, 0.07f, 0.06f}, {0.07f, 0.17f, 0.36f}, {0.12f, 0.29f, 0.14f}, {0.55f, 0.36f, 0.08f}};
    for (int i = 0; i < 4; ++i) m.cloth[i] = mesh.material(fmt::format("cloth {}", i), cloths[i], 0.95f);
    const vec3 bindings[6] = {{0.40f, 0.05f, 0.05f}, {0.06f, 0.10f, 0.30f}, {0.06f, 0.22f, 0.10f},
                              {0.55f, 0.48f, 0.30f}, {0.12f, 0.11f, 0.10f}, {0.40f, 0.20f, 0.06f}};
    for (int i = 0; i < 6; ++i) m.books[i] = mesh.material(fmt::format("book {}", i), bindings[i], 0.6f);
    const vec3 greens[3] = {{0.10f, 0.26f, 0.06f}, {0.17f, 0.30f, 0.07f}, {0.07f, 0.19f, 0.08f}};
    for (int i = 0; i < 3; ++i) m.leaves[i] = mesh.material(fmt::format("leaves {}", i), greens[i], 0.9f);
    const vec3 facades[6] = {{0.72f, 0.53f, 0.30f}, {0.64f, 0.33f, 0.22f}, {0.70f, 0.66f, 0.56f},
                             {0.42f, 0.52f, 0.56f}, {0.62f, 0.44f, 0.40f}, {0.50f, 0.55f, 0.38f}};
    for (int i = 0; i < 6; ++i) m.walls[i] = mesh.material(fmt::format("facade {}", i), facades[i], 0.95f);
    const vec3 paints[4] = {{0.78f, 0.75f, 0.68f}, {0.70f, 0.60f, 0.46f}, {0.52f, 0.62f, 0.66f}, {0.66f, 0.50f, 0.46f}};
    for (int i = 0; i < 4; ++i) m.paints[i] = mesh.material(fmt::format("paint {}", i), paints[i], 0.9f);
    m.roofTile = mesh.material("roof tile", vec3(0.44f, 0.16f, 0.09f), 0.85f);
    m.asphalt = mesh.material("asphalt", vec3(0.11f, 0.11f, 0.115f), 0.85f);
    m.paving = mesh.material("paving", vec3(0.42f, 0.40f, 0.37f), 0.8f);
    m.kerb = mesh.material("kerb", vec3(0.52f, 0.51f, 0.49f), 0.8f);
    m.cobble = mesh.material("cobble", vec3(0.34f, 0.31f, 0.28f), 0.6f);
    m.plaster = mesh.material("ceiling plaster", vec3(0.82f, 0.81f, 0.79f), 1.0f);
    m.gloss = mesh.material("polished tiles", vec3(0.55f, 0.53f, 0.49f), 0.08f);
    m.parquet = mesh.material("parquet", vec3(0.40f, 0.23f, 0.11f), 0.28f);
    m.water = mesh.material("water", vec3(0.03f, 0.07f, 0.08f), 0.015f);
    m.warmLamp = mesh.emitter("warm lamp", vec3(32.0f, 22.0f, 12.0f));
    m.coolLamp = mesh.emitter("cool lamp", vec3(20.0f, 23.0f, 26.0f));
    m.streetLamp = mesh.emitter("street lamp", vec3(9.0f, 7.0f, 4.0f));
    return m;
}

void addTable(MeshBuilder& mesh, const TownMaterials& m, vec2 size, float height, uint32_t wood)
{
    const vec2 half = 0.5f * size;
    mesh.box({-half.x, height - 0.04f, -half.y}, {half.x, height, half.y}, wood);
    for (const float x : {-1.0f, 1.0f})
        for (const float z : {-1.0f, 1.0f})
            mesh.cylinder({x * (half.x - 0.07f), 0.0f, z * (half.y - 0.07f)}, 0.022f, 0.034f, height - 0.04f, 8, m.walnut);
}

void addChair(MeshBuilder& mesh, const TownMaterials& m, uint32_t wood)
{
    mesh.box({-0.22f, 0.43f, -0.22f}, {0.22f, 0.47f, 0.22f}, wood);
    for (const float x : {-0.18f, 0.18f})
    {
        mesh.cylinder({x, 0.0f, 0.18f}, 0.016f, 0.02f, 0.43f, 8, m.walnut);
        mesh.cylinder({x, 0.0f, -0.18f}, 0.016f, 0.02f, 0.43f, 8, m.walnut);
        mesh.cylinder({x, 0.47f, -0.19f}, 0.018f, 0.43f, 8, wood);
    }
    mesh.box({-0.21f, 0.80f, -0.21f}, {0.21f, 0.92f, -0.17f}, wood);
    for (int i = 0; i < 4; ++i) mesh.box({-0.13f + 0.075f * float(i), 0.47f, -0.2f}, {-0.10f + 0.075f * float(i), 0.80f, -0.18f}, wood);
}

void addBookshelf(MeshBuilder& mesh, const TownMaterials& m, uint32_t wood, Variation& vary)
{
    mesh.box({-0.60f, 0.0f, -0.16f}, {-0.57f, 2.0f, 0.16f}, wood);
    mesh.box({0.57f, 0.0f, -0.16f}, {0.60f, 2.0f, 0.16f}, wood);
    mesh.box({-0.57f, 0.0f, -0.16f}, {0.57f, 2.0f, -0.14f}, wood);
    for (int shelf = 0; shelf < 6; ++shelf)
    {
        const float y = 0.06f + 0.38f * float(shelf);
        mesh.box({-0.57f, y, -0.14f}, {0.57f, y + 0.025f, 0.15f}, wood);
        if (shelf == 5) break;
        const float end = vary.between(0.1f, 0.5f); // the shelf is full up to here
        for (float x = -0.56f; x < end;)
        {
            const float width = vary.between(0.03f, 0.07f), height = vary.between(0.2f, 0.31f), depth = vary.between(0.15f, 0.22f);
            mesh.box({x, y + 0.025f, -0.13f}, {x + width, y + 0.025f + height, -0.13f + depth}, m.books[vary.below(6)]);
            x += width + 0.003f;
        }
    }
}

void addBed(MeshBuilder& mesh, const TownMaterials& m, uint32_t cloth)
{
    mesh.box({-0.85f, 0.16f, -1.05f}, {0.85f, 0.32f, 1.05f}, m.walnut);
    mesh.box({-0.85f, 0.16f, -1.12f}, {0.85f, 1.0f, -1.05f}, m.walnut);
    for (const float x : {-0.78f, 0.78f})
        for (const float z : {-0.98f, 0.98f}) mesh.cylinder({x, 0.0f, z}, 0.035f, 0.16f, 12, m.walnut);
    mesh.box({-0.82f, 0.32f, -1.03f}, {0.82f, 0.50f, 1.03f}, m.linen);
    mesh.box({-0.86f, 0.38f, -0.35f}, {0.86f, 0.56f, 1.07f}, cloth);
    for (const float x : {-0.4f, 0.4f}) mesh.sphere({x, 0.57f, -0.75f}, {0.33f, 0.1f, 0.2f}, 14, 8, m.linen);
}

void addSofa(MeshBuilder& mesh, const TownMaterials& m, uint32_t cloth)
{
    mesh.box({-1.0f, 0.1f, -0.42f}, {1.0f, 0.30f, 0.42f}, cloth);
    mesh.box({-1.0f, 0.30f, -0.42f}, {1.0f, 0.82f, -0.20f}, cloth);
    for (const float x : {-1.0f, 0.82f}) mesh.box({x, 0.30f, -0.20f}, {x + 0.18f, 0.60f, 0.42f}, cloth);
    for (const float x : {-0.80f, 0.01f}) mesh.box({x, 0.30f, -0.19f}, {x + 0.79f, 0.44f, 0.43f}, m.linen);
    for (const float x : {-0.9f, 0.9f})
        for (const float z : {-0.35f, 0.35f}) mesh.cylinder({x, 0.0f, z}, 0.03f, 0.1f, 12, m.darkMetal);
}

void addWardrobe(MeshBuilder& mesh, const TownMaterials& m, uint32_t wood)
{
    mesh.box({-0.75f, 0.0f, -0.3f}, {0.75f, 2.05f, 0.28f}, wood);
    for (const float x : {-0.74f, 0.01f}) mesh.box({x, 0.08f, 0.28f}, {x + 0.73f, 2.0f, 0.30f}, wood);
    for (const float x : {-0.05f, 0.05f}) mesh.sphere({x, 1.05f, 0.33f}, 0.025f, 12, 8, m.brass);
}

void addKitchenCounter(MeshBuilder& mesh, const TownMaterials& m)
{
    mesh.box({-1.3f, 0.1f, -0.3f}, {1.3f, 0.86f, 0.27f}, m.birch);
    mesh.box({-1.32f, 0.86f, -0.3f}, {1.32f, 0.90f, 0.30f}, m.screen); // black polished stone
    for (int i = 0; i < 4; ++i)
    {
        const float x = -1.28f + 0.65f * float(i);
        mesh.box({x, 0.12f, 0.27f}, {x + 0.61f, 0.84f, 0.29f}, m.birch);
        mesh.box({x + 0.2f, 0.74f, 0.29f}, {x + 0.41f, 0.76f, 0.31f}, m.steel);
    }
    mesh.box({-1.3f, 1.45f, -0.3f}, {0.4f, 2.1f, 0.02f}, m.birch);
    mesh.cylinder({-0.7f, 0.90f, 0.0f}, 0.11f, 0.16f, 28, m.steel);
    mesh.cylinder({-0.3f, 0.90f, 0.05f}, 0.09f, 0.12f, 28, m.brass);
    mesh.sphere({0.85f, 0.96f, 0.0f}, {0.16f, 0.06f, 0.16f}, 24, 12, m.ceramic);
    for (int i = 0; i < 3; ++i) mesh.sphere({0.79f + 0.06f * float(i), 1.04f, 0.03f * float(i % 2)}, 0.04f, 14, 10, m.cloth[i % 2 ? 2 : 0]);
}

void addTableware(MeshBuilder& mesh, const TownMaterials& m)
{
    for (const float x : {-0.42f, 0.42f})
        for (const float z : {-0.22f, 0.22f})
        {
            mesh.cylinder({x, 0.0f, z}, 0.07f, 0.12f, 0.02f, 12, m.ceramic);
            mesh.cylinder({x + 0.17f, 0.0f, z}, 0.03f, 0.038f, 0.10f, 10, m.ceramic);
        }
    mesh.cylinder({0.0f, 0.0f, 0.0f}, 0.06f, 0.09f, 0.16f, 24, m.brass);
    mesh.sphere({0.0f, 0.24f, 0.0f}, {0.12f, 0.11f, 0.12f}, 16, 10, m.leaves[1]);
}

void addPottedPlant(MeshBuilder& mesh, const TownMaterials& m, Variation& vary)
{
    mesh.cylinder({0, 0, 0}, 0.13f, 0.18f, 0.30f, 20, m.roofTile);
    mesh.cylinder({0, 0.30f, 0}, 0.16f, 0.01f, 20, m.soil);
    mesh.cylinder({0, 0.31f, 0}, 0.02f, 0.5f, 10, m.walnut);
    for (int i = 0; i < 7; ++i)
    {
        const float angle = 0.9f * float(i) + vary.between(0.0f, 0.5f), out = vary.between(0.06f, 0.2f);
        mesh.sphere({out * std::cos(angle), 0.65f + 0.09f * float(i), out * std::sin(angle)}, {0.13f, 0.06f, 0.13f}, 8, 6, m.leaves[i % 3]);
    }
}

void addCeilingLamp(MeshBuilder& mesh, const TownMaterials& m, float ceiling, uint32_t lamp)
{
    mesh.cylinder({0, ceiling - 0.45f, 0}, 0.008f, 0.45f, 8, m.darkMetal);
    mesh.cylinder({0, ceiling - 0.55f, 0}, 0.20f, 0.05f, 0.10f, 24, m.brass);
    mesh.sphere({0, ceiling - 0.62f, 0}, 0.08f, 12, 8, lamp);
}

void addFloorLamp(MeshBuilder& mesh, const TownMaterials& m, uint32_t lamp)
{
    mesh.cylinder({0, 0, 0}, 0.15f, 0.03f, 24, m.darkMetal);
    mesh.cylinder({0, 0.03f, 0}, 0.012f, 1.4f, 10, m.darkMetal);
    mesh.cylinder({0, 1.43f, 0}, 0.13f, 0.09f, 0.22f, 24, lamp);
}

void addTree(MeshBuilder& mesh, const TownMaterials& m, Variation& vary)
{
    mesh.cylinder({0, 0, 0}, 0.17f, 0.10f, 2.4f, 16, m.walnut);
    for (int i = 0; i < 9; ++i)
    {
        const float angle = 2.4f * float(i), out = i == 0 ? 0.0f : vary.between(0.5f, 1.0f); // 2.4 rad: golden angle, spreads evenly
        const vec3 centre(out * std::cos(angle), 2.7f + 0.2f * float(i), out * std::sin(angle));
        mesh.sphere(centre, vec3(0.75f, 0.55f, 0.75f) * vary.between(0.8f, 1.15f), 14, 8, m.leaves[vary.below(3)]);
    }
}

void addStreetLamp(MeshBuilder& mesh, const TownMaterials& m)
{
    mesh.cylinder({0, 0, 0}, 0.14f, 0.10f, 0.4f, 16, m.darkMetal);
    mesh.cylinder({0, 0.4f, 0}, 0.05f, 3.3f, 14, m.darkMetal);
    mesh.sphere({0, 3.9f, 0}, 0.2f, 14, 10, m.streetLamp);
    mesh.cylinder({0, 4.08f, 0}, 0.24f, 0.03f, 0.12f, 20, m.darkMetal);
}

void addBench(MeshBuilder& mesh, const TownMaterials& m)
{
    for (int i = 0; i < 4; ++i) mesh.box({-0.9f, 0.43f, -0.22f + 0.12f * float(i)}, {0.9f, 0.46f, -0.13f + 0.12f * float(i)}, m.oak);
    for (int i = 0; i < 3; ++i) mesh.box({-0.9f, 0.56f + 0.13f * float(i), -0.27f}, {0.9f, 0.65f + 0.13f * float(i), -0.24f}, m.oak);
    for (const float x : {-0.75f, 0.70f})
    {
        mesh.box({x, 0.0f, -0.22f}, {x + 0.05f, 0.43f, 0.22f}, m.darkMetal);
        mesh.box({x, 0.43f, -0.30f}, {x + 0.05f, 0.95f, -0.27f}, m.darkMetal);
    }
}

void addFountain(MeshBuilder& mesh, const TownMaterials& m)
{
    constexpr uint32_t kSides = 24;
    for (uint32_t i = 0; i < kSides; ++i) // a ring of stones around the water
    {
        const float angle = 2.0f * std::numbers::pi_v<float> * float(i) / float(kSides);
        mesh.boxTurned({2.2f * std::cos(angle), 0.3f, -2.2f * std::sin(angle)}, {0.35f, 0.6f, 0.56f}, angle, m.kerb);
    }
    mesh.cylinder({0, 0, 0}, 2.1f, 0.42f, 48, m.water);
    mesh.cylinder({0, 0.42f, 0}, 0.35f, 0.22f, 1.2f, 32, m.kerb);
    mesh.cylinder({0, 1.62f, 0}, 0.25f, 0.95f, 0.28f, 36, m.kerb);
    mesh.sphere({0, 2.15f, 0}, 0.27f, 28, 18, m.brass);
}

void addMarketStall(MeshBuilder& mesh, const TownMaterials& m, uint32_t cloth)
{
    addTable(mesh, m, {2.2f, 0.9f}, 0.85f, m.oak);
    for (const float x : {-1.15f, 1.15f})
        for (const float z : {-0.6f, 0.6f}) mesh.cylinder({x, 0, z}, 0.03f, z > 0 ? 2.1f : 2.4f, 12, m.birch);
    // The canopy is one sheet without thickness, as such cloth is in real assets.
    mesh.quad({-1.25f, 2.08f, 0.75f}, {1.25f, 2.08f, 0.75f}, {1.25f, 2.45f, -0.7f}, {-1.25f, 2.45f, -0.7f}, cloth, 10, 6);
    for (int crate = 0; crate < 3; ++crate)
    {
        const float x = -0.7f + 0.7f * float(crate);
        mesh.box({x - 0.26f, 0.85f, -0.3f}, {x + 0.26f, 0.93f, 0.3f}, m.birch);
        for (int i = 0; i < 12; ++i)
            mesh.sphere({x - 0.18f + 0.12f * float(i % 4), 0.97f, -0.2f + 0.19f * float(i / 4)}, 0.055f, 8, 6, m.cloth[(crate * 2) % 4]);
    }
}

} // namespace sconce
