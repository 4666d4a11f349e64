#pragma once

#include <array>
#include <span>
#include <vector>

#include "runtime/bake/emitter_patches.h"
#include "runtime/field/field_data.h"
#include "runtime/scene/lights.h"
#include "scene/closed_parts.h"
#include "scene/exact_rays.h"
#include "shaders/shared/bake_passes.h"

namespace sconce
{

/// Gathers light at the texels and cells of surface light by rays to the scene's triangles, on all cores: what surface_gather.comp and
/// cell_gather.comp find by rays through the light field, by the same text (shaders/shared/surface_gather.h) and numbers, but exact, so
/// that no light comes through a wall and no shadow lacks. Where a surface reflects specularly, a ray goes on by that lobe as often as the
/// lobe has a share in what is reflected, and ends where it is scattered: glossy floors throw light on. Refers to all that it is made from.
class TriangleGather
{
public:
    struct Desc
    {
        uint32_t rays = 0;       // a texel
        uint32_t shadowRays = 0; // a texel, to emitters; at most gpu::kMostShadowRays
    };
    /// @param field   with distances, octree and surfaceSize
    /// @param texels  of all probes
    TriangleGather(const ExactRays& triangles, const FieldData& field, std::span<const gpu::SurfaceTexel> texels, const LightList& lights,
                   const Desc& desc);

    /// What a probe's texels are gathered into, [6 surfaceSize^2] each.
    struct Target
    {
        std::span<uint32_t> links; // [ray][texel]: gpu::kLinkSky and its like, or another texel
        std::span<vec4> first;     // SurfacePush::first, light, tilts
        std::span<vec4> light;
        std::span<uint32_t> reflected; // SurfacePush::reflected, of the probe's texels
        std::span<vec4> tilts;         // empty: not asked for
        // Becomes what a ray that ends there brings: it reflects by its diffuse lobe alone, as rays that meet the others go on; but the
        // light of what has no extent it reflects by all its lobes as if they were diffuse.
        std::span<gpu::SurfaceTexel> sending;
        std::span<uint32_t> direct; // RGB9E5: what it sends of light of no extent over what arrives; empty: not asked for
    };
    void gather(uint32_t probe, const Target& target) const;
    /// Radiance that each texel sends, RGB9E5: to rays that end there at once, and, of bounces earlier, to those that were reflected so
    /// often.
    using Sent = std::array<std::vector<uint32_t>, gpu::kReflectionsCounted + 1>;
    /// Colours that links name, of luminance 1, and of how many reflections: at most gpu::kTints, the first white and of none.
    const std::vector<vec4>& tints() const { return palette; }

    /// Of the cells' facings, [cell][6].
    struct Cells
    {
        std::vector<uint32_t> places; // a cell's, with gpu::kCellKnown where it has one
        std::vector<uint32_t> links;  // [facing][ray]
        std::vector<vec3> straight;   // radiance from emitters and sky; negative: too little is known
    };
    Cells gatherCells() const;
    /// @param words  of the cells as FieldData::surfaceLight has them
    void lightCells(const Cells& cells, const Sent& sent, std::span<uint32_t> words) const;

    /// Light at one place, as `gather` finds it at a texel's.
    struct Point
    {
        vec3 straight{0.0f}, bounced{0.0f}; // from emitters and sky; all else
        float variance = 0.0f;              // of the luminance of `straight`, by chance
        float room = 0.0f, reach = 0.0f;    // harmonic mean of the lengths of its rays, of those that end at a surface; field units
        bool known = false;                 // enough of its rays found something
        float seen = 0.0f;                  // share of them that meet what a probe sees, or pass before one on their way to the sky
        float open = 0.0f;                  // share of them that go far, of a place that isn't within something solid: see Openness
        bool enclosed = false;              // none of them the sky
    };
    /// At what the 2^kFineLog squared finer texels of a texel see.
    /// @param texel  x, y, face
    using FinePoints = std::array<Point, size_t(1) << (2 * gpu::kFineLog)>;
    FinePoints gatherFiner(uint32_t probe, glm::uvec3 texel, const Sent& sent) const;

    /// What tells how open a place is.
    struct Openness
    {
        float near;                       // field units, beyond which a ray goes far
        std::span<const Outside> outside; // of the scene's triangles: a ray that meets another side comes from within something solid; of
                                          // `both` it is the back
    };
    /// At a place on a surface that no texel need show.
    /// @param point   field space, off it by gap()
    /// @param normal   unit, on the side that is lit
    /// @param grazing  of its surface, see grazingOf()
    /// @param openness  to find Point::open by; without it isn't asked for
    Point gatherAt(vec3 point, vec3 normal, float grazing, uint32_t rays, glm::uvec2 sample, const Sent& sent,
                   const Openness& openness = {}) const;
    /// Where the rays of such a place end.
    std::vector<uint32_t> linksAt(vec3 point, vec3 normal, float grazing, uint32_t rays, glm::uvec2 sample) const;
    /// How much less of light near its plane a surface takes into its diffuse lobe, as smooth coats reflect it, or how much more of it a
    /// rough metal sends on: see takenAlong() in brdf_text.h.
    float grazingOf(float metallic, float roughness) const;
    float offset() const { return 2.0f * gap / field->info.scale; } // field units that points are off their surface
    const Scene& scene() const { return triangles->scene(); }

private:
    const ExactRays* triangles;
    const FieldData* field;
    std::span<const gpu::SurfaceTexel> texels;
    const LightList* lights;
    Desc desc;
    float gap; // metres that rays start off their surface
    std::vector<vec4> palette;
    std::vector<float> straight; // by material, see straightShares()
    EmitterPatches patches;
    std::array<float, 256> grazings{}; // by roughness
};

} // namespace sconce
