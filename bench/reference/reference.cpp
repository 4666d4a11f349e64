#include "bench/reference/reference.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include <fmt/format.h>
#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include "base/numbers.h"
#include "bench/reference/path_tracer.h"
#include "scene/camera_check.h"
#include "scene/view_rays.h"

namespace sconce
{
namespace
{

bool allFinite(const PathLight& p)
{
    return finite(p.direct) && finite(p.diffuse) && finite(p.glossy);
}

Status check(const ReferenceSettings& s)
{
    const std::string fault = firstFault(
        {faultOf(knobs::width, s.width), faultOf(knobs::height, s.height), faultOf(knobs::paths, s.samples),
         faultOf(knobs::pathBounces, s.bounces),
         s.parts && s.samples < 4 ? std::string("parts need at least 4 paths a pixel; give more, or leave them out") : std::string(),
         s.roughness ? faultOf(knobs::roughness, *s.roughness) : std::string(), cameraFault(s.camera)});
    if (!fault.empty()) return Error{ErrorCode::badArgument, fault};
    return success();
}

/// Counts paths and asks the caller's progress function whether to go on, from within a pixel too: a pixel may take minutes.
class Pace
{
public:
    static constexpr uint32_t kStep = 64; // paths between two questions: milliseconds

    Pace(const Progress& asked, double allPaths, tbb::task_group_context& group) : progress(asked), paths(allPaths), context(group) {}
    bool goOn(uint32_t morePaths)
    {
        // Relaxed, here and below: a count and a flag of which nothing else hangs. The pictures are read after parallel_for, which orders
        // what the threads wrote.
        const uint64_t done = traced.fetch_add(morePaths, std::memory_order_relaxed) + morePaths;
        // One thread at a time asks; the others need not wait for it.
        if (const std::unique_lock lock(asking, std::try_to_lock);
            lock && !stopped.load(std::memory_order_relaxed) && !report(progress, "reference", static_cast<double>(done) / paths))
        {
            stopped.store(true, std::memory_order_relaxed);
            context.cancel_group_execution();
        }
        return !stopped.load(std::memory_order_relaxed);
    }
    bool cancelled() const { return stopped.load(); }

private:
    const Progress& progress;
    const double paths;
    tbb::task_group_context& context;
    std::mutex asking;
    std::atomic<uint64_t> traced{0};
    std::atomic<bool> stopped{false};
};

struct Frame
{
    const ReferenceSettings& settings;
    const RayScene& rays;
    const PathTracer& tracer;
    Pinhole pinhole;
    ImageSet images;
    std::vector<glm::dvec3> error; // [pixel] relative squared error of the means of beauty, diffuse, glossy, by halves of the samples
    std::atomic<uint64_t> nonFinite{0};
    size_t firstPart = 0; // layer

    enum : size_t
    {
        beauty,
        direct,
        diffuse,
        glossy,
        depth,
        normal,
        albedo,
        roughness
    };

    Frame(const ReferenceSettings& s, const RayScene& r, const PathTracer& t)
        : settings(s), rays(r), tracer(t), pinhole(s.camera, s.width, s.height)
    {
        images.width = s.width;
        images.height = s.height;
        for (const char* name : {"beauty", "direct", "diffuse_indirect", "glossy_indirect"}) images.add(name, 3);
        error.resize(images.pixelCount());
        if (settings.guides)
        {
            images.add("depth", 1);
            images.add("normal", 3);
            images.add("albedo", 3);
            images.add("roughness", 1);
        }
        firstPart = images.layers.size();
        if (settings.parts)
            for (const char* name : {"beauty", "diffuse_indirect", "glossy_indirect"})
                for (const char* part : kParts) images.add(fmt::format("{}{}", name, part), 3);
    }

    void store(size_t layer, size_t pixel, vec3 value)
    {
        for (int i = 0; i < 3; ++i) images.layers[layer].pixels[pixel * 3 + size_t(i)] = value[i];
    }

    vec3 through(uint32_t x, uint32_t y, vec2 within) const
    {
        return pinhole.direction(static_cast<float>(x) + within.x, static_cast<float>(y) + within.y, settings.width, settings.height);
    }
    /// By pixel and path, not by thread: the picture is the same for any number of threads.
    Random randomOf(size_t pixel, uint32_t path) const { return Random(settings.seed, pixel, settings.firstPath + path); }

