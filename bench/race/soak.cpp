// Whether frames stay what they are: so many frames with a camera that flies, light that changes where the field has live links, and maps
// that come and go where there isn't room for all.
//   sconce_soak SCENE --field FILE [--resident N] [--frames N] [--side N]
// Prints, as JSON, device memory and the process's after the first hundred frames and at the end, and whether the first frame is drawn
// again to the bit once camera, light and maps are as they were (null where there isn't room for all that it asks for: which maps are there
// depends on the way that the camera came). Exit 1 where something has grown or isn't the same.
#include <algorithm>
#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "bench/race/flight.h"
#include "bench/race/tracer_race.h"
#include "runtime/field/field_stream.h"
#include "runtime/field/live_light.h"
#include "runtime/scene/scene_renderer.h"
#include "runtime/vulkan/host_vulkan.h"
#include "scene/named_scene.h"

namespace sconce
{
namespace
{

constexpr float kStep = 0.17f;       // metres a frame
constexpr uint32_t kLightEvery = 50; // frames
constexpr uint32_t kSettled = 100;   // frames after which nothing may grow
constexpr double kMostGrowth = 1.02; // of the process's memory

struct Options
{
    std::string scene, field;
    uint32_t resident = 0, frames = 100000, side = 32;
};

/// Of the process, bytes that are in memory.
uint64_t processBytes()
{
    uint64_t size = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> size >> resident;
    return resident * uint64_t(sysconf(_SC_PAGESIZE));
}

class Soak
{
public:
    Soak(Gpu& used, const Scene& drawn, FieldData loaded, const Options& wanted)
        : gpu(used), scene(drawn), data(std::move(loaded)), options(wanted), flight(data)
    {
    }

    Status make(std::optional<MapFile> maps)
    {
        auto made = maps ? makeStreamedField(gpu, data, std::move(*maps), options.resident) : makeLightField(gpu, data);
        if (!made) return made.error();
        field.emplace(std::move(*made));
        if (options.resident > 0)
        {
            auto streamed = makeFieldStream(gpu, *field, {});
            if (!streamed) return streamed.error();
            stream.emplace(std::move(*streamed));
        }
        if (data.live.links > 0)
        {
            auto moving = makeLiveLight(gpu, *field, data);
            if (!moving) return moving.error();
            live.emplace(std::move(*moving));
        }
        auto on = DeviceScene::create(gpu, scene, data.info);
        if (!on) return on.error();
        device.emplace(std::move(*on));
        RenderSettings settings;
        settings.width = settings.height = options.side;
        settings.effects = field->effectsOfFrames();
        auto drawing = SceneRenderer::create(gpu, *device, *field, settings);
        if (!drawing) return drawing.error();
        renderer = std::move(*drawing);
        return success();
    }

    /// The first frame once more, when nothing changes any longer.
    Result<RenderedFrame> settled()
    {
        if (live)
            if (auto status = live->set({data.live.lights, {}}); !status) return status.error();
        for (int still = 0; still < 20;)
        {
            if (auto status = draw(flight.at(0.0f)); !status) return status.error();
            const bool changes =
                (stream && (stream->state().reader->reads() || (stream->counts().missing > 0 && !stream->counts().full))) ||
                (live && !live->settled());
            still = changes ? 0 : still + 1;
        }
        return renderer->render(flight.at(0.0f));
    }

    Status fly(uint32_t frame)
    {
        if (live && frame % kLightEvery == 0)
        {
            LightState state{data.live.lights, {}};
            for (Light& light : state.lights) light.intensity *= float(frame / kLightEvery % 4) / 3.0f; // off, a third, two, as it was
            if (auto status = live->set(state); !status) return status;
        }
        return draw(flight.at(kStep * float(frame)));
    }

