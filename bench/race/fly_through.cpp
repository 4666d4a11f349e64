// What a light field whose maps come from its file is off by while a camera flies, against the same with all maps on the device.
//   sconce_fly_through SCENE --field FILE [--resident N] [--a-frame N] [--speed M/S] [--frames N] [--width N] [--height N]
// The camera is put to the first probe, without a map on the device, and stays until its picture is nearly that of the whole field; then it
// goes from probe to probe, the nearest that it hasn't been at next, 60 frames a second. Prints, as JSON, the error of indirect light frame
// by frame: of the squared mean of the whole field's the mean squared difference, and the ratio of the means.
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
#include "scene/named_scene.h"

namespace sconce
{
namespace
{

constexpr float kFramesASecond = 60.0f;
constexpr double kSharp = 0.01;       // error from which on a picture counts as that of the whole field: a tenth, root mean square
constexpr size_t kMostAfterCut = 240; // frames

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

struct Flown
{
    Difference difference;
    double frameMs, copyMs; // the frame with what was copied before it, and that alone
    FieldStream::Counts counts;
};

/// Draws each frame twice: through the streamed field, and through the whole one.
class Flyer
{
public:
    Flyer(Gpu& device, FieldStream& streamed, SceneRenderer& through, SceneRenderer& truth, GpuTimer& copies)
        : gpu(device), stream(streamed), drawn(through), truths(truth), timer(copies)
    {
    }

    Result<Flown> frame(const Camera& camera)
    {
        auto status = gpu.submit(
            [&](VkCommandBuffer cmd)
            {
                timer.reset(cmd);
                stream.record(cmd, camera.eye, &timer);
            });
        if (!status) return status.error();
        double copied = 0.0;
        for (const GpuTimer::Scope& scope : timer.read()) copied += scope.milliseconds;
        const auto frame = drawn.render(camera), truth = truths.render(camera);
        if (!frame) return frame.error();
        if (!truth) return truth.error();
        if (status = stream.status(); !status) return status.error();
        double sum = copied;
        for (const GpuTimer::Scope& scope : frame->times) sum += scope.milliseconds;
        return Flown{between(*frame, *truth), sum, copied, stream.counts()};
    }

private:
    Gpu& gpu;
    FieldStream& stream;
    SceneRenderer &drawn, &truths;
    GpuTimer& timer;
};

nlohmann::ordered_json toJson(const Options& options, const std::vector<Flown>& cut, const std::vector<Flown>& flight)
{
    const auto all = [&](auto of)
    {
        std::vector<double> values;
        for (const Flown& one : flight) values.push_back(double(of(one)));
        return values;
    };
    const std::vector<double> errors = all([](const Flown&f) { return f.difference.error; }),
                              light = all([](const Flown&f) { return f.difference.ratio; }),
                              milliseconds = all([](const Flown&f) { return f.frameMs; }),
                              copies = all([](const Flown&f) { return f.copyMs; }),
                              resident = all([](const Flown&f) { return f.counts.resident; }),
                              missing = all([](const Flown&f) { return f.counts.missing; });
    nlohmann::ordered_json frames = nlohmann::ordered_json::array();
    for (const Flown& f : flight) frames.push_back({f.difference.error, f.difference.ratio, f.counts.missing, f.copyMs});
    return {{"resident", options.resident},
            {"speed", options.speed},
            {"probes_a_frame", options.stream.probesAFrame},
            {"cut", {{"frames", cut.size()}, {"first_light", cut.front().difference.ratio}, {"first_error", cut.front().difference.error}}},
            {"error", {{"median", quantile(errors, 0.5)}, {"p90", quantile(errors, 0.9)}, {"worst", quantile(errors, 1.0)}}},
            {"light", {{"least", quantile(light, 0.0)}, {"median", quantile(light, 0.5)}, {"most", quantile(light, 1.0)}}},
            {"frame_ms", {{"median", quantile(milliseconds, 0.5)}, {"p999", quantile(milliseconds, 0.999)}}},
            {"copy_ms", {{"median", quantile(copies, 0.5)}, {"most", quantile(copies, 1.0)}}},
            {"most_resident", quantile(resident, 1.0)},
            {"most_missing", quantile(missing, 1.0)},
            {"read", flight.back().counts.read},
            {"frames", std::move(frames)}};
}

Status run(const Options& options)
{
    Result<Scene> scene = namedScene(options.scene);
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
    auto timer = GpuTimer::create(**gpu, 1);
    if (!timer) return timer.error();

    const Flight flight(*all);
    Flyer flyer(**gpu, *stream, **drawn, **truths, *timer);
    std::vector<Flown> cut, flown;
    while (cut.size() < kMostAfterCut && (cut.empty() || cut.back().difference.error > kSharp))
    {
        auto frame = flyer.frame(flight.at(0.0f));
        if (!frame) return frame.error();
        cut.push_back(std::move(*frame));
    }
    for (uint32_t i = 0; i < options.frames; ++i)
    {
        auto frame = flyer.frame(flight.at(options.speed / kFramesASecond * float(i)));
        if (!frame) return frame.error();
        flown.push_back(std::move(*frame));
    }
    nlohmann::ordered_json json = toJson(options, cut, flown);
    json["probes"] = all->info.probeCount;
    json["device_bytes"] = field->deviceBytes() + stream->deviceBytes();
    json["whole_device_bytes"] = whole->deviceBytes();
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
