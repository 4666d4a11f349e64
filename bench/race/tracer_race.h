#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/knobs.h"
#include "bench/race/trace_score.h"
#include "runtime/vulkan/gpu.h"

namespace sconce
{

struct RaceSettings
{
    std::vector<std::string> fields;           // [TRACER=]FILE each, as TracedMethod::create reads them
    uint32_t runs = knobs::timedRuns.value;    // timed; 0 takes no times
    uint32_t timed = knobs::timedRays.value;   // rays of a timed run, evenly taken of all, or all again and again
    uint64_t seed = 1;                         // of their shuffling
    float warmUp = knobs::warmUpSeconds.value; // seconds of runs that don't count
    uint32_t cold = 0;                         // MiB written between timed passes, so that no cache holds the field
    uint64_t memory = 0;                       // MiB of device memory at most, of all fields; 0: 80 % of the device's
    bool cpu = false;                          // trace on the CPU, too, and count the answers that differ
    bool json = false;
};

/// What takes its turn beside the tracers and is right by definition.
struct OutsideRunner
{
    std::string name, note;
    std::function<double(const RaySet& rays)> milliseconds; // of one run over the rays
};

/// Scores tracers on the same rays and prints a table, or JSON, on stdout. With runs, times: the tracers take turns, so that whatever else
/// the machine does falls on all of them, and every turn traces the rays once in their order and once shuffled.
Status raceTracers(Gpu& gpu, const std::string& device, const RaySet& set, const RaceSettings& settings,
                   const std::optional<OutsideRunner>& outside = {});

/// The same on the best device there is.
Status raceOnOwnDevice(const RaySet& set, const RaceSettings& settings, const std::optional<OutsideRunner>& outside = {});

/// Prints the sentence of a failure on stderr; the program's exit code.
int exitCodeOf(const Status& status);

} // namespace sconce
