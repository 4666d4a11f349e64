// What the bake's compute passes over one probe are told.
#include "shared/gpu_types.h"
#ifndef SCONCE_BAKE_PASSES_H
#define SCONCE_BAKE_PASSES_H
#ifndef __cplusplus
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BakeWords { uint word[]; };
#endif
SCONCE_STRUCTS_BEGIN

const uint kBakeSurfaceBinding = 0u; // layout: probe_face.glsl
const uint kBakeDepthBinding = 1u;

/// What a bounce needs of a texel of surface light: means over the distance texels under it that lie on its surface.
struct SurfaceTexel
{
    uint albedo; // packRootOfColor
    uint normal; // shading normal, 8 + 8 bits, kSurfaceKnown, and 8 of unpackGrazing(); 0: sky
    uint sent;   // radiance that the surface sends of lights whose direct light is the host's, RGB9E5
};
SCONCE_CHECK_SIZE(SurfaceTexel, 12);
const uint kSurfaceKnown = 0x10000u;

#ifdef __cplusplus
#define SCONCE_BUFFER(name, type)
#else
#define SCONCE_BUFFER(name, type) layout(buffer_reference, scalar, buffer_reference_align = 4) buffer name { type value[]; };
#endif
SCONCE_BUFFER(SurfaceTexels, SurfaceTexel)
SCONCE_BUFFER(SurfaceFloats, vec4)

struct BakePush
{
    SCONCE_ADDRESS(BakeWords) words;    // distance words of the probe
    SCONCE_ADDRESS(BakeWords) radiance; // R11G11B10F
    SCONCE_ADDRESS(BakeWords) surface;  // reflectance 5:6:5, shading normal << 16; 0: sky
    SCONCE_ADDRESS(BakeWords) extra;    // a pass's other buffer; of a bounce, the radiance that is direct
    vec3 centre;        // of the probe, field space
    float nearPlane;    // W of depth 1, field units
    uint size;          // texels a side of a face (or of the octahedral map)
    uint faceWords;     // distance words a face
    uint chart;
    uint level;         // chain: the level written; gathers: cells a side
    vec3 sky;
    float skyDistance;  // that the moments count for sky, field units
    SCONCE_ADDRESS(BakeWords) emitted; // emission a radiance texel, R11G11B10F; null: the scene has no emitters
    SCONCE_ADDRESS(SurfaceTexels) texels;  // SurfaceTexel[6][surfaceSize][surfaceSize]
    uint surfaceSize;
    uint probe;
};
SCONCE_CHECK_SIZE(BakePush, 104);

const uint kBakeCoatsId = 1u;     // bake_surface.comp: whether rays to triangles find what coats reflect of lights of no extent, see shareToAllSides()
const uint kBakeAreaLightId = 0u; // bake_surface.comp: whether direct light has emitters and sky in it, by their shadow maps

// Where a gathering ray of a texel ended: the index of another texel, whose light it brings, in the lower bits, above them which of kTints colours
// it was reflected in on its way, and how often; or one of these. Light that comes by reflections was scattered so many times more than what ends at
// once: it is of so many bounces earlier.
const uint kLinkTexelBits = 28u;
const uint kTints = 15u;
const uint kReflectionsCounted = 3u;              // more count as so many
const uint kSentKept = kReflectionsCounted + 2u; // bounces whose light is kept: the last, that before it, and those that reflections ask for
const uint kLinkSky = 0xffffffffu;
const uint kLinkNone = 0xfffffffeu; // nothing is known of it
const uint kLinkSurface = 0xfffffffdu; // a surface of whose light nothing is known
const uint kLinkDark = 0xfffffffcu; // nothing comes by it
const float kNotKnown = -1.0f; // in place of the rays' length: too few ends are

/// Of the passes that gather light at surfaces, over one probe's texels.
struct SurfacePush
{
    SCONCE_ADDRESS(SurfaceTexels) texels; // of all probes
    SCONCE_ADDRESS(SurfaceFloats) first;  // of all probes: mean radiance straight from emitters and sky; harmonic mean of the rays' lengths, field units
    SCONCE_ADDRESS(SurfaceFloats) light;  // of all probes: mean radiance that arrives; variance of the luminance of `first`, by chance
    SCONCE_ADDRESS(BakeWords) links;      // of this probe, [ray][texel]
    SCONCE_ADDRESS(BakeWords) sentKept;   // of all probes: radiance that each texel sends after bounce b, RGB9E5, [b % kSentKept][texel]
    SCONCE_ADDRESS(BakeWords) sent;       // the same after this bounce; of the filter and of cells, the surface light
    SCONCE_ADDRESS(SurfaceFloats) tilts;  // of all probes: moment along the plane of the luminance straight from emitters and sky, and of all; none: 0
    SCONCE_ADDRESS(BakeWords) tilted;     // of all probes: of the filter, packTilt() of a texel
    SCONCE_ADDRESS(BakeWords) reflected;  // of all probes: light of emitters that comes by specular reflection, RGB9E5, [reflections - 1][texel]
    SCONCE_ADDRESS(SurfaceFloats) tints;  // kTints colours, and of how many reflections; the first white, of none
    uint probe;
    uint rays;       // a texel
    uint shadowRays; // a texel, to emitters
    float offset;    // field units that a ray starts off its surface
    uint bounce;     // 0: the first, of which light is that comes at once
    uint texelCount; // of all probes
};
SCONCE_CHECK_SIZE(SurfacePush, 104);
const uint kMostShadowRays = 32u;
const float kMostSlope = 5.0f; // tangent of a ray's angle to the normal that a tilt's moment counts
const uint kCellGroup = 64u; // facings of cells a workgroup of cell_gather.comp
const uint kCellRow = 64u;   // of its groups a row

SCONCE_STRUCTS_END
#endif
