// What a probe's texel shows, as a fragment shader that draws a probe's face writes it, a host's too, by sconce_probe_face.glsl (runtime/bake/probe_faces.h): one 4 x 32-bit texel
//   x  root of the surface's hemispherical albedo, 3 x 10 bits
//   y  shading normal, octahedral, 2 x 8 bits; of light straight from lights, the share that many normals leave and shareToAllSides(), 2 x 6 bits; the
//      grazing of takenAlong(), 4 bits: 12 steps of coats, 4 of metals
//   z  geometric normal, octahedral, 2 x 16 bits
//   w  emission, R11G11B10F
// Both normals face the probe.
#ifndef SCONCE_PROBE_FACE_GLSL
#define SCONCE_PROBE_FACE_GLSL
#include "shared/brdf.h"
#include "shared/chart.h"
#include "shared/color.h"

uint packSeen(vec3 normal, float together, float toAllSides, float grazing)
{
    uvec2 at = uvec2(octahedralFromDirection(normal) * 255.0 + 0.5), shares = uvec2(clamp(vec2(together, toAllSides), 0.0, 1.0) * 63.0 + 0.5);
    uint lean = uint(clamp(-grazing / kMostLean, 0.0, 1.0) * 4.0 + 0.5), coat = uint(clamp(grazing / kMostGrazing, 0.0, 1.0) * 11.0 + 0.5);
    return at.x | at.y << 8 | shares.x << 16 | shares.y << 22 | (lean > 0u ? 11u + lean : coat) << 28;
}

vec3 seenNormal(uint word) { return directionFromOctahedral(vec2(word & 255u, word >> 8 & 255u) / 255.0); }
float seenTogether(uint word) { return float(word >> 16 & 63u) / 63.0; }
float seenToAllSides(uint word) { return float(word >> 22 & 63u) / 63.0; }
float seenGrazing(uint word)
{
    uint code = word >> 28;
    return code > 11u ? float(code - 11u) * (-kMostLean / 4.0) : float(code) * (kMostGrazing / 11.0);
}

/// The geometric normal on the probe's side, unit.
/// @param relative  place from the probe, in any unit
/// @param across    of the triangle, of any length, to either side: cross(dFdx(relative), dFdy(relative)), taken before any discard
vec3 sconceProbeNormal(vec3 relative, vec3 across)
{
    float area = dot(across, across);
    vec3 geometric = area > 0.0 ? across * inversesqrt(area) : -normalize(relative); // edge-on: some finite normal
    return dot(geometric, relative) > 0.0 ? -geometric : geometric;
}

/// A surface of glTF's metallic-roughness model that a probe sees. Normals are of the world in which the scene is described: a host of another hand turns
/// its own.
struct SconceProbeSurface
{
    vec3 geometric; // sconceProbeNormal()
    vec3 normal;    // interpolated, unit, of either side
    vec3 shading;   // the same bent by a normal map, unit; without one, normal
    float together; // length of the mean of all normals that a normal map's texel stands for; without one, 1
    vec3 baseColor; // linear, [0,1]
    float metallic; // [0,1]
    float roughness; // [0,1]
    vec3 emission;  // W/(m^2 sr)
};

/// What the fragment shader writes of it.
uvec4 sconceProbeTexel(SconceProbeSurface s)
{
    vec3 shading = dot(s.normal, s.geometric) < 0.0 ? -s.shading : s.shading;
    BrdfSurface reflecting = BrdfSurface(clamp(s.baseColor, 0.0, 1.0), s.metallic, s.roughness);
    float grazing = grazingOfSurface(reflecting.metallic, reflecting.roughness, grazingOfRoughness(reflecting.roughness));
    // Of many normals each sees less of the hemisphere over their plane than their mean does, and less of a light along the mean.
    float ofAll = 0.5 + 0.5 * s.together;
    return uvec4(packRootOfColor(ofAll * hemisphericalAlbedo(reflecting)), packSeen(shading, s.together / ofAll, shareToAllSides(reflecting), grazing),
                 packUnorm2x16(octahedralFromDirection(s.geometric)), packRadiance(s.emission));
}

#endif
