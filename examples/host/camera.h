#pragma once

#include <string>

#include <glm/glm.hpp>

/// How this host's world lies beside glTF's, which is right-handed with y up and is that of the light field. A left-handed engine turns z
/// round when it loads, and its cameras look along +z.
struct Convention
{
    bool leftHanded = false;
    /// Of each axis of glTF's world in the host's, and back.
    glm::vec3 axes() const { return {1.0f, 1.0f, leftHanded ? -1.0f : 1.0f}; }
};

struct Camera // in the host's world
{
    std::string name;
    glm::vec3 eye{0.0f};
    glm::vec3 forward{0.0f, 0.0f, -1.0f}; // unit
    glm::vec3 up{0.0f, 1.0f, 0.0f};       // unit, orthogonal to forward
    float verticalFov = 1.0f;             // radians
};

/// Vulkan's clip space, y down, with reversed depth: 1 at the near plane, 0 at infinity. In double: its inverse keeps what floats need.
/// @param aspect  width over height of a picture
glm::dmat4 clipFromWorld(const Camera& camera, Convention convention, double aspect);
