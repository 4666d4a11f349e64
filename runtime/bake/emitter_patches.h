#pragma once

#include <span>
#include <vector>

#include "shaders/shared/lights.h"

namespace sconce
{

/// Patches of emitters by columns, so that several are weighed at once: every place that gathers light weighs them all.
class EmitterPatches
{
public:
    explicit EmitterPatches(std::span<const gpu::GpuLight> patches);

    /// What each patch would give a place unshadowed, luminance of irradiance times what is taken of it: to the bit what the shared text
    /// finds one by one (shaders/shared/surface_gather.h, weightOf(sampleOfPatch())).
    /// @param point     field units; `normal`: unit, that light is gathered about; `plane`: unit, the surface's own
    /// @param near      squared distance over area below which a patch is left to the rays that meet it
    /// @param weights   becomes one a patch
    void weigh(glm::vec3 point, glm::vec3 normal, glm::vec3 plane, float grazing, float near, std::vector<float>& weights) const;

private:
    size_t count = 0, stride = 0;
    std::vector<float> columns; // [11][stride]: place, normal, radiance, area, 1 where it is seen from one side only; to whole lanes with 0
};

} // namespace sconce
