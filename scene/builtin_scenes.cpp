#include "scene/builtin_scenes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/listed.h"
#include "scene/builtin_town.h"
#include "scene/mesh_builder.h"

namespace sconce
{

namespace
{

Light sunLight(vec3 direction, vec3 irradiance)
{
    Light sun;
    sun.name = "sun";
    sun.direction = glm::normalize(direction);
    sun.intensity = irradiance;
    return sun;
}

// The Cornell box of Goral et al. (1984) in metres: x [-1,1], y [0,2], z [-1,1], open towards +z. Without a sky what leaves through the
// open side is lost, as in the original.
Scene makeCornell(bool glossy)
{
    Scene scene;
    scene.name = glossy ? "cornell-glossy" : "cornell";
    MeshBuilder mesh(scene);
    const uint32_t white = mesh.material("white walls", vec3(0.73f, 0.72f, 0.68f), glossy ? 0.3f : 1.0f);
    const uint32_t red = mesh.material("red wall", vec3(0.63f, 0.065f, 0.05f), glossy ? 0.25f : 1.0f);
    const uint32_t green = mesh.material("green wall", vec3(0.14f, 0.45f, 0.091f), glossy ? 0.25f : 1.0f);
    const uint32_t floor = mesh.material("floor", vec3(0.73f, 0.72f, 0.68f), glossy ? 0.1f : 1.0f);
    const uint32_t tallBox = mesh.material("tall box", vec3(0.75f, 0.71f, 0.62f), glossy ? 0.12f : 1.0f, glossy ? 1.0f : 0.0f);
    const uint32_t shortBox = mesh.material("short box", vec3(0.73f, 0.72f, 0.68f), glossy ? 0.2f : 1.0f);
    const uint32_t lamp = mesh.emitter("area light", vec3(17.0f, 12.5f, 7.5f));

    mesh.quad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}, floor);
    mesh.quad({-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}, white);
    mesh.quad({-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1}, white);
    mesh.quad({-1, 0, 1}, {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1}, red);
    mesh.quad({1, 0, -1}, {1, 0, 1}, {1, 2, 1}, {1, 2, -1}, green);
    mesh.quad({-0.25f, 1.99f, -0.25f}, {0.25f, 1.99f, -0.25f}, {0.25f, 1.99f, 0.25f}, {-0.25f, 1.99f, 0.25f}, lamp);
    mesh.boxTurned({-0.34f, 0.6f, -0.3f}, {0.6f, 1.2f, 0.6f}, 0.30f, tallBox);
    mesh.boxTurned({0.34f, 0.3f, 0.36f}, {0.6f, 0.6f, 0.6f}, -0.29f, shortBox);

    mesh.camera("main", {0.0f, 1.0f, 3.6f}, {0.0f, 1.0f, 0.0f}, 42.0f);
    mesh.camera("inside", {0.75f, 1.45f, 0.9f}, {-0.35f, 0.55f, -0.5f}, 65.0f);
    mesh.camera("floor", {0.0f, 0.35f, 0.95f}, {-0.1f, 0.45f, -1.0f}, 60.0f);
    return scene;
}

void addColumn(MeshBuilder& mesh, vec3 foot, float height, uint32_t stone)
{
    mesh.box(foot + vec3(-0.6f, 0.0f, -0.6f), foot + vec3(0.6f, 0.2f, 0.6f), stone);
    mesh.cylinder(foot + vec3(0, 0.2f, 0), 0.52f, 0.46f, 0.18f, 40, stone);
    mesh.cylinder(foot + vec3(0, 0.38f, 0), 0.42f, 0.34f, height - 0.98f, 40, stone);
    mesh.cylinder(foot + vec3(0, height - 0.6f, 0), 0.34f, 0.56f, 0.4f, 40, stone);
    mesh.box(foot + vec3(-0.62f, height - 0.2f, -0.62f), foot + vec3(0.62f, height, 0.62f), stone);
}

