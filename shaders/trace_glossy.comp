#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"
#include "gbuffer_read.glsl"

// Glossy indirect light: GGX visible-normal rays from every surface pixel through the light field.
// Dispatch: ceil(width/8) x ceil(height/8).
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 1, binding = 4, rgba32f) writeonly uniform image2D glossy;  // rgb: radiance reflected to the eye; a: mean hit distance, metres
layout(set = 1, binding = 5, rgba32ui) writeonly uniform uimage2D counts; // probe of the last ray, hand-offs, reads, unknown rays

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(frame.size)))) return;
    Pixel p = readPixel(at);
    vec4 result = vec4(0.0);
    uvec4 count = uvec4(kNoProbe, 0u, 0u, 0u); // probe, hand-offs, distance + index reads, unknown rays
    if (p.surface)
    {
        TangentFrame tangents = tangentFrame(p.normal);
        vec3 view = toTangent(tangents, p.view);
        view.z = max(view.z, 1e-4); // a shading normal may turn away from the eye
        bool mirror = isMirror(p.brdf.roughness);
        uint rays = mirror ? 1u : frame.glossyRays;
        for (uint i = 0u; i < rays; ++i)
        {
            vec3 halfway = mirror ? vec3(0.0, 0.0, 1.0) : sampleVisibleNormal(normalize(view), ggxAlpha(p.brdf.roughness), randomPair(uvec2(at), i, 0u, frame.seed));
            vec3 direction = reflect(-view, halfway);
            if (direction.z <= 0.0) continue; // below the surface: no light
            vec3 fresnel = fresnelSchlick(reflectanceAtNormal(p.brdf), dot(view, halfway));
            // weight of a visible-normal sample: F G2 / G1 (Heitz 2018)
            float alpha = ggxAlpha(p.brdf.roughness);
            float weight = mirror ? 1.0 : 4.0 * view.z * direction.z * smithVisibility(direction.z, view.z, alpha) / max(smithMasking(view.z, alpha), 1e-6);
            RayHit hit = sconceQuery(p.position + frame.normalOffset * p.normal, normalize(toWorld(tangents, direction)));
            result += vec4(fresnel * weight * hit.radiance, hit.t);
            count.x = hit.probe;
            count.y += uint(hit.handoffs);
            count.z += uint(hit.distanceReads + hit.indexReads);
            count.w += hit.status == kUnknown ? 1u : 0u;
        }
        result /= float(rays);
    }
    imageStore(glossy, at, result);
    imageStore(counts, at, count);
}
