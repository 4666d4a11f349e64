// The opponents of the bench, by number: what kBaseline of baseline_trace.h may be.
#include "shared/gpu_types.h"
#ifndef SCONCE_BASELINE_H
#define SCONCE_BASELINE_H
SCONCE_STRUCTS_BEGIN

const uint kBaselineB0 = 0u;           // McGuire et al. 2017 as their supplement traces, on a uniform grid
const uint kBaselineB0Plus = 1u;       // the same with its known defects mended
const uint kBaselineB0PlusOctree = 2u; // that march, but the probes come from the octree's ranked lists
const uint kBaselineWang = 3u;         // Wang et al. 2019: the same lists, a min/max chain marched in the octahedral map

const float kLookUpBias = 0.1; // metres along the normal, and as many towards the viewer, where none is chosen

// Specialization constants of grid_light.glsl, beside those of gather_light.glsl.
const uint kGridBiasId = 60u;
const uint kGridBiasViewId = 61u;

SCONCE_STRUCTS_END
#endif
