// sconce tune: settings from the measured front of a bench.
#include <iostream>

#include <fmt/format.h>

#include "base/safe_file.h"
#include "bench/sweep/tune.h"
#include "tools/common.h"

namespace sconce::tools
{

namespace
{

struct TuneOptions
{
    std::string scene, results = "out/bench/results.json", output = "settings.json";
    TuneGoal goal;
};

int runTune(const TuneOptions& options, const Context& context)
{
    const Result<Json> results = readResults(options.results);
    if (!results) return fail(results.error());
    std::string known;
    for (const Json& scene : (*results)["scenes"])
    {
        const std::string name = scene["name"];
        known += (known.empty() ? "" : ", ") + name;
        if (name != options.scene && scene.value("source", Json()) != options.scene) continue;
        const Result<Json> point = tune(scene["points"].get<std::vector<Json>>(), options.goal);
        if (!point && point.error().code == ErrorCode::badInput) // a goal that can't be met
        {
            std::cerr << "sconce: " << point.error().message << std::endl;
            return exitThreshold;
        }
        if (!point) return fail(point.error());
        const Json file = qualityFile(name, *point);
        if (Status status = writeText(options.output, file.dump(1) + "\n"); !status) return fail(status.error());
        if (context.json)
            print(file);
        else
            std::cout << options.output << ": " << file["point"].get<std::string>() << ", " << file["price"].dump() << std::endl;
        return exitOk;
    }
    return fail(ErrorCode::badArgument,
                fmt::format("'{}' has no scene '{}'; it has: {}.", options.results, options.scene, known.empty() ? "none" : known));
}

} // namespace

void addTuneCommand(CLI::App& app, Context& context)
{
    CLI::App* command =
        addCommand(app, context, "tune", "Picks settings that keep to a time, an error or a memory from what `sconce bench` measured");
    auto options = std::make_shared<TuneOptions>();
    command->add_option("SCENE", options->scene, "Name of a scene of the results")->required()->type_name("");
    command->add_option("--results", options->results, described("What a bench measured", options->results))->type_name("FILE");
    addKnob(command, "--time", options->goal.frameMs, knobs::goalTime, "MS");
    addKnob(command, "--error", options->goal.error, knobs::goalError, "E");
    addKnob(command, "--memory", options->goal.bytes, knobs::goalMemory, "BYTES");
    addKnob(command, "--metric", options->goal.metric, knobs::goalMetric);
    command
        ->add_option("-o,--output", options->output, described("File to write, for --quality of place, bake and render", options->output))
        ->type_name("FILE");
    onChosen(command, context, options, runTune);
}

} // namespace sconce::tools
