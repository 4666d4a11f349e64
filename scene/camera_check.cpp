#include "scene/camera_check.h"

#include <cmath>

#include <fmt/format.h>

namespace sconce
{

std::string cameraFault(const Camera& camera)
{
    const std::string name = camera.name.empty() ? "The camera" : fmt::format("The camera '{}'", camera.name);
    if (!(camera.verticalFov > 0.0f && camera.verticalFov < 3.1f))
        return fmt::format("{} has a vertical field of view of {:f} radians; choose above 0 and below 3.1", name, camera.verticalFov);
    if (!std::isfinite(glm::length(camera.eye))) return fmt::format("{} has an eye that is not finite; give its position in metres", name);
    const float area = glm::length(glm::cross(camera.forward, camera.up));
    if (!(area > 1e-6f) || !std::isfinite(area))
        return fmt::format("{} has a forward and an up that are parallel, of no length or not finite; give two directions that differ",
                           name);
    return {};
}

} // namespace sconce