    bool lacksRoom() const { return stream && stream->counts().full; }

private:
    Status draw(const Camera& camera)
    {
        if (stream || live)
        {
            auto status = gpu.submit(
                [&](VkCommandBuffer cmd)
                {
                    if (stream) stream->record(cmd, camera.eye);
                    if (live) live->record(cmd, {.probes = 4, .eye = camera.eye});
                });
            if (!status) return status;
        }
        if (stream)
            if (auto status = stream->status(); !status) return status;
        const auto times = renderer->draw(camera);
        if (!times) return times.error();
        return success();
    }

    Gpu& gpu;
    const Scene& scene;
    FieldData data;
    const Options& options;
    Flight flight;
    std::optional<LightField> field;
    std::optional<FieldStream> stream;
    std::optional<LiveLight> live;
    std::optional<DeviceScene> device;
    std::unique_ptr<SceneRenderer> renderer;
};

Status run(const Options& options, bool& same)
{
    Result<Scene> scene = namedScene(options.scene);
    if (!scene) return scene.error();
    FieldData data;
    std::optional<MapFile> maps;
    if (options.resident > 0)
    {
        auto opened = openField(options.field);
        if (!opened) return opened.error();
        data = std::move(opened->field), maps = std::move(opened->maps);
    }
    else
    {
        auto loaded = loadField(options.field);
        if (!loaded) return loaded.error();
        data = std::move(*loaded);
    }
    const auto own = OwnDevice::create({});
    if (!own) return own.error();
    const auto gpu = Gpu::create(own->host());
    if (!gpu) return gpu.error();
    Soak soak(**gpu, *scene, std::move(data), options);
    if (auto status = soak.make(std::move(maps)); !status) return status;
    const auto first = soak.settled();
    if (!first) return first.error();
    uint64_t deviceBefore = 0, processBefore = 0;
    for (uint32_t frame = 0; frame < options.frames; ++frame)
    {
        if (frame == std::min(kSettled, options.frames - 1)) deviceBefore = (*gpu)->memory().used(), processBefore = processBytes();
        if (auto status = soak.fly(frame); !status) return status;
    }
    const uint64_t deviceAfter = (*gpu)->memory().used(), processAfter = processBytes();
    const auto last = soak.settled();
    if (!last) return last.error();
    const bool judged = !soak.lacksRoom();
    const bool alike = !judged || (first->beauty == last->beauty && first->diffuseIndirect == last->diffuseIndirect &&
                                   first->glossyIndirect == last->glossyIndirect);
    const bool flat = deviceAfter == deviceBefore && double(processAfter) < kMostGrowth * double(processBefore);
    same = alike && flat;
    const nlohmann::ordered_json json = {{"frames", options.frames},
                                         {"resident", options.resident},
                                         {"device_bytes", {deviceBefore, deviceAfter}},
                                         {"process_bytes", {processBefore, processAfter}},
                                         {"first_frame_again", judged ? nlohmann::ordered_json(alike) : nlohmann::ordered_json(nullptr)},
                                         {"memory_flat", flat}};
    std::cout << json.dump(1) << "\n";
    return success();
}

} // namespace
} // namespace sconce

int main(int argc, char** argv)
{
    CLI::App app{"Whether frames and memory stay what they are over many frames"};
    sconce::Options options;
    app.add_option("SCENE", options.scene, ".gltf, .glb or built-in name")->required();
    app.add_option("--field", options.field, "a baked light field; with live links its lights change")->required();
    app.add_option("--resident", options.resident, "probes whose maps are on the device at a time (default: all)");
    app.add_option("--frames", options.frames, "frames (default: 100000; range: 2 to 10000000)")->check(CLI::Range(2u, 10000000u));
    app.add_option("--side", options.side, "pixels of the picture's sides (default: 32; range: 8 to 4096)")->check(CLI::Range(8u, 4096u));
    CLI11_PARSE(app, argc, argv);
    bool same = false;
    const sconce::Status status = sconce::run(options, same);
    return status && !same ? 1 : sconce::exitCodeOf(status);
}
