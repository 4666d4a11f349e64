// The `sconce` command: thin, it calls the libraries.
#include <exception>
#include <iostream>

#include <fmt/format.h>

#include "tools/common.h"
#include "tools/version.h"

namespace
{

/// What a command has answered is on stdout, or the command has failed: a full disk swallows it without a word.
int answered(int code)
{
    if (std::cout.flush() || code != sconce::tools::exitOk) return code;
    return sconce::tools::fail(sconce::ErrorCode::fileError, "stdout could not be written whole; free some space or send it elsewhere");
}

} // namespace

int main(int argc, char** argv)
{
    using namespace sconce::tools;
    CLI::App app("Real-time indirect light from non-uniformly placed light field probes.\n"
                 "stdout is data, stderr is progress and notes.\n"
                 "Exit codes: 0 ok, 1 a threshold was missed, 2 usage, 3 input, 4 device or memory, 5 file, 130 interrupted.",
                 "sconce");
    app.set_version_flag("--version", versionText());
    app.require_subcommand(1);
    Context context;
    context.commandLine = spelledForShell(argc, argv);
    context.arguments.assign(argv + 1, argv + argc);
    addSceneCommands(app, context);
    addPlaceCommand(app, context);
    addBakeCommand(app, context);
    addMergeCommand(app, context);
    addFieldCommands(app, context);
    addRelightCommand(app, context);
    addRenderCommand(app, context);
    addTraceCommand(app, context);
    addProbeCommand(app, context);
    addExplainCommand(app, context);
    addReferenceCommands(app, context);
    addViewCommand(app, context);
    addBenchCommand(app, context);
    addTuneCommand(app, context);
    addKnobsCommand(app, context);
    addManualCommand(app, context);
    addDoctorCommand(app, context);
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        return answered(app.exit(error) == 0 ? exitOk : exitUsage);
    }
    catchInterrupts();
    try
    {
        const int code = context.action();
        endProgress();
        return answered(code);
    }
    catch (const std::bad_alloc&)
    {
        return fail(sconce::ErrorCode::outOfMemory,
                    "There is not enough memory; choose a smaller scene, fewer probes or a lower resolution.");
    }
    catch (const std::exception& error)
    {
        return fail(sconce::ErrorCode::badInput, fmt::format("Unexpected failure: {}.", error.what()));
    }
}
