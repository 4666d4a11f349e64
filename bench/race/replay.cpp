// Rays that were recorded with their truth, through baked light fields again: the same shares and reads on any machine with Vulkan, and
// that machine's times. Links the runtime and nothing that reads or traces scenes.
//   sconce_replay RAYS --field [TRACER=]FILE... [--runs N] [--timed N] [--cpu] [--json]
#include <CLI/CLI.hpp>

#include "bench/race/race_options.h"
#include "bench/race/ray_file.h"

int main(int argc, char** argv)
{
    CLI::App app{"Recorded rays through light fields: accuracy, reads, and this machine's times"};
    std::string rays;
    sconce::RaceSettings race;
    app.add_option("RAYS", rays, "file of `sconce bench` (DIR/replay/SCENE.rays) or `sconce_ray_accuracy --record`")->required();
    sconce::addRaceOptions(app, race);
    CLI11_PARSE(app, argc, argv);
    const auto set = sconce::loadRays(rays);
    return sconce::exitCodeOf(set ? sconce::raceOnOwnDevice(*set, race) : sconce::Status(set.error()));
}
