#include "scene/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

namespace sconce
{

uint32_t MeshBuilder::material(std::string name, vec3 baseColor, float roughness, float metallic)
{
    Material m;
    m.name = std::move(name);
    m.baseColor = vec4(baseColor, 1.0f);
    m.roughness = roughness;
    m.metallic = metallic;
    scene.materials.push_back(std::move(m));
    return uint32_t(scene.materials.size() - 1);
}

uint32_t MeshBuilder::emitter(std::string name, vec3 radiance)
{
    const uint32_t index = material(std::move(name), vec3(0.0f));
    scene.materials[index].emission = radiance;
    return index;
}

uint32_t MeshBuilder::vertex(vec3 position, vec3 normal, vec2 uv)
{
    scene.positions.push_back(vec3(place * vec4(position, 1.0f)));
    scene.normals.push_back(glm::normalize(mat3(place) * normal));
    scene.uvs.push_back(uv);
    return uint32_t(scene.positions.size() - 1);
}

void MeshBuilder::addTriangle(uint32_t a, uint32_t b, uint32_t c, uint32_t material)
{
    scene.triangles.push_back({a, b, c});
    scene.triangleMaterial.push_back(material);
}

void MeshBuilder::quad(vec3 a, vec3 b, vec3 c, vec3 d, uint32_t material, uint32_t cellsU, uint32_t cellsV)
{
    const vec3 normal = glm::normalize(glm::cross(b - a, d - a));
    const vec2 size(glm::length(b - a), glm::length(d - a));
    const uint32_t first = uint32_t(scene.positions.size());
    for (uint32_t j = 0; j <= cellsV; ++j)
        for (uint32_t i = 0; i <= cellsU; ++i)
        {
            const vec2 at(float(i) / float(cellsU), float(j) / float(cellsV));
            vertex(glm::mix(glm::mix(a, b, at.x), glm::mix(d, c, at.x), at.y), normal, at * size);
        }
    for (uint32_t j = 0; j < cellsV; ++j)
        for (uint32_t i = 0; i < cellsU; ++i)
        {
            const uint32_t corner = first + j * (cellsU + 1) + i;
            addTriangle(corner, corner + 1, corner + cellsU + 2, material);
            addTriangle(corner, corner + cellsU + 2, corner + cellsU + 1, material);
        }
}

void MeshBuilder::triangle(vec3 a, vec3 b, vec3 c, uint32_t material)
{
    const vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    const uint32_t first = vertex(a, normal, vec2(0.0f));
    vertex(b, normal, vec2(glm::length(b - a), 0.0f));
    vertex(c, normal, vec2(0.0f, glm::length(c - a)));
    addTriangle(first, first + 1, first + 2, material);
}

void MeshBuilder::box(vec3 low, vec3 high, uint32_t material)
{
    const auto p = [&](int x, int y, int z) { return vec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z); };
    quad(p(1, 0, 1), p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), material); // +x
    quad(p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0), material); // -x
    quad(p(0, 1, 1), p(1, 1, 1), p(1, 1, 0), p(0, 1, 0), material); // +y
    quad(p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1), material); // -y
    quad(p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1), material); // +z
    quad(p(1, 0, 0), p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), material); // -z
}

void MeshBuilder::boxTurned(vec3 centre, vec3 size, float aboutY, uint32_t material)
{
    const mat4 before = place;
    place = glm::rotate(glm::translate(place, centre), aboutY, vec3(0.0f, 1.0f, 0.0f));
    box(-0.5f * size, 0.5f * size, material);
    place = before;
}

void MeshBuilder::cylinder(vec3 base, float bottomRadius, float topRadius, float height, uint32_t segments, uint32_t material)
{
    const vec3 top = base + vec3(0.0f, height, 0.0f);
    const float slope = (bottomRadius - topRadius) / height;
    const auto around = [&](uint32_t i)
    {
        const float angle = 2.0f * std::numbers::pi_v<float> * float(i % segments) / float(segments); // % closes the seam exactly
        return vec3(std::cos(angle), 0.0f, -std::sin(angle));
    };
    const uint32_t side = uint32_t(scene.positions.size());
    for (uint32_t i = 0; i <= segments; ++i)
    {
        const vec3 out = around(i);
        const float u = 2.0f * std::numbers::pi_v<float> * bottomRadius * float(i) / float(segments);
        const vec3 normal = glm::normalize(out + vec3(0.0f, slope, 0.0f));
        vertex(base + bottomRadius * out, normal, vec2(u, 0.0f));
        vertex(top + topRadius * out, normal, vec2(u, height));
    }
    for (uint32_t i = 0; i < segments; ++i)
    {
        const uint32_t corner = side + 2 * i;
        addTriangle(corner, corner + 2, corner + 3, material);
        addTriangle(corner, corner + 3, corner + 1, material);
    }
    for (const bool up : {false, true})
    {
        const vec3 normal(0.0f, up ? 1.0f : -1.0f, 0.0f);
        const vec3 middle = up ? top : base;
        const float radius = up ? topRadius : bottomRadius;
        const uint32_t centre = vertex(middle, normal, vec2(0.0f));
        for (uint32_t i = 0; i < segments; ++i)
        {
            const vec3 out = radius * around(i);
            vertex(middle + out, normal, vec2(out.x, out.z));
        }
        for (uint32_t i = 0; i < segments; ++i)
        {
            const uint32_t here = centre + 1 + i, next = centre + 1 + (i + 1) % segments;
            up ? addTriangle(centre, here, next, material) : addTriangle(centre, next, here, material);
        }
    }
}

