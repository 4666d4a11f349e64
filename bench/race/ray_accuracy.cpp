// How right and how fast tracers are: the same glossy rays through baked light fields, against Embree (bench/race/tracer_race.h).
//   sconce_ray_accuracy SCENE --field [TRACER=]FILE... [--rays N] [--seed N] [--runs N] [--timed N] [--cpu] [--json] [--record FILE]
//   [--camera N]
// TRACER: ours, b0, b0plus, b0plus-octree, wang (bench/opponents/baselines.h); left out, the field tells. Rays leave surfaces that the
// scene's cameras and points of the reachable space see, GGX alpha 0.1 to 0.3; with --camera those that one camera sees alone: as coherent
// as a frame's rays. --record keeps them for sconce_replay.
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/race/race_options.h"
#include "bench/race/ray_file.h"
#include "bench/race/scene_rays.h"
#include "bench/race/tracer_race.h"
#include "scene/named_scene.h"

namespace sconce
{
namespace
{

struct Options
{
    std::string scene, record;
    uint32_t rays = 100000;
    std::optional<uint32_t> camera;
    RaceSettings race;
};

Result<RaySet> raysOf(const Options& options, const Scene& scene, const RayScene& truth)
{
    if (!options.camera) return sceneRays(scene, truth, options.rays, options.race.seed);
    if (*options.camera >= scene.cameras.size())
        return Error{ErrorCode::badArgument, fmt::format("--camera is {}, and {} has {} of them, from 0 on; leave it out for rays of all",
                                                         *options.camera, options.scene, scene.cameras.size())};
    return cameraRays(scene.cameras[*options.camera], truth, options.rays, options.race.seed);
}

Status run(const Options& options)
{
    Result<Scene> scene = namedScene(options.scene);
    if (!scene) return scene.error();
    auto truth = RayScene::create(*scene);
    if (!truth) return truth.error();
    auto set = raysOf(options, *scene, *truth);
    if (!set) return set.error();
    if (!options.record.empty())
        if (auto status = saveRays(*set, options.record); !status) return status;
    const OutsideRunner embree{"embree", "all cores, robust, the faster of 1 and 8 rays a call",
                               [&](const RaySet& rays) { return embreeMilliseconds(*truth, rays); }};
    return raceOnOwnDevice(*set, options.race, embree);
}

} // namespace
} // namespace sconce

int main(int argc, char** argv)
{
    CLI::App app{"Accuracy and speed of light field tracers on glossy rays, against Embree"};
    sconce::Options options;
    app.add_option("SCENE", options.scene, ".gltf, .glb or built-in name")->required();
    app.add_option("--rays", options.rays, "rays (default: 100000; range: 1 to 10000000)")->check(CLI::Range(1u, 10000000u));
    app.add_option("--record", options.record, "file to keep the rays and their truth in, for sconce_replay (default: none)");
    app.add_option("--camera", options.camera,
                   "camera of the scene whose picture alone sends the rays, by number (default: all, and points between)");
    sconce::addRaceOptions(app, options.race);
    CLI11_PARSE(app, argc, argv);
    return sconce::exitCodeOf(sconce::run(options));
}
