#pragma once

#include <cstdint>
#include <vector>

#include "runtime/field/field_data.h"

namespace sconce
{

/// What one probe of a light field sees, as a panorama: longitude over the width, its middle towards -z and its right towards +x; latitude
/// over the height, from +y at the top. Rows from the top.
struct ProbeView
{
    uint32_t width = 0, height = 0;
    std::vector<glm::vec3> radiance;                      // W/(m^2 sr), as a ray that meets the surface has it
    std::vector<float> depth;                             // metres, along the direction; 0: sky
    std::vector<glm::vec3> normal;                        // unit, of the surface, on the probe's side; 0: sky
    std::vector<uint8_t> alone;                           // 1: no other probe of the field sees the surface there
    float nearest = 0.0f, median = 0.0f, farthest = 0.0f; // metres, of all directions but the sky's; 0: there is only sky
    float sky = 0.0f;                                     // share of all directions
    float area = 0.0f, areaAlone = 0.0f;                  // m^2 of the surface that it sees, and of that what no other probe sees
    float first = 0.0f, named = 0.0f; // shares of the octree's box: where it is the first of the leaf's probes, and one of them
};

/// @param probe  of a field of cube faces
/// @param width  pixels, even; the height is half of it
/// Cost: a read a pixel and probe of the field; on all cores.
ProbeView viewOfProbe(const FieldData& field, uint32_t probe, uint32_t width);

} // namespace sconce
