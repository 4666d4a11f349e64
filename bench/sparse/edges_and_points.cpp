// Pictures from light at one pixel of some: between edges found in the scene, against weights by what the G-buffer shows, as frames have
// them, and by distance alone.
//   sconce_edges_and_points SCENE --field FILE.sconce [--camera N|--eye X,Y,Z --target X,Y,Z] [--every N,...] [--width N] [--height N]
//     [-o PREFIX]
// All light but emission is what is sparse, as light before the surface's colour. Edges are silhouettes, sharp edges, borders of materials
// and of hard shadows (Bala, Walter, Greenberg 2003, "Combining Edges and Points for Interactive High-Quality Rendering"). Errors are
// against the same frame with light at every pixel, and, with edges smoothed, against one of 16 pixels each. Prints JSON on stdout.
#include <chrono>
#include <cmath>
#include <iostream>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bench/race/tracer_race.h"
#include "bench/reference/metrics.h"
#include "bench/sparse/pictures.h"
#include "runtime/field/light_field_file.h"
#include "runtime/vulkan/host_vulkan.h"
#include "scene/camera_check.h"
#include "scene/named_scene.h"

namespace sconce
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr uint32_t kFiner = 4;        // times as many rows and columns in the picture that is right about edges
constexpr float kLeastColour = 0.04f; // of what light is divided by: what a dielectric without colour reflects

struct Options
{
    std::string scene, field, output;
    uint32_t camera = 0, width = 320, height = 180;
    std::vector<float> eye, target;
    std::vector<uint32_t> every = {4, 16, 64};
};

double millisecondsSince(std::chrono::steady_clock::time_point then)
{
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - then).count();
}

/// A frame taken apart: light before the surface's colour, and what doesn't come of light, or shines by itself.
struct Parts
{
    std::vector<vec3> light, colour, rest;

    Parts(const RenderedFrame& frame, const std::vector<bool>& shines)
    {
        for (size_t i = 0; i < frame.beauty.size(); ++i)
        {
            const vec3 sum = shines[i] ? vec3(0.0f) : frame.direct[i] + frame.diffuseIndirect[i] + frame.glossyIndirect[i];
            colour.push_back(frame.albedo[i] + kLeastColour);
            light.push_back(sum / colour.back());
            rest.push_back(frame.beauty[i] - sum);
        }
    }
    std::vector<vec3> with(std::span<const vec3> other) const
    {
        std::vector<vec3> picture(rest);
        for (size_t i = 0; i < picture.size(); ++i) picture[i] += other[i] * colour[i];
        return picture;
    }
};

/// Pixels whose centre shows what shines: to others they say nothing.
std::vector<bool> shiningPixels(const RayScene& rays, const Camera& camera, uint32_t width, uint32_t height)
{
    std::vector<bool> shines;
    const Pinhole pinhole(camera, width, height);
    for (uint32_t i = 0; i < width * height; ++i)
    {
        const auto hit = rays.closest(camera.eye, pinhole.direction(float(i % width) + 0.5f, float(i / width) + 0.5f, width, height));
        shines.push_back(hit && evaluateMaterial(rays.scene(), hit->material, hit->uv).emission != vec3(0.0f));
    }
    return shines;
}

/// What shines shows no surface.
SurfacePixels surfacesOf(const RenderedFrame& frame, const Camera& camera, const std::vector<bool>& shines)
{
    SurfacePixels pixels = surfacesOf(frame, camera);
    for (size_t i = 0; i < shines.size(); ++i)
        if (shines[i]) pixels.normal[i] = vec3(0.0f);
    return pixels;
}

std::vector<vec3> meansOf(std::span<const vec3> fine, uint32_t width, uint32_t height)
{
    std::vector<vec3> coarse(size_t(width) * height, vec3(0.0f));
    for (size_t i = 0; i < fine.size(); ++i)
    {
        const size_t x = i % (size_t(width) * kFiner) / kFiner, y = i / (size_t(width) * kFiner) / kFiner;
        coarse[y * width + x] += fine[i] / float(kFiner * kFiner);
    }
    return coarse;
}

class Compared
{
public:
    Compared(const RenderedFrame& frame, const RenderedFrame& fine, const Camera& camera, const EdgeImage& found,
             const std::vector<bool>& shines)
        : parts(frame, shines), pixels(surfacesOf(frame, camera, shines)), edges(found),
          atCentres(pictureOf(frame.beauty, frame.width, frame.height)),
          smooth(pictureOf(meansOf(fine.beauty, frame.width, frame.height), frame.width, frame.height)), own(frame.beauty)
    {
    }

