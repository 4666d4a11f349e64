// sconce explain: why a pixel of a frame has the light that it has, term by term, beside the path tracer's.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include <fmt/format.h>

#include "base/numbers.h"
#include "bench/reference/path_tracer.h"
#include "bench/reference/reference.h"
#include "runtime/field/explain.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/light_groups.h"
#include "runtime/field/live_light.h"
#include "runtime/field/tracer_cpu.h"
#include "runtime/scene/scene_renderer.h"
#include "runtime/vulkan/host_vulkan.h"
#include "scene/scene_check.h"
#include "scene/view_rays.h"
#include "shaders/shared/frame.h"
#include "tools/field_report.h"
#include "tools/frame_setup.h"
#include "tools/live_light_options.h"
#include "tools/pictures.h"
#include "tools/ray_picture.h"

namespace sconce::tools
{

namespace
{

constexpr float kRight = 0.05f;      // of a term: what counts as right, or thrice the reference's own error where that is more
constexpr float kSeenAtAll = 0.002f; // of the pixel's whole light: terms that are off by less are not worth a word
constexpr float kHitRight = 0.01f;   // of the diagonal, as the bench judges rays
constexpr float kWayRight = 0.05f;   // of the ray's own way: a room on a plain has a diagonal that says nothing of it
constexpr float kTexelsRight = 2.0f; // of the probe that answered, where that is more
constexpr float kLight = 0.05f;      // of the radiance along a ray
constexpr uint32_t kAround = 64;     // rays by which a place's surroundings are measured
constexpr float kCoarse = 0.25f;     // texels wider than this share of the distance to the surroundings lose their shadows
constexpr size_t kOthers = 3;        // probes that a list leaves out and are named

struct ExplainOptions
{
    SceneOptions scene;
    CameraOptions camera;
    std::string field, pixel, picture, device;
    uint32_t width = knobs::width.value, height = knobs::height.value, paths = knobs::explainedPaths.value;
    std::optional<float> roughness;
};

/// All that is known of the pixel.
struct Explained
{
    glm::uvec2 pixel{0};
    vec3 direction{0.0f}; // from the eye
    SurfaceHit hit;
    ShadingPoint point;
    vec3 frameDiffuse{0.0f}, frameGlossy{0.0f}, frameAll{0.0f}; // as it is drawn
    PixelLight truth;
    ExplainedSurface surface;
    float around = 0.0f;                      // metres: harmonic mean of the distances to what is about the place
    bool traced = false, prefiltered = false; // how reflections are made
    gpu::Ray ray{};                           // along the axis of the reflection
    ExplainedRay way;
    float truthT = std::numeric_limits<float>::infinity(); // of that ray
    vec3 truthNormal{0.0f};
    std::string met;          // what it truly meets, a few words
    vec3 arriving{0.0f};      // radiance along that ray, by paths
    float metresRight = 0.0f; // by how much a ray's end may be off
};

Result<glm::uvec2> pixelOf(const ExplainOptions& options)
{
    const auto numbers = parseNumbers(options.pixel, {2});
    if (!numbers) return Error{numbers.error().code, "--pixel: " + numbers.error().message};
    const float x = (*numbers)[0], y = (*numbers)[1];
    if (x < 0.0f || y < 0.0f || x >= float(options.width) || y >= float(options.height) || x != std::floor(x) || y != std::floor(y))
        return Error{ErrorCode::badArgument,
                     fmt::format("--pixel {}: the picture of {} x {} has pixels 0,0 to {},{}; choose one, or give --size.", options.pixel,
                                 options.width, options.height, options.width - 1, options.height - 1)};
    return glm::uvec2(uint32_t(x), uint32_t(y));
}

/// The frame's own terms at the pixel: drawn with every default, as `sconce render` does.
Status draw(const ExplainOptions& options, Scene scene, const FieldData& data, const Camera& camera, Explained& e)
{
    RenderSettings settings;
    FrameChoice choice;
    choice.roughness = options.roughness;
    const Result<EffectPlan> plan = planFor(choice, scene);
    if (!plan) return plan.error();
    capScene(scene, *plan);
    const Result<OwnDevice> device = OwnDevice::create({.device = options.device});
    if (!device) return device.error();
    const Result<std::shared_ptr<Gpu>> gpu = Gpu::create(device->host());
    if (!gpu) return gpu.error();
    settings.width = options.width;
    settings.height = options.height;
    settings.roughness = options.roughness;
    settings.effects = plan->indirect();
    const auto field = makeLightField(**gpu, data);
    if (!field) return field.error();
    const auto uploaded = DeviceScene::create(**gpu, scene, field->info(), sceneForFrames(settings.effects, field->info(), camera.eye), {});
    if (!uploaded) return uploaded.error();
    const auto renderer = SceneRenderer::create(**gpu, *uploaded, *field, settings);
    if (!renderer) return renderer.error();
    const auto frame = (*renderer)->render(camera);
    if (!frame) return frame.error();
    const size_t at = size_t(e.pixel.y) * options.width + e.pixel.x;
    e.frameDiffuse = frame->diffuseIndirect[at];
    e.frameGlossy = frame->glossyIndirect[at];
    e.frameAll = frame->beauty[at];
    return success();
}

/// Harmonic mean of the distances from a place to what is about it; infinity in the open.
float surroundings(const RayScene& rays, const ShadingPoint& point)
{
    const TangentFrame frame = tangentFrame(point.geometricNormal);
    Random random(knobs::pathSeed.value, 0);
    float sum = 0.0f;
    for (uint32_t i = 0; i < kAround; ++i)
        if (const auto met =
                rays.closest(point.position + rays.offset() * point.geometricNormal, toWorld(frame, sampleCosine(random.uniform2()))))
            sum += 1.0f / std::max(met->t, rays.offset());
    return sum > 0.0f ? float(kAround) / sum : std::numeric_limits<float>::infinity();
}

/// Width of a texel of the probe that answered, at what it answered, metres; 0: none did.
float texelAtEnd(const FieldData& data, const gpu::RayHit& hit)
{
    if (hit.probe >= data.probes.size()) return 0.0f;
    const vec3 centre = vec3(data.info.origin) + data.info.scale * vec3(data.probes[hit.probe].centre);
    return 2.0f * glm::distance(centre, vec3(hit.position)) / float(data.info.faceSize);
}

void explainReflection(const RayScene& rays, const PathTracer& paths, const FieldData& data, uint32_t count, Explained& e)
{
    const float roughness = e.point.surface.roughness;
    e.traced = isMirror(roughness) || roughness < gpu::kRaysBelow + gpu::kRaysBlend;
    e.prefiltered = !isMirror(roughness) && roughness > gpu::kRaysBelow - gpu::kRaysBlend;
    const vec3 direction = glm::normalize(glm::reflect(-e.point.viewer, e.point.normal));
    const float offset = knobs::normalOffset.value * data.info.diagonal * data.info.scale; // as a frame's rays start
    e.ray = {e.point.position + offset * e.point.normal, direction, e.point.normal};
    e.way = explainRay(data, e.ray);
    e.metresRight = kHitRight * data.info.diagonal * data.info.scale;
    if (const auto met = rays.closest(e.ray.origin, direction))
    {
        e.truthT = std::max(met->t, 0.0f);
        e.metresRight = std::min(e.metresRight, std::max(kWayRight * e.truthT, kTexelsRight * texelAtEnd(data, e.way.hit)));
        const ShadingPoint surface = paths.shade(*met, -direction);
        e.truthNormal = surface.geometricNormal;
        e.met = fmt::format("material '{}', metallic {:.2f}, roughness {:.2f}", rays.scene().materials[met->material].name,
                            surface.surface.metallic, surface.surface.roughness);
    }
    glm::dvec3 sum(0.0);
    for (uint32_t i = 0; i < count; ++i)
    {
        Random random(knobs::pathSeed.value, 1, i);
        const PathLight path = paths.trace(e.ray.origin, direction, random);
        sum += path.direct + path.diffuse + path.glossy;
    }
    e.arriving = vec3(sum / double(count));
}

bool rayIsRight(const Explained& e)
{
    using Text = twin::LightFieldTwin<float>;
    if (!std::isfinite(e.truthT)) return e.way.hit.status == Text::kMiss;
    return e.way.hit.status == Text::kHit && std::abs(e.way.hit.t - e.truthT) <= e.metresRight;
}

/// Whether a term is as the reference has it, within what the reference knows.
bool isRight(vec3 ours, vec3 truth, vec3 unsure, vec3 all)
{
    const float off = luminance(glm::abs(ours - truth));
    return off <= std::max({kRight * luminance(truth), 3.0f * luminance(unsure), kSeenAtAll * luminance(all)});
}

std::string spelled(vec3 p)
{
    return fmt::format("{:.2f},{:.2f},{:.2f}", p.x, p.y, p.z);
}

void adviseDiffuse(const FieldData& data, const Explained& e, std::vector<std::string>& advice)
{
    if (data.surfaceLight.empty())
    {
        advice.push_back("The field holds no surface light: diffuse light is that of the open. Bake with --surface-texels above 0.");
        return;
    }
    if (e.surface.from <= 0)
    {
        if (e.surface.others.empty())
            advice.push_back(fmt::format("No probe sees this place, so its diffuse light is a guess: one more at {}, or more of them "
                                         "(`place --count`).",
                                         spelled(e.point.position + 0.5f * std::min(e.around, 1.0f) * e.point.geometricNormal)));
        else
            advice.push_back(fmt::format("Probe {} would light this place, and the octree's leaf doesn't name it: finer voxels "
                                         "(`tune`'s quality files, octreeVoxels), or fewer probes nearby.",
                                         e.surface.others.front().probe));
        return;
    }
    float texel = std::numeric_limits<float>::infinity();
    for (const AskedProbe& asked : e.surface.asked)
        if (asked.verdict == Verdict::lights) texel = std::min(texel, asked.texel);
    if (texel > kCoarse * e.around)
        advice.push_back(
            fmt::format("The texels that light this place are {:.1f} cm wide, and what is about it is {:.1f} cm off: --surface-texels {}, "
                        "or a probe nearer.",
                        100.0f * texel, 100.0f * e.around, knobs::surfaceTexels.most));
    else
        advice.push_back(
            fmt::format("Texels are fine enough here ({:.1f} cm, surroundings {:.1f} cm): what is left is their noise and blending; "
                        "--surface-rays, --surface-refined.",
                        100.0f * texel, 100.0f * e.around));
}

void adviseGlossy(const FieldData& data, const Explained& e, std::vector<std::string>& advice)
{
    if (!e.traced)
    {
        advice.push_back(
            fmt::format("Reflections of roughness {:.2f} are read from prefiltered radiance; `render --rays-below {:.2f}` traces them.",
                        e.point.surface.roughness, std::min(e.point.surface.roughness + 2.0f * gpu::kRaysBlend, 1.0f)));
        return;
    }
    if (!rayIsRight(e) && std::isfinite(e.truthT))
    {
        const vec3 end = e.ray.origin + e.truthT * e.ray.direction;
        const std::vector<uint32_t> seeing = probesThatSee(data, end, e.truthNormal);
        advice.push_back(
            seeing.empty()
                ? fmt::format("The ray should end at {}, which no probe sees: one more that does.", spelled(end))
                : fmt::format("The ray should end at {}, which probe {} sees: a higher --resolution, or a probe that sees the way there.",
                              spelled(end), seeing.front()));
        return;
    }
    if (!rayIsRight(e))
    {
        advice.push_back("The ray should leave the scene: a higher --resolution, or a probe that sees past what it met.");
        return;
    }
    const float off = luminance(glm::abs(e.way.hit.radiance - e.arriving));
    if (off > kLight * luminance(e.arriving))
        advice.push_back(
            fmt::format("The axis' ray ends where it should; light there is {:.3g} where paths find {:.3g}. It meets {}: to a ray "
                        "every surface is as bright to all sides, which smooth ones are not; of a rough one the diffuse light is off.",
                        luminance(e.way.hit.radiance), luminance(e.arriving), e.met.empty() ? std::string("the sky") : e.met));
    else
        advice.push_back(
            "The axis' ray is right, place and light: what is left is the noise of rays about it, and the filter; `render --samples`.");
}

std::vector<std::string> advise(const FieldData& data, const Explained& e)
{
    std::vector<std::string> advice;
    const vec3 all = e.truth.direct + e.truth.diffuse + e.truth.glossy;
    const bool diffuse = isRight(e.frameDiffuse, e.truth.diffuse, e.truth.unsureDiffuse, all);
    const bool glossy = isRight(e.frameGlossy, e.truth.glossy, e.truth.unsureGlossy, all);
    if (!diffuse) adviseDiffuse(data, e, advice);
    if (!glossy) adviseGlossy(data, e, advice);
    if (diffuse && glossy)
        advice.push_back(
            fmt::format("Both terms are within {:.0f} % of the reference, or as near as it can tell: nothing to mend.", 100.0f * kRight));
    return advice;
}

Json jsonOf(const Explained& e, const std::vector<std::string>& advice)
{
    Json json;
    json["pixel"] = {e.pixel.x, e.pixel.y};
    json["position"] = toJson(e.point.position);
    json["normal"] = toJson(e.point.normal);
    json["albedo"] = toJson(e.point.surface.baseColor);
    json["metallic"] = e.point.surface.metallic;
    json["roughness"] = e.point.surface.roughness;
    json["diffuse"] = {{"frame", toJson(e.frameDiffuse)},  {"look_up", toJson(e.surface.light * e.point.lobes.diffuse)},
                       {"truth", toJson(e.truth.diffuse)}, {"truth_unsure", toJson(e.truth.unsureDiffuse)},
                       {"from", e.surface.sentence()},     {"asked", Json::array()},
                       {"others", Json::array()}};
    for (const AskedProbe& asked : e.surface.asked)
        json["diffuse"]["asked"].push_back({{"probe", asked.probe}, {"share", asked.share}, {"why", asked.sentence()}});
    for (const AskedProbe& other : e.surface.others) json["diffuse"]["others"].push_back(other.probe);
    json["glossy"] = {{"frame", toJson(e.frameGlossy)},
                      {"truth", toJson(e.truth.glossy)},
                      {"truth_unsure", toJson(e.truth.unsureGlossy)},
                      {"traced", e.traced},
                      {"prefiltered", e.prefiltered},
                      {"way", Json::array()},
                      {"t", e.way.hit.t},
                      {"truth_t", std::isfinite(e.truthT) ? Json(e.truthT) : Json(nullptr)},
                      {"right", rayIsRight(e)},
                      {"radiance", toJson(e.way.hit.radiance)},
                      {"truth_radiance", toJson(e.arriving)}};
    for (const RayStretch& stretch : e.way.way)
        json["glossy"]["way"].push_back(
            {{"probe", stretch.probe}, {"from", stretch.from}, {"to", stretch.to}, {"why", stretch.sentence()}});
    json["advice"] = advice;
    return json;
}

void printDiffuse(const Explained& e)
{
    std::cout << fmt::format("diffuse  frame {:.4g}, reference {:.4g} +- {:.2g}", luminance(e.frameDiffuse), luminance(e.truth.diffuse),
                             luminance(e.truth.unsureDiffuse));
    std::cout << fmt::format("; this place's own look-up {:.4g}, of {}\n", luminance(e.surface.light * e.point.lobes.diffuse),
                             e.surface.sentence());
    for (const AskedProbe& asked : e.surface.asked) std::cout << "  " << asked.sentence() << "\n";
    for (size_t i = 0; i < std::min(kOthers, e.surface.others.size()); ++i)
        std::cout << fmt::format("  not asked: probe {}, {:.2f} m off, sees it by texels {:.1f} cm wide\n", e.surface.others[i].probe,
                                 e.surface.others[i].distance, 100.0f * e.surface.others[i].texel);
    if (e.surface.others.size() > kOthers) std::cout << fmt::format("  not asked: {} more\n", e.surface.others.size() - kOthers);
}

void printGlossy(const Explained& e, bool picture)
{
    std::cout << fmt::format("glossy   frame {:.4g}, reference {:.4g} +- {:.2g}; by {}\n", luminance(e.frameGlossy),
                             luminance(e.truth.glossy), luminance(e.truth.unsureGlossy),
                             e.traced && e.prefiltered ? "rays and prefiltered radiance, blended"
                             : e.traced                ? "rays"
                                                       : "prefiltered radiance");
    std::cout << (e.traced ? "  a ray along the lobe's axis:\n" : "  a ray along the lobe's axis, if it were traced:\n");
    for (size_t i = 0; i < e.way.way.size(); ++i)
        std::cout << "  " << (picture ? fmt::format("{}: ", kStretchColours[i % std::size(kStretchColours)].name) : "")
                  << e.way.way[i].sentence() << "\n";
    const char* const ends[] = {"leaves the scene", "ends", "is lost"};
    std::cout << fmt::format("  it {} at {:.3f} m with radiance {:.4g}; truly {} with {:.4g}: {}\n", ends[e.way.hit.status], e.way.hit.t,
                             luminance(e.way.hit.radiance),
                             std::isfinite(e.truthT) ? fmt::format("it ends at {:.3f} m", e.truthT) : std::string("it leaves the scene"),
                             luminance(e.arriving), rayIsRight(e) ? "right" : "wrong");
}

/// Why a field's own light is not that of the scene, which paths see; empty where nothing says so.
std::string otherLight(const ExplainOptions& options, const FieldData& data, Scene scene)
{
    if (data.live.links == 0) return {};
    const auto lights = takeLiveLights(scene, groupsOf(data.groups));
    if (!lights) return lights.error().message;
    if (data.live.lit && std::ranges::equal(*lights, data.live.lights, sameLight)) return {};
    return fmt::format("Light field '{}' is {}; give `sconce relight --keep` the same lights, and explain what that writes.", options.field,
                       data.live.lit ? "lit by other lights than the scene" : "captured, not lit");
}

int runExplain(const ExplainOptions& options, const Context& context)
{
    Explained e;
    const Result<glm::uvec2> pixel = pixelOf(options);
    if (!pixel) return fail(pixel.error());
    e.pixel = *pixel;
    const Result<FieldData> data = loadFieldFor(options.field, "ours");
    if (!data) return fail(data.error());
    Result<Scene> scene = options.scene.load(context);
    if (!scene) return fail(scene.error());
    const Result<Camera> camera = options.camera.choose(*scene);
    if (!camera) return fail(camera.error());
    if (std::string fault = validate(*scene); !fault.empty()) return fail(ErrorCode::badInput, fault);
    if (std::string fault = otherLight(options, *data, *scene); !fault.empty()) return fail(ErrorCode::badArgument, fault);
    const Result<RayScene> rays = RayScene::create(*scene);
    if (!rays) return fail(rays.error());
    e.direction = Pinhole(*camera, options.width, options.height)
                      .direction(float(e.pixel.x) + 0.5f, float(e.pixel.y) + 0.5f, options.width, options.height);
    const std::optional<SurfaceHit> hit = rays->closest(camera->eye, e.direction);
    if (!hit)
        return fail(ErrorCode::badArgument,
                    fmt::format("Pixel {},{} shows the sky, which has no indirect light; choose another.", e.pixel.x, e.pixel.y));
    e.hit = *hit;
    const PathTracer paths(*rays, options.roughness, knobs::referenceBounces.value);
    e.point = paths.shade(e.hit, -e.direction);
    if (Status status = draw(options, *scene, *data, *camera, e); !status) return fail(status.error());
    ReferenceSettings reference;
    reference.width = options.width;
    reference.height = options.height;
    reference.samples = options.paths;
    reference.bounces = knobs::referenceBounces.value;
    reference.roughness = options.roughness;
    reference.pixelCentre = true;
    reference.camera = *camera;
    const Result<PixelLight> truth = pixelReference(*rays, reference, e.pixel);
    if (!truth) return fail(truth.error());
    e.truth = *truth;
    e.around = surroundings(*rays, e.point);
    e.surface = explainSurface(*data, e.point.position, e.point.normal, e.point.geometricNormal);
    explainReflection(*rays, paths, *data, options.paths, e);
    const std::vector<std::string> advice = advise(*data, e);
    if (!options.picture.empty())
    {
        const Picture picture = drawWay(*scene, *data, e.ray, e.way, e.truthT);
        if (Status status = writePng(picture.rgb, picture.width, picture.height, options.picture); !status) return fail(status.error());
    }
    if (context.json)
    {
        print(jsonOf(e, advice));
        return exitOk;
    }
    std::cout << fmt::format("pixel {},{}: {} of material '{}', albedo {}, metallic {:.2f}, roughness {:.2f}\n", e.pixel.x, e.pixel.y,
                             spelled(e.point.position), scene->materials[e.hit.material].name, spelled(e.point.surface.baseColor),
                             e.point.surface.metallic, e.point.surface.roughness);
    printDiffuse(e);
    printGlossy(e, !options.picture.empty());
    for (const std::string& sentence : advice) std::cout << sentence << "\n";
    std::cout << std::flush;
    return exitOk;
}

} // namespace

void addExplainCommand(CLI::App& app, Context& context)
{
    CLI::App* command =
        addCommand(app, context, "explain",
                   "Why a pixel of `render` has its light: probes asked and refused, the ray's way, the truth, what would help");
    auto options = std::make_shared<ExplainOptions>();
    command->add_option("FIELD", options->field, ".sconce file of the scene")->required()->type_name("");
    options->scene.add(command);
    command->add_option("--pixel", options->pixel, "x,y from the top left corner, the first 0,0 (required)")->required()->type_name("X,Y");
    options->camera.add(command);
    addSize(command, options->width, options->height);
    addKnob(command, "--roughness", options->roughness, knobs::roughness, "R");
    addKnob(command, "--spp", options->paths, knobs::explainedPaths);
    command
        ->add_option(
            "--picture", options->picture,
            described("Draws the reflection's way from the side: the scene cut along it, a colour a probe, a cross where it truly ends",
                      words("none")))
        ->type_name("FILE");
    addDevice(command, options->device);
    onChosen(command, context, options, runExplain);
}

} // namespace sconce::tools