// A peripteral temple: 6 x 9 columns around a cella with one door; light reaches the cella only through it.
Scene makeTemple()
{
    Scene scene;
    scene.name = "temple";
    MeshBuilder mesh(scene);
    const uint32_t grass = mesh.material("grass", vec3(0.16f, 0.24f, 0.07f));
    const uint32_t stone = mesh.material("marble", vec3(0.78f, 0.74f, 0.66f), 0.7f);
    const uint32_t steps = mesh.material("steps", vec3(0.55f, 0.50f, 0.43f), 0.9f);
    const uint32_t tileLight = mesh.material("light tile", vec3(0.70f, 0.66f, 0.58f), 0.2f);
    const uint32_t tileDark = mesh.material("dark tile", vec3(0.22f, 0.12f, 0.09f), 0.15f);
    const uint32_t roof = mesh.material("roof", vec3(0.50f, 0.20f, 0.11f), 0.8f);
    const uint32_t plaster = mesh.material("cella", vec3(0.62f, 0.30f, 0.16f), 0.9f);
    const uint32_t gold = mesh.material("gold", vec3(1.0f, 0.77f, 0.34f), 0.22f, 1.0f);
    const uint32_t fire = mesh.emitter("fire", vec3(30.0f, 14.0f, 4.0f));

    mesh.quad({-30, 0, 30}, {30, 0, 30}, {30, 0, -30}, {-30, 0, -30}, grass, 12, 12);
    for (int i = 0; i < 5; ++i) // the stairs run all around
    {
        const float out = 0.45f * float(4 - i), y = 0.24f * float(i);
        mesh.box({-7.5f - out, y, -11.5f - out}, {7.5f + out, y + 0.24f, 11.5f + out}, steps);
    }
    const float floor = 1.2f;
    for (int z = 0; z < 23; ++z)
        for (int x = 0; x < 15; ++x)
        {
            const vec3 low(-7.5f + float(x), floor, -11.5f + float(z));
            mesh.box(low, low + vec3(1.0f, 0.02f, 1.0f), (x + z) % 2 ? tileDark : tileLight);
        }
    const float top = floor + 0.02f, height = 5.6f;
    for (int i = 0; i < 6; ++i)
        for (const float z : {-10.4f, 10.4f}) addColumn(mesh, {-6.4f + 2.56f * float(i), top, z}, height, stone);
    for (int i = 1; i < 8; ++i)
        for (const float x : {-6.4f, 6.4f}) addColumn(mesh, {x, top, -10.4f + 2.6f * float(i)}, height, stone);

    // Later steps win: the room is carved when stone and paint stand, or the fills would close it.
    BlockSolid cella;
    cella.fill({-4.2f, top, -7.8f}, {4.2f, top + 5.6f, 7.0f}, stone);
    cella.fill({-4.0f, top, -7.6f}, {4.0f, top + 5.6f, 6.8f}, plaster); // paint of 0.2 m inside a stone skin of the same
    cella.carve({-3.8f, top - 1.0f, -7.4f}, {3.8f, top + 5.3f, 6.6f});
    // The door, the cella's only opening.
    cella.carve({-1.2f, top - 1.0f, 6.0f}, {1.2f, top + 3.6f, 8.0f});
    cella.addTo(mesh);

    const float beam = top + height;
    mesh.box({-7.2f, beam, -11.2f}, {7.2f, beam + 0.7f, 11.2f}, stone);
    mesh.box({-7.6f, beam + 0.7f, -11.6f}, {7.6f, beam + 0.95f, 11.6f}, stone);
    const mat4 before = mesh.place; // the ridge runs along z
    mesh.place = mat4(vec4(0, 0, -1, 0), vec4(0, 1, 0, 0), vec4(1, 0, 0, 0), vec4(0, 0, 0, 1));
    mesh.gable({-11.5f, beam + 0.95f, -7.5f}, {11.5f, beam + 3.4f, 7.5f}, roof, stone);
    mesh.place = before;

    mesh.box({-1.1f, top, -6.2f}, {1.1f, top + 0.9f, -4.2f}, tileDark);
    mesh.cylinder({0, top + 0.9f, -5.2f}, 0.55f, 0.30f, 1.3f, 32, gold);
    mesh.sphere({0, top + 2.75f, -5.2f}, 0.75f, 32, 20, gold);
    for (const float x : {-2.6f, 2.6f})
    {
        mesh.cylinder({x, top, -3.0f}, 0.10f, 0.22f, 1.1f, 24, gold);
        mesh.sphere({x, top + 1.25f, -3.0f}, {0.16f, 0.2f, 0.16f}, 16, 10, fire);
    }
    scene.lights.push_back(sunLight({-0.55f, -0.72f, -0.42f}, {6.0f, 5.4f, 4.4f}));
    scene.sky = vec3(0.55f, 0.70f, 0.95f);
    mesh.camera("main", {13.5f, 2.6f, 20.5f}, {-0.5f, 4.0f, 0.0f}, 50.0f);
    mesh.camera("colonnade", {5.3f, top + 1.7f, 9.0f}, {5.2f, top + 2.1f, -9.0f}, 60.0f);
    mesh.camera("cella", {2.4f, top + 1.7f, 5.6f}, {-0.3f, top + 1.9f, -5.2f}, 60.0f);
    mesh.camera("door", {0.0f, top + 1.7f, -2.4f}, {0.3f, top + 1.9f, 10.0f}, 65.0f);
    return scene;
}

