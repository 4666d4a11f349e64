// Sconce in this renderer's lighting pass: see sconce_gi.h. Define GI_BINDING to the first of four bindings of set 0.
#include "shared/frame.h" // with the reflection model that indirect light is made for
layout(set = 0, binding = GI_BINDING + 0) uniform texture2D giDiffuse; // mean of the arriving radiance
layout(set = 0, binding = GI_BINDING + 1) uniform texture2D giRough;   // these three: radiance reflected to the eye
layout(set = 0, binding = GI_BINDING + 2) uniform texture2D giGlossy;
layout(set = 0, binding = GI_BINDING + 3) uniform texture2D giMirror;

/// Radiance that a pixel's surface sends to the eye of indirect light. An image is read where the pixel has its term and nowhere else.
/// @param nv    cosine of the eye to the normal
/// @param made  SconceGi::made()
void indirectLight(ivec2 at, BrdfSurface surface, float nv, uint made, out vec3 scattered, out vec3 reflected)
{
    uint terms = termsOf(surface, kRaysBelow) & made;
    float rays = shareOfRays(surface.roughness, kRaysBelow);
    scattered = reflected = vec3(0.0);
    if ((terms & (1u << kTermDiffuse)) != 0u) scattered = lobesAt(surface, nv).diffuse * texelFetch(giDiffuse, at, 0).rgb;
    if ((terms & (1u << kTermRough)) != 0u) reflected += (1.0 - rays) * texelFetch(giRough, at, 0).rgb;
    if ((terms & (1u << kTermGlossy)) != 0u) reflected += rays * texelFetch(giGlossy, at, 0).rgb;
    if ((terms & (1u << kTermMirror)) != 0u) reflected += texelFetch(giMirror, at, 0).rgb;
}
