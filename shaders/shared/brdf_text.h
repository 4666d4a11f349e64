// The one reflection model of the project: a Lambertian base under GGX, and how punctual lights fall off. Shared text, see texel.h; C++ finds it
// in brdf.h, in float, and in pure.h.
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
    vec3 specular; // 0 for a mirror: its delta is mirrorReflectance's
};

struct TangentFrame
{
    vec3 tangent;
    vec3 bitangent;
    vec3 normal;
};

SCONCE_PURE bool isMirror(real roughness) { return roughness < kMirrorRoughness; }

SCONCE_PURE real ggxAlpha(real roughness)
{
    real alpha = roughness * roughness;
    return alpha > kSmallestAlpha ? alpha : kSmallestAlpha;
}

// Reflectance at normal incidence: 4 % for dielectrics, the base colour for metals (glTF 2.0, appendix B).
SCONCE_PURE vec3 reflectanceAtNormal(BrdfSurface surface)
{
    return vec3(real(0.04)) * (real(1.0) - surface.metallic) + surface.baseColor * surface.metallic;
}

// Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering".
SCONCE_PURE vec3 fresnelSchlick(vec3 atNormal, real cosine)
{
    real m = cosine < real(0.0) ? real(1.0) : (cosine > real(1.0) ? real(0.0) : real(1.0) - cosine);
    real m2 = m * m;
    return atNormal + (vec3(real(1.0)) - atNormal) * (m2 * m2 * m);
}

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

// Both lobes; 0 when either direction is below the surface.
SCONCE_PURE BrdfValue evaluateBrdf(BrdfSurface surface, vec3 normal, vec3 view, vec3 light)
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
    vec3 fresnel = fresnelSchlick(reflectanceAtNormal(surface), dot(view, halfway));
    value.diffuse = surface.baseColor * ((real(1.0) - surface.metallic) / kBrdfPi) * (vec3(real(1.0)) - fresnel);
    if (!isMirror(surface.roughness))
    {
        real alpha = ggxAlpha(surface.roughness);
        value.specular = fresnel * (ggxDistribution(normal, halfway, alpha) * smithVisibility(nl, nv, alpha));
    }
    return value;
}

// Weight of the mirror direction's radiance, for surfaces that isMirror.
SCONCE_PURE vec3 mirrorReflectance(BrdfSurface surface, real nv) { return fresnelSchlick(reflectanceAtNormal(surface), nv); }

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
