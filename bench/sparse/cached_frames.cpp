// A camera that flies, and a light that is switched, at a fixed number of rays from the eye a frame: what is kept over frames, and how.
//   sconce_cached_frames SCENE --field FILE.sconce [--every N] [--frames N] [--speed M/S] [--switch GROUP --to W] [--width N] [--height N]
//   [-o PREFIX]
// The picture is what a light field's probes saw, a ray a pixel; each way has one ray for every N pixels a frame. Ways: the render cache
// (Walter et al. 1999); a post-render warp, whose whole frames take N of those that are shown (Mark, McMillan, Bishop 1997); frameless,
// pixels in random order without a change of their place (Bishop et al. 1994); whole frames one after the other; and a lattice of this
// frame's rays, nothing kept. Beside them reflections of frames with geometry, against their own with all rays: prefiltered radiance, the
// same with corrective textures (Stamminger et al. 2000) by a ray for N pixels, frames with --trace-every N, and those with --temporal,
// too, which both trace what is sharp at all pixels. Prints JSON on stdout: errors frame by frame, and those before and after the switch.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <numeric>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "bench/race/flight.h"
#include "bench/race/tracer_race.h"
#include "bench/reference/metrics.h"
#include "bench/sparse/corrective_textures.h"
#include "bench/sparse/pictures.h"
#include "bench/sparse/render_cache.h"
#include "runtime/field/light_field.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/light_groups.h"
#include "runtime/field/tracer_cpu.h"
#include "runtime/vulkan/host_vulkan.h"
#include "scene/named_scene.h"

namespace sconce
{
namespace
{

using Json = nlohmann::ordered_json;
using Text = twin::LightFieldTwin<float>;

constexpr float kFramesASecond = 60.0f;
constexpr float kInfinity = 1e5f;  // metres that what is not met is taken to be off
constexpr float kFarOff = 0.25f;   // relative error of a pixel that counts as a ghost
constexpr uint32_t kFlipEvery = 8; // frames
constexpr double kSettled = 0.05;  // of the mean light's change that is left when a switch has been seen

struct Options
{
    std::string scene, field, output, group;
    uint32_t every = 16, frames = 96, width = 320, height = 180;
    float speed = 2.0f, weight = 0.0f;
};

/// All rays of a frame, answered.
struct Answers
{
    Camera camera;
    std::vector<RenderCache::Point> points; // [pixel]

