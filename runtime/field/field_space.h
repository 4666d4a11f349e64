#pragma once

#include "runtime/field/field_data.h"
#include "scene/scene.h"

namespace sconce
{

/// Origin, scale, bounds and diagonal of a light field about a scene; everything else of the info is zero. The scale is the power of two
/// nearest the scene's diagonal; the origin is the bounds' centre, rounded to a multiple of the scale / 2^12 so that scenes far from the
/// world's origin lose nothing when it is subtracted.
gpu::LightFieldInfo fieldSpace(const Bounds& sceneBounds);

/// Fills the coarser levels of one face, and their far bounds, from its level 0 words. Invariant: no surfel plane of a texel rises above
/// the bounding planes of the cells over it, nor falls behind their far bounds (face_chain.h). CPU twin of shaders/bake_chain.comp.
void buildChain(uint32_t* faceWords, uint32_t faceSize);

/// Fills freeRadius, farthest, the harmonic mean of the distances and the influence box (median distance per cube face, Wang et al. 2019,
/// section 4.1) of one probe from its distance words; its centre is kept.
void summariseProbe(FieldData& field, size_t probe);

/// Puts a built octree into the field and its layout into the field's info.
void attachOctree(FieldData& field, const Octree& octree);

} // namespace sconce
