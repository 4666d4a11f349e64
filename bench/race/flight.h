#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/field/field_data.h"
#include "scene/scene.h"

namespace sconce
{

/// A way through a light field's probes, from the first on always to the nearest that is left, and back: in the open, as probes are.
class Flight
{
public:
    explicit Flight(const FieldData& field)
    {
        for (const gpu::ProbeHeader& probe : field.probes) way.push_back(field.info.origin + field.info.scale * probe.centre);
        for (size_t i = 0; i + 1 < way.size(); ++i)
        {
            const auto nearest = std::min_element(way.begin() + std::ptrdiff_t(i) + 1, way.end(),
                                                  [&](vec3 a, vec3 b) { return glm::distance(a, way[i]) < glm::distance(b, way[i]); });
            std::swap(way[i + 1], *nearest);
            length += glm::distance(way[i], way[i + 1]);
        }
    }

    /// So many metres from the start, looking ahead.
    Camera at(float along) const
    {
        Camera camera;
        camera.eye = place(along);
        const vec3 ahead = place(along + kLookAhead) - camera.eye;
        const bool level = glm::length(ahead) > 1e-3f && std::abs(ahead.y) < 0.99f * glm::length(ahead); // else up would be along it
        camera.forward = glm::normalize(level ? ahead : vec3(1.0f, 0.0f, 0.1f));
        return camera;
    }

private:
    static constexpr float kLookAhead = 3.0f; // metres

    vec3 place(float along) const
    {
        along = length > 0.0f ? std::fmod(along, 2.0f * length) : 0.0f;
        if (along > length) along = 2.0f * length - along;
        for (size_t i = 1; i < way.size(); ++i)
        {
            const float piece = glm::distance(way[i - 1], way[i]);
            if (along <= piece && piece > 0.0f) return glm::mix(way[i - 1], way[i], along / piece);
            along -= piece;
        }
        return way.back();
    }

    std::vector<vec3> way;
    float length = 0.0f; // metres
};

} // namespace sconce
