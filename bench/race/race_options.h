#pragma once

#include <CLI/CLI.hpp>

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
    app.add_option("--runs", race.runs, "timed runs; 0 takes no times (default: 0; range: 0 to 1000)")->check(CLI::Range(0u, 1000u));
    app.add_option("--timed", race.timed, "rays of a timed run, evenly taken of all (default: 50000; range: 1 to 262144)")
        ->check(CLI::Range(1u, 262144u));
    app.add_option("--seed", race.seed, "seed of the rays and of their shuffling (default: 1)");
    app.add_flag("--cpu", race.cpu, "trace the same rays on the CPU, too, and count the answers that differ");
    app.add_flag("--json", race.json, "machine-readable results");
}

} // namespace sconce
