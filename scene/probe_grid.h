#pragma once

#include <glm/glm.hpp>

namespace sconce
{

/// A uniform grid of probes: index = x + count.x * (y + count.y * z), position = origin + step * (x,y,z), world metres.
struct ProbeGrid
{
    glm::ivec3 count{0};
    glm::vec3 origin{0.0f};
    glm::vec3 step{0.0f};
};

} // namespace sconce
