#include "bench/sweep/point_json.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "scene/section.h"

namespace sconce
{
namespace
{

constexpr double kWrongRays = 0.5; // right within 1 %: fewer are no answer
constexpr size_t kMostSegments = 20000;

double meanSquare(std::span<const float> values)
{
    double sum = 0.0;
    for (const float value : values) sum += double(value) * value;
    return sum / double(values.size());
}

} // namespace

Json toJson(vec3 v)
{
    return Json::array({v.x, v.y, v.z});
}

Json numberOrNull(double value)
{
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json bytesJson(const FieldBytes& bytes)
{
    return {{"total", bytes.total()},     {"distance", bytes.distance},     {"normals", bytes.normals},
            {"radiance", bytes.radiance}, {"irradiance", bytes.irradiance}, {"index", bytes.index}};
}

Json raysJson(const TraceScore& score)
{
    return {{"count", score.rays},
            {"right_1", score.right1},
            {"right_02", score.right02},
            {"right_1_unsure", score.right1Unsure},
            {"right_02_unsure", score.right02Unsure},
            {"false", score.falseHit},
            {"leak", score.leak},
            {"unresolved", score.unresolved},
            {"reads_mean", score.distanceReads.mean},
            {"reads_p95", score.distanceReads.p95},
            {"reads_max", score.distanceReads.max},
            {"index_reads_mean", score.indexReads.mean},
            {"handoffs_mean", score.handoffs.mean}};
}

Json wrongness(const Json& point, std::span<const float> reference)
{
    const double black = meanSquare(reference);
    const Json& error = point["error"]["beauty"]["mse"];
    if (error.is_null()) return "The picture has pixels that are not finite.";
    if (error.get<double>() >= black)
        return fmt::format("The picture is wrong beyond use: its MSE is {}, that of a black one {}.", error.dump(), Json(black).dump());
    if (point.contains("rays") && point["rays"]["right_1"].get<double>() < kWrongRays)
        return fmt::format("More than half of the rays are answered wrongly: {} are right.", point["rays"]["right_1"].dump());
    return nullptr;
}

Json sectionAt(const Scene& scene, float height)
{
    std::vector<glm::vec4> segments;
    for (const auto& [a, b] : sectionOf(scene, vec3(0.0f, height, 0.0f), vec3(0.0f, 1.0f, 0.0f))) segments.emplace_back(a.x, a.z, b.x, b.z);
    const auto length = [](const glm::vec4& s) { return glm::distance(vec2(s), vec2(s.z, s.w)); };
    // The longest stay: a page must be able to draw the plan, and walls are what it is looked at for.
    if (segments.size() > kMostSegments)
    {
        std::ranges::nth_element(segments, segments.begin() + kMostSegments, std::greater<>(), length);
        segments.resize(kMostSegments);
    }
    Json json = Json::array();
    for (const glm::vec4& s : segments) json.push_back({s.x, s.y, s.z, s.w});
    return json;
}

} // namespace sconce
