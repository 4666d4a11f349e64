// Direct light from the list of lights, shadowed by their maps. Points and normals in field space. Define SCONCE_SUN_LEVELS to how many maps of a
// directional light are read (1 when undefined: that of the whole scene).
#ifndef SCONCE_LIGHTS_GLSL
#define SCONCE_LIGHTS_GLSL
#include "scene.glsl"
#include "shared/brdf.h"
#include "shared/delta_light.h"
#include "shared/chart.h"
#ifndef SCONCE_SUN_LEVELS
#define SCONCE_SUN_LEVELS 1
#endif

struct LightSample
{
    vec3 toLight;    // unit
    vec3 irradiance; // on a surface that faces the light, W/m^2; shadowed
};

/// The light of entry i at a point, without its shadow.
/// @param kind  lights[i].type; a constant where the caller knows it, so that nothing of other kinds is in its way: software Vulkan (Mesa 22.3) takes
///              every branch of a condition that it doesn't know
LightSample unshadowedLight(uint kind, uint i, vec3 p)
{
    GpuLight light = lights[i];
    LightSample s;
    if (kind == kLightEmitter)
    {
        vec3 away = light.position - p;
        float d2 = max(dot(away, away), 1e-14);
        s.toLight = away * inversesqrt(d2);
        s.irradiance = light.intensity * patchAttenuation(-dot(s.toLight, light.direction), d2, light.area, light.area, light.innerCone > 0.0);
        return s;
    }
    DeltaLight delta = deltaLightAt(light, kind == kLightSky ? kLightDirectional : kind, p, 0.0);
    s.toLight = delta.toLight;
    s.irradiance = delta.irradiance;
    return s;
}

const float kSteepest = 0.05; // cosine to the light below which a plane counts as no steeper
const float kWithinFiner = 0.495; // of a finer map's width to either side of its middle
const float kPlaneSlack = 0.1; // texels, along a plane and towards the light, that its depth may be off by

/// Of a directional light: each of the map's four texels about the point is compared with the depth that the receiver's own plane has there
/// (receiver plane depth bias, Isidoro 2006, "Shadow Mapping: GPU-based Tips and Techniques"). A receiver that is moved off its plane instead is
/// lit under every ledge that a low sun should shade: by three times as much as it is moved, at 20 degrees.
float sunVisibility(GpuLight light, vec3 p, vec3 normal)
{
    vec4 q = vec4(p, 1.0);
    vec3 at = vec3(dot(light.shadowX, q), dot(light.shadowY, q), dot(light.shadowDepth, q));
    // The finest map whose filter lies in it all.
    vec4 eye = vec4(lightsHeader.eye, 1.0);
    vec2 off = at.xy - vec2(dot(light.shadowX, eye), dot(light.shadowY, eye));
    float finer = 1.0, finest = 1.0;
    int level = 0;
    for (int l = 1; l < SCONCE_SUN_LEVELS; ++l)
    {
        finer *= kFinerSun;
        vec2 within = abs(off * finer);
        if (!(max(within.x, within.y) <= kWithinFiner)) break;
        level = l;
        finest = finer;
    }
    if (level > 0) at.xy = off * finest + 0.5;
    vec3 x = finest * light.shadowX.xyz, y = finest * light.shadowY.xyz, depth = light.shadowDepth.xyz;
    float deep = length(depth), facing = max(dot(depth, normal) / deep, kSteepest);
    vec2 slope = -vec2(dot(x, normal) / dot(x, x), dot(y, normal) / dot(y, y)) * (deep / facing); // depth over map
    vec2 size = vec2(textureSize(sconceSunShadows, 0).xy);
    float slack = 1e-6 + kPlaneSlack * (dot(abs(slope), 1.0 / size) + deep * light.shadowTexel / finest);
    vec2 low = floor(at.xy * size - 0.5), f = at.xy * size - 0.5 - low;
    float lit[4];
    for (int tap = 0; tap < 4; ++tap)
    {
        vec2 texel = (low + vec2(tap & 1, tap >> 1) + 0.5) / size;
        lit[tap] = texture(sconceSunShadows, vec4(texel, float(light.shadowLayer + level), at.z + dot(slope, texel - at.xy) + slack));
    }
    return mix(mix(lit[0], lit[1], f.x), mix(lit[2], lit[3], f.x), f.y);
}

