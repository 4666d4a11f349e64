#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "runtime/sconce.h"
#include "shaders/shared/moving_shapes.h"

namespace sconce
{

/// What is wrong with shapes of a frame, as a sentence's middle; empty: nothing. @param most  of the frame
std::string faultOf(std::span<const MovingShape> shapes, uint32_t most);

/// The front of the buffer that shaders/moving_shapes.glsl reads: gpu::MovingShapesHead, then a gpu::MovingShapeData each. Neighbours stand
/// together, by the Morton code of their middles, so that rays skip them together.
std::vector<std::byte> packShapes(std::span<const MovingShape> shapes);

/// Of the whole buffer, with room for kMostMovingShapes and their light.
constexpr uint64_t kMovingBytes = sizeof(gpu::MovingShapesHead) + uint64_t(gpu::kMostMovingShapes) * sizeof(gpu::MovingShapeData) +
                                  uint64_t(gpu::kMostMovingShapes) * gpu::kShapeFacings * sizeof(vec3);
static_assert(sizeof(gpu::MovingShapesHead) + gpu::kMostMovingShapes * sizeof(gpu::MovingShapeData) <= 65536, "vkCmdUpdateBuffer");

} // namespace sconce
