// sconce relight: a light field in other light.
#include <fmt/format.h>

#include "runtime/field/light_field_file.h"
#include "runtime/field/light_groups.h"
#include "runtime/field/live_light.h"
#include "runtime/vulkan/host_vulkan.h"
#include "tools/field_report.h"
#include "tools/light_group_options.h"
#include "tools/live_light_options.h"

namespace sconce::tools
{

namespace
{

struct RelightOptions
{
    std::string field, output, device;
    std::vector<std::string> dims;
    LiveLightOptions live;
    bool keep = false;
};

/// A field in other light, groups and all.
Status relit(FieldData& field, const RelightOptions& options, std::span<const vec3> weights)
{
    if (field.live.links == 0)
    {
        if (options.live.any())
            return Error{ErrorCode::badArgument,
                         fmt::format("The lights of light field '{}' can't move; bake it with --live-links.", options.field)};
        return mixGroups(field, weights);
    }
    for (const LightGroup& group : field.groups)
        if (options.live.sunDirection && std::ranges::find(group.which.members, "sun") != group.which.members.end())
            return Error{ErrorCode::badArgument,
                         fmt::format("--sun: the sun of light field '{}' is in group '{}', which dims it where it stands; bake it without.",
                                     options.field, group.which.name)};
    std::vector<Light> lights = field.live.lights;
    if (Status status = options.live.apply(lights); !status) return status;
    const Result<OwnDevice> device = OwnDevice::create({.device = options.device});
    if (!device) return device.error();
    const auto gpu = Gpu::create(device->host());
    if (!gpu) return gpu.error();
    return relightField(**gpu, field, lights, weights);
}

int runRelight(const RelightOptions& options, const Context& context)
{
    const Stopwatch watch;
    Result<FieldData> field = loadField(options.field);
    if (!field) return fail(field.error());
    const Result<std::vector<vec3>> weights = weightsOf(options.dims, groupsOf(field->groups));
    if (!weights) return fail(weights.error());
    if (options.dims.empty() && !options.live.any() && field->live.lit)
        return fail(ErrorCode::badArgument, "There is nothing to change; give --dim, --sun or --lights.");
    if (Status status = relit(*field, options, *weights); !status) return fail(status.error());
    if (!options.keep)
    {
        field->groups.clear();
        field->live = {};
    }
    field->fileVersion = 0; // it isn't that file
    if (Status status = saveField(*field, options.output); !status) return fail(status.error());
    if (!context.json)
    {
        printField(*field, options.output);
        return exitOk;
    }
    Json json = fieldJson(*field);
    json["dim"] = options.dims;
    addCost(json, watch);
    print(json);
    return exitOk;
}

} // namespace

void addRelightCommand(CLI::App& app, Context& context)
{
    CLI::App* relight =
        addCommand(app, context, "relight", "A light field in other light: of its light groups, and of lights that may move");
    auto options = std::make_shared<RelightOptions>();
    relight
        ->add_option("FIELD", options->field,
                     ".sconce file of `sconce capture`, which takes the scene's lights if told nothing else, or of `bake --group` or "
                     "`--live-links`")
        ->required()
        ->type_name("");
    relight->add_option("-o,--output", options->output, ".sconce file to write (required)")->required()->type_name("FILE");
    relight->add_flag("--keep", options->keep,
                      described("Keeps groups and links, so that its light still changes; else it stays, in a smaller file", words("off")));
    addDims(relight, options->dims);
    options->live.add(relight);
    addDevice(relight, options->device);
    onChosen(relight, context, options, runRelight);
}

} // namespace sconce::tools
