#pragma once

#include <cstdint>

#include <vulkan/vulkan.h>

#include "base/result.h"
#include "scene/scene.h"

namespace sconce
{

/// What a face's draws write to: a colour image of one 4 x 32-bit word a pixel and depth, one sample.
inline constexpr VkFormat kProbeFaceFormat = VK_FORMAT_R32G32B32A32_UINT;
inline constexpr VkFormat kProbeDepthFormat = VK_FORMAT_D32_SFLOAT;

/// A cube face of a probe that is to be drawn.
struct ProbeFace
{
    mat4 clipFromRelative; // takes (position - centre, 1) in the world's metres; depth is then 1 at the near plane and 0 infinitely far
    vec3 centre;           // world, metres, off a surface that it stood on; subtracted first: far from the origin no bits are lost
    uint32_t probe = 0;    // its place in the list that is baked
    uint32_t face = 0;     // 0 to 5: +x, -x, +y, -y, +z, -z
    bool mirrored = false; // the face is seen in a mirror, as every second is: front faces turn the other way
};

/// Draws what probes see by a host's own renderer, with its geometry, materials and level of detail, where a bake would draw the scene.
/// Pipelines are for the two formats above: depth test and write, VK_COMPARE_OP_GREATER, viewport and scissor dynamic. The fragment shader
/// writes sconceProbeTexel() of shaders/sconce_probe_face.glsl; the vertex shader gl_Position = clipFromRelative * vec4(position - centre,
/// 1).
///
/// The scene that is baked has still to be described: its triangles are what rays that gather light meet, its lamps, lights and sky what
/// lights, and what is drawn shines only where some material of it does.
class ProbeFaces
{
public:
    virtual ~ProbeFaces();
    /// Records the draws of one face. Called six times a probe, in order, within vkCmdBeginRendering(); colour isn't cleared, depth is 0,
    /// viewport and scissor are set. What it binds is left behind. All that it uses is kept until the bake is done.
    /// @return  an error ends the bake, which returns it
    virtual Status draw(VkCommandBuffer cmd, const ProbeFace& face) = 0;
};

} // namespace sconce
