#include "camera.h"

#include <cmath>

namespace
{

constexpr double kNear = 0.01; // metres; with reversed depth in float it costs no precision to have it small

/// x right, y up; the right-handed camera looks along -z, the left-handed one along +z.
glm::dmat4 viewFromWorld(const Camera& camera, Convention convention)
{
    const glm::dvec3 forward = glm::normalize(glm::dvec3(camera.forward)), up(camera.up);
    const glm::dvec3 right = glm::normalize(convention.leftHanded ? glm::cross(up, forward) : glm::cross(forward, up));
    const glm::dvec3 above = convention.leftHanded ? glm::cross(forward, right) : glm::cross(right, forward);
    const glm::dvec3 rows[3] = {right, above, convention.leftHanded ? forward : -forward};
    glm::dmat4 view(1.0);
    for (int row = 0; row < 3; ++row)
    {
        for (int column = 0; column < 3; ++column) view[column][row] = rows[row][column];
        view[3][row] = -glm::dot(rows[row], glm::dvec3(camera.eye));
    }
    return view;
}

glm::dmat4 clipFromView(double verticalFov, double aspect, Convention convention)
{
    const double tangent = std::tan(0.5 * verticalFov);
    glm::dmat4 clip(0.0);
    clip[0][0] = 1.0 / (aspect * tangent);
    clip[1][1] = -1.0 / tangent; // Vulkan's y points down the picture
    clip[2][3] = convention.leftHanded ? 1.0 : -1.0;
    clip[3][2] = kNear; // depth is near over the distance along the view
    return clip;
}

} // namespace

glm::dmat4 clipFromWorld(const Camera& camera, Convention convention, double aspect)
{
    return clipFromView(camera.verticalFov, aspect, convention) * viewFromWorld(camera, convention);
}
