// The one reflection model of the project, and how punctual lights fall off. Shared text, see texel.h; C++ finds it in brdf.h, in float, and
// in pure.h. glTF 2.0's mix of a dielectric and a metal (appendix B) over GGX, with the light that facets send to one another put back: the
// specular lobe gains what single scattering loses (Turquin 2019, "Practical multiple scattering compensation for microfacet models"), the
// diffuse lobe has what the dielectric's lobe leaves of the light at both of its ends (Kulla and Conty 2017, "Revisiting Physically Based Shading
// at Imageworks"). White surfaces reflect all light, at every roughness and angle. The diffuse lobe is reciprocal; the gain of the specular one
// is the viewer's side's alone.
// Surfaces are two-sided: callers turn the normal to the viewer's side first. All directions are unit and point away from the surface.
#if defined(__cplusplus) || !defined(SCONCE_BRDF_TEXT)
#define SCONCE_BRDF_TEXT

SCONCE_CONST real kBrdfPi = real(3.14159265358979);
// Below this roughness the specular lobe is a perfect mirror (a delta); above it alpha is kept large enough for single precision.
SCONCE_CONST real kMirrorRoughness = real(0.02);
SCONCE_CONST real kSmallestAlpha = real(1e-3);

struct BrdfSurface
{
    vec3 baseColor; // linear
    real metallic;
    real roughness;
};

struct BrdfValue // 1/sr, without the cosine
{
    vec3 diffuse;
    vec3 specular; // 0 for a mirror: its delta has the weight of specularColor
};

/// What a surface reflects toward one viewer, the same for every light.
struct BrdfLobes
{
    vec3 diffuse;  // of white light from all sides, [0,1]
    vec3 atNormal; // the specular lobe's colour is atNormal + atEdge (1 - v.h)^5
    vec3 atEdge;
    vec2 shares;   // of white light that a white specular lobe reflects once: whiteShares
};

struct TangentFrame
{
    vec3 tangent;
    vec3 bitangent;
    vec3 normal;
};

/// The viewer that a surface's lobes are for. A retroreflective one sends light back to where it comes from: its lobe is the one that a viewer on the
/// other side of the normal has. As wide, of the same energy, and as reciprocal (Portsmouth et al. 2026, "The Minimal Retroreflective Microfacet Model").
/// @param view  unit, to the eye, or to where the light goes
SCONCE_PURE vec3 viewerOfLobes(vec3 normal, vec3 view, bool retroreflective)
{
    if (!retroreflective) return view;
    return real(2.0) * dot(normal, view) * normal - view;
}

SCONCE_PURE bool isMirror(real roughness) { return roughness < kMirrorRoughness; }

SCONCE_PURE real ggxAlpha(real roughness)
{
    real alpha = roughness * roughness;
    return alpha > kSmallestAlpha ? alpha : kSmallestAlpha;
}

SCONCE_CONST real kDielectricAtNormal = real(0.04); // reflectance of glTF's dielectrics at normal incidence

SCONCE_PURE real fifthPower(real m) { return m * m * (m * m) * m; }

SCONCE_PURE real between0And1(real x) { return x > real(0.0) ? (x < real(1.0) ? x : real(1.0)) : real(0.0); }

/// Schlick's (1 - cosine)^5 (Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering").
SCONCE_PURE real schlick(real cosine) { return fifthPower(real(1.0) - between0And1(cosine)); }

// Walter et al. 2007, GGX. 1 - (n.h)^2 is taken from the cross product: the plain form cancels for small alpha (Guy and Agopian 2018).
SCONCE_PURE real ggxDistribution(vec3 normal, vec3 halfway, real alpha)
{
    vec3 across = cross(normal, halfway);
    real nh = dot(normal, halfway);
    real a = nh * alpha;
    real k = alpha / (dot(across, across) + a * a);
    return k * k * (real(1.0) / kBrdfPi);
}

