// sconce probe: what one probe of a light field sees, why it stands where it does, and what only it sees.
#include <iostream>

#include <fmt/format.h>

#include "bench/reference/image_io.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/probe_view.h"
#include "tools/field_report.h"

namespace sconce::tools
{

namespace
{

struct ProbeOptions
{
    std::string field, output;
    uint32_t probe = 0, width = knobs::panoramaWidth.value;
    std::optional<float> exposure;
};

constexpr vec3 kAlone{1.0f, 0.25f, 0.0f}; // tints what no other probe sees

/// Four panoramas below one another: radiance, distance, normals, and the radiance in which what no other probe sees is orange.
std::vector<float> sheetOf(const ProbeView& view, std::optional<float> exposure)
{
    const size_t pixels = view.radiance.size();
    std::vector<float> radiance(3 * pixels);
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c) radiance[3 * i + c] = view.radiance[i][int(c)];
    const std::vector<float> mapped = toneMap(radiance, exposure.value_or(autoExposure(radiance)));
    std::vector<float> sheet(mapped);
    sheet.resize(4 * 3 * pixels);
    for (size_t i = 0; i < pixels; ++i)
    {
        const float near = view.depth[i] > 0.0f ? view.median / (view.median + view.depth[i]) : 0.0f; // white at the probe, black far off
        for (size_t c = 0; c < 3; ++c)
        {
            sheet[3 * (pixels + i) + c] = near;
            sheet[3 * (2 * pixels + i) + c] = view.depth[i] > 0.0f ? 0.5f + 0.5f * view.normal[i][int(c)] : 0.0f;
            sheet[3 * (3 * pixels + i) + c] = glm::mix(mapped[3 * i + c], kAlone[int(c)], view.alone[i] != 0 ? 0.6f : 0.0f);
        }
    }
    return sheet;
}

ImageSet layersOf(const ProbeView& view)
{
    ImageSet images;
    images.width = view.width;
    images.height = view.height;
    for (const char* name : {"beauty", "normal"}) images.add(name, 3);
    for (const char* name : {"depth", "alone"}) images.add(name, 1);
    for (size_t i = 0; i < view.radiance.size(); ++i)
    {
        for (size_t c = 0; c < 3; ++c)
        {
            images.layers[0].pixels[3 * i + c] = view.radiance[i][int(c)];
            images.layers[1].pixels[3 * i + c] = view.normal[i][int(c)];
        }
        images.layers[2].pixels[i] = view.depth[i];
        images.layers[3].pixels[i] = view.alone[i] != 0 ? 1.0f : 0.0f;
    }
    return images;
}

Json jsonOf(const FieldData& field, uint32_t probe, const ProbeView& view)
{
    Json json;
    json["probe"] = probe;
    json["position"] = toJson(field.info.origin + field.info.scale * vec3(field.probes[probe].centre));
    json["why"] = field.why.empty() ? "" : field.why[probe];
    json["metres"] = {{"nearest", view.nearest}, {"median", view.median}, {"farthest", view.farthest}};
    json["sky"] = view.sky;
    json["square_metres"] = view.area;
    json["square_metres_alone"] = view.areaAlone;
    json["first_of_space"] = view.first;
    json["named_in_space"] = view.named;
    return json;
}

void print(const FieldData& field, uint32_t probe, const ProbeView& view)
{
    const vec3 at = field.info.origin + field.info.scale * vec3(field.probes[probe].centre);
    std::cout << fmt::format("probe {} of {} at {:.3f}, {:.3f}, {:.3f}\n", probe, field.info.probeCount, at.x, at.y, at.z)
              << fmt::format("why: {}\n",
                             field.why.empty() ? "the field doesn't say; its bake was given probes without reasons" : field.why[probe])
              << fmt::format("sees {:.2f} m^2 of surface {:.2f} to {:.2f} m away, half of its directions within {:.2f} m; {:.1f} % sky\n",
                             view.area, view.nearest, view.farthest, view.median, 100.0f * view.sky)
              << fmt::format("no other probe sees {:.2f} m^2 of it, {:.1f} %\n", view.areaAlone,
                             view.area > 0.0f ? 100.0f * view.areaAlone / view.area : 0.0f)
              << fmt::format("asked first in {:.1f} % of the octree's box, at all in {:.1f} %\n", 100.0f * view.first, 100.0f * view.named)
              << std::flush;
}

int runProbe(const ProbeOptions& options, const Context& context)
{
    const bool exr = options.output.ends_with(".exr");
    if (!exr && !options.output.ends_with(".png"))
        return fail(
            ErrorCode::badArgument,
            fmt::format("-o {}: a panorama is a .png, as it looks, or an .exr, in numbers; give a name that ends so.", options.output));
    const Result<FieldData> field = loadFieldFor(options.field, "ours");
    if (!field) return fail(field.error());
    if (options.probe >= field->info.probeCount)
        return fail(ErrorCode::badArgument, fmt::format("There is no probe {} in '{}'; it has {}, the first is 0.", options.probe,
                                                        options.field, field->info.probeCount));
    const ProbeView view = viewOfProbe(*field, options.probe, options.width / 2 * 2);
    const Status written = exr ? writeExr(layersOf(view), options.output)
                               : writePng(sheetOf(view, options.exposure), view.width, 4 * view.height, options.output);
    if (!written) return fail(written.error());
    if (context.json)
        tools::print(jsonOf(*field, options.probe, view));
    else
        print(*field, options.probe, view);
    return exitOk;
}

} // namespace

void addProbeCommand(CLI::App& app, Context& context)
{
    CLI::App* command =
        addCommand(app, context, "probe", "What one probe of a light field sees, why it stands there, and what only it sees");
    auto options = std::make_shared<ProbeOptions>();
    command->add_option("FIELD", options->field, ".sconce file of cube faces")->required()->type_name("");
    command->add_option("ID", options->probe, "Number of the probe, from 0; as `trace`, `explain` and the layer probe name it")
        ->required()
        ->type_name("");
    command
        ->add_option("-o,--output", options->output,
                     "Panorama to write, its middle towards -z, its right towards +x: .png with radiance, distance (white is near), "
                     "normals, and in orange what no other probe sees, below one another; or .exr with the layers beauty, depth in "
                     "metres, normal and alone (required)")
        ->required()
        ->type_name("FILE");
    addKnob(command, "--width", options->width, knobs::panoramaWidth, "PIXELS");
    addKnob(command, "--exposure", options->exposure, knobs::exposure, "FACTOR");
    onChosen(command, context, options, runProbe);
}

} // namespace sconce::tools
