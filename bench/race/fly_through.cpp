// What a light field whose maps come from its file is off by while a camera flies, against the same with all maps on the device.
//   sconce_fly_through SCENE --field FILE [--resident N] [--a-frame N] [--speed M/S] [--frames N] [--width N] [--height N]
// The camera goes from probe to probe, the nearest that it hasn't been at next, 60 frames a second. Prints, as JSON, the error of indirect
// light frame by frame: of the squared mean of the whole field's the mean squared difference, and the ratio of the means.
#include <algorithm>
#include <cmath>
#include <iostream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/race/flight.h"
#include "bench/race/tracer_race.h"
#include "runtime/field/field_stream.h"
#include "runtime/scene/scene_renderer.h"
#include "runtime/vulkan/host_vulkan.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_gltf.h"

namespace sconce
{
namespace
{

constexpr float kFramesASecond = 60.0f;

struct Options
{
    std::string scene, field;
    uint32_t resident = 16, frames = 200, width = 320, height = 180;
    float speed = 10.0f; // metres a second
    FieldStream::Desc stream;
};

struct Difference
{
    double error, ratio;
};

Difference between(const RenderedFrame& frame, const RenderedFrame& truth)
{
    double squares = 0.0, mean = 0.0, own = 0.0;
    for (size_t i = 0; i < truth.beauty.size(); ++i)
    {
        const vec3 a = frame.diffuseIndirect[i] + frame.glossyIndirect[i], b = truth.diffuseIndirect[i] + truth.glossyIndirect[i];
        squares += double(glm::dot(a - b, a - b));
        own += double(a.x + a.y + a.z), mean += double(b.x + b.y + b.z);
    }
    const double count = 3.0 * double(truth.beauty.size());
    own /= count, mean /= count;
    return mean > 0.0 ? Difference{squares / count / (mean * mean), own / mean} : Difference{0.0, 1.0};
}

double quantile(std::vector<double> values, double share)
{
    std::ranges::sort(values);
    return values[size_t(share * double(values.size() - 1))];
}

Status run(const Options& options)
{
    Result<Scene> scene = options.scene.find('.') == std::string::npos ? makeBuiltinScene(options.scene) : loadGltf(options.scene);
    if (!scene) return scene.error();
    auto all = loadField(options.field);
    if (!all) return all.error();
    auto opened = openField(options.field);
    if (!opened) return opened.error();
    const auto own = OwnDevice::create({});
    if (!own) return own.error();
    const auto gpu = Gpu::create(own->host());
    if (!gpu) return gpu.error();
    const auto whole = makeLightField(**gpu, *all);
    if (!whole) return whole.error();
    const auto field = makeStreamedField(**gpu, opened->field, std::move(opened->maps), options.resident);
    if (!field) return field.error();
    auto stream = makeFieldStream(**gpu, *field, options.stream);
    if (!stream) return stream.error();
    RenderSettings settings;
    settings.width = options.width;
    settings.height = options.height;
    settings.effects = whole->effectsOfFrames();
    const auto device = DeviceScene::create(**gpu, *scene, all->info);
    if (!device) return device.error();
    const auto truths = SceneRenderer::create(**gpu, *device, *whole, settings),
               drawn = SceneRenderer::create(**gpu, *device, *field, settings);
    if (!truths) return truths.error();
    if (!drawn) return drawn.error();

    const Flight flight(*all);
    auto timer = GpuTimer::create(**gpu, 1);
    if (!timer) return timer.error();
    std::vector<double> errors, ratios, milliseconds, copies;
    nlohmann::ordered_json frames = nlohmann::ordered_json::array();
    uint32_t missing = 0, resident = 0;
    for (uint32_t i = 0; i < options.frames; ++i)
    {
        const Camera camera = flight.at(options.speed / kFramesASecond * float(i));
        double copied = 0.0;
        auto status = (*gpu)->submit(
            [&](VkCommandBuffer cmd)
            {
                timer->reset(cmd);
                stream->record(cmd, camera.eye, &*timer);
            });
        if (!status) return status;
        for (const GpuTimer::Scope& scope : timer->read()) copied += scope.milliseconds;
        const auto frame = (*drawn)->render(camera), truth = (*truths)->render(camera);
        if (!frame) return frame.error();
        if (!truth) return truth.error();
        double sum = copied;
        for (const GpuTimer::Scope& scope : frame->times) sum += scope.milliseconds;
        const Difference difference = between(*frame, *truth);
        errors.push_back(difference.error), ratios.push_back(difference.ratio), milliseconds.push_back(sum), copies.push_back(copied);
        const FieldStream::Counts counts = stream->counts();
        missing = std::max(missing, counts.missing), resident = std::max(resident, counts.resident);
        frames.push_back({difference.error, difference.ratio, counts.missing, copied});
    }
    if (auto status = stream->status(); !status) return status;
    const nlohmann::ordered_json json = {
        {"probes", all->info.probeCount},
        {"resident", options.resident},
        {"speed", options.speed},
        {"probes_a_frame", options.stream.probesAFrame},
        {"error", {{"median", quantile(errors, 0.5)}, {"p90", quantile(errors, 0.9)}, {"worst", quantile(errors, 1.0)}}},
        {"light", {{"least", quantile(ratios, 0.0)}, {"median", quantile(ratios, 0.5)}, {"most", quantile(ratios, 1.0)}}},
        {"frame_ms", {{"median", quantile(milliseconds, 0.5)}, {"p999", quantile(milliseconds, 0.999)}}},
        {"copy_ms", {{"median", quantile(copies, 0.5)}, {"most", quantile(copies, 1.0)}}},
        {"most_resident", resident},
        {"most_missing", missing},
        {"read", stream->counts().read},
        {"device_bytes", field->deviceBytes() + stream->deviceBytes()},
        {"whole_device_bytes", whole->deviceBytes()},
        {"frames", std::move(frames)}};
    std::cout << json.dump(1) << "\n";
    return success();
}

} // namespace
} // namespace sconce

int main(int argc, char** argv)
{
    CLI::App app{"What a streamed light field is off by while a camera flies"};
    sconce::Options options;
    app.add_option("SCENE", options.scene, ".gltf, .glb or built-in name")->required();
    app.add_option("--field", options.field, "a baked light field with cube faces")->required();
    app.add_option("--resident", options.resident, "probes whose maps are on the device at a time (default: 16)");
    app.add_option("--a-frame", options.stream.probesAFrame,
                   "probes whose maps are copied in a frame at most (default: 2; range: 1 to 64)");
    app.add_option("--speed", options.speed, "metres a second (default: 10; range: 0 to 1000)")->check(CLI::Range(0.0f, 1000.0f));
    app.add_option("--frames", options.frames, "frames (default: 200; range: 2 to 100000)")->check(CLI::Range(2u, 100000u));
    app.add_option("--width", options.width, "pixels (default: 320; range: 1 to 4096)")->check(CLI::Range(1u, 4096u));
    app.add_option("--height", options.height, "pixels (default: 180; range: 1 to 4096)")->check(CLI::Range(1u, 4096u));
    CLI11_PARSE(app, argc, argv);
    return sconce::exitCodeOf(sconce::run(options));
}
