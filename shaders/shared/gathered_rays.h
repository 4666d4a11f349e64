// The rays that gather light at a place: their directions and what they ended at. Shared text, see probe_trace.h; needs brdf_text.h and surface_light.h besides. All places
// draw the same numbers, so that the order of probes changes nothing, and what a ray brought can be asked for its direction later.
SCONCE_CONST uint kGatherStream = 6u;

/// A texel's grazing, from 8 bits of its SurfaceTexel::normal: a sign, and how much.
SCONCE_PURE uint packGrazing(real grazing)
{
    real most = grazing < real(0.0) ? -kMostLean : kMostGrazing;
    return (uint(real(127.0) * between0And1(grazing / most) + real(0.5)) | (grazing < real(0.0) ? 128u : 0u)) << 24;
}
SCONCE_PURE real unpackGrazing(uint normal)
{
    return real((normal >> 24) & 127u) * (((normal >> 31) != 0u ? -kMostLean : kMostGrazing) / real(127.0));
}

/// The cosine below which a share of all light is taken that comes evenly from the hemisphere: its share is found by Newton's steps.
SCONCE_PURE real cosineTaken(real share, real grazing)
{
    real c = sqrt(share);
    for (int step = 0; step < 4; ++step)
    {
        real away = real(1.0) - c;
        real sixth = fifthPower(away) * away;
        real below = c * c + grazing * ((c * c - real(1.0)) / real(21.0) + sixth * (real(1.0) / real(3.0) - away * (real(2.0) / real(7.0))));
        c = between0And1(c - (below - share) / max(real(2.0) * c * takenAlong(c, grazing), real(0.02)));
    }
    return c;
}

/// Weighted by the cosine about the tangents' normal, and by what a coat takes of light along it. Metals' light is kept as it arrives, for hosts that ask for it.
SCONCE_FN vec3 gatherDirection(SCONCE_IN(TangentFrame) tangents, uvec2 pixel, uint i, real grazing)
{
    vec2 lots = pairOfRay(pixel, i, kGatherStream);
    if (grazing > real(0.0))
    {
        real c = cosineTaken(real(1.0) - lots.x, grazing);
        lots.x = real(1.0) - c * c;
    }
    return normalize(toWorld(tangents, sampleCosine(lots)));
}
/// That a texel's random numbers are drawn by.
SCONCE_FN uvec2 pixelOfTexel(uvec3 at) { return uvec2(at.x + field.surfaceSize * at.z, at.y); }

/// What a ray's radiance adds to a tilt: the slope of the direction along the plane.
SCONCE_FN vec3 slopeOf(vec3 direction, vec3 normal)
{
    real cosine = dot(direction, normal);
    return (direction - cosine * normal) / max(cosine, real(1.0) / kMostSlope);
}

/// How many rays ended somewhere, at surfaces, and at surfaces whose light is known.
struct Ends
{
    real all, surfaces, known;
};

/// @return  whether the link is a texel
SCONCE_FN bool countEnd(SCONCE_INOUT(Ends) ends, uint link)
{
    if (link == kLinkNone) return false;
    ends.all += real(1.0);
    if (link == kLinkSky) return false;
    ends.surfaces += real(1.0);
    if (link == kLinkSurface) return false;
    ends.known += real(1.0);
    return link != kLinkDark;
}

/// Of a link that is a texel: its index, and which colour the ray was reflected in.
SCONCE_FN uint texelOfLink(uint link) { return link & ((1u << kLinkTexelBits) - 1u); }
SCONCE_FN uint tintOfLink(uint link) { return link >> kLinkTexelBits; }

/// Of a sum over the known surfaces the share of all rays: surfaces whose light isn't known send what the others send.
SCONCE_FN real perRay(SCONCE_IN(Ends) ends) { return ends.surfaces / (max(ends.known, real(1.0)) * max(ends.all, real(1.0))); }

/// Whether so few ends are known that nothing is of the light.
SCONCE_FN bool knowsTooLittle(SCONCE_IN(Ends) ends, real asked) { return ends.all - ends.surfaces + ends.known < real(0.5) * asked; }

/// Variance of a share of tries that came out; as if half a try more had and half a one hadn't, since none of a few is not none of all.
SCONCE_FN real varianceOfShare(real came, real tries)
{
    real share = (came + real(0.5)) / (tries + real(1.0));
    return share * (real(1.0) - share) / max(tries, real(1.0));
}

/// A texel of a probe that shows a point, drawn among the four about it by their weights; else the nearest of the same surface; else kLinkSurface.
/// @param point  relative to the probe's centre
SCONCE_FN uint texelShowing(uint probe, vec3 point, vec3 normal, real lot)
{
    int face = dominantFace(point);
    vec3 uvw = faceCoordinates(face, point);
    uint found = kLinkSurface;
    if (!(uvw.z > real(1e-6))) return found;
    real middle = real(0.5) * real(field.surfaceSize);
    real px = middle * (uvw.x / uvw.z + real(1.0)) - real(0.5);
    real py = middle * (uvw.y / uvw.z + real(1.0)) - real(0.5);
    int x0 = clamp(int(floor(px)), 0, int(field.surfaceSize) - 2);
    int y0 = clamp(int(floor(py)), 0, int(field.surfaceSize) - 2);
    real fx = clamp(px - real(x0), real(0.0), real(1.0));
    real fy = clamp(py - real(y0), real(0.0), real(1.0));
    real weights = real(0.0);
    for (int tap = 0; tap < 4; ++tap)
    {
        int x = x0 + (tap & 1);
        int y = y0 + (tap >> 1);
        real weight = ((tap & 1) != 0 ? fx : real(1.0) - fx) * ((tap >> 1) != 0 ? fy : real(1.0) - fy);
        if (!(weight > real(0.0)) || !isSameSurface(point, normal, surfacePointAt(probe, face, x, y), kSurfaceBend)) continue;
        weights += weight;
        real share = weight / weights;
        if (lot < share)
        {
            found = surfaceIndex(probe, face, x, y);
            lot /= share;
        }
        else lot = (lot - share) / (real(1.0) - share);
    }
    if (found != kLinkSurface) return found;
    found = nearestSurfaceTexel(probe, point, normal);
    return found == kNoTexel ? kLinkSurface : found;
}
