#pragma once

#include "bench/sweep/settings.h"

namespace sconce
{

/// One point that a bench measures: the scene's defaults of its method but for one knob.
struct PlannedPoint
{
    std::string id;    // METHOD/default, METHOD/KNOB=VALUE
    std::string knob;  // "default" for the default point itself
    std::string value; // of the knob
    PointSettings settings;
};

struct PlanSettings
{
    uint32_t probes = knobs::benchProbes.value; // of the default points
    std::vector<std::string> knobs;             // only these; empty: all
    std::vector<std::string> methods;           // only these; empty: all
    bool methodsOnly = false;                   // the methods' default points alone, volumes at several biases and at equal bytes, too
    std::optional<float> roughness;             // of every surface
    PointSettings ours;                         // our default point; method, probes and roughness are set from the above
};

/// The points of one scene; the first is our default. Ours with every knob; B0, B0+, B0+ with our placement and lists, and W' with their
/// own curves (probes and resolution), our tracer on the uniform grid likewise; the path tracer at 1 to 64 paths a pixel.
/// The opponents' octahedral maps have as many texels as take no more memory than our cube faces. W' reads maps of as many texels, made
/// from cube faces of as many. Errors: badArgument (names a knob that isn't there).
Result<std::vector<PlannedPoint>> planPoints(const PlanSettings& settings);

} // namespace sconce