// A closed hall with floating stairs to a gallery and a corridor around a corner; lit by area emitters only, no sky and no punctual light.
Scene makeHall()
{
    Scene scene;
    scene.name = "hall";
    MeshBuilder mesh(scene);
    const uint32_t concrete = mesh.material("concrete", vec3(0.46f, 0.45f, 0.43f), 0.85f);
    const uint32_t paint = mesh.material("white paint", vec3(0.80f, 0.79f, 0.76f), 0.9f);
    const uint32_t red = mesh.material("red paint", vec3(0.60f, 0.08f, 0.06f), 0.9f);
    const uint32_t floor = mesh.material("polished floor", vec3(0.30f, 0.28f, 0.26f), 0.12f);
    const uint32_t oak = mesh.material("oak", vec3(0.48f, 0.29f, 0.14f), 0.45f);
    const uint32_t steel = mesh.material("steel", vec3(0.62f, 0.63f, 0.65f), 0.2f, 1.0f);
    const uint32_t blue = mesh.material("blue cloth", vec3(0.07f, 0.13f, 0.38f), 0.95f);
    const uint32_t warm = mesh.emitter("warm panel", vec3(14.0f, 10.5f, 6.5f));
    const uint32_t cool = mesh.emitter("cool lamp", vec3(9.0f, 12.0f, 16.0f));
    const uint32_t amber = mesh.emitter("amber lamp", vec3(20.0f, 8.0f, 1.5f));

    // Hall x [0,24], z [0,9], y [0,7]; corridor x [24.3,26.8] along z [-12,9], its far end lies around the corner.
    // Each step wins over those before: rooms are carved from filled blocks, and what stands in the rooms is filled last.
    BlockSolid shell;
    shell.fill({-0.3f, -0.3f, -0.3f}, {24.3f, 7.3f, 9.3f}, paint);
    shell.fill({24.3f, -0.3f, -12.3f}, {27.1f, 3.3f, 9.3f}, red);
    shell.fill({-0.3f, -0.3f, -12.3f}, {27.1f, 0.0f, 9.3f}, floor);
    shell.fill({18.0f, -0.3f, -12.3f}, {24.3f, 3.3f, -7.7f}, concrete); // side room at the corridor's end
    shell.carve({0, 0, 0}, {24, 7, 9});
    shell.carve({24.3f, 0, -12}, {26.8f, 3, 9});
    shell.carve({18.3f, 0, -12}, {24.0f, 3, -8});
    shell.carve({23.9f, 0, -10.6f}, {24.4f, 2.3f, -9.4f});       // door to the side room
    shell.carve({23.9f, 0, 3.4f}, {24.4f, 2.6f, 5.6f});          // opening between hall and corridor
    shell.fill({16.0f, 3.4f, 0}, {24.0f, 3.7f, 3.0f}, concrete); // gallery
    for (const float x : {16.4f, 20.0f, 23.6f}) shell.fill({x - 0.2f, 0, 2.4f}, {x + 0.2f, 3.4f, 2.8f}, concrete);
    shell.addTo(mesh);

    constexpr int kTreads = 20;
    for (int i = 0; i < kTreads; ++i) // floating slabs of 5 cm, held by one steel beam each
    {
        const float x = 9.6f + 0.32f * float(i), y = 0.185f * float(i + 1);
        mesh.box({x, y - 0.05f, 0.6f}, {x + 0.34f, y, 2.4f}, oak);
        mesh.box({x + 0.14f, y - 0.11f, 0.0f}, {x + 0.20f, y - 0.05f, 2.2f}, steel);
        mesh.cylinder({x + 0.17f, y, 2.32f}, 0.012f, 1.0f, 8, steel);
    }
    for (int i = 0; i <= 40; ++i) mesh.cylinder({16.1f + 0.195f * float(i), 3.7f, 2.94f}, 0.012f, 1.0f, 8, steel);
    mesh.box({16.0f, 4.7f, 2.90f}, {24.0f, 4.76f, 2.98f}, oak);

    for (int i = 0; i < 4; ++i)
    {
        const float x = 2.6f + 5.6f * float(i);
        mesh.box({x, 6.6f, 3.6f}, {x + 2.0f, 6.66f, 5.4f}, i == 3 ? cool : warm);
        for (const float cx : {0.1f, 1.9f}) mesh.cylinder({x + cx, 6.66f, 4.5f}, 0.01f, 0.34f, 8, steel);
    }
    for (const float z : {-9.0f, -3.0f, 3.0f}) mesh.box({25.2f, 2.94f, z}, {25.9f, 2.97f, z + 0.5f}, warm);
    mesh.sphere({20.2f, 1.35f, -10.9f}, 0.22f, 24, 16, amber);
    mesh.cylinder({20.2f, 0.0f, -10.9f}, 0.03f, 1.15f, 16, steel);

    for (int i = 0; i < 3; ++i) // benches and pillars in the hall
    {
        const float x = 2.5f + 4.2f * float(i);
        mesh.box({x, 0.40f, 6.6f}, {x + 2.2f, 0.48f, 7.3f}, oak);
        for (const float leg : {0.2f, 1.9f}) mesh.box({x + leg, 0.0f, 6.7f}, {x + leg + 0.1f, 0.40f, 7.2f}, steel);
    }
    for (const float x : {5.0f, 10.0f, 15.0f}) mesh.cylinder({x, 0, 8.3f}, 0.28f, 7.0f, 32, concrete);
    mesh.box({0.02f, 1.2f, 2.2f}, {0.08f, 4.4f, 7.0f}, blue);
    mesh.sphere({4.0f, 0.9f, 2.6f}, 0.9f, 40, 24, steel);
    mesh.box({19.0f, 0.0f, -9.9f}, {20.6f, 0.75f, -9.1f}, oak);
    mesh.boxTurned({22.0f, 0.5f, -11.2f}, {1.0f, 1.0f, 1.0f}, 0.4f, blue);

    mesh.camera("main", {1.6f, 1.7f, 7.9f}, {16.0f, 2.2f, 1.6f}, 60.0f);
    mesh.camera("stairs", {8.2f, 1.5f, 4.9f}, {14.4f, 2.0f, 0.9f}, 60.0f);
    mesh.camera("gallery", {22.6f, 5.3f, 1.5f}, {6.0f, 1.2f, 5.6f}, 65.0f);
    mesh.camera("corridor", {25.6f, 1.6f, 8.2f}, {25.5f, 1.5f, -10.0f}, 60.0f);
    mesh.camera("side room", {23.2f, 1.6f, -8.6f}, {19.6f, 0.9f, -10.8f}, 65.0f);
    return scene;
}

