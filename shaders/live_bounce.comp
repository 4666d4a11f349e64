#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "light_field.glsl"
#include "live_texels.glsl"

// Live light: one bounce at a probe's texels: what arrives of what the texels send where the links lead, and what they send then.
// Dispatch: see live_texels.glsl.

void main()
{
    Texel t = texelOfInvocation();
    if (!t.inside) return;
    LiveTexel known = LiveTexels(push.live.data.texels).value[t.index];
    if ((known.normal & kSurfaceKnown) == 0u)
    {
        BakeWords(push.live.data.sentNext).word[t.index] = BakeWords(push.live.data.bounced).word[t.index] = 0u;
        return;
    }
    bool leans = field.surfaceDirections != 0u;
    SurfacePoint surface;
    vec3 normal = vec3(0.0, 0.0, 1.0);
    if (leans)
    {
        surface = surfacePointAt(t.probe, t.at.z, t.at.x, t.at.y);
        normal = surface.normal;
    }
    TangentFrame tangents = tangentFrame(normal);
    float grazing = unpackGrazing(known.normal);
    vec3 sum = vec3(0.0), slopes = vec3(0.0);
    Ends ends = Ends(0.0, 0.0, 0.0);
    for (uint i = 0u; i < push.links; ++i)
    {
        uint link = BakeWords(push.live.data.links).word[t.probe * push.links * texelsOfProbe() + i * texelsOfProbe() + t.ofProbe];
        if (!countEnd(ends, link)) continue;
        vec3 brought = broughtBy(link);
        sum += brought;
        if (leans) slopes += luminance(brought) * slopeOf(gatherDirection(tangents, pixelOfTexel(uvec3(t.at)), i, grazing), normal);
    }
    vec3 light = min(perRay(ends) * sum, vec3(kMostStored));
    BakeWords(push.live.data.bounced).word[t.index] = packSharedExponent(light);
    if (leans)
    {
        float all = luminance(sum);
        BakeWords(push.live.data.tilts).word[t.index] = packTilt(all > 0.0 ? alongPlane(slopes, normal) / all : vec2(0.0));
    }
    vec3 direct = unpackSharedExponent(BakeWords(push.live.data.direct).word[t.index]);
    BakeWords(push.live.data.sentNext).word[t.index] =
        packSharedExponent(min(min(unpackRootOfColor(known.albedo), vec3(kMostLiveAlbedo)) * light + unpackSharedExponent(known.direct) * direct, vec3(kMostStored)));
}
