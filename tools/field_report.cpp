#include "tools/field_report.h"

#include <cstdio>
#include <iostream>

#include "runtime/light_field_file.h"

namespace sconce::tools
{

namespace
{

const char* chartName(uint32_t chart)
{
    return chart == gpu::kChartCube ? "cube" : "octahedral";
}

Json bytesJson(const FieldBytes& bytes)
{
    return {{"total", bytes.total()},     {"distance", bytes.distance},     {"normals", bytes.normals},
            {"radiance", bytes.radiance}, {"irradiance", bytes.irradiance}, {"index", bytes.index}};
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

Status fitsTracer(const FieldData& field, const std::string& file, const std::string& tracer)
{
    const gpu::LightFieldInfo& info = field.info;
    if (info.probeCount == 0) return Error{ErrorCode::badInput, "Light field '" + file + "' has no probes; place some and bake it again."};
    if (tracer == "b0plus" && (info.chart != gpu::kChartOctahedral || info.gridX == 0))
        return Error{ErrorCode::badInput, "Tracer b0plus needs a grid of octahedral probes; '" + file +
                                              "' has none. Place with --method grid and bake with --chart octahedral."};
    if (tracer == "ours" && info.chart != gpu::kChartCube)
        return Error{ErrorCode::badInput,
                     "Tracer ours needs cube probes; '" + file + "' has octahedral ones. Bake with --chart cube, or give --tracer b0plus."};
    return success();
}

} // namespace sconce::tools
