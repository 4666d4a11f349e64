#include "tests/properties/hard_cases/hard_scenes.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"
#include "scene/scene_gltf.h"
#include "tests/support/files.h"

namespace sconce::testing_support
{
namespace
{

std::vector<vec3> probesSeenFrom(const RayScene& rays, uint32_t perCamera)
{
    const float diagonal = rays.scene().bounds().diagonal();
    std::vector<vec3> probes;
    for (const Camera& camera : rays.scene().cameras)
        for (uint32_t i = 0; i < perCamera; ++i)
        {
            Random random(5, probes.size(), i);
            const vec3 d = unitVector(random);
            const auto hit = rays.closest(camera.eye, d);
            const float reach = hit ? hit->t : 0.1f * diagonal;
            probes.push_back(camera.eye + 0.5f * std::min(reach, 0.2f * diagonal) * d);
        }
    return probes;
}

} // namespace

HardScene::HardScene(Scene made, std::span<const vec3> probes, uint32_t faceSize, int voxels)
    : scene(std::move(made)), rays(std::move(*RayScene::create(scene))), field(fieldByRays(rays, probes, faceSize, {.voxels = voxels}))
{
}

HardScene::HardScene(Scene made, uint32_t probesPerCamera)
    : scene(std::move(made)), rays(std::move(*RayScene::create(scene))),
      field(fieldByRays(rays, probesSeenFrom(rays, probesPerCamera), 64, {.voxels = 32}))
{
}

Scene closedBox(float scale, vec3 centre)
{
    Scene scene;
    scene.name = "box";
    MeshBuilder mesh(scene);
    mesh.box(centre - scale * kBoxHalf, centre + scale * kBoxHalf, mesh.material("wall", vec3(0.5f)));
    return scene;
}

Scene curtains()
{
    Scene scene;
    scene.name = "curtains";
    MeshBuilder mesh(scene);
    const uint32_t cloth = mesh.material("cloth", vec3(0.5f));
    mesh.box({0, 0, 0}, {4, 3, 4}, cloth);
    for (const float x : {1.0f, 2.0f, 3.0f})
    {
        const auto at = [&](int i, float y)
        {
            const float z = 0.5f + 3.0f * float(i) / float(kCurtainStrips);
            return vec3(x + 0.12f * std::sin(9.0f * z + 4.0f * x), y, z);
        };
        for (int i = 0; i < kCurtainStrips; ++i) mesh.quad(at(i, 0.0f), at(i + 1, 0.0f), at(i + 1, 2.6f), at(i, 2.6f), cloth);
    }
    mesh.camera("a", {0.4f, 1.5f, 2.0f}, {2.0f, 1.4f, 2.1f}, 70.0f);
    mesh.camera("b", {1.5f, 1.2f, 1.8f}, {2.0f, 1.4f, 3.1f}, 70.0f);
    mesh.camera("c", {2.5f, 1.2f, 1.8f}, {2.0f, 1.4f, 0.9f}, 70.0f);
    mesh.camera("d", {3.6f, 1.6f, 2.2f}, {2.0f, 1.4f, 2.0f}, 70.0f);
    return scene;
}

std::optional<Scene> sponza()
{
    const auto file = testing_support::scenesFolder() / "sponza" / "Sponza.gltf";
    if (!std::filesystem::exists(file)) return std::nullopt;
    auto scene = loadGltf(file);
    if (!scene) throw std::runtime_error(scene.error().message);
    return std::move(*scene);
}

std::unique_ptr<HardScene> hardScene(const std::string& name)
{
    if (name == "curtains")
    {
        std::vector<vec3> probes; // six in each of the four bays
        for (const float x : {0.45f, 1.5f, 2.5f, 3.55f})
            for (const float y : {0.8f, 2.0f})
                for (const float z : {0.8f, 2.05f, 3.2f}) probes.emplace_back(x, y, z);
        return std::make_unique<HardScene>(curtains(), probes, 128u);
    }
    if (name != "sponza") return std::make_unique<HardScene>(*makeBuiltinScene(name), name == "cornell" ? 8u : 5u);
    auto scene = sponza();
    return scene ? std::make_unique<HardScene>(std::move(*scene), 12u) : nullptr;
}

RaySet glossyRaysOf(const HardScene& scene, uint32_t count)
{
    return *glossyRays(scene.rays, scene.scene.cameras, {}, {.count = count, .alphaLow = 0.1f, .alphaHigh = 0.3f, .seed = 3});
}

vec3 unitVector(Random& random)
{
    const float z = 2.0f * random.uniform() - 1.0f, turn = 6.2831853f * random.uniform(), r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return glm::normalize(vec3(r * std::cos(turn), r * std::sin(turn), z));
}

vec3 pointIn(Random& random, vec3 low, vec3 high)
{
    const float x = random.uniform(), y = random.uniform(), z = random.uniform();
    return low + (high - low) * vec3(x, y, z);
}

double boxExit(glm::dvec3 origin, glm::dvec3 direction, glm::dvec3 half)
{
    double t = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a)
        if (direction[a] != 0.0) t = std::min(t, ((direction[a] > 0.0 ? half[a] : -half[a]) - origin[a]) / direction[a]);
    return t;
}

} // namespace sconce::testing_support
