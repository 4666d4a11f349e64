#include "scene/builtin_town.h"

#include <glm/gtc/matrix_transform.hpp>

#include "scene/furniture.h"
#include "scene/mesh_builder.h"

namespace sconce
{

namespace
{

// One house: 9 x 8 m on the ground, front towards +z, two storeys. All lengths in metres in the house's own frame.
constexpr float kWidth = 9.0f, kDepth = 8.0f, kWall = 0.2f, kDivide = 5.0f;
constexpr float kGround = 0.15f, kCeiling = 2.85f, kUpper = 3.10f, kUpperCeiling = 5.80f, kTop = 6.0f;

class Furnisher // puts furniture at a spot of the house, turned about y in quarter turns
{
public:
    Furnisher(MeshBuilder& target, mat4 frame) : mesh(target), house(frame) {}
    template <class Add> void at(vec3 spot, float degrees, Add&& add)
    {
        mesh.place = glm::rotate(glm::translate(house, spot), glm::radians(degrees), vec3(0.0f, 1.0f, 0.0f));
        add();
        mesh.place = house;
    }

private:
    MeshBuilder& mesh;
    mat4 house;
};

void addWalls(MeshBuilder& mesh, const TownMaterials& m, uint32_t facade, uint32_t paintA, uint32_t paintB, bool tiles)
{
    const float x1 = kWidth - kWall, z1 = kDepth - kWall, skin = 0.5f * kWall;
    BlockSolid house;
    house.fill({0, -0.3f, 0}, {kWidth, kTop, kDepth}, facade);                         // founded below the grass
    house.fill({skin, kGround, skin}, {kDivide, kTop - 0.05f, kDepth - skin}, paintA); // the inner half of the walls carries the paint
    house.fill({kDivide, kGround, skin}, {kWidth - skin, kTop - 0.05f, kDepth - skin}, paintB);
    house.fill({skin, kGround - 0.05f, skin}, {kWidth - skin, kGround, kDepth - skin}, tiles ? m.gloss : m.parquet);
    house.fill({skin, kCeiling, skin}, {kWidth - skin, kUpper - 0.05f, kDepth - skin}, m.plaster);
    house.fill({skin, kUpper - 0.05f, skin}, {kWidth - skin, kUpper, kDepth - skin}, m.parquet);
    house.fill({skin, kUpperCeiling, skin}, {kWidth - skin, kTop - 0.05f, kDepth - skin}, m.plaster);
    const float a1 = kDivide - 0.1f, b0 = kDivide + 0.1f;
    for (const auto& [low, high] : {std::pair{kGround, kCeiling}, std::pair{kUpper, kUpperCeiling}})
    {
        house.carve({kWall, low, kWall}, {a1, high, z1});
        house.carve({b0, low, kWall}, {x1, high, z1});
    }
    house.carve({0.5f, kCeiling - 0.1f, kWall}, {4.2f, kUpper + 0.1f, 1.3f});   // stair well
    house.carve({a1 - 0.1f, kGround, 4.6f}, {b0 + 0.1f, kGround + 2.1f, 5.6f}); // doors between the rooms
    house.carve({a1 - 0.1f, kUpper, 2.2f}, {b0 + 0.1f, kUpper + 2.1f, 3.1f});
    house.carve({3.5f, kGround, z1 - 0.1f}, {4.6f, kGround + 2.2f, kDepth + 0.1f}); // front door
    house.carve({1.0f, 1.0f, z1 - 0.1f}, {2.8f, 2.3f, kDepth + 0.1f});              // windows: front
    house.carve({6.0f, 1.0f, z1 - 0.1f}, {8.0f, 2.3f, kDepth + 0.1f});
    house.carve({1.0f, 4.0f, z1 - 0.1f}, {2.8f, 5.3f, kDepth + 0.1f});
    house.carve({6.0f, 4.0f, z1 - 0.1f}, {8.0f, 5.3f, kDepth + 0.1f});
    house.carve({6.2f, 4.0f, -0.1f}, {7.8f, 5.3f, kWall + 0.1f}); // back
    house.carve({6.2f, 1.2f, -0.1f}, {7.8f, 2.2f, kWall + 0.1f});
    house.carve({-0.1f, 4.0f, 4.0f}, {kWall + 0.1f, 5.3f, 5.2f}); // side
    house.addTo(mesh);
}

void addWindowBars(MeshBuilder& mesh, const TownMaterials& m)
{
    const auto bars = [&](float x0, float x1, float y0, float y1, float z)
    {
        const float middleX = 0.5f * (x0 + x1), middleY = 0.5f * (y0 + y1);
        mesh.box({middleX - 0.02f, y0, z - 0.02f}, {middleX + 0.02f, y1, z + 0.02f}, m.white);
        mesh.box({x0, middleY - 0.015f, z - 0.015f}, {x1, middleY + 0.015f, z + 0.015f}, m.white);
        mesh.box({x0 - 0.08f, y0 - 0.05f, z - 0.05f}, {x1 + 0.08f, y0, z + 0.22f}, m.kerb); // sill
    };
    for (const float y : {1.0f, 4.0f})
    {
        bars(1.0f, 2.8f, y, y + 1.3f, kDepth - 0.1f);
        bars(6.0f, 8.0f, y, y + 1.3f, kDepth - 0.1f);
    }
}

void addStairs(MeshBuilder& mesh, const TownMaterials& m)
{
    constexpr int kSteps = 15;
    const float rise = (kUpper - kGround) / float(kSteps);
    for (int i = 0; i < kSteps; ++i)
    {
        const float x = 0.55f + 0.235f * float(i), y = kGround + rise * float(i + 1);
        mesh.box({x, y - 0.05f, kWall + 0.01f}, {x + 0.26f, y, 1.25f}, m.oak);
        mesh.cylinder({x + 0.13f, y, 1.22f}, 0.012f, 0.9f, 6, m.darkMetal);
    }
    mesh.box({0.5f, kUpper, 1.32f}, {4.2f, kUpper + 0.9f, 1.36f}, m.birch); // parapet of the stair well
}

void addRoof(MeshBuilder& mesh, const TownMaterials& m, uint32_t facade, bool flat)
{
    if (flat)
    {
        BlockSolid parapet;
        parapet.fill({-0.1f, kTop, -0.1f}, {kWidth + 0.1f, kTop + 0.7f, kDepth + 0.1f}, facade);
        parapet.carve({0.15f, kTop - 1.0f, 0.15f}, {kWidth - 0.15f, kTop + 1.0f, kDepth - 0.15f});
        parapet.addTo(mesh);
        mesh.box({5.5f, kTop, 2.0f}, {7.0f, kTop + 0.9f, 3.2f}, m.steel);
        return;
    }
    const vec3 low(-0.4f, kTop, -0.5f), high(kWidth + 0.4f, kTop + 2.6f, kDepth + 0.5f);
    mesh.gable(low, high, m.roofTile, facade);
    constexpr int kRows = 7, kTiles = 10; // overlapping rows of tiles on both slopes
    const float halfDepth = 0.5f * (high.z - low.z), slope = std::atan2(high.y - low.y, halfDepth),
                length = std::hypot(high.y - low.y, halfDepth);
    const mat4 house = mesh.place;
    for (const bool front : {true, false})
    {
        mesh.place = glm::translate(house, vec3(front ? low.x : high.x, high.y, 0.5f * (low.z + high.z)));
        if (!front) mesh.place = glm::rotate(mesh.place, glm::radians(180.0f), vec3(0, 1, 0));
        mesh.place = glm::rotate(mesh.place, slope, vec3(1, 0, 0)); // +z now runs down the slope
        const float width = (high.x - low.x) / float(kTiles), row = length / float(kRows);
        for (int j = 0; j < kRows; ++j)
            for (int i = 0; i < kTiles; ++i)
                mesh.box({width * float(i) + 0.01f, 0.005f, row * float(j)},
                         {width * float(i + 1) - 0.01f, 0.035f + 0.01f * float(i % 2), row * float(j + 1) - 0.02f}, m.roofTile);
    }
    mesh.place = house;
    mesh.box({2.0f, kTop + 1.2f, 1.6f}, {2.7f, kTop + 3.2f, 2.3f}, m.walls[1]);
}

void addHouse(MeshBuilder& mesh, const TownMaterials& m, mat4 frame, uint64_t seed)
{
    Variation vary(seed);
    mesh.place = frame;
    // All draws come from one sequence: a draw added or moved changes every one after it.
    const uint32_t facade = m.walls[vary.below(6)], cloth = m.cloth[vary.below(4)], wood = vary.below(2) ? m.oak : m.birch;
    const uint32_t paintA = m.paints[vary.below(4)], paintB = m.paints[vary.below(4)];
    addWalls(mesh, m, facade, paintA, paintB, vary.below(2) == 0);
    addWindowBars(mesh, m);
    addStairs(mesh, m);
    addRoof(mesh, m, facade, seed % 4 == 3);
    mesh.box({3.3f, 0.0f, kDepth}, {4.8f, kGround, kDepth + 0.6f}, m.kerb);                       // door step
    mesh.boxTurned({3.05f, kGround + 1.1f, kDepth + 0.3f}, {0.05f, 2.2f, 1.05f}, 0.9f, m.walnut); // the door stands open

    Furnisher put(mesh, frame);
    const auto lamp = [&](bool warm) { return warm ? m.warmLamp : m.coolLamp; };
    // Ground floor: living room | kitchen
    put.at({0.75f, kGround, 5.2f}, 90, [&] { addSofa(mesh, m, cloth); });
    put.at({2.2f, kGround, 5.2f}, 90, [&] { addTable(mesh, m, {1.1f, 0.6f}, 0.45f, m.walnut); });
    put.at({2.0f, kGround, 5.2f}, 0, [&] { mesh.box({-1.0f, 0.0f, -1.2f}, {1.3f, 0.012f, 1.2f}, m.cloth[vary.below(4)]); });
    put.at({4.70f, kGround, 2.6f}, -90, [&] { addBookshelf(mesh, m, wood, vary); });
    put.at({0.55f, kGround, 7.3f}, 0, [&] { addFloorLamp(mesh, m, lamp(true)); });
    put.at({0.6f, kGround, 2.2f}, 0, [&] { addPottedPlant(mesh, m, vary); });
    put.at({2.4f, 0, 4.6f}, 0, [&] { addCeilingLamp(mesh, m, kCeiling, lamp(vary.below(2) == 0)); });
    put.at({7.0f, kGround, 0.52f}, 0, [&] { addKitchenCounter(mesh, m); });
    put.at({7.0f, kGround, 4.6f}, 0, [&] { addTable(mesh, m, {1.5f, 0.85f}, 0.75f, wood); });
    put.at({7.0f, kGround + 0.75f, 4.6f}, 0, [&] { addTableware(mesh, m); });
    for (const float x : {6.6f, 7.4f})
    {
        put.at({x, kGround, 3.95f}, vary.between(-12, 12), [&] { addChair(mesh, m, wood); });
        put.at({x, kGround, 5.25f}, 180 + vary.between(-12, 12), [&] { addChair(mesh, m, wood); });
    }
    put.at({7.0f, 0, 4.6f}, 0, [&] { addCeilingLamp(mesh, m, kCeiling, lamp(true)); });
    // Upper floor: bedroom | study
    put.at({1.4f, kUpper, 5.9f}, 90, [&] { addBed(mesh, m, m.cloth[vary.below(4)]); });
    put.at({4.55f, kUpper, 6.4f}, -90, [&] { addWardrobe(mesh, m, wood); });
    put.at({0.6f, kUpper, 3.6f}, 0, [&] { addFloorLamp(mesh, m, lamp(true)); });
    put.at({7.0f, kUpper, 6.9f}, 180, [&] { addTable(mesh, m, {1.6f, 0.7f}, 0.74f, m.walnut); });
    put.at({7.0f, kUpper, 6.2f}, vary.between(-30, 30), [&] { addChair(mesh, m, wood); });
    put.at({7.2f, kUpper + 0.74f, 7.0f}, 180, [&] { mesh.box({-0.3f, 0.08f, -0.02f}, {0.3f, 0.45f, 0.02f}, m.screen); });
    put.at({8.62f, kUpper, 3.0f}, -90, [&] { addBookshelf(mesh, m, m.walnut, vary); });
    put.at({8.5f, kUpper, 4.4f}, -90, [&] { addChair(mesh, m, wood); });
    put.at({5.5f, kUpper, 7.3f}, 0, [&] { addPottedPlant(mesh, m, vary); });
    put.at({7.0f, 0, 3.6f}, 0, [&] { addCeilingLamp(mesh, m, kUpperCeiling, lamp(vary.below(2) == 0)); });
    mesh.place = mat4(1.0f);
}

mat4 houseFrame(vec3 corner, float degrees)
{
    return glm::rotate(glm::translate(mat4(1.0f), corner), glm::radians(degrees), vec3(0.0f, 1.0f, 0.0f));
}

void addGround(MeshBuilder& mesh, const TownMaterials& m)
{
    mesh.quad({-42, -0.02f, 22}, {42, -0.02f, 22}, {42, -0.02f, -46}, {-42, -0.02f, -46}, m.leaves[2], 21, 17);
    mesh.box({-40, -0.3f, -4}, {40, 0.0f, 4}, m.asphalt);
    for (int i = 0; i < 12; ++i) mesh.box({-36.4f + 6.2f * float(i), 0.0f, -0.08f}, {-33.9f + 6.2f * float(i), 0.006f, 0.08f}, m.white);
    mesh.box({-40, -0.3f, 4}, {40, 0.12f, 6.2f}, m.paving);
    mesh.box({-40, -0.3f, -6.2f}, {40, 0.12f, -4}, m.paving);
    for (const float z : {-4.0f, 3.85f}) mesh.box({-40, 0.0f, z}, {40, 0.13f, z + 0.15f}, m.kerb);
    for (int z = 0; z < 24; ++z) // the square's slabs, laid with joints
        for (int x = 0; x < 22; ++x)
            mesh.box({-11.0f + float(x), 0.0f, -30.2f + float(z)},
                     {-10.03f + float(x), 0.1f + 0.004f * float((x * 7 + z * 3) % 3), -29.23f + float(z)},
                     (x + z) % 5 ? m.cobble : m.paving);
}

} // namespace

// A street along x with houses on both sides, opening to the north (-z) on a square with a fountain and market stalls.
Scene makeTown()
{
    Scene scene;
    scene.name = "town";
    MeshBuilder mesh(scene);
    const TownMaterials m = makeTownMaterials(mesh);
    addGround(mesh, m);

    uint64_t seed = 1;
    for (const float x : {-34.5f, -23.0f, 14.0f, 25.5f}) addHouse(mesh, m, houseFrame({x, 0, -14.2f}, 0), seed++);
    for (int i = 0; i < 6; ++i) addHouse(mesh, m, houseFrame({-25.5f + 11.5f * float(i), 0, 14.2f}, 180), seed++);
    for (const float x : {-10.0f, 1.5f}) addHouse(mesh, m, houseFrame({x, 0, -38.6f}, 0), seed++);

    Variation vary(77);
    const auto put = [&](vec3 spot, float degrees, auto&& add)
    {
        mesh.place = houseFrame(spot, degrees);
        add();
        mesh.place = mat4(1.0f);
    };
    for (int i = 0; i < 7; ++i)
    {
        const float x = -33.0f + 11.0f * float(i);
        put({x, 0.12f, 4.6f}, 0, [&] { addStreetLamp(mesh, m); });
        if (std::abs(x) > 12.0f) put({x + 5.0f, 0.12f, -4.9f}, 0, [&] { addStreetLamp(mesh, m); });
    }
    for (const vec2 spot :
         {vec2(-8.5f, -27), vec2(8.5f, -27), vec2(-8.5f, -9), vec2(8.5f, -9), vec2(-13.5f, -22), vec2(13.5f, -24), vec2(-14, -32)})
        put({spot.x, 0.0f, spot.y}, vary.between(0, 360), [&] { addTree(mesh, m, vary); });
    put({0, 0.1f, -18.0f}, 0, [&] { addFountain(mesh, m); });
    put({-5.0f, 0.1f, -18.0f}, 90, [&] { addBench(mesh, m); });
    put({5.0f, 0.1f, -18.0f}, -90, [&] { addBench(mesh, m); });
    for (int i = 0; i < 3; ++i) put({-6.5f, 0.1f, -25.0f + 2.9f * float(i)}, 90, [&] { addMarketStall(mesh, m, m.cloth[i]); });
    for (int i = 0; i < 3; ++i) put({6.8f, 0.1f, -25.0f + 2.9f * float(i)}, -90, [&] { addMarketStall(mesh, m, m.cloth[3 - i]); });

    Light sun;
    sun.name = "sun";
    sun.direction = glm::normalize(vec3(0.42f, -0.75f, -0.50f));
    sun.intensity = vec3(7.0f, 6.3f, 5.2f);
    scene.lights.push_back(sun);
    scene.sky = vec3(0.60f, 0.78f, 1.05f);

    mesh.camera("main", {-15.5f, 2.4f, 1.6f}, {3.0f, 2.2f, -17.0f}, 60.0f);
    mesh.camera("street", {-36.0f, 1.7f, 1.2f}, {0.0f, 2.6f, -1.0f}, 55.0f);
    mesh.camera("square", {7.0f, 1.8f, -7.6f}, {-3.0f, 1.9f, -24.0f}, 65.0f);
    mesh.place = houseFrame({14.0f, 0, -14.2f}, 0); // the house at the square's corner
    mesh.camera("living room", {4.0f, 1.7f, 7.2f}, {1.6f, 0.9f, 2.6f}, 70.0f);
    mesh.camera("kitchen", {5.5f, 1.75f, 7.2f}, {7.4f, 1.0f, 1.6f}, 70.0f);
    mesh.camera("bedroom", {4.3f, kUpper + 1.6f, 2.0f}, {1.4f, kUpper + 0.6f, 6.0f}, 70.0f);
    mesh.camera("study", {5.4f, kUpper + 1.6f, 1.2f}, {7.9f, kUpper + 0.9f, 6.0f}, 70.0f);
    mesh.camera("doorway", {4.05f, 1.7f, 3.4f}, {4.1f, 1.6f, 12.0f}, 65.0f); // from indoors, through the open front door
    return scene;
}

} // namespace sconce
