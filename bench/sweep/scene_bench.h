#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/progress.h"
#include "bench/reference/ray_scene.h"
#include "bench/reference/reference.h"
#include "bench/sweep/kept_fields.h"
#include "bench/sweep/plan.h"
#include "runtime/scene/device_scene.h"

namespace sconce
{

/// What is measured, how large and how often: the same for every point of a scene.
struct BenchSettings
{
    uint32_t width = knobs::benchWidth.value, height = knobs::benchHeight.value; // pixels of the frames
    uint32_t rays = knobs::judgedRays.value;                                     // glossy rays judged against Embree
    uint32_t frames = knobs::timedFrames.value;                                  // timed, each point in turn
    uint32_t warmUp = knobs::warmUp.value;                                       // frames before them
    double referenceUntil = knobs::referenceUntil.value;                         // own relMSE by its noise
    uint32_t referencePaths = knobs::referencePaths.value;                       // a pixel
    uint32_t referenceBounces = knobs::referenceBounces.value; // a truth with more bounces than any light field that is measured
    uint64_t seed = knobs::benchSeed.value;                    // of rays and paths
    bool pictures = true;                                      // of every method's default point
    bool times = true;
    bool judgeGrids = true; // by what a method makes of them; false: grids are those whose cells' corners see best, at once
    uint64_t groupBytes = uint64_t(knobs::groupMebibytes.value)
                          << 20; // of light fields that stand on the device at once to be timed in turns
};

/// One scene on the bench: its truth, its light fields and its points, each made once and kept in a folder by a hash of everything it
/// depends on, so that a later run finds it.
class SceneBench
{
public:
    struct Desc
    {
        std::string name;   // of the scene, in results
        std::string source; // file or built-in name
        Scene scene;
        std::optional<Camera> camera; // none: the scene's first; where it has none, from the first probe to the second
        BenchSettings settings;
        std::filesystem::path folder; // of all results: pictures go to images/, what is kept to cache/
        std::string build;            // keyOfThisBuild(): part of every key of what is kept
    };
    /// @param defaults  of the scene: where its cameras fail, their probes are what is looked from
    /// Errors: badInput (scene), fileError (folder), as placeProbes().
    static Result<std::unique_ptr<SceneBench>> create(Gpu& gpu, std::string deviceName, Desc desc, const PointSettings& defaults,
                                                      const Progress& progress);

    /// The point as results.json holds it, where it has been measured; with its times where they are wanted.
    std::optional<Json> kept(const PlannedPoint& point) const;
    Status keep(const PlannedPoint& point, const Json& measured) const;

    /// Reads the reference, or renders it; of surfaces with this roughness, where it is given.
    Status makeReference(const std::optional<float>& roughness, const Progress& progress);
    /// Draws the rays; once, before anything below.
    Status prepare();

    /// A point on the device, ready to be measured and timed. Of path tracers, only the filtered path tracer has a renderer, a volume has
    /// no tracer.
    struct Live
    {
        const PlannedPoint* plan = nullptr;
        Json fieldCost = Json::object(); // probe_set, bytes, bake_s, place_s, ...
        std::unique_ptr<TracedMethod> tracer;
        std::optional<LightField> untraced; // in the tracer's place: a volume's, or a path tracer's picture
        ImageSet paths;                     // of the filtered path tracer
        std::unique_ptr<SceneRenderer> renderer;
    };
    Result<Live> enliven(const PlannedPoint& point, const Progress& progress);
    /// Rays, errors and pictures: everything but times.
    Result<Json> measure(Live& live, const Progress& progress);
    /// One frame: passes and milliseconds, by the device's clock. Where the CPU does the work (path tracer, software Vulkan): by the CPU
    /// time of all threads divided by the cores, which what else the machine does hardly touches.
    using Passes = std::vector<std::pair<std::string, double>>;
    Result<Passes> timeFrame(Live& live, uint32_t turn);

    /// The scene as results.json holds it, without points and analysis, but with the probes of these points as far as they are placed.
    Json describe(std::span<const PlannedPoint> points) const;
    /// Rays with their truth, once prepared.
    const RaySet& raySet() const { return *rays; }

    const BenchSettings& settings() const { return desc.settings; }
    const std::string& name() const { return desc.name; }
    static uint64_t bytesOf(const PointSettings& settings); // about, of a light field on the device

private:
    SceneBench(Gpu& device, std::string deviceName, Desc made);
    std::string pointKey(const PlannedPoint& point) const;
    bool software() const; // the device is the CPU
    Result<double> wrongOnGrid(const ProbeGrid& grid, const PointSettings& settings);
    Result<FieldData> volumeOn(FieldData places, const PointSettings& settings, Volume volume, const Progress& progress, uint32_t rays);
    /// How far look-ups are moved.
    struct LookUps
    {
        float bias, view; // as PointSettings has them
    };
    Result<LookUps> lookUpsOf(Live& live, const RenderSettings& frame, const Progress& progress);
    Result<double> diffuseError(const PointSettings& settings, SceneRenderer& renderer) const;
    Result<std::unique_ptr<SceneRenderer>> rendererOf(const PointSettings& settings, const LightField& field, RenderSettings frame,
                                                      const Progress& progress);
    Result<FieldData> volumeFor(const PointSettings& settings, Volume volume, Json& cost, const Progress& progress);
    /// What a point's frame shows, with the light of lamps and sky that it is given.
    void addLamps(const PointSettings& settings, RenderedFrame& frame) const;
    Status makeTracer(Live& live, const Progress& progress);
    Status makePicture(Live& live, const Progress& progress);
    Status makeVolume(Live& live, Volume volume, const Progress& progress);
    Status makeTruth();
    Result<const DeviceScene*> sceneOf(const PointSettings& settings, const IndirectEffects& effects, const Progress& progress);
    Result<Json> errorsOf(const ImageSet& picture) const;
    ReferenceSettings pathSettings(const PlannedPoint& point) const;
    Status writeReferencePictures();
    Result<Json> writePictures(const PlannedPoint& point, const RenderedFrame& frame);

    Gpu& gpu;
    std::string device;
    Desc desc;
    KeptFields fields; // of desc's scene, in its folder
    Camera camera;
    Json referenceJson; // null until the reference is there
    ImageSet referenceImages;
    std::vector<float> lampsAndSky; // diffuse light straight from there, of the path tracer
    std::optional<RayScene> truth;
    std::optional<RaySet> rays;
    std::array<std::optional<DeviceScene>, 3> deviceScenes; // whose samples of area light have maps, have none, and without such samples
    std::optional<GpuTimer> timer;
};

} // namespace sconce