constexpr float kPlain = 200.0f; // metres a side

/// Height of the dunes; flat around the ruin in the middle.
float duneHeight(float x, float z)
{
    const float away = std::clamp((std::sqrt(x * x + z * z) - 12.0f) / 20.0f, 0.0f, 1.0f);
    const float waves =
        1.6f * std::sin(0.071f * x + 0.03f * z) + 0.9f * std::sin(0.043f * x - 0.11f * z + 1.3f) + 0.4f * std::sin(0.19f * (x + z));
    return away * away * (3.0f - 2.0f * away) * (waves + 1.2f);
}

// 200 m of dunes with one small cluttered ruin: open ground, where a viewer may stand anywhere, and a room half without a roof.
Scene makePlain()
{
    Scene scene;
    scene.name = "plain";
    MeshBuilder mesh(scene);
    const uint32_t sand = mesh.material("sand", vec3(0.62f, 0.49f, 0.31f));
    const uint32_t stone = mesh.material("sandstone", vec3(0.66f, 0.56f, 0.42f), 0.9f);
    const uint32_t dark = mesh.material("basalt", vec3(0.12f, 0.12f, 0.13f), 0.35f);
    const uint32_t bronze = mesh.material("bronze", vec3(0.70f, 0.48f, 0.26f), 0.3f, 1.0f);

    constexpr int kCells = 64;
    const auto corner = [](int i, int j)
    {
        const float x = kPlain * (float(i) / kCells - 0.5f), z = kPlain * (float(j) / kCells - 0.5f);
        return vec3(x, duneHeight(x, z), z);
    };
    for (int i = 0; i < kCells; ++i)
        for (int j = 0; j < kCells; ++j)
        {
            mesh.triangle(corner(i, j), corner(i, j + 1), corner(i + 1, j), sand);
            mesh.triangle(corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1), sand);
        }

    BlockSolid walls; // stands a little in the sand, so that no two surfaces coincide
    walls.fill({-6.0f, -0.3f, -5.0f}, {6.0f, 3.4f, 5.0f}, stone);
    walls.carve({-5.5f, -0.4f, -4.5f}, {5.5f, 3.5f, 4.5f});
    walls.carve({-1.0f, -0.4f, 4.4f}, {1.0f, 2.6f, 5.1f}); // the door
    walls.carve({2.5f, 1.6f, 4.4f}, {6.1f, 3.5f, 5.1f});   // fallen corner
    walls.carve({5.4f, 2.1f, -1.0f}, {6.1f, 3.5f, 5.1f});
    walls.carve({-6.1f, 1.2f, 0.5f}, {-5.4f, 2.2f, 1.7f});       // a window
    walls.fill({-5.5f, 3.1f, -4.5f}, {0.5f, 3.4f, 0.0f}, stone); // what is left of the roof
    walls.addTo(mesh);
    for (const vec3 foot : {vec3(-3.0f, -0.1f, 2.4f), vec3(3.2f, -0.1f, 2.4f), vec3(3.2f, -0.1f, -2.6f)})
        mesh.cylinder(foot, 0.34f, 0.28f, foot.z < 0.0f ? 3.0f : 1.9f, 24, stone);
    for (int i = 0; i < 9; ++i) // rubble
    {
        const float turn = 0.7f * float(i), side = 0.25f + 0.05f * float(i % 4);
        mesh.boxTurned({-4.4f + 1.05f * float(i), 0.4f * side, -3.2f + 2.1f * float(i % 3)}, {side, 0.9f * side, 1.4f * side}, turn,
                       i % 3 ? stone : dark);
    }
    mesh.box({-4.6f, -0.1f, -4.0f}, {-2.6f, 0.8f, -3.0f}, dark);
    mesh.sphere({-3.6f, 1.2f, -3.5f}, 0.4f, 32, 20, bronze);

    scene.lights.push_back(sunLight({-0.5f, -0.62f, 0.35f}, {6.0f, 5.4f, 4.5f}));
    scene.sky = vec3(0.45f, 0.62f, 0.95f);
    mesh.camera("main", {15.0f, 2.2f, 18.0f}, {0.0f, 1.2f, 0.0f}, 55.0f);
    mesh.camera("inside", {4.3f, 1.7f, 3.4f}, {-3.4f, 0.9f, -2.6f}, 70.0f);
    mesh.camera("dunes", {-70.0f, duneHeight(-70.0f, 55.0f) + 1.8f, 55.0f}, {0.0f, 2.0f, 0.0f}, 60.0f);
    return scene;
}

} // namespace

std::vector<BuiltinScene> builtinScenes()
{
    return {{"cornell", "2 m box with red and green walls and one area light, all diffuse"},
            {"cornell-glossy", "the same box with glossy floor, walls and boxes (roughness 0.1 to 0.3)"},
            {"temple", "stairs, round columns, tiled glossy floor and a dim inner room, under sun and sky"},
            {"hall", "closed hall with floating stairs, gallery and corridor, lit by area emitters only"},
            {"town", "street, square and furnished two-storey houses, indoors and outdoors"},
            {"plain", "200 m of dunes around one small cluttered ruin, under sun and sky"}};
}

Result<Scene> makeBuiltinScene(std::string_view name)
{
    if (name == "cornell") return makeCornell(false);
    if (name == "cornell-glossy") return makeCornell(true);
    if (name == "temple") return makeTemple();
    if (name == "hall") return makeHall();
    if (name == "town") return makeTown();
    if (name == "plain") return makePlain();
    return Error{ErrorCode::badArgument,
                 fmt::format("There is no built-in scene named '{}'; use one of {}.", name, listed(builtinScenes(), &BuiltinScene::name))};
}

} // namespace sconce
