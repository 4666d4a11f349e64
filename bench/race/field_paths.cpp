// Paths through a baked light field, beside paths through the scene's triangles: what a frame gets that scatters its light by rays at run
// time.
//   sconce_field_paths SCENE --field FILE.sconce --reference FILE.exr [--rays N] [--paths S] [--camera N] [--seed N] [-o FILE.exr]
// A path leaves what a pixel's centre sees by the surface's own lobes; what its rays meet in the field is lit by the field's light, and
// sends the path on by its albedo, all lobes taken as diffuse (McGuire et al. 2017, "Real-Time Global Illumination using Precomputed Light
// Field Probes", whose rays end after one). N rays on a field of direct light alone (`bake --bounces 0 --live-links 8`, for albedo) have
// the light that a reference of N - 1 bounces has; one ray on a field of all bounces has all. Rays are traced on the device, the rest is
// done here. Prints JSON on stdout: of each ray of a path, how many are right, against Embree along the same ray; errors of both terms
// against the reference, and those of Embree's path tracer by as many paths, but for one ray on a field that has bounces.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <optional>
#include <tuple>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "base/random.h"
#include "bench/race/tracer_race.h"
#include "bench/reference/image_io.h"
#include "bench/reference/metrics.h"
#include "bench/reference/path_tracer.h"
#include "runtime/field/light_field.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/tracer_cpu.h"
#include "runtime/vulkan/host_vulkan.h"
#include "scene/named_scene.h"
#include "scene/view_rays.h"

namespace sconce
{
namespace
{

using Json = nlohmann::ordered_json;
using Text = twin::LightFieldTwin<float>;

constexpr float kRight = 0.002f, kNearlyRight = 0.01f; // of the true distance
constexpr float kOffSurface = 1e-3f; // of the distance to the probe that saw it, that a ray starts off a surface, as surface_rays.glsl
constexpr uint32_t kJudged = 2;      // paths of each pixel whose rays are judged

struct Options
{
    std::string scene, field, reference, output;
    uint32_t rays = 1, paths = 64, camera = 0;
    uint64_t seed = 1;
};

/// What is on its way: a ray, the weights of its light in both terms of its pixel, and which of the pixel's paths it is of.
struct Walk
{
    gpu::Ray ray{};
    vec3 diffuse{0.0f}, glossy{0.0f};
    uint32_t pixel = 0, path = 0;
};

bool hasEnded(const Walk& walk)
{
    return walk.diffuse + walk.glossy == vec3(0.0f);
}

/// Of all rays that are the n-th of their paths.
struct Turn
{
    uint64_t rays = 0, judged = 0, right = 0, nearlyRight = 0, unknown = 0;
    double milliseconds = 0.0; // of the traces

    Json json() const
    {
        const auto share = [&](uint64_t of, uint64_t all) { return double(of) / double(std::max<uint64_t>(all, 1)); };
        return {{"rays", rays},
                {"right_02", share(right, judged)},
                {"right_1", share(nearlyRight, judged)},
                {"unknown", share(unknown, rays)},
                {"milliseconds", milliseconds}};
    }
};

double secondsSince(std::chrono::steady_clock::time_point then)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

/// Sums of light by term, and how far along they were at half of the paths.
struct Light
{
    std::vector<vec3> diffuse, glossy, halfDiffuse, halfGlossy;

    explicit Light(size_t pixels) : diffuse(pixels), glossy(pixels) {}
    void keepHalf() { halfDiffuse = diffuse, halfGlossy = glossy; }
};

class Paths
{
public:
    Paths(const RayScene& scene, const FieldData& baked, const RayTracer& device, const Options& asked, const ImageSet& truth)
        : rays(scene), field(baked), tracer(device), options(asked), reference(truth), byTriangles(scene, std::nullopt, asked.rays - 1)
    {
    }

    Result<Json> run();

private:
    struct Met
    {
        vec3 radiance, albedo; // all lobes taken as diffuse; 0: the path ends
        vec3 start{0.0f};      // of the next ray, metres
    };