    Result<Json> way(uint32_t every, FillBy by, const std::string& output) const
    {
        const auto start = std::chrono::steady_clock::now();
        const Filled filled = fillSparse(pixels, edges, parts.light, every, by);
        const double milliseconds = millisecondsSince(start);
        const std::vector<vec3> colours = parts.with(filled.light);
        Json row = {{"samples", double(filled.samples) / double(colours.size())}, {"fill_ms", milliseconds}};
        if (Status status = judge(row, colours, by == FillBy::edges || by == FillBy::both, output); !status) return status.error();
        return row;
    }
    /// The frame itself: what no way of filling can be better than without edges, and what edges alone make of it.
    Result<Json> frame() const
    {
        Json row = {{"samples", 1.0}};
        if (Status status = judge(row, own, true, {}); !status) return status.error();
        return row;
    }

private:
    Status judge(Json& row, const std::vector<vec3>& colours, bool hasEdges, const std::string& output) const
    {
        const ImageSet drawn = pictureOf(colours, pixels.width, pixels.height);
        const auto centre = compareImages(drawn, atCentres), box = compareImages(drawn, smooth);
        if (!centre) return centre.error();
        if (!box) return box.error();
        row["relmse"] = *centre->relMse, row["flip"] = *centre->flip;
        row["smooth_relmse"] = *box->relMse, row["smooth_flip"] = *box->flip;
        ImageSet shown = drawn;
        if (hasEdges)
        {
            shown = pictureOf(smoothEdges(edges, colours), pixels.width, pixels.height);
            const auto smoothed = compareImages(shown, smooth);
            if (!smoothed) return smoothed.error();
            row["smoothed_relmse"] = *smoothed->relMse, row["smoothed_flip"] = *smoothed->flip;
        }
        return output.empty() ? success() : writeSideBySide(shown, smooth, {}, *compareImages(shown, smooth), output);
    }

    Parts parts;
    SurfacePixels pixels;
    const EdgeImage& edges;
    ImageSet atCentres, smooth;
    std::vector<vec3> own;
};

Result<RenderedFrame> drawn(Gpu& gpu, const DeviceScene& scene, const LightField& field, const Camera& camera, uint32_t width,
                            uint32_t height)
{
    RenderSettings settings;
    settings.width = width, settings.height = height;
    settings.effects = field.effectsOfFrames();
    settings.glossyRays = 16; // what is sparse is judged, not noise
    const auto renderer = SceneRenderer::create(gpu, scene, field, settings);
    if (!renderer) return renderer.error();
    return (*renderer)->render(camera);
}

Json jsonOf(const EdgeImage& image)
{
    const EdgeImage::Counts counts = image.counts();
    const double all = double(image.width()) * image.height();
    return {{"empty", double(counts.empty) / all}, {"simple", double(counts.simple) / all}, {"complex", double(counts.complex) / all}};
}

Result<Camera> cameraOf(const Scene& scene, const Options& options)
{
    if (options.eye.empty())
    {
        if (options.camera < scene.cameras.size()) return scene.cameras[options.camera];
        return Error{ErrorCode::badArgument,
                     "The scene has no camera " + std::to_string(options.camera) + "; give another, or --eye and --target"};
    }
    Camera camera;
    camera.eye = {options.eye[0], options.eye[1], options.eye[2]};
    camera.forward = glm::normalize(vec3(options.target[0], options.target[1], options.target[2]) - camera.eye);
    if (const std::string fault = cameraFault(camera); !fault.empty()) return Error{ErrorCode::badArgument, fault};
    return camera;
}

/// All pieces of edges in the picture; `shadows` counts those of shadows.
std::vector<std::array<vec2, 2>> piecesOf(const RayScene& rays, std::span<const SceneEdge> edges, const Camera& camera,
                                          const Options& options, size_t& shadows)
{
    std::vector<EdgePiece> pieces = edgesSeenFrom(edges, camera.eye);
    const size_t seen = pieces.size();
    // Two places of a border may be joined where they are within a pixel of each other.
    const float pixel = 2.0f * std::tan(0.5f * camera.verticalFov) / float(options.height);
    const auto fine = [&](vec3 a, vec3 b)
    { return glm::distance(a, b) <= pixel * std::min(glm::distance(a, camera.eye), glm::distance(b, camera.eye)); };
    for (const Light& light : rays.scene().lights)
    {
        const std::vector<EdgePiece> more = shadowEdges(rays, edges, light, fine);
        pieces.insert(pieces.end(), more.begin(), more.end());
    }
    shadows = pieces.size() - seen;
    return seenPieces(pieces, rays, camera, options.width, options.height);
}

