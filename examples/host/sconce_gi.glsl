// Sconce in this renderer's lighting pass: see sconce_gi.h. Define GI_BINDING to the first of four bindings of set 0.
#include "sconce_frame.glsl" // with the reflection model that indirect light is made for
layout(set = 0, binding = GI_BINDING + 0) uniform texture2D giDiffuse; // mean of the arriving radiance
layout(set = 0, binding = GI_BINDING + 1) uniform texture2D giRough;   // these three: radiance reflected to the eye
layout(set = 0, binding = GI_BINDING + 2) uniform texture2D giGlossy;
layout(set = 0, binding = GI_BINDING + 3) uniform texture2D giMirror;

/// Radiance that a pixel's surface sends to the eye of indirect light.
/// @param nv    cosine of the eye to the normal
/// @param made       IndirectLight::made()
/// @param raysBelow  FrameView::raysBelow
void indirectLight(ivec2 at, SconceBrdfSurface surface, float nv, uint made, float raysBelow, out vec3 scattered, out vec3 reflected)
{
    SconceIndirectSent sent = sconceComposeIndirect(surface, nv, raysBelow, made, texelFetch(giDiffuse, at, 0).rgb, texelFetch(giRough, at, 0).rgb,
                                                    texelFetch(giGlossy, at, 0).rgb, texelFetch(giMirror, at, 0).rgb);
    scattered = sent.scattered;
    reflected = sent.reflected;
}
