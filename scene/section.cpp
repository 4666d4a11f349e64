#include "scene/section.h"

namespace sconce
{

std::vector<std::array<vec3, 2>> sectionOf(const Scene& scene, vec3 point, vec3 normal)
{
    std::vector<std::array<vec3, 2>> pieces;
    for (const uvec3& triangle : scene.triangles)
    {
        std::array<vec3, 2> ends;
        size_t found = 0;
        for (int i = 0; i < 3 && found < 2; ++i)
        {
            const vec3 a = scene.positions[triangle[i]], b = scene.positions[triangle[(i + 1) % 3]];
            const float before = glm::dot(a - point, normal), after = glm::dot(b - point, normal);
            // Half open, so that a corner exactly in the plane cuts two of the edges or none, and never one.
            if ((before < 0.0f) != (after < 0.0f)) ends[found++] = glm::mix(a, b, before / (before - after));
        }
        if (found == 2) pieces.push_back(ends);
    }
    return pieces;
}

} // namespace sconce
