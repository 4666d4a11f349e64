#include "bench/sweep/kept_fields.h"

#include <fstream>

#include <fmt/format.h>

#include "base/parsed_json.h"
#include "base/safe_file.h"
#include "bench/sweep/keys.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/map_blocks.h"
#include "scene/scene_check.h"
#include "scene/triangle_rays.h"

namespace sconce
{

std::optional<Json> readJson(const std::filesystem::path& file)
{
    std::ifstream stream(file);
    if (!stream) return {};
    auto parsed = parsedJson<Json>(stream, file);
    if (!parsed || parsed->is_discarded()) return {}; // not ours, or damaged: measured again
    return std::move(*parsed);
}

KeptFields::KeptFields(Desc made) : desc(std::move(made)), scene(keyOf(desc.scene)) {}

std::filesystem::path KeptFields::cached(const char* kind, const std::string& key, const char* extension) const
{
    return desc.folder / "cache" / kind / (key + extension);
}

std::string KeptFields::probesKey(const PointSettings& settings) const
{
    Json all = {{"build", desc.build}, {"scene", scene}, {"set", probeSetName(settings)}};
    if (settings.volume()) all["judged by"] = judgedBy;
    return keyOf(all);
}

std::optional<BenchProbes> KeptFields::keptProbes(const PointSettings& settings) const
{
    const std::string key = probesKey(settings);
    auto set = loadProbes(cached("probes", key, ".json"));
    const std::optional<Json> report = readJson(cached("probes", key, ".report.json"));
    if (!set || !report) return {};
    return BenchProbes{probeSetName(settings), std::move(*set), *report};
}

Result<BenchProbes> KeptFields::probesFor(const PointSettings& settings, const Progress& progress)
{
    if (auto found = keptProbes(settings)) return std::move(*found);
    GridJudge judged;
    if (judge) judged = [&](const ProbeGrid& grid) { return judge(grid, settings); };
    auto made = placeFor(desc.scene, settings, progress, judged);
    if (!made) return made.error();
    if (made->set.probes.empty())
        return Error{ErrorCode::badInput,
                     fmt::format("Placement {} of scene '{}' has no probes; ask for more.", made->name, desc.scene.name)};
    const std::string key = probesKey(settings);
    if (auto status = writeText(cached("probes", key, ".report.json"), made->report.dump()); !status) return status.error();
    if (auto status = saveProbes(made->set, cached("probes", key, ".json")); !status) return status.error();
    return made;
}

Result<FieldData> KeptFields::fieldFor(const PointSettings& settings, Json& cost, const Progress& progress)
{
    auto probes = probesFor(settings, progress);
    if (!probes) return probes.error();
    BakeSettings bake;
    bake.resolution = settings.resolution;
    bake.chart = settings.chart();
    bake.bounces = settings.bounces;
    bake.surfaceTexels = settings.bakedSurfaceTexels();
    bake.surfaceRays = settings.surfaceRays;
    bake.surfaceRefined = settings.surfaceRefined;
    bake.octree.voxels = settings.octreeVoxels;
    bake.grid = probes->set.grid;
    Result<FieldData> field = Error{ErrorCode::badArgument, "Nothing is baked yet."};
    if (settings.opponent() && settings.surfaceTexels > 0)
    {
        // An opponent's maps are lit as ours are, by what rays find at the surfaces that the same probes see.
        BakeSettings lender = bake;
        lender.chart = gpu::kChartCube;
        lender.resolution = settings.lightResolution;
        lender.surfaceTexels = settings.surfaceTexels;
        lender.bounces = std::max(bake.bounces, 1u) - 1; // what is lent is scattered once more, see lendingBake()
        Json lent = Json::object();
        auto light = baked(*probes, lender, settings.fieldGather, "", lent, progress);
        if (light && !light->lamps.empty()) // which opponents don't know
        {
            lender.lampTexels = 0;
            light = baked(*probes, lender, settings.fieldGather, "", lent, progress);
        }
        if (!light) return light;
        bake.light = &*light;
        field = baked(*probes, bake, settings.fieldGather, fieldKey(probes->name, lender, settings.fieldGather, ""), cost, progress);
        if (field) cost["bake_s"] = cost["bake_s"].get<double>() + lent["bake_s"].get<double>();
    }
    else
        field = baked(*probes, bake, settings.fieldGather, "", cost, progress);
    if (field && settings.compact) // of the same bake
        if (auto status = putInBlocks(*field); !status) return status.error();
    cost["probe_set"] = probes->name;
    cost["place_s"] = probes->report["seconds"];
    cost["coverage"] = probes->report["coverage"]["rays"];
    return field;
}

/// What is measured of a field doesn't depend on the tracer that reads it: methods share fields.
/// @param litBy  key of the field that lends its light; empty: none
std::string KeptFields::fieldKey(const std::string& probes, const BakeSettings& bake, bool fieldGather, const std::string& litBy) const
{
    return keyOf(Json{{"build", desc.build},
                      {"format", kFieldFileVersion},
                      {"device", desc.device},
                      {"scene", scene},
                      {"probes", probes},
                      {"resolution", bake.resolution},
                      {"chart", bake.chart},
                      {"bounces", bake.bounces},
                      {"surface", bake.surfaceTexels},
                      {"surface rays", bake.surfaceTexels > 0 ? bake.surfaceRays : 0},
                      {"refined", bake.surfaceTexels > 0 ? bake.surfaceRefined : 0.0f},
                      {"lamps", bake.surfaceTexels > 0 ? bake.lampTexels : 0},
                      {"gather", fieldGather},
                      {"voxels", bake.octree.voxels},
                      {"lit by", litBy}});
}

Result<FieldData> KeptFields::baked(const BenchProbes& probes, BakeSettings bake, bool fieldGather, const std::string& litBy, Json& cost,
                                    const Progress& progress)
{
    const std::string key = fieldKey(probes.name, bake, fieldGather, litBy);
    const std::filesystem::path file = cached("fields", key, ".sconce");
    if (const std::optional<Json> known = readJson(cached("fields", key, ".json")))
        if (auto field = loadField(file))
        {
            cost.update(*known);
            cost["field"] = std::filesystem::relative(file, desc.folder).string();
            return field;
        }
    std::vector<vec3> positions;
    for (const PlacedProbe& probe : probes.set.probes) positions.push_back(probe.position);
    BakeReport report;
    std::optional<TriangleRays> exact;
    if (bake.surfaceTexels > 0 && !fieldGather)
    {
        auto built = TriangleRays::build(desc.scene);
        if (!built) return built.error();
        bake.rays = &exact.emplace(std::move(*built));
    }
    auto field = bakeLightField(desc.gpu, desc.scene, positions, bake, progress, report);
    if (!field) return field;
    for (const SceneEffect& effect : checkScene(desc.scene).effects)
        if (effect.called) field->effects.push_back(effect.name);
    const Json spent = {
        {"bake_s", report.sceneSeconds + report.probeSeconds + report.octreeSeconds + report.gatherSeconds + report.bounceSeconds},
        {"bake_peak_mb", double(report.peakDeviceBytes) / 1e6}};
    // The field before its report: both must be there to be used again, so that a run stopped in between bakes anew.
    if (auto status = saveField(*field, file); !status) return status.error();
    if (auto status = writeText(cached("fields", key, ".json"), spent.dump()); !status) return status.error();
    cost.update(spent);
    cost["field"] = std::filesystem::relative(file, desc.folder).string();
    return field;
}

} // namespace sconce
