#pragma once

#include <span>
#include <vector>

#include "placement/picture.h"
#include "runtime/field/explain.h"
#include "scene/scene.h"

namespace sconce::tools
{

/// Colours of a ray's stretches, one after another and anew: what the text beside the picture names them by.
struct NamedColour
{
    const char* name;
    vec3 linear;
};
inline constexpr NamedColour kStretchColours[] = {{"yellow", {0.9f, 0.75f, 0.1f}},   {"cyan", {0.1f, 0.7f, 0.9f}},
                                                  {"magenta", {0.85f, 0.15f, 0.7f}}, {"green", {0.2f, 0.75f, 0.15f}},
                                                  {"orange", {0.95f, 0.35f, 0.05f}}, {"blue", {0.2f, 0.3f, 0.95f}}};

/// A ray's way from the side: the scene cut by the plane through the ray and the vertical (through the ray and -z where it is vertical
/// itself), the ray's stretches in their colours, the probes that were asked as discs in the colour of their first stretch (rings where
/// they stand before or behind the plane), a white cross where the ray truly ends.
/// @param truth  metres along the ray to what it meets; infinity: nothing
Picture drawWay(const Scene& scene, const FieldData& field, const gpu::Ray& ray, const ExplainedRay& way, float truth);

} // namespace sconce::tools