// Height-correlated Smith masking and shadowing over 4 (n.l) (n.v) (Heitz 2014).
SCONCE_PURE real smithVisibility(real nl, real nv, real alpha)
{
    real a2 = alpha * alpha;
    real view = nl * sqrt(nv * nv * (real(1.0) - a2) + a2);
    real light = nv * sqrt(nl * nl * (real(1.0) - a2) + a2);
    return real(0.5) / (view + light + real(1e-20));
}

SCONCE_PURE real smithMasking(real nv, real alpha)
{
    real a2 = alpha * alpha;
    return real(2.0) * nv / (nv + sqrt(nv * nv * (real(1.0) - a2) + a2) + real(1e-20));
}

/// The shares of white light that a white single-scattering lobe reflects toward a viewer at this cosine: x all of it, y what of it is weighted
/// by (1 - v.h)^5. Polynomials fitted to quadratures of the two integrals, where k = cosine / (cosine + alpha) takes the shape out that
/// small alphas have at grazing angles: x within 0.9 %, the reflectance of a dielectric made of both within 3 %.
SCONCE_PURE vec2 whiteShares(real cosine, real roughness)
{
    real c = between0And1(cosine);
    real m = real(1.0) - c;
    if (isMirror(roughness)) return vec2(real(1.0), fifthPower(m));
    real alpha = ggxAlpha(roughness);
    real k = c / (c + alpha);
    real r = roughness;
    real r2 = r * r, r4 = r2 * r2, r5 = r4 * r;
    real lost = real(0.30091) + r * (real(0.889612) + r * (real(-4.84324) + r * real(8.11296)));
    lost += k * (real(-0.897763) + real(1.21162) * r2 + real(-28.2932) * r5);
    real k2 = k * k;
    lost += k2 * (real(3.57138) + real(-19.9357) * r4 + real(176.145) * r5 + k * real(-466.123) * r5);
    lost += k2 * k2 * (real(-8.34087) + real(761.334) * r5 + real(-67.8082) * r5 * r + k * (real(5.28858) + real(-395.601) * r5));
    real all = between0And1(real(1.0) - k * (real(1.0) - k) * lost);

    real k3 = k2 * k;
    real edge = real(0.016362) * r5 + real(1.0474) * r2 * k3;
    edge += m * (real(1.0187) + real(0.60616) * r * k2 - (real(1.0852) + real(1.1234) * r2) * r * k3);
    edge += m * m * (r * (real(-0.48644) - real(0.39475) * r) + k2 * (real(-0.086023) + r * (real(1.2094) - real(1.8582) * r)) + real(0.058544) * k3);
    edge += m * m * m * r4 * (real(1.0087) - real(0.62181) * r);
    return vec2(all, all * fifthPower(between0And1(edge)));
}

/// What facets take of a white lobe's light by scattering it again, over what they reflect at once: the gain is 1 + this times the colour.
SCONCE_PURE real lostOverKept(vec2 shares) { return (real(1.0) - shares.x) / (shares.x > real(0.1) ? shares.x : real(0.1)); }

/// The share of white light that the specular lobe of a dielectric reflects toward a viewer.
SCONCE_PURE real dielectricShare(vec2 shares)
{
    real once = kDielectricAtNormal * shares.x + (real(1.0) - kDielectricAtNormal) * shares.y;
    return once * (real(1.0) + kDielectricAtNormal * lostOverKept(shares));
}

/// The mean of dielectricShare over the hemisphere, weighted by the cosine: a fit within 0.0006.
SCONCE_PURE real meanDielectricShare(real roughness)
{
    real r = between0And1(roughness);
    return real(0.085156) + r * (real(0.039928) + r * (real(-0.384912) + r * (real(0.442841) + r * real(-0.163309))));
}

