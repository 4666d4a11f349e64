#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "light_field.glsl"
#include "live_texels.glsl"

// Live light: a probe's bounced light, blended with that of texels about it on the same surface, as surface_filter.comp blends; its share of the surface
// light, and what rays find. Dispatch: see live_texels.glsl.

shared uint leaning[64];

void main()
{
    Texel t = texelOfInvocation();
    vec3 light = vec3(0.0);
    vec2 tilt = vec2(0.0);
    LiveTexel known = LiveTexel(0u, 0u, 0u);
    if (t.inside) known = LiveTexels(push.live.data.texels).value[t.index];
    if ((known.normal & kSurfaceKnown) != 0u)
    {
        SurfacePoint own = surfacePointAt(t.probe, t.at.z, t.at.x, t.at.y);
        uint code = (known.normal >> kReachShift) & kReachMask;
        float reach = max(code != 0u ? kReachOfDistance * unpackReach(code) : 0.0, kLeastReach * own.width), weights = 0.0;
        for (int dy = -2; dy <= 2; ++dy)
            for (int dx = -2; dx <= 2; ++dx)
            {
                ivec2 at = t.at.xy + ivec2(dx, dy);
                if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(int(field.surfaceSize))))) continue;
                uint there = surfaceIndex(t.probe, t.at.z, at.x, at.y);
                if (((LiveTexels(push.live.data.texels).value[there].normal >> kReachShift) & kReachMask) == 0u) continue;
                SurfacePoint other = surfacePointAt(t.probe, t.at.z, at.x, at.y);
                if (!isSameSurface(own.at, own.normal, other, kSurfaceBend)) continue;
                vec3 to = other.at - own.at, theirs = unpackSharedExponent(BakeWords(push.live.data.bounced).word[there]);
                float weight = exp(-0.5 * dot(to, to) / (reach * reach));
                light += weight * theirs;
                weights += weight;
                if (field.surfaceDirections != 0u) tilt += weight * luminance(theirs) * unpackTilt(BakeWords(push.live.data.tilts).word[there]);
            }
        float bright = luminance(light);
        tilt = bright > 0.0 ? tilt / bright : vec2(0.0);
        light = weights > 0.0 ? light / weights : vec3(0.0);
    }
    leaning[gl_LocalInvocationIndex] = packTilt(tilt);
    barrier(); // two tilts make a word
    if (!t.inside) return;
    BakeWords(push.live.data.surface).word[t.index] = packKnownLight(light);
    BakeWords(push.live.data.incident).word[t.index] = packSharedExponent(min(light + unpackSharedExponent(BakeWords(push.live.data.direct).word[t.index]), vec3(kMostStored)));
    if (field.surfaceDirections != 0u && (t.index & 1u) == 0u)
        BakeWords(push.live.data.surface).word[surfaceTexels() + t.index / 2u] = leaning[gl_LocalInvocationIndex] | (leaning[gl_LocalInvocationIndex + 1u] << 16);
}
