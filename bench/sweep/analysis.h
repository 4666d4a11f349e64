#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/sweep/results.h"

namespace sconce
{

/// What the points of one scene say: "fronts", "equal", "prices", "breaks" of docs/formats.md. Points whose picture is wrong beyond use,
/// and figures that were not measured, take part in nothing. A loss is worded as a win is.
Json analyseScene(const std::vector<Json>& points);

/// Plain sentences over all scenes of results.json, one for each question, with the scene where it is least so.
std::vector<std::string> answersOf(const Json& results);

/// Ids of the points that no other beats in both, by rising cost: the Pareto front. Of equal ones the first in the list.
std::vector<std::string> paretoFront(std::span<const Json* const> points, std::string_view errorKey, std::string_view costKey);

/// From an error and a time ratio of one step: by what the time is multiplied when the error is halved, time ~ error^k. None where the
/// error changes by less than a fifth or a ratio isn't positive.
std::optional<double> halvingCost(double errorRatio, double timeRatio);

} // namespace sconce
