#include "runtime/frame/moving_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include <fmt/format.h>

namespace sconce
{
namespace
{

bool isFinite(vec3 v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Of one shape; empty: nothing.
std::string faultOf(const MovingShape& s)
{
    if (!isFinite(s.centre)) return "its centre is no number";
    const float turn = glm::length(vec4(s.turn.x, s.turn.y, s.turn.z, s.turn.w));
    if (!(turn > 0.5f && turn < 2.0f)) return "its turn is no unit quaternion";
    const bool box = s.kind == MovingShape::Kind::box;
    if (!isFinite(s.half) || !(s.half.x > 0.0f) || !(s.half.y >= 0.0f) || (box && !(s.half.y > 0.0f && s.half.z > 0.0f)))
        return box ? "its half sizes are not all above 0" : "its radius is not above 0, or its half length is below 0";
    if (!isFinite(s.albedo) || glm::any(glm::lessThan(s.albedo, vec3(0.0f))) || glm::any(glm::greaterThan(s.albedo, vec3(1.0f))))
        return "its albedo is not in [0,1]";
    if (!isFinite(s.emission) || glm::any(glm::lessThan(s.emission, vec3(0.0f)))) return "its emission is below 0 or no number";
    if (!std::isfinite(s.slack)) return "its slack is no number";
    return {};
}

float reachOf(const MovingShape& s)
{
    switch (s.kind)
    {
    case MovingShape::Kind::sphere:
        return s.half.x;
    case MovingShape::Kind::capsule:
        return s.half.x + s.half.y;
    default:
        return glm::length(s.half);
    }
}

gpu::MovingShapeData packed(const MovingShape& s)
{
    const glm::quat turn = glm::normalize(s.turn);
    gpu::MovingShapeData made{};
    made.centre = s.centre;
    made.reach = reachOf(s);
    made.turn = vec4(turn.x, turn.y, turn.z, turn.w);
    made.kind = s.kind == MovingShape::Kind::box ? gpu::kShapeIsBox : gpu::kShapeIsRound;
    made.half_ = s.kind == MovingShape::Kind::box ? s.half : vec3(s.half.x, s.kind == MovingShape::Kind::capsule ? s.half.y : 0.0f, 0.0f);
    made.albedo = s.albedo;
    made.slack = s.slack >= 0.0f ? s.slack : kSlackOfShape * made.reach;
    made.emission = s.emission;
    return made;
}

/// Bits of 0..1023 with two free ones between them.
uint32_t spread(float share)
{
    auto x = uint32_t(std::clamp(share * 1023.0f, 0.0f, 1023.0f));
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    return (x | (x << 2)) & 0x09249249u;
}

/// A sphere that holds the shapes.
vec4 sphereOf(std::span<const gpu::MovingShapeData> shapes)
{
    Bounds bounds;
    for (const gpu::MovingShapeData& s : shapes) bounds.add(s.centre - s.reach), bounds.add(s.centre + s.reach);
    const vec3 middle = bounds.centre();
    float radius = 0.0f;
    for (const gpu::MovingShapeData& s : shapes) radius = std::max(radius, glm::length(s.centre - middle) + s.reach);
    return {middle, radius * 1.00001f}; // a rounding of the lengths
}

} // namespace

std::string faultOf(std::span<const MovingShape> shapes, uint32_t most)
{
    if (shapes.size() > most)
        return fmt::format("{} shapes move, and this frame was made for {}; give Desc::movingShapes up to {}", shapes.size(), most,
                           gpu::kMostMovingShapes);
    for (size_t i = 0; i < shapes.size(); ++i)
        if (const std::string fault = faultOf(shapes[i]); !fault.empty()) return fmt::format("shape {}: {}", i, fault);
    return {};
}

std::vector<std::byte> packShapes(std::span<const MovingShape> shapes)
{
    Bounds bounds;
    for (const MovingShape& s : shapes) bounds.add(s.centre);
    const vec3 size = shapes.empty() ? vec3(1.0f) : glm::max(bounds.size(), vec3(1e-6f));
    const auto code = [&](uint32_t i)
    {
        const vec3 at = (shapes[i].centre - bounds.low) / size;
        return spread(at.x) | (spread(at.y) << 1) | (spread(at.z) << 2);
    };
    std::vector<uint32_t> order(shapes.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, code);
    std::vector<gpu::MovingShapeData> data;
    for (const uint32_t i : order) data.push_back(packed(shapes[i]));
    gpu::MovingShapesHead head{};
    head.count = uint32_t(data.size());
    head.groups = (head.count + gpu::kShapesOfGroup - 1) / gpu::kShapesOfGroup;
    for (uint32_t g = 0; g < head.groups; ++g)
    {
        const size_t first = size_t(g) * gpu::kShapesOfGroup;
        head.group[g] = sphereOf(std::span(data).subspan(first, std::min<size_t>(gpu::kShapesOfGroup, data.size() - first)));
    }
    std::vector<std::byte> bytes(sizeof head + data.size() * sizeof(gpu::MovingShapeData));
    std::memcpy(bytes.data(), &head, sizeof head);
    if (!data.empty()) std::memcpy(bytes.data() + sizeof head, data.data(), data.size() * sizeof(gpu::MovingShapeData));
    return bytes;
}

} // namespace sconce
