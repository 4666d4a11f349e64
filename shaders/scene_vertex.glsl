// What every pass that draws the scene's triangles shares: DeviceScene's vertices, and a view about a point.
layout(location = 0) in vec3 inPosition; // field space
#ifndef SCONCE_POSITIONS_ONLY
layout(location = 1) in vec3 inNormal;
layout(location = 2) in vec2 inUv;
layout(location = 3) in uint inMaterial;
#endif
layout(push_constant) uniform View
{
    mat4 clip;   // clipFromRelative: takes (position - centre, 1)
    vec3 centre; // field space; subtracted first, so that far from the origin no bits are lost
};
