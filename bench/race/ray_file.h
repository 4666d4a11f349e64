#pragma once

#include <filesystem>

#include "base/result.h"
#include "bench/race/trace_score.h"

namespace sconce
{

/// Rays with their truth, as sconce_replay reads them where no scene can be loaded: 32 bytes ("SCNR", version 3, number of rays, diagonal
/// in metres, zeros), then 48 bytes a ray: origin, direction, normal, distance of the truth (-1: a miss) and of RaySet::fartherTruth,
/// 32-bit floats, and the viewpoint, all ones where it is not known; little endian. Errors: fileError.
Status saveRays(const RaySet& set, const std::filesystem::path& file);
/// Truth has its distances alone. Errors: fileError, badInput (not such a file, cut short, numbers that are not finite).
Result<RaySet> loadRays(const std::filesystem::path& file);

} // namespace sconce
