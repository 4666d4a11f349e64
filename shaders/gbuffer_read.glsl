// A host's G-buffer as the passes read it.
#include "shared/frame.h"
#include "shared/frame_passes.h"
#include "shared/brdf.h"
#include "stored_light.glsl"

layout(set = 1, binding = kDepthBinding) uniform texture2D gDepth;           // r: reversed depth; 0 is the sky
layout(set = 1, binding = kNormalRoughnessBinding) uniform texture2D gNormalRoughness; // xyz: shading normal, world, unit; w: roughness, and kRetro
layout(set = 1, binding = kBaseColorMetallicBinding) uniform texture2D gBaseColorMetallic; // rgb linear, a metallic
layout(scalar, set = 1, binding = kFrameBinding) uniform SconceFrame { FrameView frame; };

struct Pixel
{
    bool surface;  // there is one; false too where the G-buffer's numbers are none
    vec4 clip;     // ndc and reversed depth, w 1
    vec3 position; // world, metres
    vec3 normal;   // on the viewer's side
    vec3 view;     // unit, towards the eye; of a retroreflective surface viewerOfLobes()
    bool retro;    // it is one
    BrdfSurface brdf;
};

float shareOfRays(float roughness) { return shareOfRays(roughness, frame.raysBelow); }
uint termsOf(Pixel p) { return p.surface ? termsOf(p.brdf, frame.raysBelow) : 0u; }

Pixel readPixel(ivec2 at)
{
    Pixel p;
    float depth = texelFetch(gDepth, at, 0).r;
    vec2 ndc = (vec2(at) + 0.5) / vec2(frame.size) * 2.0 - 1.0;
    p.clip = vec4(ndc, depth, 1.0);
    vec4 world = frame.worldFromClip * p.clip;
    p.position = world.xyz / world.w;
    vec4 normal = texelFetch(gNormalRoughness, at, 0);
    vec4 base = texelFetch(gBaseColorMetallic, at, 0);
    // A host's number that is none would spread by every filter, and index tables out of their bounds: such a pixel shows nothing. false for NaN
    float size = depth + dot(abs(normal), vec4(1.0)) + dot(abs(base), vec4(1.0));
    p.surface = depth > 0.0 && size < 1e3 && dot(normal.xyz, normal.xyz) > 0.25;
    p.normal = frame.fieldFromNormals * normal.xyz;
    p.retro = isRetroreflective(normal.w);
    p.view = viewerOfLobes(p.normal, normalize(frame.eye - p.position), p.retro);
    p.brdf.baseColor = base.rgb;
    p.brdf.metallic = base.a;
    p.brdf.roughness = roughnessOf(normal.w);
    return p;
}

/// Tells lobes apart: roughness, and kRetro as in the G-buffer.
float lobeOf(Pixel p) { return p.brdf.roughness + (p.retro ? kRetro : 0.0); }

float depthAt(ivec2 at) { return texelFetch(gDepth, clamp(at, ivec2(0), ivec2(frame.size) - 1), 0).r; }

vec3 worldAt(ivec2 at, float depth)
{
    vec4 world = frame.worldFromClip * vec4((vec2(at) + 0.5) / vec2(frame.size) * 2.0 - 1.0, depth, 1.0);
    return world.xyz / world.w;
}

const float kOffLine = 0.2;       // of a step of depth, up to which depths lie on a line
const float kDepthRounding = 1e-6; // of a depth

/// From a pixel to the one before or after it, the one whose depth goes on as that of the next but one: reversed depth is linear along a plane. 0 where
/// neither does.
vec3 alongSurface(ivec2 at, ivec2 step_, Pixel p)
{
    float before = depthAt(at - step_), after = depthAt(at + step_);
    float offBefore = abs(2.0 * before - depthAt(at - 2 * step_) - p.clip.z), offAfter = abs(2.0 * after - depthAt(at + 2 * step_) - p.clip.z);
    // Outside of the picture there is no pixel.
    if (any(lessThan(at, 2 * step_))) offBefore = 1e30;
    if (any(greaterThanEqual(at + 2 * step_, ivec2(frame.size)))) offAfter = 1e30;
    bool isBefore = offBefore < offAfter;
    float change = abs((isBefore ? before : after) - p.clip.z);
    if (min(offBefore, offAfter) > kOffLine * change + kDepthRounding * p.clip.z) return vec3(0.0);
    return isBefore ? p.position - worldAt(at - step_, before) : worldAt(at + step_, after) - p.position;
}

/// Normal of the surface itself, from depth, on the viewer's side: where the shading normal is bent far off it. 0 where depth doesn't tell. Cost: 8 reads.
vec3 geometricNormalAt(ivec2 at, Pixel p)
{
    vec3 across = cross(alongSurface(at, ivec2(1, 0), p), alongSurface(at, ivec2(0, 1), p));
    float size = length(across);
    if (!(size > 0.0 && size < 1e30)) return vec3(0.0);
    return across * ((dot(across, frame.eye - p.position) < 0.0 ? -1.0 : 1.0) / size);
}

/// Of a pixel, to ask how much others show the same surface.
struct Surroundings
{
    vec4 plane; // of clip space, not normalised; over the plane's point, in hundredths of the distance to the eye
    vec4 w;     // worldFromClip's last row
    vec3 normal;
    float lobe; // lobeOf()
};

Surroundings surroundingsOf(Pixel p)
{
    Surroundings s;
    s.plane = vec4(p.normal, -dot(p.normal, p.position)) * frame.worldFromClip * (100.0 / distance(p.position, frame.eye));
    s.w = vec4(0.0, 0.0, 0.0, 1.0) * frame.worldFromClip;
    s.normal = p.normal;
    s.lobe = lobeOf(p);
    return s;
}

/// How much a pixel shows the same surface, [0,1]: 0 across edges of depth, of the shading normal and of its lobe.
float likeness(Surroundings s, Pixel q)
{
    float plane = dot(s.plane, q.clip) / dot(s.w, q.clip);
    float rough = (s.lobe - lobeOf(q)) * 8.0;
    float facing = max(dot(s.normal, q.normal), 0.0);
    facing *= facing, facing *= facing, facing *= facing, facing *= facing; // to the 16th
    return exp(-plane * plane - rough * rough) * facing * facing;
}

/// Pixels that the filter of reflections reaches: as far as their lobe blurs.
float filterReach(float roughness) { return kFilterReach * clamp(2.5 * roughness - 0.05, 0.0, 1.0); }

/// What a surface makes of white light that comes along its reflection: what a filter divides by, to leave its texture alone.
vec3 tintOf(Pixel p) { return max(specularColor(lobesAt(p.brdf, dot(p.normal, p.view))), vec3(1e-3)); }
