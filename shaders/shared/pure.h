// The shared texts that need nothing but numbers, for C++: Pure<float>::packTexel(...), Pure<double>::faceDirection(...).
#ifndef SCONCE_PURE_H
#define SCONCE_PURE_H
#include <cmath>

#include "shared/gpu_types.h"

namespace sconce::pure_text
{
using namespace glm; // the shared text calls GLSL's functions by their plain names

/// The shaders' own functions in float or double, all static.
template <class Real> struct Pure
{
    using real = Real;
    using uint = std::uint32_t;
    using vec2 = glm::vec<2, Real>;
    using vec3 = glm::vec<3, Real>;
    using vec2f = glm::vec2;
#include "shared/pure_text.h"

#include "shared/distance_block.h"
#include "shared/radiance_block.h"

#include "shared/brdf_text.h"
#include "shared/normal_map.h"
#include "shared/polygon_light.h"
#include "shared/moving_text.h"
};

} // namespace sconce::pure_text

namespace sconce
{
using pure_text::Pure;
}
#endif
