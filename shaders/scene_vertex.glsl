// What every pass that draws the scene's triangles shares: DeviceScene's vertices, and a view about a point.
#include "shared/scene_passes.h"
layout(location = 0) in vec3 inPosition; // field space
#ifndef SCONCE_POSITIONS_ONLY
layout(location = 1) in vec3 inNormal;
layout(location = 2) in vec2 inUv;
layout(location = 3) in uint inMaterial;
#endif
layout(scalar, push_constant) uniform Push { SceneView view; };
