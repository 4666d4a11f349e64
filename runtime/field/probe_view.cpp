#include "runtime/field/probe_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "runtime/field/quality.h"
#include "runtime/field/tracer_cpu.h"

namespace sconce
{
namespace
{

using Twin = twin::LightFieldTwin<float>;
using glm::vec3;

constexpr int kAskedASide = 32;       // points along each axis of the octree's box, of which leaves are asked
constexpr float kLeastCosine = 0.05f; // at which a surface's area is still told from its solid angle

vec3 directionOf(uint32_t x, uint32_t y, const ProbeView& view)
{
    const float latitude = std::numbers::pi_v<float> * (0.5f - (float(y) + 0.5f) / float(view.height));
    const float longitude = 2.0f * std::numbers::pi_v<float> * ((float(x) + 0.5f) / float(view.width) - 0.5f);
    return {std::cos(latitude) * std::sin(longitude), std::sin(latitude), -std::cos(latitude) * std::cos(longitude)};
}

/// Radiance of what a probe sees in a direction, as the answer of a ray that met it.
vec3 radianceSeen(Twin& text, uint32_t probe, vec3 direction)
{
    if (text.source.radiance.empty() && text.source.prefiltered.empty()) return vec3(0.0f); // the file holds none
    Twin::TraceResult met{};
    met.status = Twin::kHit;
    met.probe = probe;
    met.face = text.dominantFace(direction);
    const vec3 uvw = text.faceCoordinates(met.face, direction);
    const float middle = 0.5f * float(text.field.faceSize);
    met.pixel = {middle * (uvw.x / uvw.z + 1.0f), middle * (uvw.y / uvw.z + 1.0f)};
    const int last = int(text.field.faceSize) - 1;
    const uint32_t row = uint32_t(std::clamp(int(met.pixel.y), 0, last)), column = uint32_t(std::clamp(int(met.pixel.x), 0, last));
    met.word = text.texelWord(text.mapWords(probe, met.face), column, row);
    return text.answerOf(vec3(0.0f), direction, met).radiance;
}

bool othersSee(Twin& text, uint32_t probe, vec3 point, vec3 normal)
{
    for (uint32_t other = 0; other < text.field.probeCount; ++other)
    {
        const vec3 fromOther = point - vec3(text.probeHeader(other).centre);
        if (other != probe && text.surfaceDensity(other, point, normal) > 0.0f && text.isSeenBy(other, fromOther, normal)) return true;
    }
    return false;
}

void look(Twin& text, uint32_t probe, uint32_t y, ProbeView& view)
{
    for (uint32_t x = 0; x < view.width; ++x)
    {
        const size_t pixel = size_t(y) * view.width + x;
        const vec3 direction = directionOf(x, y, view);
        const vec3 plane = text.planeSeen(probe, direction);
        const float towards = glm::dot(plane, direction);
        if (!(towards > 0.0f))
        {
            view.radiance[pixel] = text.field.sky;
            continue;
        }
        view.depth[pixel] = text.field.scale / towards;
        view.normal[pixel] = -glm::normalize(plane);
        view.radiance[pixel] = radianceSeen(text, probe, direction);
        view.alone[pixel] = othersSee(text, probe, vec3(text.probeHeader(probe).centre) + direction / towards, view.normal[pixel]) ? 0 : 1;
    }
}

void measure(ProbeView& view)
{
    std::vector<float> seen;
    double all = 0.0, sky = 0.0, area = 0.0, alone = 0.0;
    for (uint32_t y = 0; y < view.height; ++y)
        for (uint32_t x = 0; x < view.width; ++x)
        {
            const size_t pixel = size_t(y) * view.width + x;
            const vec3 direction = directionOf(x, y, view);
            const double angle =
                std::sqrt(std::max(0.0, 1.0 - double(direction.y) * double(direction.y))); // of a pixel, over the equator's
            all += angle;
            const float depth = view.depth[pixel];
            if (!(depth > 0.0f))
            {
                sky += angle;
                continue;
            }
            seen.push_back(depth);
            const float cosine = std::max(-glm::dot(direction, view.normal[pixel]), kLeastCosine);
            const double part = angle * double(depth) * double(depth) / double(cosine);
            area += part;
            if (view.alone[pixel] != 0) alone += part;
        }
    const double pixel = 4.0 * std::numbers::pi / all; // steradians at the equator
    view.sky = float(sky / all);
    view.area = float(area * pixel);
    view.areaAlone = float(alone * pixel);
    if (seen.empty()) return;
    std::ranges::sort(seen);
    view.nearest = seen.front();
    view.median = seen[seen.size() / 2];
    view.farthest = seen.back();
}

void countLeaves(Twin& text, uint32_t probe, ProbeView& view)
{
    const Octree& tree = text.source.octree;
    int first = 0, named = 0, reads = 0;
    for (int i = 0; i < kAskedASide * kAskedASide * kAskedASide; ++i)
    {
        const vec3 share =
            (vec3(i % kAskedASide, i / kAskedASide % kAskedASide, i / (kAskedASide * kAskedASide)) + 0.5f) / float(kAskedASide);
        const glm::uvec4 ranked = text.rankedProbesAt(glm::mix(tree.boundsLow, tree.boundsHigh, share), reads);
        first += ranked.x == probe ? 1 : 0;
        named += ranked.x == probe || ranked.y == probe || ranked.z == probe || ranked.w == probe ? 1 : 0;
    }
    constexpr float kAsked = float(kAskedASide * kAskedASide * kAskedASide);
    view.first = float(first) / kAsked;
    view.named = float(named) / kAsked;
}

} // namespace

ProbeView viewOfProbe(const FieldData& field, uint32_t probe, uint32_t width)
{
    ProbeView view{.width = width, .height = width / 2};
    const size_t pixels = size_t(view.width) * view.height;
    view.radiance.resize(pixels);
    view.depth.resize(pixels);
    view.normal.resize(pixels);
    view.alone.resize(pixels);
    parallelFor(view.height,
                [&](size_t y)
                {
                    Twin text(field, Quality{}.trace);
                    look(text, probe, uint32_t(y), view);
                });
    measure(view);
    Twin text(field, Quality{}.trace);
    countLeaves(text, probe, view);
    return view;
}

} // namespace sconce
