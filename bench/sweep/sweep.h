#pragma once

#include "bench/sweep/scene_bench.h"

namespace sconce
{

/// Measures the points of a scene that its folder doesn't hold yet, in groups that stand on the device at once: first what is exact of
/// each (rays, errors, bytes), then the frames' times, every point in turn, with the scene's default point in every group as the yardstick
/// that the groups' times are brought to one scale with (scaledPoints).
/// @param publish  called with all points measured so far, in the plan's order, whenever one is added or gets its times
/// @param say      a line for a person
/// Errors: cancelled (what was measured is kept), those of the truth. A point that can't be measured says so itself ("wrong").
Status sweepScene(SceneBench& bench, std::span<const PlannedPoint> plan, const std::function<Status(const std::vector<Json>&)>& publish,
                  const std::function<void(const std::string&)>& say, const Progress& progress);

/// Every point's times multiplied by what brings its group's yardstick to the median of all groups' (a machine that was busier while one
/// group ran slows both alike); the factor stands in "time_scale".
std::vector<Json> scaledPoints(std::vector<Json> points);

/// One line of what was measured, times apart.
std::string describePoint(const Json& point);

} // namespace sconce