/// @param nv  cosine of the viewer to the normal
SCONCE_PURE BrdfLobes lobesAt(BrdfSurface surface, real nv)
{
    BrdfLobes lobes;
    lobes.shares = whiteShares(nv, surface.roughness);
    real lost = lostOverKept(lobes.shares);
    real dielectric = (real(1.0) - surface.metallic) * (real(1.0) + kDielectricAtNormal * lost);
    vec3 metal = surface.metallic * (vec3(real(1.0)) + surface.baseColor * lost);
    lobes.atNormal = vec3(kDielectricAtNormal * dielectric) + surface.baseColor * metal;
    lobes.atEdge = vec3((real(1.0) - kDielectricAtNormal) * dielectric) + (vec3(real(1.0)) - surface.baseColor) * metal;
    lobes.diffuse = surface.baseColor * ((real(1.0) - surface.metallic) * (real(1.0) - dielectricShare(lobes.shares)));
    return lobes;
}

/// Of white light from all sides, what the specular lobe reflects to the viewer; a mirror's weight of the mirrored direction.
SCONCE_PURE vec3 specularColor(BrdfLobes lobes) { return lobes.atNormal * lobes.shares.x + lobes.atEdge * lobes.shares.y; }

/// Of white light from all sides, what the specular lobe reflects to all sides: Gauss's rule of four points over the cosine.
SCONCE_PURE vec3 hemisphericalSpecular(BrdfSurface surface)
{
    return specularColor(lobesAt(surface, real(0.069432))) * real(0.024152) + specularColor(lobesAt(surface, real(0.330009))) * real(0.215214) +
           specularColor(lobesAt(surface, real(0.669991))) * real(0.436931) + specularColor(lobesAt(surface, real(0.930568))) * real(0.323703);
}
/// The same of the diffuse lobe.
SCONCE_PURE vec3 hemisphericalDiffuse(BrdfSurface surface)
{
    return surface.baseColor * ((real(1.0) - surface.metallic) * (real(1.0) - meanDielectricShare(surface.roughness)));
}
SCONCE_PURE vec3 hemisphericalAlbedo(BrdfSurface surface) { return hemisphericalDiffuse(surface) + hemisphericalSpecular(surface); }

SCONCE_CONST real kRoughestLobe = real(0.7); // the specular lobes of rougher surfaces are about as wide as the diffuse one

/// Of a surface's hemispherical albedo, what is sent to all sides alike of light that comes from one: all but the specular lobe of a coat, which
/// throws it one way. Metals have nothing else, and rough lobes are wide: both count as diffuse.
SCONCE_PURE real shareToAllSides(BrdfSurface surface)
{
    if (surface.roughness > kRoughestLobe) return real(1.0);
    vec3 all = hemisphericalAlbedo(surface);
    real sum = all.x + all.y + all.z;
    return sum > real(0.0) ? real(1.0) - real(3.0) * (real(1.0) - surface.metallic) * meanDielectricShare(surface.roughness) / sum : real(1.0);
}

/// The light that the diffuse lobe reflects of what comes at a cosine to the normal, over that of light from all sides.
SCONCE_PURE real diffuseAlong(real nl, real roughness)
{
    return (real(1.0) - dielectricShare(whiteShares(nl, roughness))) / (real(1.0) - meanDielectricShare(roughness));
}

// What a diffuse lobe under a smooth coat takes of light along a cosine c, over its mean: near 1 + grazing (1/21 - (1 - c)^5), whose mean over the
// hemisphere, weighted by the cosine, is 1. A fit of diffuseAlong(), off by 0.014 in the mean square where it is worst (roughness 0.3).
SCONCE_CONST real kMostGrazing = real(1.05);
// Of rough metals, what they send on of it: near 1 + lean ((1 - c)^2 - 1/6), since their lobe's gain is its viewer's side's alone, and what comes steeply leaves
// to viewers that gain least. Off by 0.035 in the mean square where it is worst (roughness 0.6, base colour 0.5). One number says either: grazing, or below 0 a lean.
SCONCE_CONST real kMostLean = real(1.2);
SCONCE_PURE real takenAlong(real c, real grazing)
{
    real away = real(1.0) - between0And1(c);
    if (grazing < real(0.0)) return real(1.0) - grazing * (away * away - real(1.0) / real(6.0));
    return real(1.0) + grazing * (real(1.0) / real(21.0) - fifthPower(away));
}
/// A fit to quadratures: of the mean over base colours 0.5 and 0.9, within 0.06.
SCONCE_PURE real leanOfRoughness(real roughness)
{
    real x = between0And1(roughness - real(0.58));
    return x * (real(1.6) + real(2.852) * x);
}

