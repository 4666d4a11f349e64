#pragma once

#include <optional>
#include <utility>

#include "runtime/bake/triangle_gather.h"

namespace sconce
{

/// Where light of hidden surfaces is gathered.
struct HiddenPlaces
{
    struct Place
    {
        uint32_t key; // hidden_light.h
        vec3 point;   // field space
        vec3 normal;
        float grazing; // TriangleGather::grazingOf()
        float weight;  // of its light
        bool seen;     // something before it is, by a probe
    };
    uint32_t shift = 0;                          // log2 of finest voxels a side
    std::vector<Place> places;                   // by key
    std::vector<std::pair<size_t, size_t>> keys; // from where to where a key's are
};

/// Gathers light, by exact rays, at surfaces that no texel of a field's surface light shows: undersides, gaps, what stands behind things; a
/// mean for each voxel and facing (shaders/shared/hidden_light.h). Points are drawn evenly over the scene's surface, on each side that can
/// be seen from outside; where nothing arrives, that is kept only where a look-up would find light without, as in a dark room beside a lit
/// one; of a voxel's each counts that is open, those in a gap by how much of what probes see lies before them, what is sealed up or within
/// something solid not at all. Afterwards the field's info.hidden and surfaceLight hold them. Cost: a look-up for each of up to some
/// millions of points, and for each voxel and facing 64 rays for the light, and 128 to 512 for where to gather it.
/// @param lit   with surface light, without refined texels
/// @param sent  by each texel
/// @param places  where light was gathered before, of the same surfaces in other light, which then is where it is; null, or empty: found,
///                and put there
void lightHiddenSurfaces(FieldData& lit, const TriangleGather& triangles, const TriangleGather::Sent& sent,
                         std::optional<HiddenPlaces>* places = nullptr);

/// Where the light of a hidden surface comes from.
struct HiddenLinks
{
    uint32_t word; // of FieldData::surfaceLight, that its light is
    std::vector<uint32_t> links;
};
/// Of all hidden surfaces of a field, some links at each of a few places of theirs.
/// @param places  that they were found at
/// @param count   links of each
std::vector<HiddenLinks> hiddenLinks(const FieldData& lit, const HiddenPlaces& places, const TriangleGather& triangles, uint32_t count);

} // namespace sconce
