#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"
#include "gbuffer_read.glsl"
#include "tiles.glsl"
#include "lookups.glsl"
#include "opponents/volume.h"
// Diffuse light from a volume of irradiance, SCONCE_VOLUME of volume.h: what users of engines would have instead of ours. Rough reflections it has
// none.
const bool kPlaced = SCONCE_VOLUME == kVolumeDdgiPlaced;
const bool kHarmonics = SCONCE_VOLUME == kVolumeSh;

uint volumeIndex(uint probe) { return kVolumeHeaderWords + probe * (kHarmonics ? kShWords : kDdgiWords); }

/// The place whose light is asked for: off the surface, or it would be the surface that hides it.
vec3 movedOff(vec3 point, vec3 normal, vec3 view)
{
    return point + uintBitsToFloat(irradianceWord(0u)) * normal + uintBitsToFloat(irradianceWord(1u)) * view;
}

bool standsInSolid(uint probe)
{
    return unpackHalf2x16(irradianceWord(volumeIndex(probe) + (kHarmonics ? kShWords - 1u : 1u))).y != kVolumeValid;
}

vec3 ddgiTexel(uint probe, uint texel)
{
    uint at = volumeIndex(probe) + 2u * texel;
    return vec3(unpackHalf2x16(irradianceWord(at)), unpackHalf2x16(irradianceWord(at + 1u)).x);
}

/// Probes are blended as square roots, so that a dark one beside a bright one stays dark (Majercik et al. 2021, section 4).
vec3 ddgiRoot(uint probe, vec3 normal)
{
    OctahedralTaps taps = octahedralTaps(octahedralFromDirection(normal), int(kDdgiIrradianceSide));
    vec3 encoded = taps.weight.x * ddgiTexel(probe, taps.texel.x) + taps.weight.y * ddgiTexel(probe, taps.texel.y) +
                   taps.weight.z * ddgiTexel(probe, taps.texel.z) + taps.weight.w * ddgiTexel(probe, taps.texel.w);
    return pow(encoded, vec3(0.5 * kDdgiGamma));
}

vec2 ddgiMoments(uint probe, vec3 direction)
{
    uint at = volumeIndex(probe) + 2u * kDdgiIrradianceSide * kDdgiIrradianceSide;
    OctahedralTaps taps = octahedralTaps(octahedralFromDirection(direction), int(kDdgiDistanceSide));
    return taps.weight.x * unpackHalf2x16(irradianceWord(at + taps.texel.x)) + taps.weight.y * unpackHalf2x16(irradianceWord(at + taps.texel.y)) +
           taps.weight.z * unpackHalf2x16(irradianceWord(at + taps.texel.z)) + taps.weight.w * unpackHalf2x16(irradianceWord(at + taps.texel.w));
}

/// Without the place in the cell: wrapped cosine, Chebyshev's bound cubed, small weights crushed (Majercik et al. 2019, section 4; 2021).
float ddgiWeight(uint probe, vec3 point, vec3 moved, vec3 normal)
{
    vec3 centre = probeHeader(probe).centre;
    float wrap = 0.5 * dot(centre - point, normal) / max(length(centre - point), 1e-6) + 0.5;
    float weight = wrap * wrap + 0.2;
    float away = max(length(moved - centre), 1e-6);
    vec2 moments = ddgiMoments(probe, (moved - centre) / away);
    if (away > moments.x)
    {
        float variance = abs(moments.x * moments.x - moments.y), beyond = away - moments.x;
        float bound = variance / max(variance + beyond * beyond, 1e-12);
        weight *= max(bound * bound * bound, 0.05);
    }
    weight = max(weight, 1e-6);
    return weight < 0.2 ? weight * weight * weight / 0.04 : weight;
}

/// Second order, of irradiance / pi; a sum that rings below 0 is 0.
vec3 harmonicLight(uint probe, vec3 n)
{
    float basis[9] = {0.282095, 0.488603 * n.y, 0.488603 * n.z, 0.488603 * n.x, 1.092548 * n.x * n.y, 1.092548 * n.y * n.z,
                      0.315392 * (3.0 * n.z * n.z - 1.0), 1.092548 * n.x * n.z, 0.546274 * (n.x * n.x - n.y * n.y)};
    vec3 sum = vec3(0.0);
    uint at = volumeIndex(probe);
    for (uint i = 0u; i < 27u; ++i)
    {
        vec2 pair = unpackHalf2x16(irradianceWord(at + i / 2u));
        sum[i % 3u] += ((i & 1u) != 0u ? pair.y : pair.x) * basis[i / 3u];
    }
    return max(sum, vec3(0.0));
}

vec3 candidateLight(uint probe, vec3 normal) { return kHarmonics ? harmonicLight(probe, normal) : ddgiRoot(probe, normal); }
vec3 blendedLight(vec3 mean) { return kHarmonics ? mean : mean * mean; }

#if SCONCE_VOLUME == 1
#include "gather_votes.glsl"

/// The inverse square of the distance stands for the place in the cell, which lists have none of.
bool nextCandidate(inout Candidates of, out uint probe, out float weight)
{
    while (nextNamed(of, probe, weight))
    {
        if (standsInSolid(probe)) continue;
        vec3 toProbe = probeHeader(probe).centre - of.point;
        weight *= ddgiWeight(probe, of.point, movedOff(of.point, of.normal, of.view), of.normal) / (dot(toProbe, toProbe) + field.voxel * field.voxel);
        return true;
    }
    return false;
}
#else
#include "opponents/grid_cell.glsl"

struct Candidates
{
    GridCell cell;
    vec3 point; // field space
    vec3 moved;
    vec3 normal;
    int corner; // the next one
};

Candidates candidatesAt(ivec2 at, Pixel p, vec3 point, TangentFrame tangents)
{
    vec3 moved = movedOff(point, p.normal, p.view);
    return Candidates(gridCellOf(moved), point, moved, p.normal, canGather(point, p.normal) ? 0 : kGridCorners);
}

bool nextCandidate(inout Candidates of, out uint probe, out float weight)
{
    weight = 0.0;
    probe = kNoProbe;
    while (of.corner < kGridCorners)
    {
        vec3 part;
        if (!gridCorner(of.cell, of.corner++, probe, part) || standsInSolid(probe)) continue;
        if (!kHarmonics) part = max(part, 0.001);
        weight = part.x * part.y * part.z;
        if (!kHarmonics) weight *= ddgiWeight(probe, of.point, of.moved, of.normal);
        if (weight > 0.0) return true;
    }
    return false;
}
#endif
#include "gather_light.glsl"
