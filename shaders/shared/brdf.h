// The one reflection model of the project, compiled as GLSL and as C++: a Lambertian base under GGX, and how punctual lights fall off.
// Surfaces are two-sided: callers turn the normal to the viewer's side first. All directions are unit and point away from the surface.
#ifndef SCONCE_SHARED_BRDF_H
#define SCONCE_SHARED_BRDF_H

#ifdef __cplusplus
#include <glm/glm.hpp>
#ifndef SCONCE_FN
#define SCONCE_FN inline
#endif
namespace sconce
{
using glm::cos; // the float overloads: C's own would compute in double
using glm::sin;
using glm::sqrt;
using glm::vec2;
using glm::vec3;
#else
#ifndef SCONCE_FN
#define SCONCE_FN
#endif
#endif

#define SCONCE_BRDF_PI 3.14159265358979f
// Below this roughness the specular lobe is a perfect mirror (a delta); above it alpha is kept large enough for single precision.
#define SCONCE_MIRROR_ROUGHNESS 0.02f
#define SCONCE_SMALLEST_ALPHA 1e-3f

struct BrdfSurface
{
    vec3 baseColor; // linear
    float metallic;
    float roughness;
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

SCONCE_FN bool isMirror(float roughness) { return roughness < SCONCE_MIRROR_ROUGHNESS; }

SCONCE_FN float ggxAlpha(float roughness)
{
    float alpha = roughness * roughness;
    return alpha > SCONCE_SMALLEST_ALPHA ? alpha : SCONCE_SMALLEST_ALPHA;
}

// Reflectance at normal incidence: 4 % for dielectrics, the base colour for metals (glTF 2.0, appendix B).
SCONCE_FN vec3 reflectanceAtNormal(BrdfSurface surface)
{
    return vec3(0.04f) * (1.0f - surface.metallic) + surface.baseColor * surface.metallic;
}

// Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering".
SCONCE_FN vec3 fresnelSchlick(vec3 atNormal, float cosine)
{
    float m = cosine < 0.0f ? 1.0f : (cosine > 1.0f ? 0.0f : 1.0f - cosine);
    float m2 = m * m;
    return atNormal + (vec3(1.0f) - atNormal) * (m2 * m2 * m);
}

// Walter et al. 2007, GGX. 1 - (n.h)^2 is taken from the cross product: the plain form cancels for small alpha (Guy and Agopian 2018).
SCONCE_FN float ggxDistribution(vec3 normal, vec3 halfway, float alpha)
{
    vec3 across = cross(normal, halfway);
    float nh = dot(normal, halfway);
    float a = nh * alpha;
    float k = alpha / (dot(across, across) + a * a);
    return k * k * (1.0f / SCONCE_BRDF_PI);
}

// Height-correlated Smith masking and shadowing over 4 (n.l) (n.v) (Heitz 2014).
SCONCE_FN float smithVisibility(float nl, float nv, float alpha)
{
    float a2 = alpha * alpha;
    float view = nl * sqrt(nv * nv * (1.0f - a2) + a2);
    float light = nv * sqrt(nl * nl * (1.0f - a2) + a2);
    return 0.5f / (view + light + 1e-20f);
}

SCONCE_FN float smithMasking(float nv, float alpha)
{
    float a2 = alpha * alpha;
    return 2.0f * nv / (nv + sqrt(nv * nv * (1.0f - a2) + a2) + 1e-20f);
}

// Both lobes; 0 when either direction is below the surface.
SCONCE_FN BrdfValue evaluateBrdf(BrdfSurface surface, vec3 normal, vec3 view, vec3 light)
{
    BrdfValue value;
    value.diffuse = vec3(0.0f);
    value.specular = vec3(0.0f);
    float nl = dot(normal, light);
    float nv = dot(normal, view);
    vec3 sum = view + light;
    float sumLength = sqrt(dot(sum, sum));
    if (!(nl > 0.0f) || !(nv > 0.0f) || !(sumLength > 0.0f)) return value;
    vec3 halfway = sum / sumLength;
    vec3 fresnel = fresnelSchlick(reflectanceAtNormal(surface), dot(view, halfway));
    value.diffuse = surface.baseColor * ((1.0f - surface.metallic) / SCONCE_BRDF_PI) * (vec3(1.0f) - fresnel);
    if (!isMirror(surface.roughness))
    {
        float alpha = ggxAlpha(surface.roughness);
        value.specular = fresnel * (ggxDistribution(normal, halfway, alpha) * smithVisibility(nl, nv, alpha));
    }
    return value;
}

// Weight of the mirror direction's radiance, for surfaces that isMirror.
SCONCE_FN vec3 mirrorReflectance(BrdfSurface surface, float nv) { return fresnelSchlick(reflectanceAtNormal(surface), nv); }

// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
SCONCE_FN TangentFrame tangentFrame(vec3 n)
{
    float s = n.z >= 0.0f ? 1.0f : -1.0f;
    float a = -1.0f / (s + n.z);
    float b = n.x * n.y * a;
    TangentFrame frame;
    frame.tangent = vec3(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
    frame.bitangent = vec3(b, s + n.y * n.y * a, -n.y);
    frame.normal = n;
    return frame;
}

SCONCE_FN vec3 toWorld(TangentFrame f, vec3 v) { return f.tangent * v.x + f.bitangent * v.y + f.normal * v.z; }
SCONCE_FN vec3 toTangent(TangentFrame f, vec3 v) { return vec3(dot(f.tangent, v), dot(f.bitangent, v), dot(f.normal, v)); }

// A microfacet normal visible from `view` (tangent space, z along the normal); u uniform in [0,1)^2.
// Heitz 2018, "Sampling the GGX Distribution of Visible Normals".
SCONCE_FN vec3 sampleVisibleNormal(vec3 view, float alpha, vec2 u)
{
    vec3 stretched = vec3(alpha * view.x, alpha * view.y, view.z);
    stretched = stretched / sqrt(dot(stretched, stretched));
    float across = stretched.x * stretched.x + stretched.y * stretched.y;
    vec3 t1 = across > 1e-14f ? vec3(-stretched.y, stretched.x, 0.0f) / sqrt(across) : vec3(1.0f, 0.0f, 0.0f);
    vec3 t2 = cross(stretched, t1);
    float r = sqrt(u.x);
    float phi = 2.0f * SCONCE_BRDF_PI * u.y;
    float p1 = r * cos(phi);
    float s = 0.5f * (1.0f + stretched.z);
    float rest = 1.0f - p1 * p1;
    float p2 = (1.0f - s) * sqrt(rest > 0.0f ? rest : 0.0f) + s * r * sin(phi);
    float up = 1.0f - p1 * p1 - p2 * p2;
    vec3 n = t1 * p1 + t2 * p2 + stretched * sqrt(up > 0.0f ? up : 0.0f);
    vec3 m = vec3(alpha * n.x, alpha * n.y, n.z > 1e-7f ? n.z : 1e-7f);
    return m / sqrt(dot(m, m));
}

// Density over solid angle of the light direction that reflecting about a visible normal gives: G1(v) D(h) / (4 n.v).
SCONCE_FN float visibleNormalPdf(vec3 normal, vec3 view, vec3 light, float alpha)
{
    float nv = dot(normal, view);
    vec3 sum = view + light;
    float sumLength = sqrt(dot(sum, sum));
    if (!(nv > 0.0f) || !(dot(normal, light) > 0.0f) || !(sumLength > 0.0f)) return 0.0f;
    return smithMasking(nv, alpha) * ggxDistribution(normal, sum / sumLength, alpha) / (4.0f * nv);
}

// Cosine-weighted direction about z, density cos/pi.
SCONCE_FN vec3 sampleCosine(vec2 u)
{
    float r = sqrt(u.x);
    float phi = 2.0f * SCONCE_BRDF_PI * u.y;
    float up = 1.0f - u.x;
    return vec3(r * cos(phi), r * sin(phi), sqrt(up > 0.0f ? up : 0.0f));
}

// Irradiance factor of a point or spot light at a distance; range 0 is unlimited (KHR_lights_punctual).
SCONCE_FN float distanceAttenuation(float distance, float range)
{
    float d2 = distance * distance > 1e-12f ? distance * distance : 1e-12f;
    if (!(range > 0.0f)) return 1.0f / d2;
    float q = distance / range;
    float window = 1.0f - q * q * q * q;
    return (window > 0.0f ? window : 0.0f) / d2;
}

// cosAngle is between the spot's axis and the direction the light travels (KHR_lights_punctual).
SCONCE_FN float spotAttenuation(float cosAngle, float innerCone, float outerCone)
{
    float outer = cos(outerCone);
    float width = cos(innerCone) - outer;
    float x = (cosAngle - outer) / (width > 1e-3f ? width : 1e-3f);
    x = x < 0.0f ? 0.0f : (x > 1.0f ? 1.0f : x);
    return x * x;
}

#ifdef __cplusplus
} // namespace sconce
#endif
#endif
