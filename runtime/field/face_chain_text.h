#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>
#include <glm/packing.hpp>

#include "shaders/shared/gpu_types.h"

namespace sconce::chain_text
{
using namespace glm; // the shared text calls GLSL's functions by their plain names

/// The shared text that lays out and builds a face's chain, in float; `words` are those of the probe or face it is asked about.
struct Text
{
    using real = float;
    using uint = std::uint32_t;
    using vec2f = glm::vec2;
    const uint32_t* words = nullptr;
    uint32_t chainWord(uint32_t index) const { return words[index]; }
#include "shaders/shared/texel.h"
#define SCONCE_BUILDS_CHAINS
#include "shaders/shared/face_chain.h"
#undef SCONCE_BUILDS_CHAINS
};

} // namespace sconce::chain_text
