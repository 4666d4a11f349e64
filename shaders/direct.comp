#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#define SCONCE_SUN_LEVELS int(lightsHeader.sunLevels)
#include "lights.glsl"
#include "gbuffer_read.glsl"
#include "shared/chart.h"

// Direct light of the frame: what a surface emits, and the shadowed light of the sun and of punctual lights; the sky where nothing is.
// Emitters and the sky light surfaces through the light field. Dispatch: ceil(width/8) x ceil(height/8).
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 1, binding = kDirectNormalBinding) uniform utexture2D gGeometricNormal;
layout(set = 1, binding = kDirectLightBinding, rgba16f) uniform image2D direct; // radiance to the eye, storedBright(); what is emitted is in it
layout(scalar, push_constant) uniform Push { DirectPush push; };

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(frame.size)))) return;
    Pixel p = readPixel(at);
    vec3 light = push.sky;
    if (p.surface)
    {
        light = brightLight(imageLoad(direct, at));
        vec3 geometric = directionFromOctahedral(unpackUnorm2x16(texelFetch(gGeometricNormal, at, 0).x));
        vec3 point = (p.position - push.origin) / push.scale;
        BrdfLobes lobes = lobesAt(p.brdf, dot(p.normal, p.view));
        for (uint i = 0u; i < push.lightCount; ++i)
        {
            LightSample s = lightAt(lights[i].type, i, point, geometric);
            BrdfValue f = evaluateLobes(lobes, p.brdf.roughness, p.normal, p.view, s.toLight);
            light += s.irradiance * max(dot(p.normal, s.toLight), 0.0) * (f.diffuse + f.specular);
        }
    }
    imageStore(direct, at, storedBright(light));
}
