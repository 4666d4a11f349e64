#pragma once

#include "bench/sweep/results.h"

namespace sconce
{

/// A guard against getting worse: figures of some small points, measured before, each with the margin it may worsen by. baseline.json:
/// {"guard": 1, "margins": [{"figure": "reads", "relative": 0.03, "absolute": 0}, ..],
///  "scenes": [{"name": "..", "source": "..", "options": {..}, "points": [{"id": "..", "reads": 17.6, ..}]}]}

/// One scene of a baseline, of points as results.json has them.
Json guardedScene(const std::string& name, const std::string& source, const Json& options, const std::vector<Json>& points);
/// The whole of a baseline but its scenes.
Json emptyGuard();
Result<Json> readGuard(const std::filesystem::path& file);

/// A sentence for every figure that is worse than its margin allows, or that is missing; empty when all is well. Better ones are well.
std::vector<std::string> worsened(const Json& guard, const Json& scene, const std::vector<Json>& points);

} // namespace sconce
