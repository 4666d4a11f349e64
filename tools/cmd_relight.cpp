// sconce relight: a light field in other light.
#include "runtime/field/light_field_file.h"
#include "runtime/field/light_groups.h"
#include "tools/field_report.h"
#include "tools/light_group_options.h"

namespace sconce::tools
{

namespace
{

struct RelightOptions
{
    std::string field, output;
    std::vector<std::string> dims;
};

int runRelight(const RelightOptions& options, const Context& context)
{
    const Stopwatch watch;
    Result<FieldData> field = loadField(options.field);
    if (!field) return fail(field.error());
    const Result<std::vector<vec3>> weights = weightsOf(options.dims, groupsOf(field->groups));
    if (!weights) return fail(weights.error());
    if (Status mixed = mixGroups(*field, *weights); !mixed) return fail(mixed.error());
    field->groups.clear();
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
    CLI::App* relight = addCommand(app, context, "relight", "A light field in other light of its light groups, without rays");
    auto options = std::make_shared<RelightOptions>();
    relight->add_option("FIELD", options->field, ".sconce file of `sconce bake --group`")->required()->type_name("");
    relight->add_option("-o,--output", options->output, ".sconce file to write, without groups (required)")->required()->type_name("FILE");
    addDims(relight, options->dims);
    relight->get_option("--dim")->required();
    onChosen(relight, context, options, runRelight);
}

} // namespace sconce::tools
