#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <glm/glm.hpp>

namespace sconce
{

/// Of 16 texels, [4 y + x], W/(m^2 sr), the block (shaders/shared/radiance_block.h) that is nearest to those that count, by squares of
/// errors relative to their light. About 10 us. Endpoints are searched for from the longest axis of the texels' half floats on: what comes
/// out isn't the nearest there is. @param counts  bit 4 y + x: the texel is read
std::array<uint32_t, 4> radianceBlockOf(std::span<const glm::vec3, 16> texels, uint32_t counts);

} // namespace sconce
