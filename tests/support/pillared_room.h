#pragma once

#include <random>
#include <vector>

#include "bench/race/ray_sets.h"
#include "scene/mesh_builder.h"
#include "tests/support/field_by_rays.h"

namespace sconce::testing_support
{

/// A closed room of 8 x 3 x 8 m with nine pillars, a wall and two slabs of 5 cm, and cosine-distributed rays from its surfaces: the kind of
/// scene that the published figures of McGuire's tracer were re-measured on (tests/bench/opponents/baselines_test.cpp).
class PillaredRoom
{
public:
    PillaredRoom()
    {
        MeshBuilder mesh(scene);
        const uint32_t wall = mesh.material("wall", vec3(0.5f));
        mesh.box(kLow, kHigh, wall);
        for (int x = 1; x <= 3; ++x)
            for (int z = 1; z <= 3; ++z)
                solids.push_back({{2.0f * x - 0.2f, 0.0f, 2.0f * z - 0.2f}, {2.0f * x + 0.2f, 3.0f, 2.0f * z + 0.2f}});
        solids.push_back({{4.2f, 0.0f, 4.6f}, {5.8f, 2.2f, 4.65f}}); // wall
        solids.push_back({{0.4f, 0.9f, 2.5f}, {1.8f, 0.95f, 3.5f}}); // slabs
        solids.push_back({{6.3f, 1.6f, 5.0f}, {7.6f, 1.65f, 6.4f}});
        for (const Solid& solid : solids) mesh.box(solid.low, solid.high, wall);
    }

    /// @return rays with the truth of `rays`, which must be of this scene
    RaySet cosineRays(const RayScene& rays, size_t count) const
    {
        std::mt19937 random(11);
        std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
        std::vector<Solid> boxes = solids;
        boxes.push_back({kLow, kHigh});
        std::vector<double> areas; // of the six faces of each box
        for (const Solid& box : boxes)
            for (int face = 0; face < 6; ++face)
            {
                const vec3 size = box.high - box.low;
                areas.push_back(size[(face / 2 + 1) % 3] * size[(face / 2 + 2) % 3]);
            }
        std::discrete_distribution<size_t> pick(areas.begin(), areas.end());
        std::vector<vec3> origins, directions, normals;
        while (origins.size() < count)
        {
            const size_t index = pick(random), axis = index % 6 / 2;
            const Solid& box = boxes[index / 6];
            const bool room = index / 6 == solids.size();
            vec3 point = box.low + (box.high - box.low) * vec3(uniform(random), uniform(random), uniform(random));
            point[int(axis)] = (index & 1) ? box.low[int(axis)] : box.high[int(axis)];
            vec3 normal(0.0f);
            normal[int(axis)] = ((index & 1) != 0) == room ? 1.0f : -1.0f;
            const vec3 origin = point + 1e-4f * normal;
            const float z = std::sqrt(uniform(random)), turn = 6.2831853f * uniform(random), r = std::sqrt(1.0f - z * z);
            vec3 direction(0.0f);
            direction[int(axis)] = z * normal[int(axis)];
            direction[int(axis + 1) % 3] = r * std::cos(turn);
            direction[int(axis + 2) % 3] = r * std::sin(turn);
            if (!free(origin)) continue;
            origins.push_back(origin);
            normals.push_back(normal);
            directions.push_back(glm::normalize(direction));
        }
        RaySet set = raySetFrom(rays, origins, directions);
        set.normals = normals;
        return set;
    }

    /// 4 x 2 x 4 probes, `size` texels a side.
    FieldData grid(const RayScene& rays, uint32_t size) const
    {
        return gridByRays(rays, {4, 2, 4}, {1.0f, 0.75f, 1.0f}, {2.0f, 1.5f, 2.0f}, size);
    }

    Scene scene;

private:
    struct Solid
    {
        vec3 low, high;
    };
    static constexpr vec3 kLow{0.0f}, kHigh{8.0f, 3.0f, 8.0f};
    bool free(vec3 p) const
    {
        if (glm::any(glm::lessThan(p, kLow)) || glm::any(glm::greaterThan(p, kHigh))) return false;
        for (const Solid& solid : solids)
            if (glm::all(glm::greaterThan(p, solid.low)) && glm::all(glm::lessThan(p, solid.high))) return false;
        return true;
    }
    std::vector<Solid> solids;
};

} // namespace sconce::testing_support
