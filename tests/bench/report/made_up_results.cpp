#include "tests/bench/report/made_up_results.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <vector>

#include <glm/gtc/packing.hpp>

namespace sconce::testing_support
{

namespace
{

using Json = nlohmann::ordered_json;

constexpr uint32_t kNone = 0xffffffffu;

void writeImage(const std::filesystem::path& file, int width, int height, uint32_t kind, const void* pixels, size_t bytes)
{
    std::filesystem::create_directories(file.parent_path());
    const uint32_t words[] = {uint32_t(width), uint32_t(height), kind};
    std::ofstream out(file, std::ios::binary);
    out.write("SCNI", 4);
    out.write(reinterpret_cast<const char*>(words), sizeof words);
    out.write(static_cast<const char*>(pixels), std::streamsize(bytes));
}

/// Radiance over a room-like picture: a bright window, a dark corner. `error` adds a pattern of that relative size.
float radiance(float u, float v, int channel, float error)
{
    const float window = std::exp(-40.0f * ((u - 0.7f) * (u - 0.7f) + (v - 0.3f) * (v - 0.3f)));
    const float base = 0.02f + 0.4f * u * (1.0f - v) + (6.0f - float(channel)) * window;
    return base * (1.0f + error * std::sin(37.0f * u + 11.0f * float(channel)) * std::cos(23.0f * v));
}

std::string colours(const std::filesystem::path& folder, const std::string& name, const MadeUp& what, float error)
{
    std::vector<uint16_t> bits;
    for (int y = 0; y < what.height; ++y)
        for (int x = 0; x < what.width; ++x)
            for (int channel = 0; channel < 3; ++channel)
                bits.push_back(glm::packHalf1x16(radiance(float(x) / float(what.width), float(y) / float(what.height), channel, error)));
    const std::string file = "images/" + name + ".half";
    writeHalves(folder / file, what.width, what.height, bits);
    return file;
}

template <class Value> std::string numbers(const std::filesystem::path& folder, const std::string& name, const MadeUp& what, Value valueAt)
{
    std::vector<uint32_t> values;
    for (int y = 0; y < what.height; ++y)
        for (int x = 0; x < what.width; ++x) values.push_back(y < 3 ? kNone : uint32_t(valueAt(x, y))); // a strip of sky
    const std::string file = "images/" + name + ".u32";
    writeNumbers(folder / file, what.width, what.height, values);
    return file;
}

Json allImages(const std::filesystem::path& folder, const std::string& prefix, const MadeUp& what, float error)
{
    return {{"beauty", colours(folder, prefix + ".beauty", what, error)},
            {"glossy", colours(folder, prefix + ".glossy", what, 2.0f * error)},
            {"diffuse", colours(folder, prefix + ".diffuse", what, 0.5f * error)},
            {"probe", numbers(folder, prefix + ".probe", what, [](int x, int y) { return x / 12 + y / 14 * 8; })},
            {"handoffs", numbers(folder, prefix + ".handoffs", what, [](int x, int y) { return x * y / 700; })},
            {"reads", numbers(folder, prefix + ".reads", what, [](int x, int y) { return 4 + (x + 2 * y) / 5; })},
            {"unresolved", numbers(folder, prefix + ".unresolved", what, [](int x, int y) { return (x * y) % 97 == 0; })}};
}

struct MethodShape
{
    const char* name;
    double time, error, diffuse, memory, reads; // factors on ours
};
// The strongest by the picture is wang, by diffuse light b0plus, which is better than ours.
constexpr MethodShape kMethods[] = {{"ours", 1.0, 1.0, 1.0, 1.0, 1.0},
                                    {"b0plus", 2.2, 3.1, 0.25, 0.7, 2.6},
                                    {"b0", 1.9, 6.0, 6.0, 0.7, 2.3},
                                    {"wang", 1.6, 1.8, 1.8, 0.9, 1.9},
                                    {"path tracer", 30.0, 0.8, 0.8, 0.0, 0.0}};
struct KnobShape
{
    const char* name;
    std::vector<double> values; // the first is the default's
};
const std::vector<KnobShape>& knobShapes()
{
    static const std::vector<KnobShape> knobs = {
        {"probes", {54, 16, 32, 128}}, {"resolution", {416, 128, 256, 512, 1024}}, {"ranked", {4, 1, 2, 3}}};
    return knobs;
}

Json spread(double median)
{
    return {{"median", median}, {"p5", 0.94 * median}, {"p95", 1.17 * median}, {"frames", 20}};
}

Json errorsOf(double relMse)
{
    return {{"mse", 0.31 * relMse}, {"relmse", relMse}, {"flip", std::min(1.0, 0.9 * std::sqrt(relMse))}, {"mean", 1.0 - 2.0 * relMse}};
}

/// @param turn  how often all settings of all methods were gone through already: a little different each time
Json pointOf(const MethodShape& method, const std::string& knob, double value, int turn)
{
    double probes = 54, resolution = 416, ranked = 4;
    if (knob == "probes") probes = value;
    if (knob == "resolution") resolution = value;
    if (knob == "ranked") ranked = value;
    const double texels = probes * resolution * resolution / (54.0 * 416 * 416), drift = 1.0 + 0.07 * turn;
    const double time = 20.0 * method.time * std::pow(texels, 0.12) * (0.6 + 0.1 * ranked) * drift;
    const double relMse = 0.02 * method.error * std::pow(texels, -0.6) * std::pow(ranked / 4.0, -0.5) * std::pow(drift, -0.8);
    const std::string text = knob == "default" ? "" : std::to_string(int(value)), turned = turn ? "/run=" + std::to_string(turn) : "";

    Json point = {{"id", std::string(method.name) + "/" + (knob == "default" ? knob : knob + "=" + text) + turned},
                  {"method", method.name},
                  {"knob", knob},
                  {"value", text},
                  {"frame_ms", spread(8.0 + 1.5 * time)},
                  {"trace_ms", spread(time)},
                  {"error",
                   {{"beauty", errorsOf(0.3 * relMse)},
                    {"diffuse", errorsOf(0.5 * relMse * method.diffuse / method.error)},
                    {"glossy", errorsOf(relMse)}}},
                  {"wrong", nullptr}};
    if (method.memory == 0.0) // the path tracer has neither rays of ours nor a light field
    {
        point["settings"] = {{"spp", int(value) + 1}};
        point["rays"] = nullptr;
        return point;
    }
    const double right = std::clamp(1.0 - 0.9 * relMse, 0.0, 1.0), bytes = 1.5e8 * texels * method.memory;
    point["settings"] = {{"probes", probes},         {"placement", method.name == std::string("ours") ? "optimised" : "grid"},
                         {"resolution", resolution}, {"chart", method.name == std::string("ours") ? "cube" : "octahedral"},
                         {"ranked", ranked},         {"denoise", true}};
    point["probes"] = probes;
    point["probe_set"] = method.name == std::string("ours") ? "optimised-54" : "grid-54";
    point["passes_ms"] = {{"G-buffer", 3.1}, {"glossy trace", time}, {"diffuse gather", 2.0}, {"denoise", 1.7}};
    point["rays"] = {{"count", 50000},
                     {"right_1", right},
                     {"right_02", right - 0.01},
                     {"false", 0.3 * (1 - right)},
                     {"leak", 0.2 * (1 - right)},
                     {"unresolved", 0.5 * (1 - right)},
                     {"reads_mean", 18.0 * method.reads * std::pow(texels, 0.1)},
                     {"reads_p95", 55},
                     {"handoffs_mean", 0.6}};
    point["bytes"] = {{"total", bytes},           {"distance", 0.5 * bytes},    {"normals", 0.0},
                      {"radiance", 0.48 * bytes}, {"irradiance", 0.01 * bytes}, {"index", 0.01 * bytes}};
    point["bake_s"] = 40.0 * texels;
    point["place_s"] = 12.0;
    point["bake_peak_mb"] = 700.0 + 200.0 * texels;
    if (method.name == std::string("b0") && knob == "resolution" && value == 128)
        point["wrong"] = "92 % of the rays are wrong: light comes through the walls.";
    return point;
}

std::vector<Json> pointsOf(int wanted)
{
    std::vector<Json> points;
    for (int turn = 0; int(points.size()) < wanted; ++turn)
        for (const MethodShape& method : kMethods)
        {
            points.push_back(pointOf(method, "default", 0, turn));
            for (const KnobShape& knob : knobShapes())
                for (size_t i = 1; i < knob.values.size(); ++i) points.push_back(pointOf(method, knob.name, knob.values[i], turn));
        }
    points.resize(size_t(wanted));
    return points;
}

Json probeSets()
{
    Json placed = Json::array(), grid = Json::array();
    const char* const reasons[] = {"skeleton ridge, covers 1.2 % of the surface first", "free point, covers 0.3 % of the surface first",
                                   "gap in the view of others, covers 0.05 % of the surface first", "pinned"};
    for (int i = 0; i < 54; ++i)
    {
        const double turn = 2.39996 * i, far = 0.135 * std::sqrt(double(i)); // a sunflower
        placed.push_back(
            {{"position", {9.0 * far * std::cos(turn), 1.0 + 0.3 * (i % 7), 6.0 * far * std::sin(turn)}}, {"why", reasons[i % 4]}});
        const int x = i % 6, y = i / 6 % 3, z = i / 18;
        grid.push_back({{"position", {-7.5 + 3.0 * x, 0.5 + y, -4.0 + 4.0 * z}},
                        {"why", "grid point " + std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(z)}});
    }
    return {
        {"optimised-54", {{"method", "sdf"}, {"seconds", 12.0}, {"coverage", {{"rays", 0.997}, {"area", 0.98}}}, {"probes", placed}}},
        {"grid-54",
         {{"method", "grid"}, {"grid", {6, 3, 3}}, {"seconds", 2.5}, {"coverage", {{"rays", 0.917}, {"area", 0.81}}}, {"probes", grid}}}};
}

Json analysisOf(const std::vector<Json>& points)
{
    const auto has = [&](const char* id) { return std::ranges::any_of(points, [&](const Json& point) { return point["id"] == id; }); };
    Json equal = Json::array(), prices = Json::array();
    if (has("ours/default") && has("b0plus/default"))
    {
        equal.push_back({{"what", "probes"},
                         {"error_key", "glossy.relmse"},
                         {"ours", "ours/default"},
                         {"theirs", "b0plus/default"},
                         {"ratio", {{"time", 0.51}, {"error", 0.32}, {"memory", 1.43}, {"wrong_rays", 0.32}}},
                         {"sentence", "With 54 probes each, ours errs a third as much in half the time, for 1.4 times the memory."}});
        equal.push_back({{"what", "memory"},
                         {"error_key", "diffuse.relmse"},
                         {"ours", "ours/probes=32"},
                         {"theirs", "b0plus/default"},
                         {"ratio", {{"time", nullptr}, {"error", 1.0}, {"memory", 0.98}}},
                         {"sentence", "At equal memory there is no time to compare."}});
        equal.push_back({{"what", "error"},
                         {"cost_key", "frame_ms"},
                         {"method", "path tracer"},
                         {"ours", nullptr},
                         {"theirs", "path tracer/default"},
                         {"ratio", nullptr},
                         {"sentence", "No setting of ours is as good as the path tracer."}});
    }
    if (has("ours/probes=128"))
        for (const char* key : {"glossy.relmse", "wrong_rays"})
            prices.push_back({{"knob", "probes"},
                              {"error_key", key},
                              {"from", "ours/default"},
                              {"to", "ours/probes=128"},
                              {"error_ratio", 0.60},
                              {"time_ratio", 1.11},
                              {"memory_ratio", 2.37},
                              {"halving_costs_time", 1.15},
                              {"halving_costs_memory", 3.22},
                              {"sentence", "Halving the error by more probes costs 15 % of the time."}});
    return {{"fronts", Json::object()},
            {"equal", equal},
            {"prices", prices},
            {"breaks", {{{"method", "b0"}, {"sentence", "Below 256 texels light comes through the walls."}}}}};
}

} // namespace

void writeHalves(const std::filesystem::path& file, int width, int height, const std::vector<uint16_t>& bits)
{
    writeImage(file, width, height, 0, bits.data(), bits.size() * sizeof bits[0]);
}

void writeNumbers(const std::filesystem::path& file, int width, int height, const std::vector<uint32_t>& numbers)
{
    writeImage(file, width, height, 1, numbers.data(), numbers.size() * sizeof numbers[0]);
}

nlohmann::ordered_json madeUpResults(const std::filesystem::path& folder, const MadeUp& what)
{
    Json scenes = Json::array();
    for (int number = 0; number < what.scenes; ++number)
    {
        const std::string name = number == 0 ? "made-up room" : "made-up hall " + std::to_string(number),
                          prefix = "scene" + std::to_string(number);
        std::vector<Json> points = pointsOf(what.points);
        if (what.width > 0)
        {
            points[0]["images"] = allImages(folder, prefix + ".ours", what, 0.05f);
            for (Json& point : points)
                for (const std::string method : {"b0plus", "wang"})
                    if (point["id"] == method + "/default") point["images"] = allImages(folder, prefix + "." + method, what, 0.2f);
        }
        const Json images = what.width > 0 ? Json{{"beauty", colours(folder, prefix + ".reference.beauty", what, 0.0f)},
                                                  {"glossy", colours(folder, prefix + ".reference.glossy", what, 0.0f)},
                                                  {"diffuse", colours(folder, prefix + ".reference.diffuse", what, 0.0f)}}
                                           : Json::object();
        scenes.push_back({{"name", name},
                          {"source", "made up"},
                          {"triangles", 262267},
                          {"width", what.width},
                          {"height", what.height},
                          {"camera", {{"eye", {-6, 2, 0}}, {"target", {0, 1.5, 0}}, {"fov_degrees", 60}}},
                          {"reference",
                           {{"spp", 256},
                            {"seconds", 61.2},
                            {"estimated_relmse", {{"beauty", 0.001}, {"diffuse", 0.0007}, {"glossy", 0.002}}},
                            {"images", images}}},
                          {"bounds", {{"min", {-9, 0, -6}}, {"max", {9, 4, 6}}}},
                          {"plan", {{"segments", {{-9, -6, 9, -6}, {9, -6, 9, 6}, {9, 6, -9, 6}, {-9, 6, -9, -6}, {0, -6, 0, 1}}}}},
                          {"probe_sets", probeSets()},
                          {"points", points},
                          {"analysis", analysisOf(points)}});
    }
    return {{"schema", 2},
            {"version", "0.1.0"},
            {"commands", {"sconce bench made-up -o out", "sconce tune made-up --time 20"}},
            {"started", "2026-01-02T03:04:05Z"},
            {"seconds", 321.5},
            {"machine", {{"cpu", "none: these figures are made up"}, {"cores", 2}, {"memory_mb", 23000}}},
            {"device", {{"name", "made up"}, {"driver", "0.0"}, {"api", "1.3.230"}}},
            {"scenes", scenes},
            {"answers", {"These figures are made up: they only try the page.", "Losses are shown like wins."}},
            {"gpu",
             {{"device", "made-up card"},
              {"driver", "its own 0.1"},
              {"size", "1920x1080"},
              {"wrong", {"validation"}},
              {"frames",
               {{{"name", "frame_room"},
                 {"clock_mhz", {345, 1980, 1980}},
                 {"passes_ms", {{"G-buffer", 3.0}, {"glossy trace", 0.5}, {"compose", 0.25}}}},
                {{"name", "frame_town"},
                 {"clock_mhz", nullptr},
                 {"passes_ms", {{"G-buffer", 2.0}, {"glossy trace", 0.125}, {"surface light", 0.25}}}}}},
              {"rays",
               {{{"tracer", "ours"}, {"cold", false}, {"in_order", 600.0}, {"shuffled", 500.0}},
                {{"tracer", "b0plus-octree"}, {"cold", false}, {"in_order", 300.0}, {"shuffled", 200.0}},
                {{"tracer", "ours"}, {"cold", true}, {"in_order", 400.0}, {"shuffled", 300.0}}}}}}};
}

} // namespace sconce::testing_support
