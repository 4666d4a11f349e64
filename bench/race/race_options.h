#pragma once

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/race/tracer_race.h"

namespace sconce
{

/// The options of the programs that race tracers: sconce_ray_accuracy and sconce_replay.
inline void addRaceOptions(CLI::App& app, RaceSettings& race)
{
    app.add_option(
           "--field", race.fields,
           "[TRACER=]FILE, a baked light field and what traces it: ours, b0, b0plus, b0plus-octree or wang; ours/ranked:2,opinion:0 "
           "sets knobs, b0plus/8 the low factor (default: b0plus for octahedral maps on a grid, b0plus-octree for others, else ours); "
           "repeatable")
        ->required();
    const auto add = [&app](const char* name, auto& target, const auto& knob)
    {
        app.add_option(name, target, fmt::format("{} (default: {}; range: {})", knob.what, defaultText(knob), rangeText(knob)))
            ->check(CLI::Range(knob.least, knob.most));
    };
    add("--runs", race.runs, knobs::timedRuns);
    add("--timed", race.timed, knobs::timedRays);
    add("--warm-up", race.warmUp, knobs::warmUpSeconds);
    add("--memory", race.memory, knobs::deviceMebibytes);
    app.add_option("--cold", race.cold,
                   "MiB that are written between timed passes, so that caches hold nothing of the field (default: 0; range: 0 to 4096 MiB)")
        ->check(CLI::Range(0u, 4096u));
    app.add_option("--seed", race.seed, fmt::format("seed of the rays and of their shuffling (default: {})", race.seed));
    app.add_flag("--cpu", race.cpu, "trace the same rays on the CPU, too, and count the answers that differ");
    app.add_flag("--json", race.json, "machine-readable results");
}

} // namespace sconce
