#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace sconce
{

/// Adds simple shapes to a scene: flat or smooth unit normals that agree with the winding, uvs in metres along each face. Every point
/// goes through `place` first, so furniture is written around its own origin. Used by the built-in scenes and by tests.
class MeshBuilder
{
public:
    explicit MeshBuilder(Scene& target) : scene(target) {}

    mat4 place{1.0f}; // rigid, no scale: normals go through its upper 3x3

    uint32_t material(std::string name, vec3 baseColor, float roughness = 1.0f, float metallic = 0.0f);
    uint32_t emitter(std::string name, vec3 radiance); // black, so that it only gives light

    /// Corners counter-clockwise as seen from the front; cut into cellsU x cellsV equal parts, U from a to b.
    void quad(vec3 a, vec3 b, vec3 c, vec3 d, uint32_t material, uint32_t cellsU = 1, uint32_t cellsV = 1);
    void triangle(vec3 a, vec3 b, vec3 c, uint32_t material);
    void box(vec3 low, vec3 high, uint32_t material);
    void boxTurned(vec3 centre, vec3 size, float aboutY, uint32_t material); // radians
    /// Upright cone frustum; equal radii make a cylinder. Both ends are closed.
    void cylinder(vec3 base, float bottomRadius, float topRadius, float height, uint32_t segments, uint32_t material);
    void cylinder(vec3 base, float radius, float height, uint32_t segments, uint32_t m)
    {
        cylinder(base, radius, radius, height, segments, m);
    }
    void sphere(vec3 centre, vec3 radii, uint32_t segments, uint32_t rings, uint32_t material);
    void sphere(vec3 centre, float radius, uint32_t segments, uint32_t rings, uint32_t m)
    {
        sphere(centre, vec3(radius), segments, rings, m);
    }
    /// Solid triangular prism along x: base low..high at low.y, ridge at high.y above the middle of z; a gable roof.
    void gable(vec3 low, vec3 high, uint32_t roof, uint32_t ends);

    void camera(std::string name, vec3 eye, vec3 target, float verticalFovDegrees); // through `place`, too

private:
    uint32_t vertex(vec3 position, vec3 normal, vec2 uv);
    void addTriangle(uint32_t a, uint32_t b, uint32_t c, uint32_t material);

    Scene& scene;
};

/// A solid made of axis-aligned boxes that are filled and carved in turn, the later one winning: walls of real thickness with doors and
/// windows. Only faces between solid and empty become triangles, all on one common grid: the surface is closed, without hidden inner
/// faces and without T-junctions.
class BlockSolid
{
public:
    void fill(vec3 low, vec3 high, uint32_t material) { steps.push_back({low, high, int64_t(material)}); }
    void carve(vec3 low, vec3 high) { steps.push_back({low, high, kEmpty}); }
    void addTo(MeshBuilder& mesh) const;

private:
    static constexpr int64_t kEmpty = -1;
    struct Step
    {
        vec3 low, high;
        int64_t material;
    };
    std::vector<Step> steps;
};

} // namespace sconce
