#pragma once

#include <vector>

#include "runtime/field/tracer_cpu.h"
#include "tests/support/field_by_rays.h"

namespace sconce::testing_support
{

inline constexpr uint32_t kLitTexels = 24; // of surface light a side

/// A field by rays with the light that `lightAt` says at every texel's point, world metres.
template <class Light> FieldData litField(const Scene& scene, const std::vector<vec3>& probes, Light lightAt)
{
    const RayScene rays = std::move(*RayScene::create(scene));
    FieldData field = fieldByRays(rays, probes, 96);
    field.info.surfaceSize = kLitTexels;
    field.info.cellShift = cellShiftOf(field.info);
    field.surfaceLight.resize(size_t(6) * kLitTexels * kLitTexels * probes.size() + cellWords(field.info));
    field.irradiance.assign(probes.size() * kIrradianceWordsPerProbe, 0u);
    twin::LightFieldTwin<float> text(field, defaultQuality());
    for (uint32_t probe = 0; probe < probes.size(); ++probe)
        for (int face = 0; face < 6; ++face)
            for (int y = 0; y < int(kLitTexels); ++y)
                for (int x = 0; x < int(kLitTexels); ++x)
                {
                    const auto point = text.surfacePointAt(probe, face, x, y);
                    const vec3 world = field.info.origin + field.info.scale * (vec3(field.probes[probe].centre) + point.at);
                    field.surfaceLight[text.surfaceIndex(probe, face, x, y)] = text.packSharedExponent(vec3(lightAt(world)));
                }
    return field;
}

} // namespace sconce::testing_support
