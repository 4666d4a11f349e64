#include "runtime/bake/drawn_faces.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using Text = Pure<float>;

constexpr uint32_t kLooks = 16;      // along a side of a face
constexpr float kAlike = 0.1f;       // of a distance: more than texels of slanted surfaces and levels of detail differ by
constexpr uint32_t kFewestLooks = 8; // that have something to compare: fewer tell nothing

/// 1 / distance along the face's axis, field units, of the first triangle that a probe would be shown; 0: sky. Less: it isn't known, since
/// the front alone of triangles is drawn and this is a back.
float nearnessOfTriangle(const ExactRays& rays, const gpu::LightFieldInfo& space, vec3 centre, vec3 direction)
{
    const auto hit = rays.closest(space.origin + space.scale * centre, direction);
    if (!hit) return 0.0f;
    const Scene& scene = rays.scene();
    if (!scene.twoSided && glm::dot(geometricNormal(scene, hit->triangle), direction) > 0.0f) return -1.0f;
    return space.scale / hit->t;
}

} // namespace

ProbeFaces::~ProbeFaces() = default;

ProbeFace faceInWorld(const gpu::SceneView& view, const gpu::LightFieldInfo& space, uint32_t probe, uint32_t face)
{
    // clip of x / s, times s: what is projected is the same, and only the near plane, which x isn't multiplied with, is in metres.
    ProbeFace out{view.clip, space.origin + space.scale * view.centre, probe, face, glm::determinant(view.clip) > 0.0f};
    out.clipFromRelative[3] *= space.scale;
    return out;
}

std::string faultOfDrawn(const ExactRays& rays, const gpu::LightFieldInfo& space, vec3 centre, uint32_t probe,
                         std::span<const uint32_t> words, uint32_t size, size_t stride)
{
    uint32_t looks = 0, alike = 0;
    for (uint32_t face = 0; face < 6; ++face)
        for (uint32_t i = 0; i < kLooks * kLooks; ++i)
        {
            const uint32_t x = (2 * (i % kLooks) + 1) * size / (2 * kLooks), y = (2 * (i / kLooks) + 1) * size / (2 * kLooks);
            const vec3 uvw((2.0f * float(x) + 1.0f) / float(size) - 1.0f, (2.0f * float(y) + 1.0f) / float(size) - 1.0f, 1.0f);
            const float there = nearnessOfTriangle(rays, space, centre, Text::faceDirection(int(face), uvw));
            const float drawn = Text::halfToReal(words[face * stride + size_t(y) * size + x]);
            if (there < 0.0f || (there == 0.0f && drawn == 0.0f)) continue;
            ++looks;
            if (std::abs(there - drawn) <= kAlike * std::max(there, drawn)) ++alike;
        }
    if (looks < kFewestLooks || 2 * alike >= looks) return {};
    return fmt::format("the host has drawn what probe {} sees, and in {} of {} directions it is not where the scene's triangles are; take "
                       "clipFromRelative times (position - centre) in the scene's metres, test depth by VK_COMPARE_OP_GREATER, and bake "
                       "the scene that is drawn",
                       probe, looks - alike, looks);
}

} // namespace sconce
