#pragma once

#include <optional>

#include "runtime/bake/triangle_gather.h"

namespace sconce
{

/// Texels that are refined, in the order of their numbers.
struct RefinedPlaces
{
    struct Texel
    {
        uint32_t probe;
        glm::uvec3 at; // x, y, face
    };
    std::vector<Texel> texels;
};

/// Refines the texels of a field's surface light (shaders/shared/surface_light.h) within which light changes most, for their area: those
/// whose light is off what their neighbours on the same surface would have it, of the two probes that light a place; into finer ones,
/// gathered by exact rays. Afterwards the field's info.refinedTexels and surfaceLight hold them.
/// @param lit    with surface light, none of it refined
/// @param sent   by each texel
/// @param share  of all texels, at most
/// @param places  where texels were refined before, which then are those; null, or empty: found, and put there
void refineTexels(FieldData& lit, const TriangleGather& triangles, const TriangleGather::Sent& sent, float share,
                  std::optional<RefinedPlaces>* places = nullptr);

} // namespace sconce
