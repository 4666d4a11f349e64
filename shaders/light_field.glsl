// The light field in a shader: queryRay() traces a ray, irradianceAt() reads prefiltered light. Hosts include it by sconce.glsl, which tells its names apart.
// SCONCE_GLSL_VERSION rises whenever what a host may have written against it no longer means the same.
// Define SCONCE_FIELD_SET to the descriptor set that LightField::descriptorSet() is bound to (0 when undefined).
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shared/field_passes.h"
#define SCONCE_GLSL_VERSION 1
#ifndef SCONCE_FIELD_SET
#define SCONCE_FIELD_SET 0
#endif

// The maps are read through texel buffers where they fit, else through addresses: one probe set may exceed what a buffer descriptor can span
// (128 Mi texels, 128 MiB of a storage buffer on software Vulkan).
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SconceWords { uint word[]; };
layout(scalar, set = SCONCE_FIELD_SET, binding = kFieldBlockBinding) uniform SconceField { SCONCE_FIELD_BLOCK };
// Texels of four words, which software Vulkan loads in less time than as many words of a storage buffer: FieldData::probes, 3 texels each, and
// FieldData::patches, a texel for two.
layout(set = SCONCE_FIELD_SET, binding = kFieldProbesBinding) uniform textureBuffer sconceProbes;
layout(set = SCONCE_FIELD_SET, binding = kFieldPatchesBinding) uniform utextureBuffer sconcePatches;
layout(set = SCONCE_FIELD_SET, binding = kFieldOctreeBinding) uniform utexture3D sconceOctree;
layout(set = SCONCE_FIELD_SET, binding = kFieldDistanceBinding) uniform utextureBuffer sconceDistance;
layout(set = SCONCE_FIELD_SET, binding = kFieldRadianceBinding) uniform utextureBuffer sconceRadiance;
layout(set = SCONCE_FIELD_SET, binding = kFieldIrradianceBinding) uniform utextureBuffer sconceIrradiance;
layout(set = SCONCE_FIELD_SET, binding = kFieldPrefilteredBinding) uniform utextureBuffer sconcePrefiltered;
layout(set = SCONCE_FIELD_SET, binding = kFieldSurfaceBinding) uniform utextureBuffer sconceSurfaceLight;

layout(scalar, set = SCONCE_FIELD_SET, binding = kFieldSlotsBinding) readonly buffer SconceSlots { uint sconceSlots[]; };

// Of a pass; LightField::constants() holds them.
layout(constant_id = kFieldFlagsId) const uint kFieldFlags = 0u;
bool readsFarBounds() { return (kFieldFlags & kReadsFarBounds) != 0u; }
bool byTexels() { return (kFieldFlags & kByTexels) != 0u; }
bool holdsRefined() { return (kFieldFlags & kHoldsRefined) != 0u; }
bool holdsPrefiltered() { return (kFieldFlags & kHoldsPrefiltered) != 0u; }
bool holdsLive() { return (kFieldFlags & kHoldsLive) != 0u; }
bool streams() { return (kFieldFlags & kStreams) != 0u; }
int probeOrder() { return int((kFieldFlags >> kOrderShift) & 3u); }
#ifdef SCONCE_REFILLS
bool shortTurns() { return true; }
#else
bool shortTurns() { return false; }
#endif
bool mapsInBlocks() { return (kFieldFlags & kMapsInBlocks) != 0u; }
bool onOctahedron() { return (kFieldFlags & kOnOctahedron) != 0u; }
// Whether the field holds the maps' radiance; else only its prefiltered form, or none.
layout(constant_id = kHoldsRadianceId) const bool kHoldsRadiance = true;
bool holdsRadiance() { return kHoldsRadiance; }