/// The nearest to diffuseAlong() by least squares over the hemisphere, of a surface that is no metal.
SCONCE_PURE real grazingOfRoughness(real roughness)
{
    const int kCosines = 16;
    real sum = real(0.0);
    real squares = real(0.0);
    for (int i = 0; i < kCosines; ++i)
    {
        real c = sqrt((real(i) + real(0.5)) / real(kCosines));
        real by = takenAlong(c, real(1.0)) - real(1.0);
        sum += (diffuseAlong(c, roughness) - real(1.0)) * by;
        squares += by * by;
    }
    return kMostGrazing * between0And1(sum / (squares * kMostGrazing));
}
/// Of a surface; what takenAlong() wants.
/// @param coat  grazingOfRoughness() of it
SCONCE_PURE real grazingOfSurface(real metallic, real roughness, real coat)
{
    return (real(1.0) - metallic) * coat - metallic * leanOfRoughness(roughness);
}

/// Both lobes; 0 when either direction is below the surface.
SCONCE_PURE BrdfValue evaluateLobes(BrdfLobes lobes, real roughness, vec3 normal, vec3 view, vec3 light)
{
    BrdfValue value;
    value.diffuse = vec3(real(0.0));
    value.specular = vec3(real(0.0));
    real nl = dot(normal, light);
    real nv = dot(normal, view);
    vec3 sum = view + light;
    real sumLength = sqrt(dot(sum, sum));
    if (!(nl > real(0.0)) || !(nv > real(0.0)) || !(sumLength > real(0.0))) return value;
    vec3 halfway = sum / sumLength;
    value.diffuse = lobes.diffuse * (diffuseAlong(nl, roughness) / kBrdfPi);
    if (!isMirror(roughness))
    {
        real alpha = ggxAlpha(roughness);
        vec3 color = lobes.atNormal + lobes.atEdge * schlick(dot(view, halfway));
        value.specular = color * (ggxDistribution(normal, halfway, alpha) * smithVisibility(nl, nv, alpha));
    }
    return value;
}

/// The same for one light alone.
SCONCE_PURE BrdfValue evaluateBrdf(BrdfSurface surface, vec3 normal, vec3 view, vec3 light)
{
    return evaluateLobes(lobesAt(surface, dot(normal, view)), surface.roughness, normal, view, light);
}

// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
SCONCE_PURE TangentFrame tangentFrame(vec3 n)
{
    real s = n.z >= real(0.0) ? real(1.0) : -real(1.0);
    real a = -real(1.0) / (s + n.z);
    real b = n.x * n.y * a;
    TangentFrame frame;
    frame.tangent = vec3(real(1.0) + s * n.x * n.x * a, s * b, -s * n.x);
    frame.bitangent = vec3(b, s + n.y * n.y * a, -n.y);
    frame.normal = n;
    return frame;
}

SCONCE_PURE vec3 toWorld(TangentFrame f, vec3 v) { return f.tangent * v.x + f.bitangent * v.y + f.normal * v.z; }
SCONCE_PURE vec3 toTangent(TangentFrame f, vec3 v) { return vec3(dot(f.tangent, v), dot(f.bitangent, v), dot(f.normal, v)); }

