// sconce bake, info and verify: light fields made and looked into.
#include <iostream>

#include "placement/probe_set.h"
#include "runtime/bake.h"
#include "runtime/light_field_file.h"
#include "tools/common.h"

namespace sconce::tools
{

namespace
{

struct BakeOptions
{
    SceneOptions scene;
    BakeSettings settings;
    std::string probes, output, device;
    uint64_t memoryMb = 0;
};

struct FileOptions
{
    std::string file;
};

const char* chartName(uint32_t chart)
{
    return chart == gpu::kChartCube ? "cube" : "octahedral";
}

Json bytesJson(const FieldBytes& bytes)
{
    return {{"total", bytes.total()},     {"distance", bytes.distance},     {"normals", bytes.normals},
            {"radiance", bytes.radiance}, {"irradiance", bytes.irradiance}, {"index", bytes.index}};
}

Json fieldJson(const FieldData& field)
{
    const gpu::LightFieldInfo& info = field.info;
    Json json;
    json["scene"] = field.sceneName;
    json["probes"] = info.probeCount;
    json["chart"] = chartName(info.chart);
    json["resolution"] = field.resolution;
    json["face_size"] = info.faceSize;
    json["bounces"] = field.bounces;
    json["effects"] = field.effects;
    json["bytes"] = bytesJson(bytesByPart(field));
    json["octree"] = {{"leaves", field.octree.leaves},
                      {"nodes", field.octree.nodes},
                      {"depth", field.octree.topShift},
                      {"voxel", field.octree.voxel * info.scale},
                      {"top_cells", {info.topCells.x, info.topCells.y, info.topCells.z}}};
    if (info.gridX != 0) json["grid"] = {info.gridX, info.gridY, info.gridZ};
    json["origin"] = toJson(info.origin);
    json["scale"] = info.scale;
    json["sky"] = toJson(info.sky);
    json["format_version"] = kFieldFileVersion;
    return json;
}

std::string megabytes(size_t bytes)
{
    char text[32];
    std::snprintf(text, sizeof(text), "%.2f MB", double(bytes) / 1e6);
    return text;
}

void printField(const FieldData& field, const std::string& file)
{
    const gpu::LightFieldInfo& info = field.info;
    const FieldBytes bytes = bytesByPart(field);
    std::cout << file << ": scene " << field.sceneName << ", " << info.probeCount << " probes, chart " << chartName(info.chart) << ", "
              << (info.chart == gpu::kChartCube ? "faces of " : "maps of ") << info.faceSize << " texels, " << field.bounces << " bounces\n"
              << "bytes: " << megabytes(bytes.total()) << " = distance " << megabytes(bytes.distance) << " + normals "
              << megabytes(bytes.normals) << " + radiance " << megabytes(bytes.radiance) << " + irradiance " << megabytes(bytes.irradiance)
              << " + index " << megabytes(bytes.index) << "\n"
              << "octree: " << field.octree.leaves << " leaves, " << field.octree.nodes << " nodes, depth " << field.octree.topShift
              << ", voxels of " << field.octree.voxel * info.scale << " m\n"
              << "effects:";
    for (const std::string& effect : field.effects) std::cout << " " << effect;
    std::cout << std::endl;
}

int runInfo(const FileOptions& options, const Context& context)
{
    const Result<FieldData> field = loadField(options.file);
    if (!field) return fail(field.error());
    if (context.json)
        print(fieldJson(*field));
    else
        printField(*field, options.file);
    return exitOk;
}

int runVerify(const FileOptions& options, const Context& context)
{
    const Result<VerifyReport> report = verifyField(options.file);
    if (!report) return fail(report.error());
    if (context.json)
    {
        Json json;
        json["ok"] = report->ok();
        json["version"] = report->version;
        json["bytes"] = report->fileBytes;
        json["blocks"] = Json::array();
        for (const BlockReport& block : report->blocks)
            json["blocks"].push_back({{"name", block.name},
                                      {"ok", block.problem.empty()},
                                      {"problem", block.problem},
                                      {"offset", block.offset},
                                      {"stored_bytes", block.storedBytes},
                                      {"raw_bytes", block.rawBytes}});
        json["problem"] = report->problem;
        print(json);
    }
    else
        for (const BlockReport& block : report->blocks)
            std::cout << (block.problem.empty() ? "ok       " : "DAMAGED  ") << block.name << "  " << block.storedBytes << " bytes"
                      << (block.problem.empty() ? "" : ": " + block.problem) << std::endl;
    if (report->ok()) return exitOk;
    return fail(ErrorCode::badInput,
                !report->problem.empty() ? report->problem : "'" + options.file + "' is damaged; bake it again or restore it from a copy.");
}

int runBake(const BakeOptions& options, const Context& context)
{
    const Stopwatch watch;
    const Result<ProbeSet> set = loadProbes(options.probes);
    if (!set) return fail(set.error());
    const Result<Scene> scene = options.scene.load(context);
    if (!scene) return fail(scene.error());
    const Result<OwnDevice> device = OwnDevice::create({.device = options.device, .memoryBudget = options.memoryMb << 20});
    if (!device) return fail(device.error());
    BakeSettings settings = options.settings;
    settings.grid = set->grid;
    std::vector<vec3> positions;
    for (const PlacedProbe& probe : set->probes) positions.push_back(probe.position);
    BakeReport report;
    Result<FieldData> field = bakeLightField(device->host(), *scene, positions, settings, consoleProgress(context), report);
    if (!field) return fail(field.error());
    if (Status status = saveField(*field, options.output); !status) return fail(status.error());
    if (context.json)
    {
        Json json = fieldJson(*field);
        json["device"] = device->name();
        addCost(json, watch);
        print(json);
    }
    else
    {
        printField(*field, options.output);
        std::cout << watch.seconds() << " s, " << peakRssMb() << " MB of host memory, on " << device->name() << std::endl;
    }
    return exitOk;
}

} // namespace

void addFieldCommands(CLI::App& app, Context& context)
{
    CLI::App* bake = addCommand(app, context, "bake", "Bakes the light field of a scene at given probes");
    auto options = std::make_shared<BakeOptions>();
    BakeSettings& settings = options->settings;
    options->scene.add(bake);
    bake->add_option("--probes", options->probes, "probes.json of `sconce place` (required)")->required()->type_name("FILE");
    bake->add_option("-o,--output", options->output, ".sconce file to write (required)")->required()->type_name("FILE");
    bake->add_option("--resolution", settings.resolution,
                     "Side of an octahedral map in texels; the cube chart's faces have half of it; memory grows with its square (default: "
                     "512; range: 64 to 2048, power of two)")
        ->check(unlisted(CLI::IsMember({64, 128, 256, 512, 1024, 2048})))
        ->type_name("TEXELS");
    bake->add_option("--bounces", settings.bounces,
                     "Times the baked light is re-injected; each costs one more pass over every probe (default: 2; range: 0 to 8)")
        ->check(unlisted(CLI::Range(0u, 8u)))
        ->type_name("N");
    const std::map<std::string, uint32_t> charts{{"cube", gpu::kChartCube}, {"octahedral", gpu::kChartOctahedral}};
    bake->add_option("--chart", settings.chart,
                     "cube: six faces a probe; octahedral: one map a probe, for the b0plus tracer (default: cube)")
        ->transform(unlisted(CLI::CheckedTransformer(charts)))
        ->type_name("cube|octahedral");
    bake->add_option("--memory", options->memoryMb,
                     "Budget of device memory, MiB; too little is refused with the number needed (default: 80 % of the device's; range: 1 "
                     "to 1048576)")
        ->check(unlisted(CLI::Range(uint64_t(1), uint64_t(1) << 20)))
        ->type_name("MIB");
    addDevice(bake, options->device);
    onChosen(bake, context, options, runBake);

    auto infoOptions = std::make_shared<FileOptions>();
    CLI::App* info = addCommand(app, context, "info", "What a light field consists of: probes, bytes by part, octree, effects, settings");
    info->add_option("FIELD", infoOptions->file, ".sconce file")->required()->type_name("");
    onChosen(info, context, infoOptions, runInfo);

    auto verifyOptions = std::make_shared<FileOptions>();
    CLI::App* verify = addCommand(app, context, "verify", "Checks every checksum of a light field; exit 3 when it is damaged");
    verify->add_option("FIELD", verifyOptions->file, ".sconce file")->required()->type_name("");
    onChosen(verify, context, verifyOptions, runVerify);
}

} // namespace sconce::tools
