#pragma once

#include <algorithm>
#include <span>

#include "bench/reference/image_io.h"
#include "bench/sparse/sparse_fill.h"
#include "runtime/scene/scene_renderer.h"

namespace sconce
{

/// Colours as a picture's layer `beauty`.
inline ImageSet pictureOf(std::span<const vec3> colours, uint32_t width, uint32_t height)
{
    ImageSet images;
    images.width = width;
    images.height = height;
    std::copy_n(&colours[0].x, 3 * colours.size(), images.add("beauty", 3).pixels.begin());
    return images;
}

/// What a drawn frame shows where.
inline SurfacePixels surfacesOf(const RenderedFrame& frame, const Camera& camera)
{
    SurfacePixels pixels{frame.width, frame.height, camera.eye, {}, frame.normal, frame.roughness};
    const Pinhole pinhole(camera, frame.width, frame.height);
    for (size_t i = 0; i < frame.depth.size(); ++i)
    {
        const vec3 way = pinhole.direction(float(i % frame.width) + 0.5f, float(i / frame.width) + 0.5f, frame.width, frame.height);
        pixels.position.push_back(camera.eye + way * (frame.depth[i] / glm::dot(way, pinhole.forward)));
    }
    return pixels;
}

} // namespace sconce
