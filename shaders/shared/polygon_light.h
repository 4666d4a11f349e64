// Light of a flat polygon of up to four corners that shines evenly, without what stands before it. Shared text, see texel.h; needs brdf_text.h.
// Corners are relative to the lit point, in its tangent space (z along the normal); of a triangle one comes twice.
#if defined(__cplusplus) || !defined(SCONCE_POLYGON_LIGHT)
#define SCONCE_POLYGON_LIGHT

/// What an edge between directions of any length adds to twice the mean direction of a polygon's solid angle: the angle between them, along
/// their common normal (Lambert 1760, "Photometria"; Baum, Rushmeier and Winget 1989, "Improving Radiosity Solutions through the Use of
/// Analytically Determined Form-factors").
SCONCE_PURE vec3 edgeOfPolygon(vec3 from, vec3 to)
{
    vec3 across = cross(from, to);
    real size = sqrt(dot(across, across));
    return size > real(1e-30) ? across * (atan(size, dot(from, to)) / size) : vec3(real(0.0));
}

/// The same between corners a and b, of what is above the horizon: `leaves` and `returns` become where the edge crosses it.
SCONCE_PURE real edgeAboveHorizon(vec3 a, vec3 b, SCONCE_INOUT(vec3) leaves, SCONCE_INOUT(vec3) returns)
{
    bool aAbove = a.z > real(0.0);
    bool bAbove = b.z > real(0.0);
    if (!aAbove && !bAbove) return real(0.0);
    if (aAbove && bAbove) return edgeOfPolygon(a, b).z;
    vec3 crossing = a + (a.z / (a.z - b.z)) * (b - a);
    if (aAbove)
    {
        leaves = crossing;
        return edgeOfPolygon(a, crossing).z;
    }
    returns = crossing;
    return edgeOfPolygon(crossing, b).z;
}

/// Irradiance over radiance of a convex polygon, [0, pi]; what is below the horizon is cut off.
SCONCE_PURE real polygonIrradiance(vec3 a, vec3 b, vec3 c, vec3 d)
{
    vec3 leaves = vec3(real(0.0));
    vec3 returns = vec3(real(0.0));
    real sum = edgeAboveHorizon(a, b, leaves, returns) + edgeAboveHorizon(b, c, leaves, returns);
    sum += edgeAboveHorizon(c, d, leaves, returns) + edgeAboveHorizon(d, a, leaves, returns);
    sum += edgeOfPolygon(leaves, returns).z; // along the horizon
    return abs(sum) * real(0.5);
}

/// Half vector of a viewer and a corner, as a direction of the space in which the lobe's normals lie as a cosine does.
SCONCE_PURE vec3 cornerInLobe(vec3 corner, vec3 view, real alpha)
{
    corner.z = corner.z > real(0.0) ? corner.z : real(0.0); // what is below the horizon sends nothing
    vec3 halfway = view + corner / sqrt(dot(corner, corner) + real(1e-30));
    return vec3(halfway.x / alpha, halfway.y / alpha, halfway.z);
}

/// Twice the mean direction of a polygon's half vectors, in the space of cornerInLobe(), z >= 0.
SCONCE_PURE vec3 polygonInLobe(real alpha, vec3 view, vec3 a, vec3 b, vec3 c, vec3 d)
{
    vec3 p = cornerInLobe(a, view, alpha);
    vec3 q = cornerInLobe(b, view, alpha);
    vec3 r = cornerInLobe(c, view, alpha);
    vec3 s = cornerInLobe(d, view, alpha);
    vec3 sum = edgeOfPolygon(p, q) + edgeOfPolygon(q, r) + edgeOfPolygon(r, s) + edgeOfPolygon(s, p);
    return sum.z < real(0.0) ? -sum : sum;
}

/// Share of the specular lobe's normals that reflect a polygon to a viewer, [0,1].
/// @param view  unit, z > 0
SCONCE_PURE real polygonOfLobe(real alpha, vec3 view, vec3 a, vec3 b, vec3 c, vec3 d)
{
    if (a.z <= real(0.0) && b.z <= real(0.0) && c.z <= real(0.0) && d.z <= real(0.0)) return real(0.0);
    return min(polygonInLobe(alpha, view, a, b, c, d).z / (real(2.0) * kBrdfPi), real(1.0));
}

/// Radiance over the polygon's that the specular lobe reflects to a viewer. GGX's normals are a cosine's, stretched by alpha (Walter et al. 2007,
/// "Microfacet Models for Refraction through Rough Surfaces", equation 35), so that their share in a polygon of half vectors is that polygon's
/// irradiance where it is shrunk again: a linearly transformed cosine (Heitz et al. 2016, "Real-Time Polygonal-Light Shading with Linearly
/// Transformed Cosines") without a table, in half vectors in place of directions. All else of the lobe is taken from the mean half vector of that
/// share. Error: within 1 % for a polygon 0.02 radians wide, 4 % for one of 0.1, 10 % for one of 0.3, whose half vectors have bent edges.
/// @param view  unit, z > 0
SCONCE_PURE vec3 polygonReflected(BrdfLobes lobes, real alpha, vec3 view, vec3 a, vec3 b, vec3 c, vec3 d)
{
    if (a.z <= real(0.0) && b.z <= real(0.0) && c.z <= real(0.0) && d.z <= real(0.0)) return vec3(real(0.0));
    vec3 sum = polygonInLobe(alpha, view, a, b, c, d);
    real share = sum.z / (real(2.0) * kBrdfPi);
    vec3 halfway = vec3(sum.x * alpha, sum.y * alpha, sum.z);
    real size = sqrt(dot(halfway, halfway));
    if (!(size > real(1e-30))) return vec3(real(0.0));
    halfway = halfway / size;
    real vh = dot(view, halfway);
    real nl = real(2.0) * vh * halfway.z - view.z;
    if (!(nl > real(0.0)) || !(vh > real(0.0))) return vec3(real(0.0));
    vec3 color = lobes.atNormal + lobes.atEdge * schlick(vh);
    return color * (share * smithVisibility(nl, view.z, alpha) * nl * real(4.0) * vh / halfway.z);
}

#endif
