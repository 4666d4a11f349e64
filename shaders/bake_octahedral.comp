#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "bake_probe.glsl"

// Bake: resamples a probe's faces (as large as the octahedral map) into the octahedral chart: words, radiance and surfaces. A direction
// meets the plane of the face texel it falls in; where that plane is grazing, the texel's own distance stands.
// Dispatch: ceil(N/8) x ceil(N/8).
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = kBakeSurfaceBinding) uniform utexture2D surfaceImage;
layout(set = 0, binding = kBakeDepthBinding) uniform texture2D depthImage;

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= push.size || at.y >= push.size) return;
    uint index = at.y * push.size + at.x;
    uint texels = 6u * push.size * push.size; // extra holds the faces' radiance, their surfaces, and their emission
    vec3 direction = directionFromOctahedral((vec2(at) + 0.5) / float(push.size));
    int face = dominantFace(direction);
    vec3 uvw = faceCoordinates(face, direction);
    vec2 onFace = (0.5 * uvw.xy / uvw.z + 0.5) * float(push.size);
    uvec2 texel = min(uvec2(max(onFace, vec2(0.0))), uvec2(push.size - 1u));
    uint source = (uint(face) * push.size + texel.y) * push.size + texel.x;
    push.radiance.word[index] = push.extra.word[source];
    push.surface.word[index] = push.extra.word[texels + source];
    if (!isNull(push.emitted)) push.emitted.word[index] = push.extra.word[2u * texels + source];
    ivec2 pixel = ivec2(texel.x, uint(face) * push.size + texel.y);
    float depth = texelFetch(depthImage, pixel, 0).x;
    if (depth <= 0.0)
    {
        push.words.word[index] = 0x7c00u;
        return;
    }
    vec3 normal = directionFromOctahedral(unpackUnorm2x16(texelFetch(surfaceImage, pixel, 0).z));
    vec3 centreOfTexel = faceDirection(face, vec3(texelOnFace(texel, push.size), 1.0)) * (push.nearPlane / depth);
    float own = length(centreOfTexel);
    float facing = dot(normal, direction);
    float r = abs(facing) > 0.02 ? dot(normal, centreOfTexel) / facing : own;
    float limit = 1.0 + 8.0 / float(push.size) * inversesqrt(max(facing * facing, 1e-6)); // a plane seen within its texel can't lie further off
    r = clamp(r, own / limit, own * limit);
    push.words.word[index] = realToHalf(r) | (packNormal8(normal) << 16);
}
