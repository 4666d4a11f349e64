#include "base/knobs.h"

#include <cstdio>

#include <fmt/format.h>

#include "base/listed.h"
namespace sconce
{

std::string knobText(uint32_t value)
{
    return value == knobs::kMost32 ? "2^32-1" : fmt::to_string(value);
}

std::string knobText(int value)
{
    return fmt::to_string(value);
}

std::string knobText(uint64_t value)
{
    return value == knobs::kMost64 ? "2^64-1" : fmt::to_string(value);
}

std::string knobText(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    std::string shown = text;
    if (const size_t e = shown.find('e'); e != std::string::npos) // 1e-6, not 1e-06; 1e6, not 1e+06
    {
        const size_t first = shown[e + 1] == '-' ? e + 2 : e + 1;
        shown.erase(first, shown.find_first_not_of("+0", first) - first);
    }
    return shown;
}

std::string knobText(float value)
{
    return knobText(double(value)); // six digits hide what a float adds to 0.995
}

std::string knobText(bool value)
{
    return value ? "on" : "off";
}

std::string knobText(std::string_view value)
{
    return std::string(value);
}

namespace knob_words
{

std::string range(const std::vector<std::string>& only, const std::string& least, const std::string& most, std::string_view unit,
                  std::string_view also)
{
    std::string text = most.empty() ? least : fmt::format("{} to {}", least, most);
    if (most.empty() && !least.empty() && !least.starts_with("above")) text += " or more";
    if (!only.empty()) text = listed(only);
    if (!unit.empty()) text += fmt::format(" {}", unit);
    if (!also.empty()) text += fmt::format(", {}", also);
    return text;
}

std::string fault(std::string_view name, const std::string& value, const std::string& range)
{
    return fmt::format("{} is {}; give {}", name, value.empty() ? "''" : value, range);
}

} // namespace knob_words

std::span<const KnobRow> knobRows()
{
    using namespace knobs;
    // Named one by one, since constants of different types can't be walked through; a test counts them against the header.
    static const std::vector<KnobRow> rows = {rowOf(method),          rowOf(count),           rowOf(fitGrid),
                                              rowOf(coverage),        rowOf(mapBytes),        rowOf(placeSeed),
                                              rowOf(clearance),       rowOf(distanceVoxels),  rowOf(candidates),
                                              rowOf(surfels),         rowOf(refine),          rowOf(refineRounds),
                                              rowOf(refineSurfels),   rowOf(resolution),      rowOf(bounces),
                                              rowOf(converged),       rowOf(surfaceTexels),   rowOf(surfaceRays),
                                              rowOf(surfaceRefined),  rowOf(liveLinks),       rowOf(compact),
                                              rowOf(lampTexels),      rowOf(gather),          rowOf(chart),
                                              rowOf(deviceMebibytes), rowOf(hostBytes),       rowOf(submissionMs),
                                              rowOf(octreeVoxels),    rowOf(topShift),        rowOf(textureSize),
                                              rowOf(emitterSamples),  rowOf(skySamples),      rowOf(tracedLightSamples),
                                              rowOf(sunShadow),       rowOf(pointShadow),     rowOf(emitterShadow),
                                              rowOf(skyShadow),       rowOf(glossyRays),      rowOf(diffuse),
                                              rowOf(areaShadows),     rowOf(traceEvery),      rowOf(surfaceProbes),
                                              rowOf(resident),        rowOf(raysBelow),       rowOf(areaSamples),
                                              rowOf(denoise),         rowOf(temporal),        rowOf(screenTrace),
                                              rowOf(normalOffset),    rowOf(roughness),       rowOf(frameSeed),
                                              rowOf(drawnFrames),     rowOf(warmUpSeconds),   rowOf(width),
                                              rowOf(height),          rowOf(verticalFov),     rowOf(exposure),
                                              rowOf(panoramaWidth),   rowOf(explainedPaths),  rowOf(light),
                                              rowOf(ranked),          rowOf(opinion),         rowOf(maxHandoffs),
                                              rowOf(startLevel),      rowOf(coarsestLevel),   rowOf(tolerance),
                                              rowOf(epsilon),         rowOf(farBounds),       rowOf(order),
                                              rowOf(paths),           rowOf(pathsUntil),      rowOf(pathBounces),
                                              rowOf(pathSeed),        rowOf(pixelCentre),     rowOf(parts),
                                              rowOf(benchProbes),     rowOf(benchResolution), rowOf(referenceBounces),
                                              rowOf(benchBounces),    rowOf(benchWidth),      rowOf(benchHeight),
                                              rowOf(judgedRays),      rowOf(timedFrames),     rowOf(warmUp),
                                              rowOf(referencePaths),  rowOf(referenceUntil),  rowOf(benchSeed),
                                              rowOf(groupMebibytes),  rowOf(placement),       rowOf(lowFactor),
                                              rowOf(lookUpBias),      rowOf(lookUpView),      rowOf(distanceBits),
                                              rowOf(tracedPaths),     rowOf(timedRuns),       rowOf(timedRays),
                                              rowOf(goalTime),        rowOf(goalError),       rowOf(goalMemory),
                                              rowOf(goalMetric)};
    return rows;
}

} // namespace sconce