void MeshBuilder::sphere(vec3 centre, vec3 radii, uint32_t segments, uint32_t rings, uint32_t material)
{
    constexpr float pi = std::numbers::pi_v<float>;
    const uint32_t first = uint32_t(scene.positions.size());
    for (uint32_t j = 0; j <= rings; ++j)
        for (uint32_t i = 0; i <= segments; ++i)
        {
            const float theta = pi * float(j) / float(rings), phi = 2.0f * pi * float(i % segments) / float(segments);
            const float ring = j == 0 || j == rings ? 0.0f : std::sin(theta); // sin(pi) isn't 0 in single precision; the pole is one point
            const vec3 out(ring * std::cos(phi), std::cos(theta), -ring * std::sin(phi));
            vertex(centre + radii * out, out / radii, vec2(float(i) / float(segments), float(j) / float(rings)));
        }
    for (uint32_t j = 0; j < rings; ++j)
        for (uint32_t i = 0; i < segments; ++i)
        {
            const uint32_t upper = first + j * (segments + 1) + i, lower = upper + segments + 1;
            if (j != 0) addTriangle(upper, lower + 1, upper + 1, material);
            if (j + 1 != rings) addTriangle(upper, lower, lower + 1, material);
        }
}

void MeshBuilder::gable(vec3 low, vec3 high, uint32_t roof, uint32_t ends)
{
    const float middle = 0.5f * (low.z + high.z);
    const vec3 a(low.x, low.y, low.z), b(high.x, low.y, low.z), c(high.x, low.y, high.z), d(low.x, low.y, high.z);
    const vec3 ridgeLow(low.x, high.y, middle), ridgeHigh(high.x, high.y, middle);
    quad(d, c, ridgeHigh, ridgeLow, roof);
    quad(b, a, ridgeLow, ridgeHigh, roof);
    quad(a, b, c, d, ends);
    triangle(a, d, ridgeLow, ends);
    triangle(c, b, ridgeHigh, ends);
}

void MeshBuilder::camera(std::string name, vec3 eye, vec3 target, float verticalFovDegrees)
{
    Camera view;
    view.name = std::move(name);
    view.eye = vec3(place * vec4(eye, 1.0f));
    view.forward = glm::normalize(mat3(place) * (target - eye));
    const vec3 right = glm::normalize(glm::cross(view.forward, vec3(0.0f, 1.0f, 0.0f)));
    view.up = glm::normalize(glm::cross(right, view.forward));
    view.verticalFov = glm::radians(verticalFovDegrees);
    scene.cameras.push_back(std::move(view));
}

void BlockSolid::addTo(MeshBuilder& mesh) const
{
    std::vector<float> cuts[3];
    for (int axis = 0; axis < 3; ++axis)
    {
        for (const Step& step : steps) cuts[axis].insert(cuts[axis].end(), {step.low[axis], step.high[axis]});
        std::sort(cuts[axis].begin(), cuts[axis].end());
        // Cuts closer than 0.1 mm are the same plane written twice with different rounding.
        const auto same = [](float a, float b) { return b - a < 1e-4f; };
        cuts[axis].erase(std::unique(cuts[axis].begin(), cuts[axis].end(), same), cuts[axis].end());
    }
    const glm::ivec3 cells(int(cuts[0].size()) - 1, int(cuts[1].size()) - 1, int(cuts[2].size()) - 1);
    if (cells.x <= 0 || cells.y <= 0 || cells.z <= 0) return;
    const auto corner = [&](int x, int y, int z) { return vec3(cuts[0][size_t(x)], cuts[1][size_t(y)], cuts[2][size_t(z)]); };

    std::vector<int64_t> owner(size_t(cells.x) * size_t(cells.y) * size_t(cells.z), kEmpty);
    const auto index = [&](int x, int y, int z) { return (size_t(z) * size_t(cells.y) + size_t(y)) * size_t(cells.x) + size_t(x); };
    const auto at = [&](int x, int y, int z)
    {
        const bool inside = x >= 0 && y >= 0 && z >= 0 && x < cells.x && y < cells.y && z < cells.z;
        return inside ? owner[index(x, y, z)] : kEmpty;
    };
    for (int z = 0; z < cells.z; ++z)
        for (int y = 0; y < cells.y; ++y)
            for (int x = 0; x < cells.x; ++x)
            {
                // A cell lies wholly in or out of each step, since the planes of all steps are cuts: its middle decides. Later steps win,
                // so that a carve undoes what was filled before it.
                const vec3 middle = 0.5f * (corner(x, y, z) + corner(x + 1, y + 1, z + 1));
                for (const Step& step : steps)
                    if (glm::all(glm::lessThan(step.low, middle)) && glm::all(glm::lessThan(middle, step.high)))
                        owner[index(x, y, z)] = step.material;
            }

    for (int z = 0; z < cells.z; ++z)
        for (int y = 0; y < cells.y; ++y)
            for (int x = 0; x < cells.x; ++x)
            {
                // Faces between two solid cells are left out: nothing sees them.
                const int64_t solid = at(x, y, z);
                if (solid == kEmpty) continue;
                const auto m = uint32_t(solid);
                const auto p = [&](int i, int j, int k) { return corner(x + i, y + j, z + k); };
                if (at(x + 1, y, z) == kEmpty) mesh.quad(p(1, 0, 1), p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), m);
                if (at(x - 1, y, z) == kEmpty) mesh.quad(p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0), m);
                if (at(x, y + 1, z) == kEmpty) mesh.quad(p(0, 1, 1), p(1, 1, 1), p(1, 1, 0), p(0, 1, 0), m);
                if (at(x, y - 1, z) == kEmpty) mesh.quad(p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1), m);
                if (at(x, y, z + 1) == kEmpty) mesh.quad(p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1), m);
                if (at(x, y, z - 1) == kEmpty) mesh.quad(p(1, 0, 0), p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), m);
            }
}

} // namespace sconce
