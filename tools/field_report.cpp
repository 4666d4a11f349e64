#include "tools/field_report.h"

#include <algorithm>
#include <cstdio>
#include <iostream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/listed.h"
#include "bench/opponents/baselines.h"
#include "runtime/bake/prefilter.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/tracer_cpu.h"

namespace sconce::tools
{

namespace
{

const char* chartName(uint32_t chart)
{
    return chart == gpu::kChartCube ? "cube" : "octahedral";
}

/// Median of the texels of surface light that show a surface, of some evenly spread: how many fit into a metre there. 0: there are none.
double texelsPerMetre(const FieldData& field)
{
    constexpr size_t kAsked = 100000;
    twin::LightFieldTwin<float> text(field, {});
    const uint32_t side = field.info.surfaceSize, texels = 6 * side * side * field.info.probeCount;
    std::vector<double> found;
    for (size_t i = 0; i < texels; i += 1 + texels / kAsked)
    {
        const auto at = uint32_t(i);
        const auto point = text.surfacePointAt(at / (6 * side * side), int(at / (side * side) % 6), int(at % side), int(at / side % side));
        if (point.width > 0.0f) found.push_back(1.0 / double(point.width * field.info.scale));
    }
    if (found.empty()) return 0.0;
    const auto middle = found.begin() + std::ptrdiff_t(found.size() / 2);
    std::ranges::nth_element(found, middle);
    return *middle;
}
constexpr double kFewTexels = 4.0; // a metre: contact shadows of chairs and shelves are lost

Json bytesJson(const FieldBytes& bytes)
{
    return {{"total", bytes.total()},
            {"distance", bytes.distance},
            {"normals", bytes.normals},
            {"radiance", bytes.radiance},
            {"irradiance", bytes.irradiance},
            {"index", bytes.index},
            {"prefiltered_radiance", bytes.prefiltered},
            {"surface_light", bytes.surface},
            {"surface_light_cells", bytes.cells},
            {"lamps", bytes.lamps},
            {"light_groups", bytes.groups},
            {"live", bytes.live}};
}

std::string megabytes(size_t bytes)
{
    char text[32];
    std::snprintf(text, sizeof(text), "%.2f MB", double(bytes) / 1e6);
    return text;
}

} // namespace

Json fieldJson(const FieldData& field)
{
    const gpu::LightFieldInfo& info = field.info;
    Json json;
    json["scene"] = field.sceneName;
    json["probes"] = info.probeCount;
    json["chart"] = chartName(info.chart);
    json["resolution"] = field.resolution;
    json["face_size"] = info.faceSize;
    json["surface_size"] = info.surfaceSize;
    if (info.surfaceSize > 0) json["surface_texels_per_metre"] = texelsPerMetre(field);
    json["compact"] = inBlocks(field.info);
    json["surface_directions"] = info.surfaceDirections != 0;
    json["lamps"] = field.lamps.size();
    json["bounces"] = field.bounces;
    json["effects"] = field.effects;
    json["bytes"] = bytesJson(bytesByPart(field));
    json["light_groups"] = Json::array();
    for (const LightGroup& group : field.groups)
        json["light_groups"].push_back({{"name", group.which.name}, {"members", group.which.members}});
    json["live_links"] = field.live.links;
    json["lit"] = field.live.lit;
    json["live_lights"] = Json::array();
    for (const Light& light : field.live.lights) json["live_lights"].push_back(light.name);
    json["octree"] = {{"leaves", field.octree.leaves},
                      {"nodes", field.octree.nodes},
                      {"depth", field.octree.topShift},
                      {"voxel", field.octree.voxel * info.scale},
                      {"top_cells", {info.topCells.x, info.topCells.y, info.topCells.z}}};
    if (info.gridX != 0) json["grid"] = {info.gridX, info.gridY, info.gridZ};
    json["origin"] = toJson(info.origin);
    json["scale"] = info.scale;
    json["sky"] = toJson(info.sky);
    json["format_version"] = field.fileVersion > 0 ? field.fileVersion : fileVersionOf(field); // what was baked is written as that
    return json;
}

void printField(const FieldData& field, const std::string& file)
{
    const gpu::LightFieldInfo& info = field.info;
    const FieldBytes bytes = bytesByPart(field);
    std::cout << file << ": scene " << field.sceneName << ", " << info.probeCount << " probes, chart " << chartName(info.chart) << ", "
              << (info.chart == gpu::kChartCube ? "faces of " : "maps of ") << info.faceSize << " texels, " << field.bounces << " bounces\n"
              << fmt::format("bytes: {} = distance {} + normals {} + radiance {} + prefiltered {} + irradiance {} + index {}\n",
                             megabytes(bytes.total()), megabytes(bytes.distance), megabytes(bytes.normals), megabytes(bytes.radiance),
                             megabytes(bytes.prefiltered), megabytes(bytes.irradiance), megabytes(bytes.index))
              << (inBlocks(field.info) ? "maps in blocks of 4x4 texels (--compact)\n" : "") << "octree: " << field.octree.leaves
              << " leaves, " << field.octree.nodes << " nodes, depth " << field.octree.topShift << ", voxels of "
              << field.octree.voxel * info.scale << " m\n";
    const double density = info.surfaceSize > 0 ? texelsPerMetre(field) : 0.0;
    if (info.surfaceSize > 0)
        std::cout << fmt::format(
            "surface light: {} texels a face's side{}, {:.1f} a metre{}; {}, {} of it in cells of {} m in the open, {} in {} refined "
            "texels, {} of hidden surfaces\n",
            info.surfaceSize, info.surfaceDirections != 0 ? " with directions" : "", density,
            density < kFewTexels && info.surfaceSize < knobs::surfaceTexels.most
                ? fmt::format(" (few: --surface-texels {} has more)", knobs::surfaceTexels.most)
                : "",
            megabytes(bytes.surface), megabytes(bytes.cells), float(1 << info.cellShift) * info.voxel * info.scale,
            megabytes(bytes.refined), info.refinedTexels, megabytes(bytes.hidden));
    if (!field.lamps.empty())
        std::cout << fmt::format("lamps: {}, with shadow maps of {} texels a side, {}\n", field.lamps.size(), field.lamps[0].size,
                                 megabytes(bytes.lamps));
    if (!field.groups.empty())
    {
        std::cout << fmt::format("light groups: {} in {}, {} each, {:.2f} MB a probe:", field.groups.size(), megabytes(bytes.groups),
                                 megabytes(bytes.groups / field.groups.size()),
                                 double(bytes.groups) / 1e6 / double(field.groups.size()) / double(info.probeCount));
        for (const LightGroup& group : field.groups)
            std::cout << " " << group.which.name
                      << (group.which.members.empty() ? "" : fmt::format("={}", fmt::join(group.which.members, ",")));
        std::cout << "\n";
    }
    if (field.live.links > 0)
        std::cout << fmt::format("live: {} links a texel, {}, {:.2f} MB a probe; {} lights{}\n", field.live.links, megabytes(bytes.live),
                                 double(bytes.live) / 1e6 / double(info.probeCount), field.live.lights.size(),
                                 field.live.lit ? "" : ", which don't shine yet: captured, not lit");
    std::cout << "format version " << (field.fileVersion > 0 ? field.fileVersion : fileVersionOf(field)) << "\n"
              << "effects:";
    for (const std::string& effect : field.effects) std::cout << " " << effect;
    std::cout << std::endl;
}

void noteGivenUp(const Context& context, const EffectPlan& plan)
{
    for (const PlannedEffect& effect : plan.effects)
        if (!effect.givenUp.empty()) note(context, fmt::format("Given up: {}. {}", effect.name, effect.givenUp));
}

Result<FieldData> loadFieldFor(const std::string& file, const std::string& tracer)
{
    Result<FieldData> field = loadField(file);
    if (!field) return field;
    if (field->prefiltered.empty() && !field->radiance.empty()) prefilterRadiance(*field); // a file of version 2
    if (const std::optional<Baseline> baseline = baselineNamed(tracer))
    {
        Result<FieldData> made = baselineField(std::move(*field), *baseline);
        if (!made) return Error{made.error().code, fmt::format("'{}': {}", file, made.error().message)};
        return made;
    }
    if (field->info.probeCount == 0)
        return Error{ErrorCode::badInput, fmt::format("Light field '{}' has no probes; place some and bake it again.", file)};
    if (field->info.chart != gpu::kChartCube)
        return Error{
            ErrorCode::badInput,
            fmt::format("Tracer ours needs cube probes; '{}' has octahedral ones. Bake with --chart cube, or give --tracer b0plus.", file)};
    return field;
}

void addTracer(CLI::App* command, std::string& tracer)
{
    std::vector<std::string> names{"ours"};
    for (Baseline baseline : kBaselines) names.emplace_back(baselineName(baseline));
    const std::string spelled = listed(names, {}, "|");
    command
        ->add_option("--tracer", tracer,
                     described("ours, or an opponent: b0 (McGuire et al. 2017 as published) and b0plus (its defects mended) on a grid of "
                               "octahedral probes, b0plus-octree on octahedral probes anywhere, wang (Wang et al. 2019) on octahedral maps "
                               "that it makes from cube faces, as large as a face",
                               tracer))
        ->check(unlisted(CLI::IsMember(names)))
        ->type_name(spelled);
}

} // namespace sconce::tools
