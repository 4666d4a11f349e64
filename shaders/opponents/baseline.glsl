// One of the bench's opponents, by its number SCONCE_BASELINE, in our tracer's place.
#include "light_field.glsl"
#include "opponents/baseline.h"
const uint kBaseline = SCONCE_BASELINE;
#include "opponents/baseline_b0.h"
#include "opponents/baseline_wang.h"
#include "opponents/baseline_trace.h"

RayHit opponentQuery(vec3 origin, vec3 direction, vec3 normal) { return baselineQuery(origin, direction); } // no use for the normal