    Status look();
    Status ours(Light& light);
    void theirs(Light& light);
    std::vector<Walk> leaveEyePoints(uint32_t path) const;
    void judge(std::span<const Walk> walks, std::span<const gpu::RayHit> hits, Turn& turn) const;
    /// Adds what was met, and turns walks to their next rays; those that have ended are dropped.
    void meet(std::vector<Walk>& walks, std::span<const gpu::RayHit> hits, uint32_t ray, Turn& turn, Light& light) const;
    Met metBy(const gpu::RayHit& hit, bool first) const;
    Result<Json> errorsOf(const Light& light) const;
    ImageSet pictureOf(const std::vector<vec3>& diffuse, const std::vector<vec3>& glossy, uint32_t paths) const;

    const RayScene& rays;
    const FieldData& field;
    const RayTracer& tracer;
    const Options& options;
    const ImageSet& reference;
    PathTracer byTriangles;
    std::vector<ViewRay> eyeRays;
    std::vector<std::optional<ShadingPoint>> seen; // by each pixel
    std::vector<float> depth;
    std::vector<Turn> turns;
};

Status Paths::look()
{
    const Camera& camera = rays.scene().cameras[options.camera];
    auto view = ViewRays::create(camera, {.width = reference.width, .height = reference.height});
    if (!view) return view.error();
    const size_t pixels = reference.pixelCount();
    seen.resize(pixels), eyeRays.resize(pixels), depth.resize(pixels);
    parallelFor(pixels,
                [&](size_t i)
                {
                    eyeRays[i] = view->ray(uint32_t(i % reference.width), uint32_t(i / reference.width), 0);
                    const auto hit = rays.closest(eyeRays[i].origin, eyeRays[i].direction);
                    if (!hit) return;
                    seen[i] = byTriangles.shade(*hit, -eyeRays[i].direction);
                    depth[i] = hit->t * glm::dot(eyeRays[i].direction, camera.forward);
                });
    return success();
}

std::vector<Walk> Paths::leaveEyePoints(uint32_t path) const
{
    std::vector<Walk> walks(seen.size());
    parallelFor(
        seen.size(),
        [&](size_t i)
        {
            if (!seen[i]) return;
            Random random(options.seed, i, path);
            const auto next = byTriangles.scatter(*seen[i], random);
            if (!next) return;
            const vec3 normal = seen[i]->geometricNormal;
            walks[i] = {
                {seen[i]->position + rays.offset() * normal, next->direction, normal}, next->diffuse, next->specular, uint32_t(i), path};
        });
    std::erase_if(walks, hasEnded);
    return walks;
}

Paths::Met Paths::metBy(const gpu::RayHit& hit, bool first) const
{
    Met met{first ? vec3(hit.radiance) : vec3(0.0f), vec3(0.0f)};
    if (hit.status != Text::kHit || glm::dot(hit.normal, hit.normal) < 0.5f || options.rays == 1) return met;
    Text text(field, {});
    const vec3 point = (hit.position - field.info.origin) / field.info.scale, normal = hit.normal;
    const vec3 fromProbe = point - vec3(field.probes[hit.probe].centre);
    Text::TraceResult at{};
    at.probe = hit.probe;
    at.face = Text::dominantFace(fromProbe);
    const vec3 uvw = Text::faceCoordinates(at.face, fromProbe);
    at.pixel = 0.5f * float(field.info.faceSize) * (vec2(uvw.x, uvw.y) / uvw.z + 1.0f);
    met.albedo = text.liveAlbedo(at);
    met.start = hit.position + kOffSurface * field.info.scale * glm::length(fromProbe) * normal;
    if (first) return met;
    // What emitters and sky send themselves is in the light of the surfel before. A surfel sends no more than it reflects of the light that
    // frames read there, which has come one bounce further; what is beyond that it emits.
    int reads = 0;
    const vec3 arriving = text.surfaceLightAt(point, normal, normal, point + 0.5f * field.info.voxel * normal, reads).light;
    met.radiance = glm::min(vec3(hit.radiance), met.albedo * arriving);
    return met;
}

void Paths::judge(std::span<const Walk> walks, std::span<const gpu::RayHit> hits, Turn& turn) const
{
    std::vector<float> off(walks.size()); // of the true distance
    parallelFor(walks.size(),
                [&](size_t i)
                {
                    const auto truth = rays.closest(walks[i].ray.origin, walks[i].ray.direction);
                    const bool open = hits[i].status == Text::kMiss;
                    off[i] = !truth && open ? 0.0f : std::numeric_limits<float>::infinity();
                    if (truth && hits[i].status == Text::kHit) off[i] = std::abs(hits[i].t - truth->t) / truth->t;
                });
    turn.judged += walks.size();
    turn.right += uint64_t(std::ranges::count_if(off, [](float share) { return share <= kRight; }));
    turn.nearlyRight += uint64_t(std::ranges::count_if(off, [](float share) { return share <= kNearlyRight; }));
}

void Paths::meet(std::vector<Walk>& walks, std::span<const gpu::RayHit> hits, uint32_t ray, Turn& turn, Light& light) const
{
    std::vector<Met> met(walks.size());
    parallelFor(walks.size(), [&](size_t i) { met[i] = metBy(hits[i], ray == 0); });
    for (size_t i = 0; i < walks.size(); ++i)
    {
        Walk& walk = walks[i];
        light.diffuse[walk.pixel] += walk.diffuse * met[i].radiance;
        light.glossy[walk.pixel] += walk.glossy * met[i].radiance;
        turn.unknown += hits[i].status == Text::kUnknown;
        walk.diffuse *= met[i].albedo;
        walk.glossy *= met[i].albedo;
        Random random(options.seed + ray + 1, walk.pixel, walk.path);
        const vec3 normal = hits[i].normal;
        if (met[i].albedo != vec3(0.0f))
            walk.ray = {met[i].start, glm::normalize(toWorld(tangentFrame(normal), sampleCosine(random.uniform2()))), normal};
    }
    std::erase_if(walks, hasEnded);
}

Status Paths::ours(Light& light)
{
    turns.resize(options.rays);
    std::vector<gpu::RayHit> hits;
    for (uint32_t path = 0; path < options.paths; ++path)
    {
        if (path == options.paths / 2) light.keepHalf();
        std::vector<Walk> walks = leaveEyePoints(path);
        for (uint32_t ray = 0; ray < options.rays; ++ray)
        {
            std::vector<gpu::Ray> traced;
            traced.reserve(walks.size());
            for (const Walk& walk : walks) traced.push_back(walk.ray);
            hits.resize(walks.size());
            double milliseconds = 0.0;
            if (auto status = tracer.trace(traced, hits, &milliseconds); !status) return status;
            turns[ray].rays += walks.size();
            turns[ray].milliseconds += milliseconds;
            if (path < kJudged) judge(walks, hits, turns[ray]);
            meet(walks, hits, ray, turns[ray], light);
        }
    }
    return success();
}

void Paths::theirs(Light& light)
{
    for (uint32_t path = 0; path < options.paths; ++path)
    {
        if (path == options.paths / 2) light.keepHalf();
        parallelFor(seen.size(),
                    [&](size_t i)
                    {
                        Random random(options.seed, i, path);
                        const PathLight found = byTriangles.trace(eyeRays[i].origin, eyeRays[i].direction, random);
                        light.diffuse[i] += found.diffuse;
                        light.glossy[i] += found.glossy;
                    });
    }
}

ImageSet Paths::pictureOf(const std::vector<vec3>& diffuse, const std::vector<vec3>& glossy, uint32_t paths) const
{
    ImageSet picture{reference.width, reference.height, {}};
    for (const auto& [name, sums] : {std::pair("diffuse_indirect", &diffuse), {"glossy_indirect", &glossy}})
    {
        std::vector<float>& pixels = picture.add(name, 3).pixels;
        for (size_t i = 0; i < sums->size(); ++i)
            for (int c = 0; c < 3; ++c) pixels[3 * i + size_t(c)] = (*sums)[i][c] / float(paths);
    }
    picture.add("depth", 1).pixels = depth;
    return picture;
}

Result<Json> Paths::errorsOf(const Light& light) const
{
    const ImageSet whole = pictureOf(light.diffuse, light.glossy, options.paths);
    const ImageSet half = pictureOf(light.halfDiffuse, light.halfGlossy, options.paths / 2);
    Json errors;
    for (const char* layer : {"diffuse_indirect", "glossy_indirect"})
    {
        CompareSettings settings;
        settings.layer = layer;
        settings.sameSurface = true;
        const auto all = compareImages(whole, reference, settings), some = compareImages(half, reference, settings);
        if (!all) return all.error();
        if (!some) return some.error();
        // The error of endless paths: noise falls by half from half the paths to all, what is left doesn't.
        errors[layer] = {{"relmse", *all->relMse},
                         {"relmse_of_endless", 2.0 * *all->relMse - *some->relMse},
                         {"flip", *all->flip},
                         {"mean", *all->mean}};
    }
    return errors;
}

Result<Json> Paths::run()
{
    if (auto status = look(); !status) return status.error();
    Light light(seen.size()), lightOfTriangles(seen.size());
    auto then = std::chrono::steady_clock::now();
    if (auto status = ours(light); !status) return status.error();
    const double all = secondsSince(then);
    then = std::chrono::steady_clock::now();
    const bool comparable = options.rays > 1 || field.bounces == 0; // else one ray has all bounces, and a path of triangles as many as rays
    if (comparable) theirs(lightOfTriangles);
    const double theirsAll = secondsSince(then);

    Json printed = {{"scene", rays.scene().name}, {"width", reference.width}, {"height", reference.height}, {"paths", options.paths}};
    double traces = 0.0;
    for (const Turn& turn : turns) printed["rays"].push_back(turn.json()), traces += turn.milliseconds;
    for (const auto& [name, found, seconds] : {std::tuple("ours", &light, all), {"path_tracer", &lightOfTriangles, theirsAll}})
    {
        if (found == &lightOfTriangles && !comparable) continue;
        auto errors = errorsOf(*found);
        if (!errors) return errors.error();
        printed[name] = std::move(*errors);
        printed[name]["seconds"] = seconds;
    }
    printed["ours"]["trace_seconds"] = 1e-3 * traces;
    if (options.output.empty()) return printed;
    if (auto status = writeExr(pictureOf(light.diffuse, light.glossy, options.paths), options.output); !status) return status.error();
    return printed;
}

Status run(const Options& options)
{
    Result<Scene> scene = namedScene(options.scene);
    if (!scene) return scene.error();
    if (options.camera >= scene->cameras.size())
        return Error{ErrorCode::badArgument, fmt::format("--camera is {}, but scene '{}' has {}; give a smaller number", options.camera,
                                                         scene->name, scene->cameras.size())};
    const auto truth = RayScene::create(*scene);
    if (!truth) return truth.error();
    const auto reference = readExr(options.reference);
    if (!reference) return reference.error();
    const auto field = loadField(options.field);
    if (!field) return field.error();
    if (options.rays > 1 && field->live.albedo.empty())
        return Error{ErrorCode::badArgument,
                     fmt::format("{} holds no albedo, by which a path of {} rays goes on; bake it with --live-links 8, or give --rays 1",
                                 options.field, options.rays)};
    const Result<OwnDevice> device = OwnDevice::create({});
    if (!device) return device.error();
    const Result<std::shared_ptr<Gpu>> gpu = Gpu::create(device->host());
    if (!gpu) return gpu.error();
    const auto onDevice = makeLightField(**gpu, *field);
    if (!onDevice) return onDevice.error();
    const auto tracer = makeRayTracer(**gpu, *onDevice);
    if (!tracer) return tracer.error();

    const auto printed = Paths(*truth, *field, *tracer, options, *reference).run();
    if (!printed) return printed.error();
    std::cout << printed->dump(1) << std::endl;
    return success();
}

} // namespace
} // namespace sconce

int main(int argc, char** argv)
{
    CLI::App app{"Paths through a light field, against paths through the scene's triangles"};
    sconce::Options options;
    app.add_option("SCENE", options.scene, ".gltf, .glb or built-in name")->required();
    app.add_option("--field", options.field, "baked light field, of direct light alone where paths have more rays than one")->required();
    app.add_option("--reference", options.reference,
                   "what `sconce reference --pixel-centre --parts` made of the same camera; its size is taken")
        ->required();
    app.add_option("--rays", options.rays, "of a path, from what the eye sees (default: 1; range: 1 to 16)")->check(CLI::Range(1u, 16u));
    app.add_option("--paths", options.paths, "a pixel (default: 64; range: 2 to 65536)")->check(CLI::Range(2u, 65536u));
    app.add_option("--camera", options.camera, "of the scene (default: 0)");
    app.add_option("--seed", options.seed, "of the paths (default: 1)");
    app.add_option("-o,--output", options.output, "EXR file of both terms to write (default: none)");
    CLI11_PARSE(app, argc, argv);
    return sconce::exitCodeOf(sconce::run(options));
}
