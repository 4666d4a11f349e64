#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"
#include "gbuffer_read.glsl"
#include "tiles.glsl"
#include "lookups.glsl"
#include "gather_votes.glsl"

bool nextCandidate(inout Candidates of, out uint probe, out float weight)
{
    bool named = nextNamed(of, probe, weight);
    if (named) weight *= weightOfProbe(probe, of.point, of.normal);
    return named;
}

vec3 candidateLight(uint probe, vec3 normal) { return probeIrradiance(probe, normal); }
vec3 blendedLight(vec3 mean) { return mean; }
#include "gather_light.glsl"
