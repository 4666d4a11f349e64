#version 460
#extension GL_GOOGLE_include_directive : require
#define SCONCE_LEAVES_LOOK_UPS
#include "light_field.glsl"
#include "lamps.glsl"
#include "gbuffer_read.glsl"
#include "tiles.glsl"
#include "lookups.glsl"

// Adds the light of the field's lamps, which is in none of the other passes, to each term of a pixel. No sample, no filter. Four pixels of one flat
// surface are lit as its middle is; edges of shadows and narrow reflections are left to the second dispatch.
// Dispatch: see lookups.glsl.
layout(local_size_x = 64) in;
layout(constant_id = kLampTermsId) const uint kTerms = 15u; // bit i: of term i
layout(constant_id = kLampEachId) const bool kEach = false; // normals differ from pixel to pixel of a look-up
layout(set = 1, binding = kLampDiffuseBinding, rgba16f) uniform image2D diffuse; // as the passes before it left them
layout(set = 1, binding = kLampRoughBinding, rgba16f) uniform image2D rough;
layout(set = 1, binding = kLampGlossyBinding, rgba16f) uniform image2D glossy;
layout(set = 1, binding = kLampMirrorBinding, rgba16f) uniform image2D mirror;

const float kNarrow = 0.25; // roughness below which a reflection of a lamp differs from pixel to pixel
const float kMostOfEdge = 0.15; // of half its width, that four pixels of one look-up span
const uint kReflections = (1u << kTermRough) | (1u << kTermGlossy) | (1u << kTermMirror);

struct FromLamp
{
    vec3 arriving;  // mean radiance, weighted by the cosine and by what the diffuse lobe reflects of it
    vec3 reflected;
};

/// What a pixel has of a lamp that it sees whole.
FromLamp fromLamp(Lamp lamp, Pixel p, vec3 point)
{
    TangentFrame tangents = tangentFrame(p.normal);
    LampCorners c = cornersFrom(lamp, point, tangents);
    float given = polygonIrradiance(c.a, c.b, c.c, c.d);
    if (!(given > 0.0)) return FromLamp(vec3(0.0), vec3(0.0));
    vec3 view = toTangent(tangents, p.view);
    view.z = max(view.z, 1e-4); // a shading normal may turn away from the eye
    view = normalize(view);
    float cosine = dot(p.normal, normalize(lamp.centre - point));
    return FromLamp(lamp.radiance * (given / kBrdfPi * diffuseAlong(cosine, p.brdf.roughness)),
                    lamp.radiance * polygonReflected(lobesAt(p.brdf, view.z), ggxAlpha(p.brdf.roughness), view, c.a, c.b, c.c, c.d));
}

void add(ivec2 at, uint terms, FromLamp light)
{
    // Of constants, so that no image is touched that is not made.
    if ((kTerms & (1u << kTermDiffuse)) != 0u && (terms & (1u << kTermDiffuse)) != 0u) imageStore(diffuse, at, storedLight(imageLoad(diffuse, at) + vec4(light.arriving, 0.0)));
    if ((kTerms & (1u << kTermRough)) != 0u && (terms & (1u << kTermRough)) != 0u) imageStore(rough, at, storedLight(imageLoad(rough, at) + vec4(light.reflected, 0.0)));
    if ((kTerms & (1u << kTermGlossy)) != 0u && (terms & (1u << kTermGlossy)) != 0u) imageStore(glossy, at, storedLight(imageLoad(glossy, at) + vec4(light.reflected, 0.0)));
    if ((kTerms & (1u << kTermMirror)) != 0u && (terms & (1u << kTermMirror)) != 0u) imageStore(mirror, at, storedLight(imageLoad(mirror, at) + vec4(light.reflected, 0.0)));
}

void main()
{
    LookUp l;
    if (!findLookUp(l)) return;
    Pixel p = readLookUp(l);
    uint terms = termsOf(p) & kTerms;
    if (terms == 0u) return;
    vec3 point = (p.position - field.origin) / field.scale;
    vec3 plane = geometricNormalAt(l.at, readPixel(l.at));
    if (dot(plane, plane) < 0.5) plane = p.normal;
    bool alone = l.pixels > 1 && (terms & kReflections) != 0u && p.brdf.roughness < kNarrow, later = alone;
    float seen[kMostLamps];
    for (uint i = 0u; i < kMostLamps; ++i)
    {
        seen[i] = 0.0;
        if (i >= lampCount) break;
        Lamp lamp = lampAt(i);
        LampShade shade = lampShade(lamp, point, plane);
        seen[i] = kIsRest && shade.seen < 0.0 ? seenOfLamp(lamp, shade) : shade.seen;
        if (seen[i] >= 0.0) continue;
        later = true;
        alone = alone || l.across > kMostOfEdge * field.scale * shade.receiver.at.z * min(shade.disc.x, shade.disc.y);
    }
    if (!kIsRest && later)
    {
        leave(l, alone);
        return;
    }
    FromLamp shared_ = FromLamp(vec3(0.0), vec3(0.0));
    for (uint i = 0u; i < lampCount && !kEach; ++i)
    {
        FromLamp own = fromLamp(lampAt(i), p, point);
        shared_.arriving += seen[i] * own.arriving;
        shared_.reflected += seen[i] * own.reflected;
    }
    bool reflects = (kTerms & kReflections) != 0u;
    vec3 tint = reflects ? tintOf(p) : vec3(1.0);
    for (int k = 0; k < l.pixels; ++k)
    {
        ivec2 at = pixelOf(l, k);
        FromLamp light = shared_;
        if (kEach)
        {
            Pixel q = readPixel(at);
            for (uint i = 0u; i < lampCount; ++i)
            {
                FromLamp own = fromLamp(lampAt(i), q, point);
                light.arriving += seen[i] * own.arriving;
                light.reflected += seen[i] * own.reflected;
            }
        }
        else if (reflects)
            light.reflected *= tintOf(readPixel(at)) / tint;
        add(at, terms, light);
    }
}