    std::vector<vec3> colours() const
    {
        std::vector<vec3> colours;
        for (const RenderCache::Point& point : points) colours.push_back(point.colour);
        return colours;
    }
};

Result<Answers> answersOf(const RayTracer& tracer, const Camera& camera, uint32_t width, uint32_t height)
{
    const Result<ViewRays> view = ViewRays::create(camera, {.width = width, .height = height});
    if (!view) return view.error();
    const std::vector<glm::uvec2> order = view->pixelsInTiles(0, height);
    std::vector<gpu::Ray> rays;
    for (const glm::uvec2 at : order)
    {
        const ViewRay ray = view->ray(at.x, at.y, 0);
        rays.push_back({.origin = ray.origin, .direction = ray.direction, .normal = vec3(0.0f)});
    }
    std::vector<gpu::RayHit> hits(rays.size());
    if (Status traced = tracer.trace(rays, hits); !traced) return traced.error();
    Answers answers{camera, std::vector<RenderCache::Point>(hits.size())};
    for (size_t i = 0; i < hits.size(); ++i)
    {
        const float t = hits[i].status == Text::kMiss ? kInfinity : hits[i].t;
        answers.points[size_t(order[i].y) * width + order[i].x] = {rays[i].origin + t * rays[i].direction, hits[i].radiance, 0.0f};
    }
    return answers;
}

/// A way to show a frame by some of its rays.
class Way
{
public:
    explicit Way(const Options& of) : options(of), pixels(size_t(of.width) * of.height), shown(pixels, vec3(0.0f)) {}
    virtual ~Way() = default;
    virtual void frame(const Answers& all, uint32_t index) = 0;
    std::span<const vec3> picture() const { return shown; }

protected:
    size_t budget() const { return pixels / options.every; }
    const Options& options;
    size_t pixels;
    std::vector<vec3> shown;
};

class Cached final : public Way
{
public:
    explicit Cached(const Options& of) : Way(of), cache({.width = of.width, .height = of.height}) {}
    void frame(const Answers& all, uint32_t) override
    {
        cache.project(all.camera);
        const std::vector<uint32_t> asked = cache.ask(budget());
        std::vector<RenderCache::Point> samples;
        for (const uint32_t pixel : asked) samples.push_back(all.points[pixel]);
        cache.add(asked, samples);
        shown.assign(cache.picture().begin(), cache.picture().end());
        for (size_t i = 0; i < asked.size(); ++i) shown[asked[i]] = samples[i].colour; // as they come
    }

private:
    RenderCache cache;
};

class Warped final : public Way
{
public:
    explicit Warped(const Options& of) : Way(of), cache({.width = of.width, .height = of.height, .points = 1.0f}) {}
    void frame(const Answers& all, uint32_t index) override
    {
        if (index % options.every == 0)
        {
            cache.replace(next.points.empty() ? all.points : next.points);
            next = all; // ready when its rays are traced
        }
        cache.project(all.camera);
        shown.assign(cache.picture().begin(), cache.picture().end());
    }

private:
    RenderCache cache;
    Answers next;
};

class Frameless final : public Way
{
public:
    explicit Frameless(const Options& of) : Way(of), order(pixels)
    {
        std::iota(order.begin(), order.end(), 0u);
        Random random(1, 77);
        for (size_t i = pixels; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    }
    void frame(const Answers& all, uint32_t) override
    {
        for (size_t i = 0; i < budget(); ++i, next = (next + 1) % pixels) shown[order[next]] = all.points[order[next]].colour;
    }

private:
    std::vector<uint32_t> order;
    size_t next = 0;
};

class Whole final : public Way
{
public:
    using Way::Way;
    void frame(const Answers& all, uint32_t index) override
    {
        if (index % options.every != 0) return;
        shown = next.empty() ? all.colours() : next;
        next = all.colours();
    }

private:
    std::vector<vec3> next;
};

class Lattice final : public Way
{
public:
    using Way::Way;
    void frame(const Answers& all, uint32_t) override
    {
        const int side = int(std::lround(std::sqrt(double(options.every))));
        const glm::ivec2 last(int(options.width - 1) / side * side, int(options.height - 1) / side * side);
        for (int y = 0; y < int(options.height); ++y)
            for (int x = 0; x < int(options.width); ++x)
            {
                const glm::ivec2 at(x / side * side, y / side * side), after = glm::min(at + side, last);
                const vec2 share = vec2(x - at.x, y - at.y) / float(side);
                const auto of = [&](int u, int v) { return all.points[size_t(v) * options.width + size_t(u)].colour; };
                shown[size_t(y) * options.width + size_t(x)] =
                    glm::mix(glm::mix(of(at.x, at.y), of(after.x, at.y), share.x),
                             glm::mix(of(at.x, after.y), of(after.x, after.y), share.x), share.y);
            }
    }
};

/// What a way is off by in one frame.
struct Off
{
    double error = 0.0, mean = 1.0, ghosts = 0.0;
    std::optional<double> flip; // of some frames
};

Result<Off> offOf(std::span<const vec3> drawn, std::span<const vec3> truth, const Options& options, uint32_t frame)
{
    const auto values = [](std::span<const vec3> of) { return std::span<const float>(&of[0].x, 3 * of.size()); };
    Off off{relativeMeanSquaredError(values(drawn), values(truth)), meanOverMean(values(drawn), values(truth)), 0.0, {}};
    if (frame % kFlipEvery == kFlipEvery - 1)
    {
        CompareSettings settings;
        settings.mse = settings.relMse = settings.psnr = settings.mean = false;
        const auto compared =
            compareImages(pictureOf(drawn, options.width, options.height), pictureOf(truth, options.width, options.height), settings);
        if (!compared) return compared.error();
        off.flip = compared->flip;
    }
    for (size_t i = 0; i < drawn.size(); ++i)
    {
        const vec3 weights(0.2126f, 0.7152f, 0.0722f);
        const float own = glm::dot(drawn[i], weights), is = glm::dot(truth[i], weights);
        off.ghosts += std::abs(own - is) > kFarOff * std::max(own, is) ? 1.0 / double(drawn.size()) : 0.0;
    }
    return off;
}

double meanFlip(std::span<const Off> of)
{
    double sum = 0.0, count = 0.0;
    for (const Off& off : of)
        if (off.flip) sum += *off.flip, count += 1.0;
    return sum / count;
}

double meanOf(std::span<const Off> of, double Off::*value)
{
    double sum = 0.0;
    for (const Off& off : of) sum += off.*value;
    return of.empty() ? 0.0 : sum / double(of.size());
}

/// Before the switch, from when all ways have filled their pictures; and after it.
Json jsonOf(std::span<const Off> frames, const Options& options)
{
    const size_t change = frames.size() / 2, filled = std::min<size_t>(2 * options.every, change - 1);
    const std::span<const Off> before = frames.subspan(filled, change - filled), after = frames.subspan(change);
    const double steady = meanOf(before, &Off::mean);
    size_t settled = 0; // frames until the mean light is what it was before, but for a twentieth, for good
    for (size_t i = 0; i < after.size(); ++i)
        if (std::abs(after[i].mean - steady) > kSettled) settled = i + 1;
    Json json = {{"error", meanOf(before, &Off::error)},
                 {"flip", meanFlip(before)},
                 {"ghosts", meanOf(before, &Off::ghosts)},
                 {"mean", steady},
                 {"frames_to_light", settled == after.size() ? Json() : Json(settled)}};
    for (const size_t frame : {size_t(0), size_t(8), size_t(16), size_t(32)})
        if (frame < after.size())
        {
            json["error_after_" + std::to_string(frame)] = after[frame].error;
            json["ghosts_after_" + std::to_string(frame)] = after[frame].ghosts;
        }
    for (const Off& off : frames) json["frames"].push_back({off.error, off.mean, off.ghosts});
    return json;
}

/// The device, with all that is drawn on it.
struct World
{
    Scene scene;
    FieldData data;
    std::shared_ptr<Gpu> gpu;
    LightField field;
    std::optional<LightGroups> groups;