ProbeHeader probeHeader(uint probe)
{
    vec4 a = texelFetch(sconceProbes, 3 * int(probe)), b = texelFetch(sconceProbes, 3 * int(probe) + 1), c = texelFetch(sconceProbes, 3 * int(probe) + 2);
    return ProbeHeader(a.xyz, a.w, b.xyz, b.w, c.xyz, c.w);
}
// Probes that light a point, of a pass that says so before it includes this.
#ifndef SCONCE_SURFACE_PROBES
#define SCONCE_SURFACE_PROBES kSurfaceProbes
#endif
// Of a field that streams not all maps are on the device. A compute pass that defines SCONCE_ASKS_FOR_MAPS before it includes this tells FieldStream which it
// would read, and how often: one of eight invocations does.
uint slotOf(uint probe) { return sconceSlots[probe]; }
bool holdsMaps(uint probe) { return !streams() || slotOf(probe) != kNoProbe; }
uint mapSlot(uint probe) // in the field even of maps that aren't there, which nobody should read
{
    if (!streams()) return probe;
    uint slot = slotOf(probe);
    return slot == kNoProbe ? 0u : slot;
}
#ifdef SCONCE_ASKS_FOR_MAPS
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SconceMapsAsked { uint word[]; };
void askForMaps(uint probe)
{
    if (!streams()) return;
    if ((gl_LocalInvocationIndex & 7u) == 0u) atomicAdd(SconceMapsAsked(askedAddress).word[probe], 1u);
}
#else
void askForMaps(uint probe) {}
#endif
uint distanceWord(uint index)
{
    if (byTexels()) return texelFetch(sconceDistance, int(index)).x;
    return SconceWords(distanceAddress).word[index];
}
uint radianceWord(uint index)
{
    if (byTexels()) return texelFetch(sconceRadiance, int(index)).x;
    return SconceWords(radianceAddress).word[index];
}
uvec4 radianceBlock(uint index)
{
    if (byTexels()) return texelFetch(sconceRadiance, int(index));
    SconceWords words = SconceWords(radianceAddress);
    return uvec4(words.word[4u * index], words.word[4u * index + 1u], words.word[4u * index + 2u], words.word[4u * index + 3u]);
}
uint irradianceWord(uint index)
{
    if (byTexels()) return texelFetch(sconceIrradiance, int(index)).x;
    return SconceWords(irradianceAddress).word[index];
}
uvec4 patchWords(uint pair) { return texelFetch(sconcePatches, int(pair)); }
uint prefilteredWord(uint index)
{
    if (byTexels()) return texelFetch(sconcePrefiltered, int(index)).x;
    return SconceWords(prefilteredAddress).word[index];
}
uint surfaceWord(uint index)
{
    if (byTexels()) return texelFetch(sconceSurfaceLight, int(index)).x;
    return SconceWords(surfaceAddress).word[index];
}
uint liveWord(uint index) { return SconceWords(liveAddress).word[index]; }
uint albedoWord(uint index) { return SconceWords(albedoAddress).word[index]; }
vec3 fixedWeight() { return radianceWeight; }
uvec4 octreeTexel(ivec3 p) { return texelFetch(sconceOctree, p, 0); }

#include "shared/pure_text.h"
#include "shared/distance_block.h"
#include "shared/radiance_block.h"
#include "shared/octree_descent.h"
#include "shared/ray_state.h"
#include "shared/face_march.h"
#include "shared/probe_trace.h"
#include "shared/prefiltered.h"
#include "shared/light_lookup.h"
#include "shared/light_cells.h"
#include "shared/refined.h"
#include "shared/hidden_light.h"
#define surfaceProbes() SCONCE_SURFACE_PROBES
#include "shared/surface_light.h"
#include "shared/live_text.h"
#include "shared/ray_query.h"
/// A world-space ray through the light field. `normal`: of the surface it starts on, unit, or 0; see Ray.
RayHit sconceQuery(vec3 origin, vec3 direction, vec3 normal) { return queryRay(origin, direction, normal); }

// Light at a point of the world, metres. It is asked of the probes of a point half a voxel off the surface, which are on its side.
vec3 sconceFieldPoint(vec3 point) { return (point - field.origin) / field.scale; }
vec3 sconceLookUp(vec3 point, vec3 facing) { return sconceFieldPoint(point) + 0.5 * field.voxel * facing; }

/// Mean of the radiance that arrives at a surface, weighted by the cosine, of all light but the host's own and what comes straight from the field's
/// lamps, which sconceLampLightAt() of lamps.glsl adds (rays don't meet lamps either): of a field with surface light (field.surfaceSize > 0). What
/// moves is lit by what is known in the open about it. Cost: about 25 reads.
/// @param normal  for shading, unit
/// @param facing  of the surface itself, unit, on the side that is looked at
vec3 sconceLightAt(vec3 point, vec3 normal, vec3 facing)
{
    int reads = 0;
    return surfaceLightAt(sconceFieldPoint(point), normal, facing, sconceLookUp(point, facing), reads).light;
}

/// The same, anywhere and of any field, of what surfaces reflect alone: no light straight from emitters and sky. Cost: about 15 reads.
vec3 sconceIrradianceAt(vec3 point, vec3 normal)
{
    int reads = 0;
    return irradianceAt(sconceFieldPoint(point), normal, sconceLookUp(point, normal), reads);
}
