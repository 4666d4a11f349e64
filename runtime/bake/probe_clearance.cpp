#include "runtime/bake/probe_clearance.h"

#include <algorithm>
#include <numeric>

#include "scene/closest_point.h"

namespace sconce
{

namespace
{

constexpr int kPasses = 16; // a corner needs one for each of its walls

/// Moves the probe off the triangle when it is nearer than the clearance; whether it was.
bool moveOff(const Scene& scene, uint32_t triangle, float clearance, vec3& probe)
{
    const uvec3& corner = scene.triangles[triangle];
    const vec3 nearest = closestPointOnTriangle(probe, scene.positions[corner.x], scene.positions[corner.y], scene.positions[corner.z]);
    const vec3 away = probe - nearest;
    const float distance = glm::length(away);
    if (!(distance < 0.99f * clearance)) return false;
    probe = nearest + clearance * (distance > 1e-3f * clearance ? away / distance : geometricNormal(scene, triangle));
    return true;
}

} // namespace

ClearedProbes clearedOfSurfaces(const Scene& scene, std::span<const vec3> probes, float clearance)
{
    ClearedProbes cleared{{probes.begin(), probes.end()}};
    std::vector<uint32_t> order(probes.size()); // by x: a triangle looks at a slab of them
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return probes[a].x != probes[b].x ? probes[a].x < probes[b].x : a < b; });
    const float reach = float(kPasses + 1) * clearance; // a probe may have gone a clearance a pass from where it was sorted
    std::vector<uint8_t> touched(probes.size(), 0);
    bool again = true;
    for (int pass = 0; pass < kPasses && again; ++pass)
    {
        again = false;
        for (uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle)
        {
            const uvec3& corner = scene.triangles[triangle];
            const vec3 a = scene.positions[corner.x], b = scene.positions[corner.y], c = scene.positions[corner.z];
            const vec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
            auto at = std::lower_bound(order.begin(), order.end(), low.x - reach, [&](uint32_t i, float x) { return probes[i].x < x; });
            for (; at != order.end() && probes[*at].x <= high.x + reach; ++at)
            {
                vec3& probe = cleared.positions[*at];
                if (glm::any(glm::lessThan(probe, low - clearance)) || glm::any(glm::greaterThan(probe, high + clearance))) continue;
                if (!moveOff(scene, triangle, clearance, probe)) continue;
                touched[*at] = pass + 1 == kPasses ? 2 : 1;
                again = true;
            }
        }
    }
    for (const uint8_t mark : touched)
    {
        cleared.moved += mark > 0;
        cleared.tight += mark > 1;
    }
    return cleared;
}

} // namespace sconce
