// Rays from the eye through baked light fields, against Embree: how much of a picture without geometry is right, and what it costs.
//   sconce_primary_rays SCENE --field [TRACER=]FILE... [--views N] [--size WxH] [--runs N] [--seed N]
// Views stand at random points of the reachable space, from the one nearest to a probe of the first field to the farthest, and look the
// most open way of eight. Prints JSON on stdout. Right: a hit within 0.2 % (1 %) of the true distance, or a true miss.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "bench/race/ray_sets.h"
#include "bench/race/traced_method.h"
#include "bench/race/tracer_race.h"
#include "placement/free_space.h"
#include "placement/visibility.h"
#include "runtime/vulkan/host_vulkan.h"
#include "scene/named_scene.h"
#include "scene/view_rays.h"

namespace sconce
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr float kFov = 60.0f * std::numbers::pi_v<float> / 180.0f; // vertical
constexpr float kEyesApart = 0.064f;                               // metres
constexpr vec2 kHeadset(0.22f, 0.24f);                             // lens of a headset, about what early ones had
constexpr float kRight = 0.002f, kNearlyRight = 0.01f;             // of the true distance

struct Options
{
    std::string scene;
    std::vector<std::string> fields;
    uint32_t views = 10, width = 480, height = 270, runs = 5;
    uint64_t seed = 1;
};

/// A place and where it looks.
struct Seen
{
    Camera camera;
    float toProbe = 0.0f; // metres, to the nearest
};

/// The direction, of eight about level, in which rays go farthest before they meet something.
vec3 mostOpen(const RayScene& truth, vec3 eye, float diagonal, Random& random)
{
    const float turn = random.uniform();
    vec3 best(0.0f);
    float farthest = -1.0f;
    for (int i = 0; i < 8; ++i)
    {
        const float angle = 2.0f * std::numbers::pi_v<float> * (turn + float(i)) / 8.0f;
        const vec3 forward = glm::normalize(vec3(std::cos(angle), -0.15f, std::sin(angle)));
        float sum = 0.0f;
        Random rays(7, uint64_t(i));
        for (int ray = 0; ray < 32; ++ray)
        {
            const auto hit = truth.closest(eye, glm::normalize(forward + 0.5f * rays.direction()));
            sum += hit ? std::min(hit->t, 0.25f * diagonal) : 0.25f * diagonal; // an open sky alone is no view
        }
        if (sum > farthest) farthest = sum, best = forward;
    }
    return best;
}

Result<std::vector<Seen>> chooseViews(const Scene& scene, const RayScene& truth, const FieldData& field, const Options& options)
{
    auto visibility = Visibility::build(scene);
    if (!visibility) return visibility.error();
    auto space = findFreeSpace(scene, *visibility, {});
    if (!space) return space.error();
    const float diagonal = scene.bounds().diagonal();
    Random random(options.seed, 41);
    std::vector<Seen> views(options.views);
    for (Seen& view : views)
    {
        view.camera.eye = space->randomPoint(random);
        view.camera.forward = mostOpen(truth, view.camera.eye, diagonal, random);
        view.camera.verticalFov = kFov;
        view.toProbe = std::numeric_limits<float>::infinity();
        for (const gpu::ProbeHeader& probe : field.probes)
        {
            const vec3 world = field.info.origin + field.info.scale * vec3(probe.centre);
            view.toProbe = std::min(view.toProbe, glm::distance(world, view.camera.eye));
        }
    }
    std::ranges::sort(views, {}, &Seen::toProbe);
    return views;
}

RaySet raysOf(const RayScene& truth, const Camera& camera, const View& view)
{
    const ViewRays rays = *ViewRays::create(camera, view);
    std::vector<vec3> origins, directions;
    for (const glm::uvec2 at : rays.pixelsInTiles(0, rays.height()))
    {
        const ViewRay ray = rays.ray(at.x, at.y, 0);
        origins.push_back(ray.origin);
        directions.push_back(ray.direction);
    }
    return raySetFrom(truth, origins, directions);
}

/// Shares of a picture's rays, and the median time of its trace.
struct Score
{
    double right = 0.0, nearlyRight = 0.0, tooNear = 0.0, tooFar = 0.0, unknown = 0.0, reads = 0.0, milliseconds = 0.0;

    void add(const Score& of, double share)
    {
        right += share * of.right, nearlyRight += share * of.nearlyRight, tooNear += share * of.tooNear, tooFar += share * of.tooFar;
        unknown += share * of.unknown, reads += share * of.reads, milliseconds += share * of.milliseconds;
    }
    Json json() const
    {
        return {{"right_02", right},  {"right_1", nearlyRight}, {"too_near", tooNear},         {"too_far", tooFar},
                {"unknown", unknown}, {"reads", reads},         {"milliseconds", milliseconds}};
    }
};

