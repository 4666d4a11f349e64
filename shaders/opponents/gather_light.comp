#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"
#include "gbuffer_read.glsl"
#include "tiles.glsl"
#include "lookups.glsl"
#include "opponents/grid_light.glsl"

struct Candidates
{
    GridCell cell;
    vec3 point; // field space
    vec3 normal;
    vec3 view;
    int corner; // the next one
};

Candidates candidatesAt(ivec2 at, Pixel p, vec3 point, TangentFrame tangents)
{
    return Candidates(gridCellOf(gridBiased(point, p.normal, p.view)), point, p.normal, p.view, canGather(point, p.normal) ? 0 : kGridCorners);
}

bool nextCandidate(inout Candidates of, out uint probe, out float weight)
{
    weight = 0.0;
    probe = kNoProbe;
    while (of.corner < kGridCorners && !(weight > 0.0)) weight = gridWeight(of.cell, of.corner++, of.point, of.normal, of.view, probe);
    return weight > 0.0;
}

vec3 candidateLight(uint probe, vec3 normal) { return probeIrradiance(probe, normal); }
vec3 blendedLight(vec3 mean) { return mean; }
#include "gather_light.glsl"
