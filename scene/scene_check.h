#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "shaders/shared/frame.h"

namespace sconce
{

enum class Severity : uint32_t
{
    info,
    warning,
    error
};

struct Finding
{
    std::string code; // stable, for scripts: open-edges, degenerate, duplicates, no-light, empty, invalid, ...
    Severity severity = Severity::info;
    std::string sentence; // with the remedy
};

/// One lighting phenomenon and whether the scene calls for it; what isn't called for costs nothing later (EffectPlan).
struct SceneEffect
{
    std::string name; // sun, punctual, emitters, sky, diffuse, rough, glossy, mirror, masked, thin-two-sided
    bool called = false;
    std::string why; // a sentence
};

/// Share of open edges beyond which inside and outside can't be told by winding.
inline constexpr double kMostOpenEdges = 0.25;

struct SceneReport
{
    uint64_t triangles = 0, vertices = 0, materials = 0, textures = 0, textureBytes = 0;
    uint64_t directionalLights = 0, pointLights = 0, spotLights = 0, cameras = 0;
    uint64_t emissiveTriangles = 0;
    double emissiveArea = 0.0; // m^2
    double area = 0.0;         // m^2, all triangles
    // Materials that some triangle uses. A material may be rough, glossy and a mirror at once: textured roughness is
    // judged by its smoothest and its roughest texel.
    uint64_t usedMaterials = 0, roughMaterials = 0, glossyMaterials = 0, mirrorMaterials = 0, metalMaterials = 0, maskedMaterials = 0,
             doubleSidedMaterials = 0;
    uint64_t edges = 0, openEdges = 0; // after welding equal positions; open: one triangle only
    double openEdgeShare = 0.0;        // of edges, [0,1]
    uint64_t degenerateTriangles = 0, duplicateTriangles = 0;
    Bounds bounds;
    std::vector<Finding> findings;
    std::vector<SceneEffect> effects;
};

/// What is in a scene, what is wrong with it, and which effects it calls for and why. Also for scenes that validate() refuses: then only
/// the counts of the arrays and the finding `invalid` are filled. Cost: O(n log n) of the triangles.
/// @param raysBelow  roughness below which reflections are traced; gpu::FrameView::raysBelow
SceneReport checkScene(const Scene& scene, float raysBelow = gpu::kRaysBelow);

} // namespace sconce
