// What the passes of a frame are told. Scalar layout.
#include "shared/gpu_types.h"
#ifndef SCONCE_FRAME_H
#define SCONCE_FRAME_H
SCONCE_STRUCTS_BEGIN

struct FrameView
{
    mat4 worldFromClip;  // of the camera the G-buffer was drawn with; its depth is reversed: 1 at the near plane, 0 at infinity; y is -1 at the
                         // picture's first row
    vec3 eye;            // world, metres
    uint seed;           // changes from frame to frame
    uvec2 size;          // pixels
    uint glossyRays;     // rays a pixel, 1..64
    float normalOffset;  // metres a ray starts off its surface; 1e-4 of the scene's diagonal
    float raysBelow;     // roughness: reflections below it are traced, above it read from prefiltered radiance; default kRaysBelow
    uint follows;        // 1: the frame follows the one that was recorded before; 0: it is the first, or the camera was cut; more: it follows, and
                         // a history counts for at most so many frames, since light has changed: see kFollowsChange
    vec3 eyeBefore;      // of the frame before, world, metres
    mat4 clipFromWorldBefore; // x and y in [-1,1] over the picture before, w > 0 in front of the camera; of temporal and screenTrace
    mat3 fieldFromNormals; // turns the G-buffer's normals into the field's world; the identity where they are in it. See inFieldsWorld()
};
SCONCE_CHECK_SIZE(FrameView, 216);

const uint kFollowsChange = 3u; // for kChangeFrames frames after light has changed: what was before has then faded to (2/3)^8 = 4 %
const uint kChangeFrames = 8u;

const float kRaysBelow = 0.4f;   // roughness
const float kRetro = 2.0f; // that the G-buffer's roughness of a retroreflective surface has more: see viewerOfLobes()
const float kRaysBlend = 0.05f;  // either side of raysBelow both are made and blended, so that no seam shows in a roughness texture

// The terms of a pixel's light, each of which has passes of its own.
const uint kTermDiffuse = 0u;
const uint kTermRough = 1u;  // reflections from prefiltered radiance
const uint kTermGlossy = 2u; // reflections by traced rays
const uint kTermMirror = 3u; // one traced ray, never filtered
const uint kTermCount = 4u;

const float kMostLight = 65504.0f; // radiance, in any unit: the largest half float; images of indirect light hold no more, and what has it may have been more
const float kFilterReach = 15.0f; // pixels, of all steps of a term's filter together
const float kNotTraced = -1.0f;   // in place of a ray's length: the pixel is made from its neighbours

const uint kTileSide = 8u;      // pixels; a workgroup
const uint kTileRow = 128u;     // workgroups a row of an indirect dispatch has

// Light that is looked up in maps, whose texels span many pixels, is looked up once for 2x2 pixels that show one flat surface.
const uint kLookUpsPerPixel = 1u;
const uint kLookUpsPerQuad = 2u; // of like normals and roughness
const uint kLookUpsBent = 3u;    // of normals that textures bend
const uint kLookUpOfQuad = 0x80000000u; // in a list's word
const uint kMostLookUpLists = 4u;

/// Where a list's passes run: the arguments of their indirect dispatch and the number of tiles, or look-ups, in the list.
struct TileRuns
{
    uint x;
    uint y;
    uint z;
    uint count;
};
SCONCE_CHECK_SIZE(TileRuns, 16);

/// Of the w of a G-buffer's normal: the roughness of its lobes, whose viewer is viewerOfLobes() where it is retroreflective.
SCONCE_FN bool isRetroreflective(float w) { return w >= kRetro; }
SCONCE_FN float roughnessOf(float w) { return isRetroreflective(w) ? w - kRetro : w; }

SCONCE_STRUCTS_END

#ifndef __cplusplus
#include "shared/brdf.h"
#include "shared/sample_pair.h"

/// How much of a surface's reflections traced rays give, [0,1]; prefiltered radiance gives the rest.
float shareOfRays(float roughness, float raysBelow) { return 1.0 - smoothstep(raysBelow - kRaysBlend, raysBelow + kRaysBlend, roughness); }

/// Bit i: a pixel of this surface has term i, and the images of IndirectLight hold it.
uint termsOf(BrdfSurface s, float raysBelow)
{
    uint terms = s.metallic < 1.0 && any(greaterThan(s.baseColor, vec3(0.0))) ? 1u << kTermDiffuse : 0u;
    if (isMirror(s.roughness)) return terms | (1u << kTermMirror);
    float rays = shareOfRays(s.roughness, raysBelow);
    if (rays > 0.0) terms |= 1u << kTermGlossy;
    if (rays < 1.0) terms |= 1u << kTermRough;
    return terms;
}

/// What a pixel's surface sends to the eye of indirect light, radiance.
struct IndirectSent
{
    vec3 scattered; // by its diffuse lobe
    vec3 reflected;
};

/// Puts a pixel's terms together, as the images of IndirectLight hold them. Of a term that the pixel lacks, or that isn't made, anything may be given.
/// @param nv    cosine of the eye to the normal
/// @param made  IndirectLight::made()
IndirectSent composeIndirect(BrdfSurface s, float nv, float raysBelow, uint made, vec3 diffuse, vec3 rough, vec3 glossy, vec3 mirror)
{
    uint terms = termsOf(s, raysBelow) & made;
    float rays = shareOfRays(s.roughness, raysBelow);
    IndirectSent sent = IndirectSent(vec3(0.0), vec3(0.0));
    if ((terms & (1u << kTermDiffuse)) != 0u) sent.scattered = diffuse * lobesAt(s, nv).diffuse;
    if ((terms & (1u << kTermRough)) != 0u) sent.reflected += (1.0 - rays) * rough;
    if ((terms & (1u << kTermGlossy)) != 0u) sent.reflected += rays * glossy;
    if ((terms & (1u << kTermMirror)) != 0u) sent.reflected += mirror;
    return sent;
}
#endif

#endif
