#include "tools/from_field.h"

#include <algorithm>

#include "runtime/field/tracer_cpu.h"

namespace sconce::tools
{

namespace
{

using Text = twin::LightFieldTwin<float>;

/// The rays of rows of a picture, a pixel's beside each other.
struct Rows
{
    std::vector<gpu::Ray> rays;
    std::vector<uint32_t> pixels; // that the rays are of

    Rows(const ViewRays& of, uint32_t first, uint32_t last)
    {
        for (const glm::uvec2 at : of.pixelsInTiles(first, last))
            for (uint32_t sample = 0; sample < of.samples(); ++sample)
            {
                const ViewRay ray = of.ray(at.x, at.y, sample);
                rays.push_back({.origin = ray.origin, .direction = ray.direction, .normal = vec3(0.0f)});
                pixels.push_back(at.y * of.width() + at.x);
            }
    }
};

enum Which : size_t
{
    beauty,
    depth,
    normal,
    probe,
    handoffs,
    fetches,
    unknown
};

/// The layers of a picture as they come.
struct Layers
{
    ImageSet& images;

    explicit Layers(ImageSet& of) : images(of)
    {
        for (const std::string& name : kFieldLayers) images.add(name, name == "beauty" || name == "normal" ? 3 : 1);
    }
    float& at(Which layer, size_t value) { return images.layers[layer].pixels[value]; }

    /// @param share  of the pixel's rays that one is
    void add(size_t pixel, const gpu::RayHit& hit, float share)
    {
        for (int c = 0; c < 3; ++c) at(beauty, 3 * pixel + size_t(c)) += share * hit.radiance[c];
        at(handoffs, pixel) += float(hit.handoffs);
        at(fetches, pixel) += float(hit.distanceReads + hit.indexReads);
        at(unknown, pixel) += hit.status == Text::kUnknown ? 1.0f : 0.0f;
    }
    void name(size_t pixel, const gpu::Ray& ray, const gpu::RayHit& hit, vec3 forward)
    {
        if (hit.status != Text::kMiss) at(depth, pixel) = hit.t * glm::dot(ray.direction, forward);
        for (int c = 0; c < 3; ++c) at(normal, 3 * pixel + size_t(c)) = hit.normal[c];
        at(probe, pixel) = hit.probe == gpu::kNoProbe ? -1.0f : float(hit.probe);
    }
};

} // namespace

Result<FieldPicture> drawFromField(const RayTracer& tracer, const ViewRays& rays, const Progress& progress)
{
    constexpr size_t kPiece = size_t(1) << 18; // rays at most between two looks at the progress, a row of tiles at least
    FieldPicture made;
    made.images.width = rays.width();
    made.images.height = rays.height();
    Layers layers(made.images);
    const size_t inTileRow = size_t(ViewRays::kTile) * rays.width() * rays.samples();
    const auto rows = uint32_t(std::max<size_t>(1, kPiece / inTileRow)) * ViewRays::kTile;
    double fetches = 0.0, handoffs = 0.0;
    for (uint32_t first = 0; first < rays.height(); first += rows)
    {
        if (!progress("trace", double(first) / rays.height())) return Error{ErrorCode::cancelled, "Interrupted; nothing was written."};
        const Rows piece(rays, first, std::min(first + rows, rays.height()));
        std::vector<gpu::RayHit> hits(piece.rays.size());
        double milliseconds = 0.0;
        if (Status traced = tracer.trace(piece.rays, hits, &milliseconds); !traced) return traced.error();
        made.milliseconds += milliseconds;
        for (size_t i = 0; i < hits.size(); ++i)
        {
            layers.add(piece.pixels[i], hits[i], 1.0f / float(rays.samples()));
            if (i % rays.samples() == 0) layers.name(piece.pixels[i], piece.rays[i], hits[i], rays.forward());
            made.unknown += hits[i].status == Text::kUnknown ? 1 : 0;
            fetches += hits[i].distanceReads + hits[i].indexReads;
            handoffs += hits[i].handoffs;
        }
        made.rays += hits.size();
    }
    progress("trace", 1.0);
    made.fetchesPerRay = fetches / double(made.rays);
    made.handoffsPerRay = handoffs / double(made.rays);
    return made;
}

} // namespace sconce::tools
