// What the passes that gather light at surfaces share: one invocation a texel of one probe. After light_field.glsl.
#include "shared/bake_passes.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, push_constant) uniform Push { SurfacePush push; };

/// @param texel  of the invocation: x, y, face
/// @return  whether there is a surface to work on
bool findTexel(out uvec3 texel, out uint ofProbe, out uint index)
{
    texel = gl_GlobalInvocationID;
    uint side = field.surfaceSize;
    ofProbe = (texel.z * side + texel.y) * side + texel.x;
    index = push.probe * 6u * side * side + ofProbe;
    return texel.x < side && texel.y < side && (push.texels.value[index].normal & kSurfaceKnown) != 0u;
}
/// That light is gathered about: where the light's direction is kept, of the plane; else the mean of its shading normals.
vec3 normalOfTexel(uint index, SurfacePoint surface)
{
    return field.surfaceDirections != 0u ? surface.normal : unpackNormal8(push.texels.value[index].normal);
}

uint texelsOfProbe() { return 6u * field.surfaceSize * field.surfaceSize; }
