#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "bench/reference/image_io.h"
#include "runtime/sconce.h"
#include "scene/view_rays.h"

namespace sconce::tools
{

inline const std::vector<std::string> kFieldLayers = {"beauty", "depth", "normal", "probe", "handoffs", "fetches", "unknown"};

/// A picture without geometry: what probes saw, met by rays from the eye.
struct FieldPicture
{
    ImageSet images;              // kFieldLayers, as `sconce render` has them
    double milliseconds = 0.0;    // of the trace passes, by the device's clock; 0: it has none
    size_t rays = 0, unknown = 0; // unknown: that no probe could answer, and show what was seen last on their way
    double fetchesPerRay = 0.0, handoffsPerRay = 0.0;
};

/// Primary rays through a light field (McGuire et al. 2017, section 5; Donow 2016, chapter 5). Beauty is the mean of a pixel's rays, the
/// other layers are of its first. Errors: cancelled; as RayTracer::trace().
Result<FieldPicture> drawFromField(const RayTracer& tracer, const ViewRays& rays, const Progress& progress);

} // namespace sconce::tools
