#pragma once

#include <vulkan/vulkan.h>

namespace sconce
{

/// A host's G-buffer, and what it drew before. The first three views are of 2D images in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL or
/// GENERAL (say which), of the size that IndirectLight::Desc names, all of it drawn to; one sample a texel, read as floats, of the depth
/// its depth aspect alone. A pixel with a number that is NaN, infinite or beyond all sense (over 1000), or a normal of no length, counts as
/// one where nothing was drawn.
struct FrameInputs
{
    VkImageView depth = VK_NULL_HANDLE;             // reversed: 1 at the near plane, 0 where nothing was drawn
    VkImageView normalRoughness = VK_NULL_HANDLE;   // xyz shading normal, world, unit, on the viewer's side; w roughness [0,1], and
                                                    // gpu::kRetro more where the surface is retroreflective
    VkImageView baseColorMetallic = VK_NULL_HANDLE; // rgb linear, a metallic
    VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    // Of the effect screenTrace alone, which then needs it from the first record on, in this layout; it is read where FrameView::follows
    // isn't 0. Of the G-buffer's size: rgb, radiance to the eye of the frame before, linear, before tone mapping, bloom, fog and what isn't
    // of the scene; NaN, infinity and what is beyond 1e30 are left out. It may be the image that this frame's own picture is written to
    // after record(), whose last barrier lets it. With temporal, too, FrameView::follows is kFollowsChange while anything moves. Along
    // edges, while the eye or things move, reflections have a strip of what was before there. On surfaces that the field knows the picture
    // counts as far as they scatter, and up to four times as bright as the field has them. What shines in the picture and is a light of the
    // host's, too, is reflected by both, but for the field's lamps.
    VkImageView pictureBefore = VK_NULL_HANDLE;
    VkImageLayout pictureLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
};

} // namespace sconce
