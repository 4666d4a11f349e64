#include "scene/view_rays.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace sconce
{

Pinhole::Pinhole(const Camera& camera, uint32_t width, uint32_t height) : eye(camera.eye), forward(glm::normalize(camera.forward))
{
    const float half = std::tan(0.5f * camera.verticalFov);
    right = glm::normalize(glm::cross(forward, camera.up));
    up = glm::cross(right, forward) * half;
    right *= half * static_cast<float>(width) / static_cast<float>(height);
}

vec3 Pinhole::direction(float x, float y, uint32_t width, uint32_t height) const
{
    const float u = 2.0f * x / static_cast<float>(width) - 1.0f;
    const float v = 1.0f - 2.0f * y / static_cast<float>(height);
    return glm::normalize(forward + u * right + v * up);
}

Result<ViewRays> ViewRays::create(const Camera& camera, const View& view)
{
    if (view.width == 0 || view.height == 0 || view.samples == 0)
        return Error{ErrorCode::badArgument,
                     fmt::format("A view of {} x {} pixels with {} rays each has no rays; give at least one of each", view.width,
                                 view.height, view.samples)};
    if (!(view.eyesApart >= 0.0f && view.eyesApart <= 10.0f))
        return Error{ErrorCode::badArgument, fmt::format("Eyes are {} m apart; give 0 to 10, as 0.064 of a person's", view.eyesApart)};
    // r (1 + k1 r^2 + k2 r^4) must rise over the whole picture, or places of it would be shown twice.
    const float aspect = static_cast<float>(view.width) / static_cast<float>(view.height), corner = 1.0f + aspect * aspect;
    constexpr int kSteps = 64;
    for (int i = 0; i <= kSteps; ++i)
    {
        const float rr = corner * static_cast<float>(i) / kSteps;
        if (!(1.0f + 3.0f * view.lens.x * rr + 5.0f * view.lens.y * rr * rr > 0.0f))
            return Error{ErrorCode::badArgument,
                         fmt::format("A lens of {},{} folds the picture over itself at {:.2f} half heights from its middle; give larger "
                                     "coefficients, as 0.2,0.05",
                                     view.lens.x, view.lens.y, std::sqrt(rr))};
    }
    return ViewRays(camera, view);
}

std::vector<glm::uvec2> ViewRays::pixelsInTiles(uint32_t first, uint32_t last) const
{
    std::vector<glm::uvec2> pixels;
    pixels.reserve(size_t(width()) * (last - first));
    for (uint32_t tileY = first; tileY < last; tileY += kTile)
        for (uint32_t tileX = 0; tileX < width(); tileX += kTile)
            for (uint32_t y = tileY; y < std::min(tileY + kTile, last); ++y)
                for (uint32_t x = tileX; x < std::min(tileX + kTile, width()); ++x) pixels.emplace_back(x, y);
    return pixels;
}

ViewRay ViewRays::ray(uint32_t x, uint32_t y, uint32_t sample) const
{
    // Roberts 2018, the R2 sequence: powers of the inverse plastic number; its first point is the pixel's centre.
    const vec2 at = glm::fract(0.5f + static_cast<float>(sample) * vec2(0.7548776662f, 0.5698402910f));
    vec2 place(static_cast<float>(x % view.width) + at.x, static_cast<float>(y) + at.y);
    if (view.lens != vec2(0.0f))
    {
        const vec2 middle = 0.5f * vec2(view.width, view.height), off = (place - middle) / middle.y;
        const float rr = glm::dot(off, off);
        place = middle + (place - middle) * (1.0f + rr * (view.lens.x + rr * view.lens.y));
    }
    const float side = view.eyesApart > 0.0f ? (x < view.width ? -0.5f : 0.5f) * view.eyesApart : 0.0f;
    return {pinhole.eye + side * glm::normalize(pinhole.right), pinhole.direction(place.x, place.y, view.width, view.height)};
}

} // namespace sconce
