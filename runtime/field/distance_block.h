#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace sconce
{

/// Of 16 words of level 0 (shaders/shared/texel.h), [4 y + x], the block (distance_block.h) whose planes are, of the texels' own, those
/// that leave the least difference of all texels' gradients and distances, taken one after another. Sky stays sky, and what is none doesn't
/// become it. Three of four blocks of a scene are one plane and lose nothing; where over four meet, the others' gradients are off. About
/// 10 us.
std::array<uint32_t, 8> distanceBlockOf(std::span<const uint32_t, 16> texels);

} // namespace sconce
