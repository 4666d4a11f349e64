#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "base/result.h"
#include "shaders/shared/light_field.h"

namespace sconce::tools
{

/// rays.csv: header ox,oy,oz,dx,dy,dz or ox,oy,oz,dx,dy,dz,nx,ny,nz (Ray::normal), then a ray a line; numbers as text, nan and inf
/// included. Directions and normals come back unit, or zero where they have none. Errors: fileError; badInput names the line.
Result<std::vector<gpu::Ray>> readRays(const std::filesystem::path& file);

/// hits.csv in the order of the rays; a number that is not finite is written as 0. Whole or not at all.
Status writeHits(std::span<const gpu::RayHit> hits, const std::filesystem::path& file);

} // namespace sconce::tools
