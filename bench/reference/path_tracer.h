#pragma once

#include <optional>

#include "base/random.h"
#include "bench/reference/emitters.h"
#include "bench/reference/ray_scene.h"
#include "shaders/shared/brdf.h"

namespace sconce
{

/// A hit seen from one side, ready to scatter.
struct ShadingPoint
{
    vec3 position{0.0f};
    vec3 geometricNormal{0.0f}; // on the viewer's side
    vec3 normal{0.0f};          // shading normal, on the viewer's side
    BrdfSurface surface{};
    BrdfLobes lobes{}; // of the surface, to the viewer
    vec3 viewer{0.0f}; // unit: viewerOfLobes()
    vec3 emission{0.0f};
};

/// What one path brings to its pixel, by how the first hit passed it on.
struct PathLight
{
    vec3 direct{0.0f};
    vec3 diffuse{0.0f};
    vec3 glossy{0.0f};
};

/// PathTracer's bounceCount of paths that scatter once.
inline constexpr uint32_t kStraight = ~0u;

class PathTracer
{
public:
    PathTracer(const RayScene& scene, std::optional<float> roughnessOverride, uint32_t bounceCount);

    ShadingPoint shade(const SurfaceHit& hit, vec3 view) const;
    /// @param textured  of the ray by which the first hit is textured, see RayScene::texturedBy; unit
    PathLight trace(vec3 origin, vec3 direction, vec3 textured, Random& random) const;
    PathLight trace(vec3 origin, vec3 direction, Random& random) const { return trace(origin, direction, direction, random); }

    struct Scatter // a sampled direction with both lobes' brdf * cosine / density
    {
        vec3 direction{0.0f};
        vec3 diffuse{0.0f};
        vec3 specular{0.0f};
        float pdf = 0.0f; // over solid angle; 0 for the mirror's delta
    };
    std::optional<Scatter> scatter(const ShadingPoint& point, Random& random) const;

private:
    float scatterPdf(const ShadingPoint& point, vec3 light) const;
    BrdfValue reflect(const ShadingPoint& point, vec3 light) const; // brdf * cosine
    vec3 punctual(const ShadingPoint& point, const Light& light) const;
    BrdfValue emitterLight(const ShadingPoint& point, Random& random) const;
    vec3 start(const ShadingPoint& point) const { return point.position + point.geometricNormal * rays.offset(); }

    const RayScene& rays;
    const Scene& scene;
    Emitters emitters;
    std::optional<float> roughness;
    uint32_t bounces;
};

} // namespace sconce
