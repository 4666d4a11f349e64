// The scene's descriptor set, and what the passes that draw its triangles are told.
#include "shared/gpu_types.h"
#ifndef SCONCE_SCENE_PASSES_H
#define SCONCE_SCENE_PASSES_H
SCONCE_STRUCTS_BEGIN

const uint kMaterialsBinding = 0u;
const uint kColorTexturesBinding = 1u;
const uint kDataTexturesBinding = 2u;
const uint kLightsBinding = 3u;
const uint kSunShadowsBinding = 4u;
const uint kSkyShadowsBinding = 5u;
const uint kPointShadowsBinding = 6u;
const uint kEmitterShadowsBinding = 7u;

/// A view about a point.
struct SceneView
{
    mat4 clip;   // clipFromRelative: takes (position - centre, 1), field space
    vec3 centre; // field space; subtracted first, so that far from the origin no bits are lost
};
SCONCE_CHECK_SIZE(SceneView, 76);

const uint kRoughnessOverrideId = 0u; // constant of gbuffer.frag

SCONCE_STRUCTS_END
#endif
