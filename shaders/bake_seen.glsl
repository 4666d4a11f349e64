// What bake_gbuffer.frag tells of a texel's shading normal, two coordinates of 8 bits, octahedral, and of how much it sends of light straight from lights:
// in 6 bits each the share that many normals leave, and shareToAllSides(); in 4 the grazing of takenAlong().
#ifndef SCONCE_BAKE_SEEN_GLSL
#define SCONCE_BAKE_SEEN_GLSL
#include "shared/brdf.h"
#include "shared/chart.h"

uint packSeen(vec3 normal, float together, float toAllSides, float grazing)
{
    uvec2 at = uvec2(octahedralFromDirection(normal) * 255.0 + 0.5), shares = uvec2(clamp(vec2(together, toAllSides), 0.0, 1.0) * 63.0 + 0.5);
    return at.x | at.y << 8 | shares.x << 16 | shares.y << 22 | uint(clamp(grazing / kMostGrazing, 0.0, 1.0) * 15.0 + 0.5) << 28;
}

vec3 seenNormal(uint word) { return directionFromOctahedral(vec2(word & 255u, word >> 8 & 255u) / 255.0); }
float seenTogether(uint word) { return float(word >> 16 & 63u) / 63.0; }
float seenToAllSides(uint word) { return float(word >> 22 & 63u) / 63.0; }
float seenGrazing(uint word) { return float(word >> 28) * (kMostGrazing / 15.0); }

#endif
