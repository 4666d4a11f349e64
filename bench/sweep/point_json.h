#pragma once

#include "bench/race/trace_score.h"
#include "bench/sweep/settings.h"
#include "runtime/field/field_data.h"
#include "scene/scene.h"

namespace sconce
{

// What is measured, in the form of results.json (docs/formats.md).

Json toJson(vec3 v);
/// Null where it isn't a number, which JSON has no word for.
Json numberOrNull(double value);
Json bytesJson(const FieldBytes& bytes);
Json raysJson(const TraceScore& score);

/// A sentence when the picture or the rays are of no use, else null: no better than black, not finite, or most rays wrong.
/// @param reference  linear RGB of the reference's beauty
Json wrongness(const Json& point, std::span<const float> reference);

/// Section of the triangles at a height, [x0, z0, x1, z1] each; of too many, the longest 20,000.
Json sectionAt(const Scene& scene, float height);

} // namespace sconce