    /// Of the surface at the pixel's centre, whose textures are those that the paths see.
    void guides(uint32_t x, uint32_t y, vec3 centre)
    {
        const size_t pixel = size_t(y) * settings.width + x;
        const auto hit = rays.closest(pinhole.eye, centre);
        if (!hit) return;
        images.layers[depth].pixels[pixel] = glm::dot(hit->position - pinhole.eye, pinhole.forward);
        const uint32_t count = settings.pixelCentre ? settings.samples : 1;
        glm::dvec3 normals(0.0), colors(0.0);
        double roughnesses = 0.0;
        for (uint32_t i = 0; i < count; ++i)
        {
            const bool filtered = settings.pixelCentre;
            const SurfaceHit seen = filtered ? rays.texturedBy(*hit, pinhole.eye, through(x, y, randomOf(pixel, i).uniform2())) : *hit;
            const ShadingPoint point = tracer.shade(seen, -centre);
            normals += point.normal;
            colors += point.surface.baseColor;
            roughnesses += point.surface.roughness;
        }
        images.layers[roughness].pixels[pixel] = static_cast<float>(roughnesses / count);
        store(normal, pixel, glm::normalize(normals));
        store(albedo, pixel, vec3(colors / double(count)));
    }

    /// One path of a pixel. @param centre  direction through its centre
    PathLight trace(uint32_t x, uint32_t y, uint32_t path, vec3 centre) const
    {
        Random random = randomOf(size_t(y) * settings.width + x, path);
        const vec3 within = through(x, y, random.uniform2());
        return tracer.trace(pinhole.eye, settings.pixelCentre ? centre : within, within, random);
    }

    /// False: cancelled, the pixel is unfinished.
    bool render(uint32_t x, uint32_t y, Pace& pace)
    {
        const size_t pixel = size_t(y) * settings.width + x;
        const vec3 centre = through(x, y, vec2(0.5f));
        if (settings.guides) guides(x, y, centre);
        // Every other path in each half: what the two halves differ by tells the error of the whole.
        glm::dvec3 sums[3]{}, halves[3][2]{}, parts[3][3]{}; // of beauty, diffuse, glossy
        for (uint32_t i = 0; i < settings.samples; ++i)
        {
            if (i > 0 && i % Pace::kStep == 0 && !pace.goOn(Pace::kStep)) return false;
            const PathLight path = trace(x, y, i, centre);
            // One such path would spoil its pixel whatever the other paths say; it counts as black, and is reported.
            if (!allFinite(path))
            {
                nonFinite.fetch_add(1, std::memory_order_relaxed);
                continue;
            }
            sums[0] += path.direct;
            sums[1] += path.diffuse;
            sums[2] += path.glossy;
            halves[0][i & 1] += path.direct + path.diffuse + path.glossy;
            halves[1][i & 1] += path.diffuse;
            halves[2][i & 1] += path.glossy;
            const uint32_t part = std::min(i % 4, 2u);
            parts[0][part] += path.direct + path.diffuse + path.glossy;
            parts[1][part] += path.diffuse;
            parts[2][part] += path.glossy;
        }
        const double count = settings.samples;
        const vec3 means[3] = {vec3(sums[0] / count), vec3(sums[1] / count), vec3(sums[2] / count)};
        for (size_t i = 0; i < 3; ++i) store(direct + i, pixel, means[i]);
        store(beauty, pixel, means[0] + means[1] + means[2]);
        if (!pace.goOn((settings.samples - 1) % Pace::kStep + 1)) return false; // the paths since the last question
        if (settings.parts)
            for (size_t i = 0; i < 9; ++i)
            {
                const uint32_t part = uint32_t(i % 3),
                               of = part < 2 ? (settings.samples + 3 - part) / 4 : settings.samples / 4 + (settings.samples + 1) / 4;
                store(firstPart + i, pixel, vec3(parts[i / 3][part] / double(of)));
            }
        if (settings.samples < 2) return true;
        for (int part = 0; part < 3; ++part)
        {
            const glm::dvec3 a = halves[part][0] / double((settings.samples + 1) / 2), b = halves[part][1] / double(settings.samples / 2);
            const glm::dvec3 mean = 0.5 * (a + b), off = 0.5 * (a - b); // E[off^2] is the variance of the mean
            error[pixel][part] = glm::dot(off * off / (mean * mean + 0.01), glm::dvec3(1.0 / 3.0));
        }
        return true;
    }
};

/// Layers in which a value is a direction, or the same in every picture.
bool isOfPaths(std::string_view layer)
{
    return layer != "depth" && layer != "normal";
}

} // namespace

Reference joined(const Reference& a, uint64_t pathsA, const Reference& b, uint64_t pathsB)
{
    Reference all = a;
    const double share = double(pathsB) / double(pathsA + pathsB);
    for (Layer& layer : all.images.layers)
    {
        const Layer* other = isOfPaths(layer.name) ? b.images.find(layer.name) : nullptr;
        if (!other) continue;
        for (size_t i = 0; i < layer.pixels.size(); ++i)
            layer.pixels[i] = float((1.0 - share) * double(layer.pixels[i]) + share * double(other->pixels[i]));
    }
    // Variances of means: of independent paths they add up by the squares of their shares.
    for (double Reference::*error : {&Reference::estimatedRelMse, &Reference::estimatedRelMseDiffuse, &Reference::estimatedRelMseGlossy})
        all.*error = (1.0 - share) * (1.0 - share) * a.*error + share * share * b.*error;
    all.nonFinitePaths += b.nonFinitePaths;
    return all;
}

Result<Reference> renderReference(const Scene& scene, const ReferenceSettings& settings, const Progress& progress)
{
    if (Status fine = check(settings); !fine) return fine.error();
    if (std::string fault = validate(scene); !fault.empty()) return Error{ErrorCode::badInput, std::move(fault)};
    Result<RayScene> rays = RayScene::create(scene);
    if (!rays) return rays.error();
    return renderReference(*rays, settings, progress);
}

Result<Reference> renderReference(const RayScene& rays, const ReferenceSettings& settings, const Progress& progress)
{
    if (Status fine = check(settings); !fine) return fine.error();
    const PathTracer tracer(rays, settings.roughness, settings.pathBounces());
    Frame frame(settings, rays, tracer);

    tbb::task_group_context context;
    Pace pace(progress, static_cast<double>(frame.images.pixelCount()) * settings.samples, context);
    constexpr uint32_t kTile = 16;
    tbb::parallel_for(
        tbb::blocked_range2d<uint32_t>(0, settings.height, kTile, 0, settings.width, kTile),
        [&](const tbb::blocked_range2d<uint32_t>& tile)
        {
            for (uint32_t y = tile.rows().begin(); y != tile.rows().end(); ++y)
                for (uint32_t x = tile.cols().begin(); x != tile.cols().end(); ++x)
                    if (!frame.render(x, y, pace)) return;
        },
        context);
    if (pace.cancelled() || !report(progress, "reference", 1.0))
        return Error{ErrorCode::cancelled, "the reference picture was cancelled; nothing was kept"};

    Reference result;
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& e : frame.error) sum += e; // in pixel order: the same for any number of threads
    sum /= static_cast<double>(frame.images.pixelCount());
    if (settings.samples < 2) sum = glm::dvec3(std::numeric_limits<double>::quiet_NaN());
    result.estimatedRelMse = sum[0];
    result.estimatedRelMseDiffuse = sum[1];
    result.estimatedRelMseGlossy = sum[2];
    result.images = std::move(frame.images);
    result.nonFinitePaths = frame.nonFinite.load();
    return result;
}

