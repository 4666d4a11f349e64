#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace sconce
{

/// What GGX reflects of white light from every direction, as (scale, bias) of the reflectance at normal incidence (Karis 2013, "Real
/// Shading in Unreal Engine 4"): kEnvironmentBrdfSide^2 entries, [square root of alpha][cosine to the eye], both from 0 to 1. By the
/// shaders' own BRDF text; 512 visible-normal samples an entry. Cost: about 60 ms.
std::vector<glm::vec2> environmentBrdf();

} // namespace sconce
