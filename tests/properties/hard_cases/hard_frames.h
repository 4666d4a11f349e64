#pragma once

#include <vector>

#include "runtime/scene/device_scene.h"

namespace sconce::testing_support
{

/// Few shadow maps: what is tested is not how well they sample.
inline DeviceSceneDesc fewSamples()
{
    DeviceSceneDesc desc;
    desc.light.emitterSamples = desc.light.skySamples = 12;
    desc.light.emitterShadow = desc.light.pointShadow = 64;
    desc.light.skyShadow = 128;
    desc.light.sunShadow = 512;
    return desc;
}

/// Over all pixels and channels.
inline double mean(const std::vector<vec3>& pixels)
{
    double sum = 0.0;
    for (const vec3& p : pixels) sum += double(p.x) + double(p.y) + double(p.z);
    return sum / double(3 * pixels.size());
}
inline double mean(const std::vector<float>& values)
{
    double sum = 0.0;
    for (float v : values) sum += v;
    return sum / double(values.size());
}

} // namespace sconce::testing_support
