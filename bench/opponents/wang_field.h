#pragma once

#include "base/result.h"
#include "runtime/field/field_data.h"

namespace sconce
{

/// What baseline W' reads (Wang et al. 2019, section 4.2), from cube faces of N texels a side: octahedral maps of N texels a side, each
/// texel from the plane of the face texel that its centre's direction falls in, and a min/max chain that is built per cube face and
/// resampled level by level. The paper doesn't say how: here an octahedral texel of level l covers every texel of level l of the faces that
/// its own solid angle touches, so that min <= every distance in it <= max, rounding to 16 bits included. Radiance, irradiance, headers and
/// octree are the faces' own. N must be a power of two, at least 16.
/// Words: shaders/opponents/baseline_wang.h. Errors: badInput (the size). Cost: 8 N^2 texel footprints a probe, all cores.
Result<FieldData> wangField(const FieldData& faces);

} // namespace sconce
