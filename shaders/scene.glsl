// The scene's descriptor set, as DeviceScene fills it: materials, textures, lights and their shadow maps. Define SCONCE_SCENE_SET to the
// set it is bound to (0 when undefined).
#ifndef SCONCE_SCENE_GLSL
#define SCONCE_SCENE_GLSL
#include "shared/scene_passes.h"
#include "shared/material.h"
#include "shared/lights.h"
#ifndef SCONCE_SCENE_SET
#define SCONCE_SCENE_SET 0
#endif

layout(scalar, set = SCONCE_SCENE_SET, binding = kMaterialsBinding) readonly buffer SconceMaterials { GpuMaterial sconceMaterials[]; };
layout(set = SCONCE_SCENE_SET, binding = kColorTexturesBinding) uniform sampler2DArray sconceColorTextures; // sRGB, [layer][y][x]
layout(set = SCONCE_SCENE_SET, binding = kDataTexturesBinding) uniform sampler2DArray sconceDataTextures;  // linear
layout(scalar, set = SCONCE_SCENE_SET, binding = kLightsBinding) readonly buffer SconceLights
{
    LightsHeader lightsHeader;
    GpuLight lights[];
};
layout(set = SCONCE_SCENE_SET, binding = kSunShadowsBinding) uniform sampler2DArrayShadow sconceSunShadows;     // directional lights, a layer each
layout(set = SCONCE_SCENE_SET, binding = kSkyShadowsBinding) uniform sampler2DArrayShadow sconceSkyShadows;     // sky directions, a layer each
layout(set = SCONCE_SCENE_SET, binding = kPointShadowsBinding) uniform sampler2DArrayShadow sconcePointShadows;   // point and spot lights, six faces each
layout(set = SCONCE_SCENE_SET, binding = kEmitterShadowsBinding) uniform sampler2DArrayShadow sconceEmitterShadows; // emitter samples, six faces each

#endif
