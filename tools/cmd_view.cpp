// sconce view: a scene in a window, in the light of its field, with knobs that change while it is drawn.
#include <fmt/format.h>

#include "tools/field_report.h"
#include "tools/frame_setup.h"
#include "tools/light_group_options.h"
#include "tools/view/viewer.h"

namespace sconce::tools
{

namespace
{

struct ViewOptions : FrameChoice
{
    SceneOptions scene;
    CameraOptions camera;
    std::string field, device, script;
    std::vector<std::string> groups;
    std::optional<float> exposure;
    uint32_t width = 2 * knobs::width.value, height = 2 * knobs::height.value;
};

int runView(const ViewOptions& options, const Context& context)
{
    if (!hasViewer()) return fail(runViewer({}, context).error()); // before anything that takes time
    ViewDesc desc;
    if (!options.script.empty())
    {
        auto script = readScript(options.script);
        if (!script) return fail(script.error());
        desc.script = std::move(*script);
        desc.scriptName = options.script;
    }
    auto groups = groupsOf(options.groups);
    if (!groups) return fail(groups.error());
    desc.groups = std::move(*groups);
    Result<Scene> scene = options.scene.load(context);
    if (!scene) return fail(scene.error());
    const Result<Camera> camera = options.camera.choose(*scene);
    if (!camera) return fail(camera.error());
    if (!options.field.empty())
    {
        auto field = loadFieldFor(options.field, "ours");
        if (!field) return fail(field.error());
        if (!field->sceneName.empty() && field->sceneName != scene->name)
            note(context, fmt::format("Note: the light field was baked from scene '{}', this is '{}'.", field->sceneName, scene->name));
        desc.field = std::move(*field);
        desc.fieldName = options.field;
    }
    desc.scene = std::move(*scene);
    desc.camera = *camera;
    desc.frame = options;
    desc.exposure = options.exposure;
    desc.device = options.device;
    desc.width = options.width;
    desc.height = options.height;
    if (const Status ended = runViewer(std::move(desc), context); !ended) return fail(ended.error());
    return exitOk;
}

} // namespace

void addViewCommand(CLI::App& app, Context& context)
{
    CLI::App* command =
        addCommand(app, context, "view",
                   "Shows a scene in a window, in the light of its light field, beside a path-traced reference where asked for; "
                   "knobs, effects and light change while it is drawn");
    auto options = std::make_shared<ViewOptions>();
    options->scene.add(command);
    command
        ->add_option("--field", options->field,
                     described(".sconce file of `sconce bake`", words("probes are placed and a field is baked first, with every default")))
        ->type_name("FILE");
    options->camera.add(command);
    addSize(command, options->width, options->height);
    addFrameOptions(command, *options);
    addKnob(command, "--exposure", options->exposure, knobs::exposure, "FACTOR", "Factor before the tone map");
    addGroups(command, options->groups, "Lights of the scene that the panel dims, where the field has no groups");
    addDevice(command, options->device);
    command
        ->add_option(
            "--script", options->script,
            described("Commands to play before the window is yours, a line each: camera X,Y,Z X,Y,Z (eye, target); set KNOB VALUE; "
                      "effect NAME on|off; effects LIST; view NAME; compare off|split|difference [PATHS]; sun X,Y,Z [R,G,B]; "
                      "dim GROUP W; panel on|off; frame N; shot FILE.exr|FILE.png; screen FILE.png; quit",
                      words("none")))
        ->type_name("FILE");
    onChosen(command, context, options, runView);
}

} // namespace sconce::tools
