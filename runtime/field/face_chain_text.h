#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>
#include <glm/packing.hpp>

#include "shaders/shared/gpu_types.h"

namespace sconce::chain_text
{
using namespace glm; // the shared text calls GLSL's functions by their plain names

/// The shared text that builds a face's chain, in float; `words` are those of the face it is asked about. Where they lie: Pure (pure.h).
struct Text
{
    using real = float;
    using uint = std::uint32_t;
    using vec2f = glm::vec2;
    const uint32_t* words = nullptr;
    uint32_t chainWord(uint32_t index) const { return words[index]; }
#include "shaders/shared/pure_text.h"

#include "shaders/shared/face_chain_build.h"
};

} // namespace sconce::chain_text
