#pragma once

#include "scene/scene.h"

namespace sconce::tools
{

/// What keys and mouse ask for in one frame.
struct Step
{
    vec3 move{0.0f}; // right, up, forward: -1, 0 or 1 each
    vec2 turn{0.0f}; // radians, to the right and up
    bool fast = false;
    float seconds = 0.0f; // since the frame before
};
inline constexpr float kFastWalk = 4.0f; // times as fast

/// Metres a second at which a scene of this size is walked.
float walkSpeed(const Scene& scene);

/// Moves along the view's direction and turns about the world's up; never over the zenith, and level afterwards.
void walk(Camera& camera, const Step& step, float speed);

/// A camera at a point that looks at another, level. @param target  another point than eye
Camera lookAt(vec3 eye, vec3 target, float verticalFov);

} // namespace sconce::tools
