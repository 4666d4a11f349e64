#include "tests/placement/box_scenes.h"

#include <algorithm>
#include <cmath>

namespace sconce::test
{

Scene emptyScene()
{
    Scene scene;
    scene.name = "test";
    scene.materials.emplace_back();
    return scene;
}

void addQuad(Scene& scene, vec3 corner, vec3 u, vec3 v, uint32_t material)
{
    const uint32_t first = uint32_t(scene.positions.size());
    const vec3 normal = glm::normalize(glm::cross(u, v));
    const vec2 uvs[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const vec3 corners[4] = {corner, corner + u, corner + u + v, corner + v};
    for (int i = 0; i < 4; ++i)
    {
        scene.positions.push_back(corners[i]);
        scene.normals.push_back(normal);
        scene.uvs.push_back(uvs[i]);
    }
    scene.triangles.push_back({first, first + 1, first + 2});
    scene.triangles.push_back({first, first + 2, first + 3});
    scene.triangleMaterial.insert(scene.triangleMaterial.end(), 2, material);
}

namespace
{

void addBox(Scene& scene, vec3 low, vec3 high, bool inward)
{
    const vec3 size = high - low;
    for (int axis = 0; axis < 3; ++axis)
    {
        vec3 u(0.0f), v(0.0f), w(0.0f);
        u[(axis + 1) % 3] = size[(axis + 1) % 3];
        v[(axis + 2) % 3] = size[(axis + 2) % 3];
        w[axis] = size[axis];
        // cross(u, v) points along +axis: into the room at its low side.
        if (inward)
            addQuad(scene, low, u, v), addQuad(scene, low + w, v, u);
        else
            addQuad(scene, low, v, u), addQuad(scene, low + w, u, v);
    }
}

} // namespace

void addRoom(Scene& scene, vec3 low, vec3 high)
{
    addBox(scene, low, high, true);
}
void addCrate(Scene& scene, vec3 low, vec3 high)
{
    addBox(scene, low, high, false);
}

Scene closedRoom(vec3 size)
{
    Scene scene = emptyScene();
    addRoom(scene, vec3(0.0f), size);
    return scene;
}

Scene dividedRoom()
{
    Scene scene = closedRoom({6, 3, 4});
    scene.materials[0].doubleSided = true;
    addQuad(scene, {4, 0, 0}, {0, 3, 0}, {0, 0, 4});
    return scene;
}

Scene furnishedRoom()
{
    Scene scene = closedRoom({6, 3, 4});
    addCrate(scene, {3.0f, 0.0f, 0.0f}, {3.2f, 2.4f, 3.0f});
    addCrate(scene, {1.0f, 0.0f, 1.0f}, {1.8f, 0.8f, 1.9f});
    addCrate(scene, {4.5f, 0.0f, 1.6f}, {4.9f, 3.0f, 2.1f});
    return scene;
}

double bruteDistance(const Scene& scene, vec3 at)
{
    const glm::dvec3 p(at);
    double best = 1e300;
    for (const uvec3& triangle : scene.triangles)
    {
        const glm::dvec3 corner[3] = {glm::dvec3(scene.positions[triangle.x]), glm::dvec3(scene.positions[triangle.y]),
                                      glm::dvec3(scene.positions[triangle.z])};
        const glm::dvec3 normal = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
        const double height = glm::dot(p - corner[0], normal);
        const glm::dvec3 foot = p - height * normal;
        bool within = true;
        for (int i = 0; i < 3; ++i)
        {
            const glm::dvec3 a = corner[i], edge = corner[(i + 1) % 3] - a;
            within = within && glm::dot(glm::cross(edge, foot - a), normal) >= 0.0;
            const double along = std::clamp(glm::dot(p - a, edge) / glm::dot(edge, edge), 0.0, 1.0);
            best = std::min(best, glm::length(p - (a + along * edge)));
        }
        if (within) best = std::min(best, std::abs(height));
    }
    return best;
}

bool bruteBlocked(const Scene& scene, glm::dvec3 from, glm::dvec3 to)
{
    const glm::dvec3 direction = to - from;
    for (const uvec3& triangle : scene.triangles)
    {
        const glm::dvec3 a(scene.positions[triangle.x]);
        const glm::dvec3 e1 = glm::dvec3(scene.positions[triangle.y]) - a, e2 = glm::dvec3(scene.positions[triangle.z]) - a;
        const glm::dvec3 p = glm::cross(direction, e2);
        const double determinant = glm::dot(e1, p);
        if (std::abs(determinant) < 1e-14) continue;
        const glm::dvec3 s = from - a;
        const double u = glm::dot(s, p) / determinant;
        const glm::dvec3 q = glm::cross(s, e1);
        const double v = glm::dot(direction, q) / determinant;
        const double t = glm::dot(e2, q) / determinant;
        if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < 1.0) return true;
    }
    return false;
}

} // namespace sconce::test