Status run(const Options& options)
{
    Result<Scene> scene = namedScene(options.scene);
    if (!scene) return scene.error();
    const Result<Camera> camera = cameraOf(*scene, options);
    if (!camera) return camera.error();
    const auto rays = RayScene::create(*scene);
    if (!rays) return rays.error();
    const auto data = loadField(options.field);
    if (!data) return data.error();
    const auto own = OwnDevice::create({});
    if (!own) return own.error();
    const auto gpu = Gpu::create(own->host());
    if (!gpu) return gpu.error();
    const auto field = makeLightField(**gpu, *data);
    if (!field) return field.error();
    const auto device = DeviceScene::create(**gpu, *scene, data->info);
    if (!device) return device.error();
    const auto frame = drawn(**gpu, *device, *field, *camera, options.width, options.height),
               fine = drawn(**gpu, *device, *field, *camera, kFiner * options.width, kFiner * options.height);
    if (!frame) return frame.error();
    if (!fine) return fine.error();

    auto start = std::chrono::steady_clock::now();
    const std::vector<SceneEdge> edges = edgesOf(*scene);
    const double prepared = millisecondsSince(start);
    start = std::chrono::steady_clock::now();
    size_t shadows = 0;
    const EdgeImage image(options.width, options.height, piecesOf(*rays, edges, *camera, options, shadows));
    Json printed = {{"scene", scene->name},   {"width", options.width},   {"height", options.height}, {"device", own->name()},
                    {"edges", edges.size()},  {"shadow_pieces", shadows}, {"prepare_ms", prepared},   {"find_ms", millisecondsSince(start)},
                    {"pixels", jsonOf(image)}};
    const Compared compared(*frame, *fine, *camera, image, shiningPixels(*rays, *camera, options.width, options.height));
    auto whole = compared.frame();
    if (!whole) return whole.error();
    printed["frame"] = std::move(*whole);
    for (const uint32_t every : options.every)
        for (const auto& [name, by] : {std::pair("distance", FillBy::distance), std::pair("likeness", FillBy::likeness),
                                       std::pair("edges", FillBy::edges), std::pair("both", FillBy::both)})
        {
            const std::string file = options.output.empty() ? "" : options.output + "." + std::to_string(every) + "." + name + ".png";
            auto row = compared.way(every, by, file);
            if (!row) return row.error();
            printed["every_" + std::to_string(every)][name] = std::move(*row);
        }
    std::cout << printed.dump(1) << std::endl;
    return success();
}

} // namespace
} // namespace sconce

int main(int argc, char** argv)
{
    CLI::App app{"Pictures from light at one pixel of some, between edges"};
    sconce::Options options;
    app.add_option("SCENE", options.scene, ".gltf, .glb or built-in name")->required();
    app.add_option("--field", options.field, "a baked light field")->required();
    auto* camera = app.add_option("--camera", options.camera, "of the scene, by number (default: 0)");
    auto* eye = app.add_option("--eye", options.eye, "where the camera is, metres")->delimiter(',')->expected(3)->excludes(camera);
    auto* target = app.add_option("--target", options.target, "what it looks at, metres")->delimiter(',')->expected(3)->needs(eye);
    eye->needs(target);
    app.add_option("--every", options.every, "pixels for each whose light is asked for, squares (default: 4,16,64)")
        ->delimiter(',')
        ->check(CLI::IsMember({1, 4, 16, 64, 256}));
    app.add_option("--width", options.width, "pixels (default: 320; range: 8 to 1920)")->check(CLI::Range(8u, 1920u));
    app.add_option("--height", options.height, "pixels (default: 180; range: 8 to 1080)")->check(CLI::Range(8u, 1080u));
    app.add_option("-o,--output", options.output, "writes pictures beside the smooth one, PREFIX.EVERY.WAY.png");
    CLI11_PARSE(app, argc, argv);
    return sconce::exitCodeOf(sconce::run(options));
}