void judge(Score& score, const RayTruth& truth, const TracedRay& traced, double one)
{
    score.reads += one * (traced.distanceReads + traced.indexReads);
    const float t = traced.status == TraceStatus::miss ? std::numeric_limits<float>::infinity() : traced.t;
    const float true_ = truth.hit ? truth.t : std::numeric_limits<float>::infinity();
    const bool open = std::isinf(t) && std::isinf(true_);
    if (traced.status == TraceStatus::unknown)
        score.unknown += one;
    else if (open || std::abs(t - true_) <= kNearlyRight * true_)
        score.nearlyRight += one, score.right += open || std::abs(t - true_) <= kRight * true_ ? one : 0.0;
    else
        (t < true_ ? score.tooNear : score.tooFar) += one;
}

Result<Score> scoreOf(TracedMethod& method, const RaySet& set, uint32_t runs)
{
    const std::vector<gpu::Ray> rays = method.raysOf(set);
    std::vector<gpu::RayHit> hits(rays.size());
    if (Status status = method.trace(rays, hits); !status) return status.error();
    Score score;
    const std::vector<TracedRay> traced = tracedRays(hits);
    for (size_t i = 0; i < traced.size(); ++i) judge(score, set.truth[i], traced[i], 1.0 / double(traced.size()));
    const std::vector<uint32_t> order = shuffledOrder(rays.size(), 1);
    if (Status status = method.prepare(rays, order); !status) return status.error();
    std::vector<double> milliseconds;
    for (uint32_t run = 0; run < runs; ++run)
    {
        const Result<double> time = method.time(true);
        if (!time) return time.error();
        milliseconds.push_back(*time);
    }
    score.milliseconds = timesOf(milliseconds).median;
    return score;
}

/// All views of a kind, each, and their mean.
Result<Json> scoreViews(TracedMethod& method, const RayScene& truth, std::span<const Seen> views, const View& view, uint32_t runs)
{
    Json each = Json::array();
    Score mean;
    for (const Seen& seen : views)
    {
        const Result<Score> score = scoreOf(method, raysOf(truth, seen.camera, view), runs);
        if (!score) return score.error();
        mean.add(*score, 1.0 / double(views.size()));
        each.push_back(score->json());
    }
    return Json{{"mean", mean.json()}, {"views", each}};
}

Status run(const Options& options)
{
    Result<Scene> scene = namedScene(options.scene);
    if (!scene) return scene.error();
    const auto truth = RayScene::create(*scene);
    if (!truth) return truth.error();
    const Result<OwnDevice> device = OwnDevice::create({});
    if (!device) return device.error();
    const Result<std::shared_ptr<Gpu>> gpu = Gpu::create(device->host());
    if (!gpu) return gpu.error();

    Json printed = {
        {"scene", scene->name}, {"width", options.width}, {"height", options.height}, {"runs", options.runs}, {"device", device->name()}};
    std::vector<Seen> views;
    for (const std::string& field : options.fields)
    {
        auto method = TracedMethod::create(**gpu, field);
        if (!method) return method.error();
        if (views.empty())
        {
            auto chosen = chooseViews(*scene, *truth, (*method)->data(), options);
            if (!chosen) return chosen.error();
            views = std::move(*chosen);
        }
        const View view{.width = options.width, .height = options.height};
        View stereo = view, headset = view;
        stereo.eyesApart = headset.eyesApart = kEyesApart;
        headset.lens = kHeadset;
        Json row = {{"method", (*method)->name()}, {"file", (*method)->file()}, {"probes", (*method)->data().probes.size()}};
        for (const auto& [name, kind] :
             {std::pair("one_eye", view), std::pair("two_eyes", stereo), std::pair("two_eyes_through_lenses", headset)})
        {
            auto scored = scoreViews(**method, *truth, views, kind, options.runs);
            if (!scored) return scored.error();
            row[name] = std::move(*scored);
        }
        printed["methods"].push_back(std::move(row));
    }
    for (const Seen& seen : views)
    {
        const vec3 eye = seen.camera.eye, target = eye + seen.camera.forward;
        printed["views"].push_back(
            {{"eye", {eye.x, eye.y, eye.z}}, {"target", {target.x, target.y, target.z}}, {"to_probe", seen.toProbe}});
    }
    std::cout << printed.dump(1) << std::endl;
    return success();
}

} // namespace
} // namespace sconce

int main(int argc, char** argv)
{
    CLI::App app{"Rays from the eye through light fields, against Embree"};
    sconce::Options options;
    app.add_option("SCENE", options.scene, ".gltf, .glb or built-in name")->required();
    app.add_option("--field", options.fields,
                   "[TRACER=]FILE, a baked light field and what traces it, as of sconce_ray_accuracy; repeatable")
        ->required();
    app.add_option("--views", options.views, "places (default: 10; range: 1 to 1000)")->check(CLI::Range(1u, 1000u));
    app.add_option("--width", options.width, "of an eye's picture, pixels (default: 480; range: 8 to 480)")->check(CLI::Range(8u, 480u));
    app.add_option("--height", options.height, "of an eye's picture, pixels (default: 270; range: 8 to 270)")->check(CLI::Range(8u, 270u));
    app.add_option("--runs", options.runs, "timed, the median counts (default: 5; range: 1 to 100)")->check(CLI::Range(1u, 100u));
    app.add_option("--seed", options.seed, "of the views (default: 1)");
    CLI11_PARSE(app, argc, argv);
    return sconce::exitCodeOf(sconce::run(options));
}
