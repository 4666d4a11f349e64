#pragma once

#include "bench/sparse/sparse_fill.h"
#include "runtime/scene/scene_renderer.h"

namespace sconce
{

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
