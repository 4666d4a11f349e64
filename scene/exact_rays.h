#pragma once

#include <limits>
#include <optional>

#include "scene/scene.h"

namespace sconce
{

/// Exact questions to the triangles of a scene, whoever answers them: triangle_rays.h does by Embree; a host without that may bring its
/// own. Surfaces are met from both sides; points whose alpha is below their material's cutoff are not there. Safe from many threads.
class ExactRays
{
public:
    struct Hit
    {
        float t = 0.0f;          // in lengths of the direction
        uint32_t triangle = 0;   // index into Scene::triangles
        vec2 barycentrics{0.0f}; // weights of the second and third vertex
    };

    virtual ~ExactRays();
    virtual std::optional<Hit> closest(vec3 origin, vec3 direction, float tFar = std::numeric_limits<float>::infinity()) const = 0;
    virtual bool occluded(vec3 origin, vec3 direction, float tFar) const = 0;
    virtual const Scene& scene() const = 0;

protected: // copied and moved as what it is
    ExactRays() = default;
    ExactRays(const ExactRays&) = default;
    ExactRays& operator=(const ExactRays&) = default;
};

/// Half the gap by which rays must start off a surface, metres: beyond the rounding of any position in the scene.
float rayOffset(const Scene& scene);

} // namespace sconce