    /// One group of light from now on times so much.
    Status dim(const std::string& name, float weight)
    {
        std::vector<vec3> weights;
        for (const std::string& group : groups->names()) weights.push_back(vec3(group == name ? weight : 1.0f));
        if (Status set = groups->set(weights); !set) return set;
        return gpu->submit([&](VkCommandBuffer cmd) { groups->record(cmd); });
    }
};

/// Frames with geometry, whose reflections are what is sparse.
class Drawn
{
public:
    Drawn(World& of, const Options& asked, const Flight& way) : world(of), options(asked), flight(way), textures(CorrectiveTextures::Desc())
    {
    }

    /// Errors by way: prefiltered radiance alone, that corrected by textures, a lattice of rays, and that kept by --temporal.
    Result<Json> run()
    {
        if (Status made = make(); !made) return made.error();
        for (uint32_t i = 0; i < options.frames; ++i)
            if (Status drawn = frame(i); !drawn) return drawn.error();
        Json json;
        for (const auto& [name, of] : offs)
        {
            json[name] = jsonOf(of, options);
            if (rays.contains(name)) json[name]["rays"] = rays.at(name) / options.frames;
        }
        json["corrected"]["bytes"] = textures.bytes();
        return json;
    }

private:
    Status make()
    {
        auto made = DeviceScene::create(*world.gpu, world.scene, world.data.info);
        if (!made) return made.error();
        device.emplace(std::move(*made));
        RenderSettings settings;
        settings.width = options.width, settings.height = options.height;
        settings.effects = world.field.effectsOfFrames();
        RenderSettings true_ = settings, cheap = settings, dear = settings, lattice = settings;
        true_.glossyRays = 4;
        cheap.raysBelow = 0.0f;
        dear.effects.denoise = false;
        lattice.traceEvery = options.every;
        RenderSettings temporal = lattice;
        temporal.effects.temporal = true;
        for (const auto& [name, of] : {std::pair("true", true_), std::pair("prefiltered", cheap), std::pair("dear", dear),
                                       std::pair("every", lattice), std::pair("temporal", temporal)})
        {
            auto renderer = SceneRenderer::create(*world.gpu, *device, world.field, of);
            if (!renderer) return renderer.error();
            renderers[name] = std::move(*renderer);
        }
        return success();
    }
    Status frame(uint32_t i)
    {
        if (i == options.frames / 2 && world.groups)
        {
            if (Status dimmed = world.dim(options.group, options.weight); !dimmed) return dimmed;
            for (auto& [name, renderer] : renderers) renderer->lightChanged();
        }
        const Camera camera = flight.at(options.speed / kFramesASecond * float(i));
        std::map<std::string, RenderedFrame> frames;
        for (auto& [name, renderer] : renderers)
        {
            auto drawn = renderer->render(camera, i);
            if (!drawn) return drawn.error();
            frames[name] = std::move(*drawn);
        }
        const std::vector<vec3>& truth = frames["true"].glossyIndirect;
        for (const char* name : {"prefiltered", "every", "temporal"})
        {
            if (Status judged = judge(name, frames[name].glossyIndirect, truth, i); !judged) return judged;
            const auto traced = std::ranges::count_if(frames[name].counts, [](glm::uvec4 of) { return of.z > 0; });
            rays[name] += double(traced) / double(truth.size());
        }
        return correct(frames, camera, i);
    }
    Status correct(std::map<std::string, RenderedFrame>& frames, const Camera& camera, uint32_t i)
    {
        const RenderedFrame &cheap = frames["prefiltered"], &dear = frames["dear"];
        const SurfacePixels pixels = surfacesOf(dear, camera);
        std::vector<bool> wanted;
        for (size_t pixel = 0; pixel < dear.roughness.size(); ++pixel)
            wanted.push_back(dear.normal[pixel] != vec3(0.0f) && dear.counts[pixel].z > 0); // what is traced where all is
        const std::vector<vec3> picture = textures.correct(pixels, cheap.glossyIndirect, wanted);
        const std::vector<uint32_t> asked = textures.ask(picture.size() / options.every);
        std::vector<vec3> differences;
        for (const uint32_t pixel : asked) differences.push_back(dear.glossyIndirect[pixel] - cheap.glossyIndirect[pixel]);
        textures.add(pixels, asked, differences);
        rays["corrected"] += double(asked.size()) / double(picture.size());
        return judge("corrected", picture, frames["true"].glossyIndirect, i);
    }
    Status judge(const std::string& name, std::span<const vec3> drawn, std::span<const vec3> truth, uint32_t frame)
    {
        const Result<Off> off = offOf(drawn, truth, options, frame);
        if (!off) return off.error();
        offs[name].push_back(*off);
        return success();
    }