// A microfacet normal visible from `view` (tangent space, z along the normal); u uniform in [0,1)^2.
// Heitz 2018, "Sampling the GGX Distribution of Visible Normals".
SCONCE_PURE vec3 sampleVisibleNormal(vec3 view, real alpha, vec2 u)
{
    vec3 stretched = vec3(alpha * view.x, alpha * view.y, view.z);
    stretched = stretched / sqrt(dot(stretched, stretched));
    real across = stretched.x * stretched.x + stretched.y * stretched.y;
    vec3 t1 = across > real(1e-14) ? vec3(-stretched.y, stretched.x, real(0.0)) / sqrt(across) : vec3(real(1.0), real(0.0), real(0.0));
    vec3 t2 = cross(stretched, t1);
    real r = sqrt(u.x);
    real phi = real(2.0) * kBrdfPi * u.y;
    real p1 = r * cos(phi);
    real s = real(0.5) * (real(1.0) + stretched.z);
    real rest = real(1.0) - p1 * p1;
    real p2 = (real(1.0) - s) * sqrt(rest > real(0.0) ? rest : real(0.0)) + s * r * sin(phi);
    real up = real(1.0) - p1 * p1 - p2 * p2;
    vec3 n = t1 * p1 + t2 * p2 + stretched * sqrt(up > real(0.0) ? up : real(0.0));
    vec3 m = vec3(alpha * n.x, alpha * n.y, n.z > real(1e-7) ? n.z : real(1e-7));
    return m / sqrt(dot(m, m));
}

// Density over solid angle of the light direction that reflecting about a visible normal gives: G1(v) D(h) / (4 n.v).
SCONCE_PURE real visibleNormalPdf(vec3 normal, vec3 view, vec3 light, real alpha)
{
    real nv = dot(normal, view);
    vec3 sum = view + light;
    real sumLength = sqrt(dot(sum, sum));
    if (!(nv > real(0.0)) || !(dot(normal, light) > real(0.0)) || !(sumLength > real(0.0))) return real(0.0);
    return smithMasking(nv, alpha) * ggxDistribution(normal, sum / sumLength, alpha) / (real(4.0) * nv);
}

// Cosine-weighted direction about z, density cos/pi.
SCONCE_PURE vec3 sampleCosine(vec2 u)
{
    real r = sqrt(u.x);
    real phi = real(2.0) * kBrdfPi * u.y;
    real up = real(1.0) - u.x;
    return vec3(r * cos(phi), r * sin(phi), sqrt(up > real(0.0) ? up : real(0.0)));
}

// Irradiance over radiance of a patch of an emitter, on a surface that faces it. facing: cosine at the patch; d2: squared distance; disc: its area
// again, or 0 where it is small for its distance. A disc of that area seen on its axis has exactly this form factor (Howell, "A Catalog of Radiation
// Heat Transfer Configuration Factors", B-12 limit), so that a receiver near the patch sees no singularity.
SCONCE_PURE real patchAttenuation(real facing, real d2, real area, real disc, bool oneSided)
{
    real seen = facing < real(0.0) ? (oneSided ? real(0.0) : -facing) : facing;
    return seen * area / (d2 + disc / kBrdfPi);
}

// Irradiance factor of a point or spot light at a distance; range 0 is unlimited (KHR_lights_punctual).
SCONCE_PURE real distanceAttenuation(real distance, real range)
{
    real d2 = distance * distance > real(1e-12) ? distance * distance : real(1e-12);
    if (!(range > real(0.0))) return real(1.0) / d2;
    real q = distance / range;
    real window = real(1.0) - q * q * q * q;
    return (window > real(0.0) ? window : real(0.0)) / d2;
}

// cosAngle is between the spot's axis and the direction the light travels (KHR_lights_punctual).
SCONCE_PURE real spotAttenuation(real cosAngle, real innerCone, real outerCone)
{
    real outer = cos(outerCone);
    real width = cos(innerCone) - outer;
    real x = (cosAngle - outer) / (width > real(1e-3) ? width : real(1e-3));
    x = x < real(0.0) ? real(0.0) : (x > real(1.0) ? real(1.0) : x);
    return x * x;
}

#endif
