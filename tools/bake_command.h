#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/bake/bake.h"
#include "tools/bake_job.h"
#include "tools/quality_option.h"

namespace sconce::tools
{

/// What `sconce bake` and `sconce capture` are told.
struct BakeOptions
{
    SceneOptions scene;
    BakeSettings settings;
    std::string probes, output, device, effects = "auto", gather{knobs::gather.value};
    std::vector<std::string> groups, dims;
    uint64_t memoryMb = knobs::deviceMebibytes.value;
    QualityOption quality;
    JobOptions job;
};

/// Both commands, with what a command line told the one that it chose.
struct BakeCommands
{
    std::shared_ptr<BakeOptions> bake, capture;
};
BakeCommands addBakeCommands(CLI::App& app, Context& context);

/// @param parts  that were baked before, of all shards
/// @return  the exit code
int runBake(const BakeOptions& options, std::vector<JournalFile> parts, const Context& context);

} // namespace sconce::tools