/// Share of the light of entry i that reaches a point. But for directional lights the receiver is moved along its normal by as much as its plane rises over the
/// filter's footprint (Holbert 2011, "Saying Goodbye to Shadow Acne": normal offset grows with the sine of the angle): the angle to the
/// map's axis, for it is along the map's plane that the footprint lies.
float lightVisibility(uint kind, uint i, vec3 p, vec3 geometricNormal, vec3 toLight)
{
    GpuLight light = lights[i];
    if (kind == kLightDirectional) return sunVisibility(light, p, geometricNormal);
    if (kind == kLightSky)
    {
        float c = dot(geometricNormal, toLight);
        float s = sqrt(max(0.0, 1.0 - c * c));
        vec4 q = vec4(p + (1.5 * s + 0.1) * light.shadowTexel * geometricNormal, 1.0);
        vec3 at = vec3(dot(light.shadowX, q), dot(light.shadowY, q), dot(light.shadowDepth, q));
        return texture(sconceSkyShadows, vec4(at.xy, float(light.shadowLayer), at.z + 5e-5)); // D16
    }
    vec3 from = p - light.position;
    int face = dominantFace(from);
    float along = faceCoordinates(face, geometricNormal).z;
    from += (1.5 * sqrt(max(0.0, 1.0 - along * along)) + 0.1) * light.shadowTexel * faceCoordinates(face, from).z * geometricNormal;
    face = dominantFace(from);
    vec3 uvw = faceCoordinates(face, from);
    if (uvw.z <= lightsHeader.pointNear) return 1.0; // nothing is nearer than the maps' near plane
    vec2 at = 0.5 * uvw.xy / uvw.z + 0.5;
    vec4 coordinate = vec4(at, float(light.shadowLayer + face), lightsHeader.pointNear / uvw.z * 1.0005);
    if (kind == kLightEmitter) return texture(sconceEmitterShadows, coordinate);
    return texture(sconcePointShadows, coordinate);
}

/// The light of entry i at a surface point, shadowed; irradiance is 0 where the surface's true side is turned away.
/// @param geometricNormal  unit, on the side that is looked at
LightSample lightAt(uint kind, uint i, vec3 p, vec3 geometricNormal)
{
    LightSample s = unshadowedLight(kind, i, p);
    if (dot(geometricNormal, s.toLight) <= 0.0 || all(equal(s.irradiance, vec3(0.0))))
    {
        s.irradiance = vec3(0.0);
        return s;
    }
    s.irradiance *= lightVisibility(kind, i, p, geometricNormal, s.toLight);
    return s;
}

vec3 directLightOf(uint kind, uint i, vec3 p, vec3 shadingNormal, vec3 geometricNormal)
{
    LightSample s = lightAt(kind, i, p, geometricNormal);
    return max(dot(shadingNormal, s.toLight), 0.0) * s.irradiance;
}

/// Irradiance of a surface from lights of no extent, W/m^2, as much as its diffuse lobe takes, or a rough metal sends on: see takenAlong().
vec3 deltaLight(vec3 p, vec3 shadingNormal, vec3 geometricNormal, float grazing)
{
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < lightsHeader.deltaCount; ++i)
    {
        LightSample s = lightAt(lights[i].type, i, p, geometricNormal);
        float cosine = max(dot(shadingNormal, s.toLight), 0.0);
        sum += cosine * takenAlong(cosine, grazing) * s.irradiance;
    }
    return sum;
}

/// The same from emitters and sky, by their samples.
vec3 areaLight(vec3 p, vec3 shadingNormal, vec3 geometricNormal)
{
    vec3 sum = vec3(0.0);
    uint i = lightsHeader.deltaCount;
    uint emittersEnd = i + lightsHeader.emitterCount;
    for (; i < emittersEnd; ++i) sum += directLightOf(kLightEmitter, i, p, shadingNormal, geometricNormal);
    uint skyEnd = i + lightsHeader.skyCount;
    for (; i < skyEnd; ++i) sum += directLightOf(kLightSky, i, p, shadingNormal, geometricNormal);
    return sum;
}

#endif
