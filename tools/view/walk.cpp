#include "tools/view/walk.h"

#include <algorithm>
#include <cmath>

namespace sconce::tools
{

namespace
{

constexpr float kSteepest = 1.5f; // radians above or below the horizon: steeper, and level() would take another up
constexpr vec3 kUp(0.0f, 1.0f, 0.0f);

void level(Camera& camera)
{
    // As CameraOptions::choose() does, so that the same eye and target give the same picture to the bit.
    const vec3 world = std::abs(camera.forward.y) > 0.999f ? vec3(0.0f, 0.0f, -1.0f) : kUp;
    camera.up = glm::normalize(world - glm::dot(world, camera.forward) * camera.forward);
}

} // namespace

float walkSpeed(const Scene& scene)
{
    // Across in about ten seconds, but in a large scene not faster than a run.
    return std::clamp(0.1f * scene.bounds().diagonal(), 1e-3f, 8.0f);
}

void walk(Camera& camera, const Step& step, float speed)
{
    if (step.turn != vec2(0.0f))
    {
        const float pitch = std::clamp(std::asin(std::clamp(camera.forward.y, -1.0f, 1.0f)) + step.turn.y, -kSteepest, kSteepest);
        const float yaw = std::atan2(camera.forward.x, -camera.forward.z) + step.turn.x;
        camera.forward = glm::normalize(vec3(std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch)));
        level(camera);
    }
    if (step.move == vec3(0.0f)) return;
    const vec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
    const vec3 way = step.move.x * right + step.move.y * kUp + step.move.z * camera.forward;
    if (!(glm::length(way) > 1e-6f)) return;
    camera.eye += glm::normalize(way) * speed * (step.fast ? kFastWalk : 1.0f) * step.seconds;
}

Camera lookAt(vec3 eye, vec3 target, float verticalFov)
{
    Camera camera;
    camera.name = "custom";
    camera.eye = eye;
    camera.forward = glm::normalize(target - eye);
    camera.verticalFov = verticalFov;
    level(camera);
    return camera;
}

} // namespace sconce::tools
