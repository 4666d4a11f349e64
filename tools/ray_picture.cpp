#include "tools/ray_picture.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "scene/section.h"

namespace sconce::tools
{
namespace
{

constexpr uint32_t kWidth = 1280, kHeight = 720;
constexpr float kMargin = 0.15f; // of the extent of what is shown, about it
constexpr vec3 kGround{0.01f}, kCut{0.35f}, kTruth{1.0f};
constexpr float kInPlane = 0.02f; // of the picture's width: probes this near to the plane are in it

/// The plane that is drawn, and how it lies in the picture.
struct Canvas
{
    vec3 origin, along, up, across; // along the picture's x, its y, and the plane's normal
    vec2 low{0.0f};
    float scale = 1.0f; // pixels a metre
    Picture picture{kWidth, kHeight, std::vector<float>(size_t(3) * kWidth * kHeight)};

    vec2 inPlane(vec3 p) const { return {glm::dot(p - origin, along), glm::dot(p - origin, up)}; }
    vec2 pixel(vec2 p) const { return {(p.x - low.x) * scale, float(kHeight) - (p.y - low.y) * scale}; }

    void dot(vec2 at, float radius, vec3 colour, float hole = -1.0f)
    {
        const int reach = int(std::ceil(radius));
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x)
            {
                const float away = std::hypot(float(x), float(y));
                const int px = int(std::floor(at.x)) + x, py = int(std::floor(at.y)) + y;
                if (away > radius || away < hole || px < 0 || py < 0 || px >= int(kWidth) || py >= int(kHeight)) continue;
                for (int c = 0; c < 3; ++c) picture.rgb[3 * (size_t(py) * kWidth + size_t(px)) + size_t(c)] = colour[c];
            }
    }
    void line(vec2 from, vec2 to, float radius, vec3 colour)
    {
        const vec2 a = pixel(from), b = pixel(to);
        const vec2 high(kWidth, kHeight);
        if (glm::any(glm::lessThan(glm::max(a, b), vec2(0.0f))) || glm::any(glm::greaterThan(glm::min(a, b), high))) return;
        const int steps = int(std::min(glm::distance(a, b), 16.0f * float(kWidth))) + 1;
        for (int i = 0; i <= steps; ++i) dot(glm::mix(a, b, float(i) / float(steps)), radius, colour);
    }
};

/// @param shown  places that the picture holds, world
Canvas canvasOf(const gpu::Ray& ray, std::span<const vec3> shown)
{
    Canvas canvas;
    canvas.origin = ray.origin;
    const vec3 level(ray.direction.x, 0.0f, ray.direction.z);
    canvas.up = {0.0f, 1.0f, 0.0f};
    canvas.along = glm::length(level) > 1e-3f ? glm::normalize(level) : vec3(0.0f, 0.0f, -1.0f);
    canvas.across = glm::cross(canvas.along, canvas.up);
    vec2 low(0.0f), high(0.0f);
    for (const vec3 place : shown)
    {
        low = glm::min(low, canvas.inPlane(place));
        high = glm::max(high, canvas.inPlane(place));
    }
    const float margin = kMargin * std::max(glm::distance(low, high), 1e-3f);
    const vec2 size = high - low + 2.0f * margin;
    canvas.scale = std::min(float(kWidth) / size.x, float(kHeight) / size.y);
    canvas.low = 0.5f * (low + high) - 0.5f * vec2(kWidth, kHeight) / canvas.scale;
    return canvas;
}

} // namespace

Picture drawWay(const Scene& scene, const FieldData& field, const gpu::Ray& ray, const ExplainedRay& way, float truth)
{
    const auto centreOf = [&](uint32_t probe) { return field.info.origin + field.info.scale * vec3(field.probes[probe].centre); };
    std::vector<vec3> shown;
    for (const RayStretch& stretch : way.way)
    {
        shown.push_back(ray.origin + stretch.to * ray.direction);
        shown.push_back(centreOf(stretch.probe));
    }
    if (std::isfinite(truth)) shown.push_back(ray.origin + truth * ray.direction);
    Canvas canvas = canvasOf(ray, shown);
    for (size_t i = 0; i < canvas.picture.rgb.size(); ++i) canvas.picture.rgb[i] = kGround.x;
    for (const auto& [a, b] : sectionOf(scene, canvas.origin, canvas.across)) canvas.line(canvas.inPlane(a), canvas.inPlane(b), 0.5f, kCut);
    const auto at = [&](float t) { return canvas.inPlane(ray.origin + t * ray.direction); };
    std::vector<uint32_t> drawn;
    for (size_t i = 0; i < way.way.size(); ++i)
    {
        const RayStretch& stretch = way.way[i];
        const vec3 colour = kStretchColours[i % std::size(kStretchColours)].linear;
        canvas.line(at(stretch.from), at(stretch.to), 2.0f, colour);
        canvas.dot(canvas.pixel(at(stretch.to)), 4.0f, colour);
        if (std::ranges::find(drawn, stretch.probe) != drawn.end()) continue;
        drawn.push_back(stretch.probe);
        const vec3 centre = centreOf(stretch.probe);
        const bool inPlane = std::abs(glm::dot(centre - canvas.origin, canvas.across)) * canvas.scale < kInPlane * float(kWidth);
        canvas.dot(canvas.pixel(canvas.inPlane(centre)), 9.0f, colour, inPlane ? -1.0f : 6.0f);
    }
    if (std::isfinite(truth))
    {
        const vec2 end = at(truth), arm = vec2(7.0f) / canvas.scale;
        canvas.line(end - arm, end + arm, 1.0f, kTruth);
        canvas.line(end + vec2(-arm.x, arm.y), end + vec2(arm.x, -arm.y), 1.0f, kTruth);
    }
    return std::move(canvas.picture);
}

} // namespace sconce::tools
