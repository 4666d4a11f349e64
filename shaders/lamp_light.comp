#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"
#include "lamps.glsl"
#include "gbuffer_read.glsl"

// Adds the light of the field's lamps, which is in none of the other passes, to each term of a pixel. No sample, no filter.
// Dispatch: ceil(width/8) x ceil(height/8).
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kLampTermsId) const uint kTerms = 15u; // bit i: of term i
layout(set = 1, binding = kLampDiffuseBinding, rgba32f) uniform image2D diffuse; // as the passes before it left them
layout(set = 1, binding = kLampRoughBinding, rgba32f) uniform image2D rough;
layout(set = 1, binding = kLampGlossyBinding, rgba32f) uniform image2D glossy;
layout(set = 1, binding = kLampMirrorBinding, rgba32f) uniform image2D mirror;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(frame.size)))) return;
    Pixel p = readPixel(at);
    uint terms = termsOf(p) & kTerms;
    if (terms == 0u) return;
    vec3 point = (p.position - field.origin) / field.scale;
    vec3 plane = geometricNormalAt(at, p);
    if (dot(plane, plane) < 0.5) plane = p.normal;
    TangentFrame tangents = tangentFrame(p.normal);
    vec3 view = toTangent(tangents, p.view);
    view.z = max(view.z, 1e-4); // a shading normal may turn away from the eye
    view = normalize(view);
    BrdfLobes lobes = lobesAt(p.brdf, view.z);
    vec3 arriving = vec3(0.0), reflected = vec3(0.0);
    for (uint i = 0u; i < lampCount; ++i)
    {
        Lamp lamp = lampAt(i);
        LampCorners c = cornersFrom(lamp, point, tangents);
        float given = polygonIrradiance(c.a, c.b, c.c, c.d);
        if (!(given > 0.0)) continue;
        vec3 seen = lamp.radiance * lampVisibility(lamp, point, plane);
        float cosine = dot(p.normal, normalize(lamp.centre - point));
        arriving += seen * (given / kBrdfPi * diffuseAlong(cosine, p.brdf.roughness));
        if ((terms & ~(1u << kTermDiffuse)) != 0u) reflected += seen * polygonReflected(lobes, ggxAlpha(p.brdf.roughness), view, c.a, c.b, c.c, c.d);
    }
    if ((terms & (1u << kTermDiffuse)) != 0u) imageStore(diffuse, at, imageLoad(diffuse, at) + vec4(arriving, 0.0));
    if ((terms & (1u << kTermRough)) != 0u) imageStore(rough, at, imageLoad(rough, at) + vec4(reflected, 0.0));
    if ((terms & (1u << kTermGlossy)) != 0u) imageStore(glossy, at, imageLoad(glossy, at) + vec4(reflected, 0.0));
    if ((terms & (1u << kTermMirror)) != 0u) imageStore(mirror, at, imageLoad(mirror, at) + vec4(reflected, 0.0));
}
