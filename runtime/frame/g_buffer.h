#pragma once

#include <vulkan/vulkan.h>

namespace sconce
{

/// A host's G-buffer. All views are of 2D images in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL or GENERAL (say which), of the size
/// that IndirectLight::Desc names, all of it drawn to; one sample a texel, read as floats, of the depth its depth aspect alone. A pixel
/// with a number that is NaN, infinite or beyond all sense (over 1000), or a normal of no length, counts as one where nothing was drawn.
struct FrameInputs
{
    VkImageView depth = VK_NULL_HANDLE;             // reversed: 1 at the near plane, 0 where nothing was drawn
    VkImageView normalRoughness = VK_NULL_HANDLE;   // xyz shading normal, world, unit, on the viewer's side; w roughness [0,1], and
                                                    // gpu::kRetro more where the surface is retroreflective
    VkImageView baseColorMetallic = VK_NULL_HANDLE; // rgb linear, a metallic
    VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    // With the effect screenTrace, which has no other way to it, not null: of the G-buffer's size, rgb radiance to the eye, linear and
    // before any tone, of the frame that FrameView says this one follows; written on the same queue. What has moved since shows, for a
    // frame, what was there before it along the edge that it moves to; what moves behind an edge, likewise.
    VkImageView pictureBefore = VK_NULL_HANDLE;
    VkImageLayout pictureLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
};

} // namespace sconce
