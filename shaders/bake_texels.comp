#version 460
#extension GL_GOOGLE_include_directive : require
#include "bake_probe.glsl"

// Bake: what a bounce needs of each texel of the surface light, from the finer texels under it that lie on the surface in its middle.
// `push.radiance` holds emission and the direct light of what has no extent.
// Dispatch: ceil(surfaceSize/8) twice x 6.
layout(local_size_x = 8, local_size_y = 8) in;

const float kSamePlane = 0.02; // relative difference of depth up to which a texel lies on the plane; as surfelRadiance()'s

void main()
{
    uvec3 at = gl_GlobalInvocationID;
    if (at.x >= push.surfaceSize || at.y >= push.surfaceSize) return;
    uint index = (at.z * push.surfaceSize + at.y) * push.surfaceSize + at.x;
    float finer = float(push.size) / float(push.surfaceSize);
    uvec2 middle = uvec2((vec2(at.xy) + 0.5) * finer);
    uint first = at.z * push.faceWords, firstTexel = at.z * push.size * push.size;
    uint word = push.words.word[first + middle.y * push.size + middle.x];
    float q = halfToReal(word);
    if (!(q > 0.0))
    {
        push.texels.value[index] = SurfaceTexel(0u, 0u, 0u);
        return;
    }
    vec2 gradient = vec2(unpackGradient(word >> 16), unpackGradient(word >> 24));
    vec3 own = unpackNormal8(push.surface.word[firstTexel + middle.y * push.size + middle.x] >> 16);
    vec3 albedo = vec3(0.0), normal = vec3(0.0), sent = vec3(0.0);
    float count = 0.0;
    // Where the sides don't divide each other the middle may lie past the rounded end.
    uvec2 low = min(uvec2(vec2(at.xy) * finer), middle), high = max(uvec2(vec2(at.xy + 1u) * finer), middle + 1u);
    for (uint y = low.y; y < high.y; ++y)
        for (uint x = low.x; x < high.x; ++x)
        {
            vec2 off = vec2(x, y) - vec2(middle);
            float expected = q * (1.0 + dot(gradient, off));
            float seen = halfToReal(push.words.word[first + y * push.size + x]);
            uint texel = firstTexel + y * push.size + x;
            uint surface = push.surface.word[texel];
            vec3 facing = unpackNormal8(surface >> 16);
            if (off != vec2(0.0) && (abs(seen - expected) > kSamePlane * q || dot(facing, own) < 0.7)) continue;
            vec3 emitted = isNull(push.emitted) ? vec3(0.0) : unpackRadiance(push.emitted.word[texel]);
            albedo += unpackAlbedo(surface);
            normal += facing;
            sent += max(unpackRadiance(push.radiance.word[texel]) - emitted, vec3(0.0));
            count += 1.0;
        }
    uint facing = packNormal8(normalize(normal)) | kSurfaceKnown;
    // What the surface sends of the light on its plane: less the more its normals spread, by textures, as each sees less of the hemisphere.
    float share = min(0.5 + 0.5 * length(normal) / count, 1.0);
    push.texels.value[index] = SurfaceTexel(packRootOfColor(share * albedo / count), facing, packSharedExponent(sent / count));
}