Result<PixelLight> pixelReference(const RayScene& rays, ReferenceSettings settings, glm::uvec2 pixel)
{
    settings.guides = settings.parts = false;
    if (Status fine = check(settings); !fine) return fine.error();
    if (pixel.x >= settings.width || pixel.y >= settings.height)
        return Error{ErrorCode::badArgument, fmt::format("Pixel {},{} is outside of the picture of {} x {}; the first is 0,0", pixel.x,
                                                         pixel.y, settings.width, settings.height)};
    const PathTracer tracer(rays, settings.roughness, settings.pathBounces());
    const Frame frame(settings, rays, tracer);
    const vec3 centre = frame.through(pixel.x, pixel.y, vec2(0.5f));
    glm::dvec3 sums[3]{}, squares[3]{}; // of direct, diffuse, glossy
    for (uint32_t i = 0; i < settings.samples; ++i)
    {
        const PathLight path = frame.trace(pixel.x, pixel.y, i, centre);
        if (!allFinite(path)) continue; // black, as in the picture
        const vec3 parts[] = {path.direct, path.diffuse, path.glossy};
        for (size_t part = 0; part < 3; ++part)
        {
            sums[part] += parts[part];
            squares[part] += glm::dvec3(parts[part]) * glm::dvec3(parts[part]);
        }
    }
    const double count = settings.samples;
    const auto unsure = [&](size_t part) // standard error of the mean
    {
        const glm::dvec3 variance = squares[part] / count - sums[part] / count * (sums[part] / count);
        return vec3(glm::sqrt(glm::max(variance, glm::dvec3(0.0)) / std::max(count - 1.0, 1.0)));
    };
    return PixelLight{vec3(sums[0] / count), vec3(sums[1] / count), vec3(sums[2] / count), unsure(1), unsure(2)};
}

} // namespace sconce
