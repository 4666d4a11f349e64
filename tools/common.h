#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/progress.h"
#include "base/result.h"
#include "scene/scene.h"
#include "tools/knob_options.h"
#include "tools/live_light_options.h"

namespace sconce::tools
{

using Json = nlohmann::ordered_json;

enum Exit : int
{
    exitOk = 0,
    exitThreshold = 1,
    exitUsage = 2,
    exitInput = 3,
    exitDevice = 4,
    exitFile = 5,
    exitInterrupted = 130
};
int exitCode(ErrorCode code);

/// What every sub-command shares: its flags, and the action that parsing chose.
struct Context
{
    bool json = false;
    bool quiet = false;
    std::function<int()> action;
    std::string commandLine;            // as it was typed, for what records how it was made
    std::vector<std::string> arguments; // the same, one by one, without the program
};

/// A command line as a shell takes it: `sconce`, then the arguments, those in single quotes that need it.
std::string spelledForShell(int argc, const char* const* argv);

/// A sub-command with --json and --quiet.
CLI::App* addCommand(CLI::App& app, Context& context, const std::string& name, const std::string& description);

/// Runs `run(options)` when the command line names this sub-command. The options live as long as the command line does.
template <class Options, class Run> void onChosen(CLI::App* command, Context& context, std::shared_ptr<Options> options, Run run)
{
    command->callback([&context, options, run] { context.action = [&context, options, run] { return run(*options, context); }; });
}

/// Prints the sentence on stderr and returns the exit code.
int fail(const Error& error);
int fail(ErrorCode code, const std::string& message);

/// Writes to stdout: JSON when --json was given, else the text.
void print(const Json& json);

/// Notes of a scene or a stage, on stderr unless --quiet.
void note(const Context& context, const std::string& text);

/// Progress on stderr: a bar with stage, per cent and time left on a terminal, a line now and then elsewhere, nothing when quiet. Cancels
/// after SIGINT or SIGTERM.
Progress consoleProgress(const Context& context);
void endProgress(); // leaves the bar's line, if one is drawn
void catchInterrupts();
bool interrupted();

/// Comma-separated numbers, all finite, of one of the allowed counts; the sentence says what is wrong.
Result<std::vector<float>> parseNumbers(const std::string& text, std::initializer_list<size_t> counts);
/// "1280x720" or "8x4x8": positive integers up to 65,535.
Result<std::vector<uint32_t>> parseSize(const std::string& text, size_t count);

/// A check whose bounds the description states already, in words.
template <class Check> CLI::Validator unlisted(Check check)
{
    return check.description("");
}

/// An option of numbers; a bad value is a usage error that names the option.
void addVec3(CLI::App* command, const std::string& name, std::optional<vec3>& target, const std::string& description);
void addSize(CLI::App* command, uint32_t& width, uint32_t& height);

/// SCENE, --sun and --sky.
struct SceneOptions
{
    std::string name;
    LiveLightOptions lights;
    std::optional<vec3> sky;

    void add(CLI::App* command);
    void addLight(CLI::App* command); // --sun, --lights and --sky alone
    /// The scene with its light overridden; a scene without any light gets the default sun and sky. Notes its warnings.
    Result<Scene> load(const Context& context) const;
};

/// --camera NAME, or --eye, --target and --fov.
struct CameraOptions
{
    std::string name;
    std::optional<vec3> eye, target;
    float fov = knobs::verticalFov.value; // degrees, vertical

    void add(CLI::App* command);
    Result<Camera> choose(const Scene& scene) const;
};

/// --device of the commands that use one.
void addDevice(CLI::App* command, std::string& device);

/// Seconds since its making, and the process's largest memory so far.
class Stopwatch
{
public:
    Stopwatch();
    double seconds() const;

private:
    double start;
};
double peakRssMb();
void addCost(Json& json, const Stopwatch& watch);

Json toJson(vec3 v);
std::vector<std::string> split(const std::string& text, char separator);

void addSceneCommands(CLI::App& app, Context& context);
void addKnobsCommand(CLI::App& app, Context& context);
void addPlaceCommand(CLI::App& app, Context& context);
void addBakeCommand(CLI::App& app, Context& context);
void addMergeCommand(CLI::App& app, Context& context);
void addFieldCommands(CLI::App& app, Context& context);
void addRenderCommand(CLI::App& app, Context& context);
void addTraceCommand(CLI::App& app, Context& context);
void addReferenceCommands(CLI::App& app, Context& context);
void addRelightCommand(CLI::App& app, Context& context);
void addBenchCommand(CLI::App& app, Context& context);
void addTuneCommand(CLI::App& app, Context& context);
void addManualCommand(CLI::App& app, Context& context);
void addProbeCommand(CLI::App& app, Context& context);
void addExplainCommand(CLI::App& app, Context& context);
void addViewCommand(CLI::App& app, Context& context);
void addDoctorCommand(CLI::App& app, Context& context);

} // namespace sconce::tools
