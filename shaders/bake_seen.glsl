// What bake_gbuffer.frag tells of a texel's normals. The shading normal: two coordinates of 9 bits, octahedral; and in 7 bits each what counts of light
// straight from lights: the share that many normals leave, and shareToAllSides(). That of the plane: 14 bits, and 4 of the grazing of takenAlong().
#ifndef SCONCE_BAKE_SEEN_GLSL
#define SCONCE_BAKE_SEEN_GLSL
#include "shared/brdf.h"
#include "shared/chart.h"

uint packSeenNormal(vec3 normal, float together, float toAllSides)
{
    uvec2 at = uvec2(octahedralFromDirection(normal) * 511.0 + 0.5), shares = uvec2(clamp(vec2(together, toAllSides), 0.0, 1.0) * 127.0 + 0.5);
    return at.x | at.y << 9 | shares.x << 18 | shares.y << 25;
}

vec3 seenNormal(uint word) { return directionFromOctahedral(vec2(word & 511u, word >> 9 & 511u) / 511.0); }
float seenTogether(uint word) { return float(word >> 18 & 127u) / 127.0; }
float seenToAllSides(uint word) { return float(word >> 25) / 127.0; }

uint packSeenPlane(vec3 normal, float grazing)
{
    uvec2 at = uvec2(octahedralFromDirection(normal) * 16383.0 + 0.5);
    return at.x | at.y << 14 | uint(clamp(grazing / kMostGrazing, 0.0, 1.0) * 15.0 + 0.5) << 28;
}

vec3 seenPlane(uint word) { return directionFromOctahedral(vec2(word & 16383u, word >> 14 & 16383u) / 16383.0); }
float seenGrazing(uint word) { return float(word >> 28) * (kMostGrazing / 15.0); }

#endif