    World& world;
    const Options& options;
    const Flight& flight;
    CorrectiveTextures textures;
    std::optional<DeviceScene> device;
    std::map<std::string, std::unique_ptr<SceneRenderer>> renderers;
    std::map<std::string, std::vector<Off>> offs;
    std::map<std::string, double> rays; // a pixel, of all frames
};

Status writePictures(const Options& options, const std::string& way, std::span<const vec3> drawn, std::span<const vec3> truth)
{
    const ImageSet own = pictureOf(drawn, options.width, options.height), reference = pictureOf(truth, options.width, options.height);
    const auto result = compareImages(own, reference);
    if (!result) return result.error();
    return writeSideBySide(own, reference, {}, *result, options.output + "." + way + ".png");
}

Status run(const Options& options)
{
    Result<Scene> scene = namedScene(options.scene);
    if (!scene) return scene.error();
    Result<FieldData> data = loadField(options.field);
    if (!data) return data.error();
    const auto own = OwnDevice::create({});
    if (!own) return own.error();
    Result<std::shared_ptr<Gpu>> gpu = Gpu::create(own->host());
    if (!gpu) return gpu.error();
    Result<LightField> field = makeLightField(**gpu, *data);
    if (!field) return field.error();
    World world{std::move(*scene), std::move(*data), *gpu, std::move(*field), {}};
    if (!options.group.empty())
    {
        auto groups = makeLightGroups(**gpu, world.field, world.data);
        if (!groups) return groups.error();
        const std::vector<std::string> names = groups->names();
        if (std::ranges::find(names, options.group) == names.end())
            return Error{ErrorCode::badArgument,
                         fmt::format("{} has no group '{}'; it has {}", options.field, options.group, fmt::join(names, ", "))};
        world.groups = std::move(*groups);
    }
    const auto tracer = makeRayTracer(**gpu, world.field);
    if (!tracer) return tracer.error();

    const Flight flight(world.data);
    std::vector<std::pair<std::string, std::unique_ptr<Way>>> ways;
    ways.emplace_back("cache", std::make_unique<Cached>(options));
    ways.emplace_back("warp", std::make_unique<Warped>(options));
    ways.emplace_back("frameless", std::make_unique<Frameless>(options));
    ways.emplace_back("whole", std::make_unique<Whole>(options));
    ways.emplace_back("lattice", std::make_unique<Lattice>(options));
    std::vector<std::vector<Off>> offs(ways.size());
    for (uint32_t i = 0; i < options.frames; ++i)
    {
        if (i == options.frames / 2 && world.groups)
            if (Status dimmed = world.dim(options.group, options.weight); !dimmed) return dimmed;
        const auto all = answersOf(*tracer, flight.at(options.speed / kFramesASecond * float(i)), options.width, options.height);
        if (!all) return all.error();
        const std::vector<vec3> truth = all->colours();
        for (size_t way = 0; way < ways.size(); ++way)
        {
            ways[way].second->frame(*all, i);
            const Result<Off> off = offOf(ways[way].second->picture(), truth, options, i);
            if (!off) return off.error();
            offs[way].push_back(*off);
            if (!options.output.empty() && i + 1 == options.frames / 2)
                if (Status written = writePictures(options, ways[way].first, ways[way].second->picture(), truth); !written) return written;
        }
    }
    Json printed = {{"scene", world.scene.name}, {"every", options.every}, {"speed", options.speed}, {"device", own->name()}};
    for (size_t way = 0; way < ways.size(); ++way) printed["ways"][ways[way].first] = jsonOf(offs[way], options);
    if (world.groups)
        if (Status dimmed = world.dim(options.group, 1.0f); !dimmed) return dimmed;
    auto drawn = Drawn(world, options, flight).run();
    if (!drawn) return drawn.error();
    printed["reflections"] = std::move(*drawn);
    std::cout << printed.dump(1) << std::endl;
    return success();
}

} // namespace
} // namespace sconce

int main(int argc, char** argv)
{
    CLI::App app{"A flight at a fixed number of rays a frame, by what is kept over frames"};
    sconce::Options options;
    app.add_option("SCENE", options.scene, ".gltf, .glb or built-in name")->required();
    app.add_option("--field", options.field, "a baked light field")->required();
    app.add_option("--every", options.every, "pixels for each ray, a square (default: 16)")->check(CLI::IsMember({1, 4, 16, 64}));
    app.add_option("--frames", options.frames, "60 a second (default: 96; range: 32 to 10000)")->check(CLI::Range(32u, 10000u));
    app.add_option("--speed", options.speed, "metres a second (default: 2; range: 0 to 100)")->check(CLI::Range(0.0f, 100.0f));
    app.add_option("--switch", options.group,
                   "a group of the field's lights whose light is another from the middle frame on (default: none)");
    app.add_option("--to", options.weight, "times its light (default: 0; range: 0 to 1e6)")->check(CLI::Range(0.0f, 1e6f));
    app.add_option("--width", options.width, "pixels (default: 320; range: 8 to 1920)")->check(CLI::Range(8u, 1920u));
    app.add_option("--height", options.height, "pixels (default: 180; range: 8 to 1080)")->check(CLI::Range(8u, 1080u));
    app.add_option("-o,--output", options.output, "writes the pictures of the frame before the switch, PREFIX.WAY.png");
    CLI11_PARSE(app, argc, argv);
    return sconce::exitCodeOf(sconce::run(options));
}
