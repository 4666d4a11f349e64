// A uniform grid's light as its authors blend it: the eight corners of a point's cell, by SCONCE_GRID_WEIGHTS
//   2017  McGuire et al. 2017, "Real-Time Global Illumination using Precomputed Light Field Probes", as their supplement weighs
//   2021  Majercik et al. 2019, "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields", and 2021, "Scaling Probe-Based Real-Time
//         Dynamic Global Illumination for Production"; and what ours has, of every method the same: a probe that a surface hides has no say
#include "opponents/baseline.h"
#include "opponents/grid_cell.glsl"
layout(constant_id = kGridBiasId) const float kGridBias = kLookUpBias; // metres along the normal (Majercik et al. 2021)
layout(constant_id = kGridBiasViewId) const float kGridBiasView = kLookUpBias; // and towards the viewer

/// Where a point's light is looked up: off the surface, or it would be the surface that hides it. 2017 knew no bias.
vec3 gridBiased(vec3 point, vec3 normal, vec3 view)
{
    if (SCONCE_GRID_WEIGHTS == 2017) return point;
    return point + (kGridBias * normal + kGridBiasView * view) / field.scale;
}

/// Chebyshev's bound on what of a probe's light comes as far as a point (McGuire et al. 2017, section 5.2).
float gridVisibility(uint probe, vec3 fromProbe, float away)
{
    vec2 moments = probeMoments(probe, fromProbe / away);
    if (away <= moments.x) return 1.0;
    float beyond = away - moments.x, variance = max(moments.y, 1e-9);
    return variance / (variance + beyond * beyond);
}

/// The probe of a corner (bits xyz) and its weight; 0 for a corner beyond the grid.
float gridWeight(GridCell cell, int corner, vec3 point, vec3 normal, vec3 view, out uint probe)
{
    vec3 part;
    if (!gridCorner(cell, corner, probe, part)) return 0.0;
    vec3 centre = probeHeader(probe).centre;
    vec3 toProbe = centre - point;
    vec3 direction = toProbe / max(length(toProbe), 1e-6);
    if (SCONCE_GRID_WEIGHTS == 2017)
    {
        float away = max(length(toProbe), 1e-6);
        float weight = part.x * part.y * part.z * max(0.05, dot(direction, normal)) * gridVisibility(probe, -toProbe, away);
        return max(weight, 0.0002);
    }
    vec3 fromProbe = gridBiased(point, normal, view) - centre;
    float away = max(length(fromProbe), 1e-6);
    part = max(part, 0.001);
    float wrap = 0.5 * dot(direction, normal) + 0.5;
    float visible = gridVisibility(probe, fromProbe, away);
    float weight = (wrap * wrap + 0.2) * max(visible * visible * visible, 0.05);
    if (hiddenFromProbe(probe, fromProbe)) weight = 0.0;
    weight = max(weight, 1e-6);
    if (weight < 0.2) weight *= weight * weight / 0.04; // what is nearly dark is darker, without a step
    return max(weight, 1e-9) * part.x * part.y * part.z;
}
