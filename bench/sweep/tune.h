#pragma once

#include "bench/sweep/results.h"

namespace sconce
{

/// What settings must keep to; at least one is set. With an error, the cheapest frame is wanted; else the least error.
struct TuneGoal
{
    std::optional<double> frameMs;                             // milliseconds a frame, of the size that was measured
    std::optional<double> error;                               // in the metric
    std::optional<double> bytes;                               // of the light field
    std::string metric = std::string(knobs::goalMetric.value); // a name of figureOf(): what the error is
};

/// The measured point of ours that suits best. Errors: badArgument (no goal), badInput (nothing measured keeps to it: the sentence names
/// the nearest).
Result<Json> tune(const std::vector<Json>& points, const TuneGoal& goal);

/// A file of settings (--quality): {"quality": 1, "scene": .., "point": id, "settings": {..}, "price": {..}}.
Json qualityFile(const std::string& scene, const Json& point);
/// The settings of such a file, or of a level's name (runtime/field/quality.h), whose probes are 0: not decided.
/// Errors: fileError, badInput (not such a file), badArgument (neither a level nor a file).
Result<PointSettings> loadQuality(const std::string& fileOrLevel);

/// Sets what a level decides.
void applyLevel(PointSettings& settings, const QualityLevel& level);

} // namespace sconce
