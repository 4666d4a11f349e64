#include "runtime/bake/triangle_gather.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <ranges>

#include "base/numbers.h"
#include "base/parallel.h"
#include "base/random.h"
#include "runtime/field/tracer_cpu.h"
#include "shaders/shared/pure.h"
#include "shaders/shared/sample_pair.h"

namespace sconce
{
namespace twin
{
namespace
{

using gpu::GpuLight;
using gpu::kLinkNone;
using gpu::kLinkSky;
using gpu::kLinkSurface;
using gpu::kLinkTexelBits;
using gpu::kMostShadowRays;
using gpu::kMostSlope;
using gpu::kSampleBits;
using gpu::randomPair;

constexpr float kFar = 1e6f; // field units, in place of the length of a ray that nothing stops

/// The shared text with rays to triangles, for one texel at a time.
struct Gatherer : LightFieldTwin<float>
{
#include "shaders/shared/brdf_text.h"

#include "shaders/shared/gathered_rays.h"

    const TriangleRays& triangles;
    const gpu::LightsHeader& lightsHeader;
    std::span<const GpuLight> lights;
    std::span<const EmittingTriangle> emitters;
    TriangleGather::Desc desc;
    float gap;
    std::span<const glm::vec3> palette;
    std::span<uint32_t> links; // of the probe
    size_t slot = 0;           // of the texel in it

    Gatherer(const TriangleRays& rays, const FieldData& data, const LightList& list, const TriangleGather::Desc& wanted, float offset,
             std::span<const glm::vec3> tints, std::span<uint32_t> into)
        : LightFieldTwin<float>(data, {}), triangles(rays), lightsHeader(list.header), lights(list.lights), emitters(list.emitters), desc(wanted), gap(offset),
          palette(tints), links(into)
    {
    }

    vec3 worldOf(vec3 point) const { return field.origin + field.scale * point; }
    uint gatherRays() const { return desc.rays; }
    uint shadowRays() const { return desc.shadowRays; }
    void keepLink(uint i, uint link) { links[size_t(i) * (links.size() / desc.rays) + slot] = link; }

    bool emitterReaches(vec3 point, vec3 toLight, float distance_, vec3) const
    {
        return !triangles.occluded(worldOf(point), toLight, (1.0f - 1e-4f) * field.scale * distance_ - 2.0f * gap);
    }

    uint endOfRay(vec3 point, vec3 direction, vec3, vec2 lots, float& t, vec3& emitted)
    {
        Random random(std::bit_cast<uint32_t>(lots.x), std::bit_cast<uint32_t>(lots.y), slot);
        vec3 from = worldOf(point), tint(1.0f);
        t = kFar;
        emitted = vec3(0.0f);
        for (int turn = 0;; ++turn)
        {
            const auto hit = triangles.closest(from, direction);
            if (turn == 0 && hit)
            {
                t = hit->t / field.scale;
                emitted = nearEmission(hit->triangle, direction, t * t);
            }
            if (!hit) return kLinkSky;
            const Place place = placeOf(*hit, direction);
            if (turn == kMostSpecular || !goesOn(place, turn == 0 ? lots.y : random.uniform(), random, direction, tint))
            {
                const uint found = texelAt((place.position - field.origin) / field.scale, place.normal, lots.x);
                return found == kLinkSurface ? found : found | nearestTint(tint) << gpu::kLinkTexelBits;
            }
            from = place.position + 2.0f * gap * place.normal;
        }
    }
    static constexpr int kMostSpecular = 4; // reflections on a ray's way

    struct Place
    {
        vec3 position;        // world
        vec3 normal, shading; // unit, on the side that is met
        BrdfSurface surface;
    };

    Place placeOf(const TriangleRays::Hit& hit, vec3 direction) const
    {
        const Scene& scene = triangles.scene();
        const uvec3 corner = scene.triangles[hit.triangle];
        const vec3 share(1.0f - hit.barycentrics.x - hit.barycentrics.y, hit.barycentrics);
        const auto blend = [&](const auto& of) { return share.x * of[corner.x] + share.y * of[corner.y] + share.z * of[corner.z]; };
        Place place{blend(scene.positions), facing(hit.triangle, direction), vec3(0.0f), {}};
        const vec3 smooth_ = blend(scene.normals);
        place.shading = dot(smooth_, smooth_) > 1e-12f ? normalize(smooth_) : place.normal;
        if (dot(place.shading, place.normal) < 0.0f) place.shading = -place.shading;
        if (dot(place.shading, direction) > -kLeastCosine) place.shading = place.normal;
        const sconce::SurfacePoint look = evaluateMaterial(scene, scene.triangleMaterial[hit.triangle], blend(scene.uvs));
        place.surface = {clamp(vec3(look.baseColor), 0.0f, 1.0f), look.metallic, look.roughness};
        return place;
    }
    static constexpr float kLeastCosine = 1e-3f; // of a shading normal to the ray

    /// Whether a ray is reflected specularly: drawn by the lobe's share of white light, so that it needs no weight but its colour.
    /// @param lot        even random number
    /// @param direction  becomes that of the reflected ray; `tint` is multiplied by the lobe's colour, of luminance 1
    bool goesOn(const Place& place, float lot, Random& random, vec3& direction, vec3& tint) const
    {
        const vec3 color = specularColor(lobesAt(place.surface, -dot(place.shading, direction)));
        if (!(lot < std::min(luminance(color), kMostOnward))) return false;
        tint *= color / luminance(color);
        const TangentFrame tangents = tangentFrame(place.shading);
        const vec3 view = toTangent(tangents, -direction);
        vec3 out(0.0f);
        for (int i = 0; i < kTries && !(dot(out, place.normal) > 0.0f); ++i)
        {
            const vec3 halfway = isMirror(place.surface.roughness)
                                     ? vec3(0.0f, 0.0f, 1.0f)
                                     : sampleVisibleNormal(view, ggxAlpha(place.surface.roughness), random.uniform2());
            out = toWorld(tangents, reflect(-view, halfway));
        }
        direction = dot(out, place.normal) > 0.0f ? normalize(out) : reflect(direction, place.normal);
        return true;
    }
    static constexpr int kTries = 4; // for a direction above the surface

    uint nearestTint(vec3 tint) const
    {
        uint nearest = 0;
        for (uint i = 1; i < palette.size(); ++i)
            if (distance(palette[i], tint) < distance(palette[nearest], tint)) nearest = i;
        return nearest;
    }

    /// What a texel sends, see TriangleGather::Target: to the rays that end there, which are as many fewer as go on.
    gpu::SurfaceTexel sending(gpu::SurfaceTexel known, const Place& place, vec3 fromEmitters) const
    {
        const float all = luminance(hemisphericalAlbedo(place.surface));
        const float onward = std::min(luminance(hemisphericalSpecular(place.surface)), kMostOnward), share = onward / std::max(all, 1e-6f);
        const vec3 albedo = unpackRootOfColor(known.albedo);
        known.albedo = packRootOfColor((1.0f - share) / (1.0f - onward) * albedo);
        known.sent = packSharedExponent((unpackSharedExponent(known.sent) + share * albedo * fromEmitters) / (1.0f - onward));
        return known;
    }
    static constexpr float kMostOnward = 0.75f; // of rays, so that those that end count not too much each; the rest of a metal's light is scattered

    /// A patch seen from within some of its widths is no disc on its axis: there rays that meet its triangle count.
    static bool isNearPatch(float d2, float patch) { return d2 < kNearPatch * patch; }
    static constexpr float kNearPatch = 9.0f; // of its area
    static float discOf(float) { return 0.0f; }

    vec3 nearEmission(uint32_t triangle, vec3 direction, float d2) const
    {
        const auto found = std::ranges::lower_bound(emitters, triangle, {}, &EmittingTriangle::triangle);
        if (found == emitters.end() || found->triangle != triangle || !isNearPatch(d2, found->patch)) return vec3(0.0f);
        const float side = -dot(geometricNormal(triangles.scene(), triangle), direction);
        return found->side == 0 || float(found->side) * side > 0.0f ? found->emission : vec3(0.0f);
    }

    /// Normal of a triangle on the side that a ray along `direction` meets.
    vec3 facing(uint32_t triangle, vec3 direction) const
    {
        const vec3 normal = geometricNormal(triangles.scene(), triangle);
        return dot(normal, direction) > 0.0f ? -normal : normal;
    }

    /// A texel that shows a surface point, of the probe that sees most of it; kLinkSurface where none does.
    uint texelAt(vec3 point, vec3 normal, float lot)
    {
        int reads = 0;
        const uvec4 ranked = rankedProbesAt(point + 0.5f * field.voxel * normal, reads);
        float density[kRanked];
        for (int k = 0; k < kRanked; ++k) density[k] = surfaceDensity(ranked[k], point, normal);
        for (int turn = 0; turn < kRanked; ++turn)
        {
            const int best = int(std::max_element(density, density + kRanked) - density);
            if (!(density[best] > 0.0f)) break;
            density[best] = 0.0f;
            const vec3 fromProbe = point - probeHeader(ranked[best]).centre;
            if (!isSeenBy(ranked[best], fromProbe, normal)) continue;
            const uint found = texelShowing(ranked[best], fromProbe, normal, lot);
            if (found != kLinkSurface) return found;
        }
        return kLinkSurface;
    }

    /// The true surface that a texel's packed one is near, where a ray from the probe meets it, if it does.
    std::optional<Place> findSurface(uint probe, vec3 point, vec3 normal) const
    {
        const vec3 centre = probeHeader(probe).centre, to = point - centre;
        const float expected = length(to);
        const vec3 direction = to / expected;
        const auto hit = triangles.closest(worldOf(centre), direction);
        if (!hit || std::abs(hit->t / field.scale - expected) > kOffDistance * expected) return std::nullopt;
        const Place place = placeOf(*hit, direction);
        return dot(place.normal, normal) < kSurfaceBend ? std::nullopt : std::optional(place);
    }
    static constexpr float kOffDistance = 0.01f; // of the distance, that a packed texel may be off by where its surface is steep

#include "shaders/shared/surface_gather.h"
};

} // namespace
} // namespace twin

namespace
{

/// Colours that the scene's metals give what they reflect, the farthest from those before first, where they differ visibly.
std::vector<vec3> metalTints(const Scene& scene)
{
    constexpr int kSteps = 8;                // places of a texture, along each side
    constexpr float kVisiblyOther = 0.02f; // distance of two tints
    std::vector<vec3> all, chosen{vec3(1.0f)};
    for (uint32_t material = 0; material < scene.materials.size(); ++material)
    {
        vec3 sum(0.0f);
        for (int i = 0; i < kSteps * kSteps; ++i)
        {
            const SurfacePoint look = evaluateMaterial(scene, material, (vec2(i % kSteps, i / kSteps) + 0.5f) / float(kSteps));
            sum += Pure<float>::hemisphericalSpecular({glm::clamp(vec3(look.baseColor), 0.0f, 1.0f), look.metallic, look.roughness});
        }
        if (const float light = glm::dot(sum, kLuminance); light > 0.0f) all.push_back(sum / light);
    }
    while (chosen.size() < gpu::kTints)
    {
        const auto off = [&](vec3 tint)
        { return std::ranges::min(chosen | std::views::transform([&](vec3 other) { return glm::distance(tint, other); })); };
        const auto farthest = std::ranges::max_element(all, {}, off);
        if (farthest == all.end() || !(off(*farthest) > kVisiblyOther)) break;
        chosen.push_back(*farthest);
    }
    return chosen;
}

} // namespace

TriangleGather::TriangleGather(const TriangleRays& rays, const FieldData& data, std::span<const gpu::SurfaceTexel> known,
                               const LightList& list, const Desc& wanted)
    : triangles(&rays), field(&data), texels(known), lights(&list), desc(wanted), gap(rayOffset(rays.scene())),
      palette(metalTints(rays.scene()))
{
    assert(desc.rays > 0 && desc.shadowRays <= gpu::kMostShadowRays && data.info.surfaceSize > 0);
}

void TriangleGather::gather(uint32_t probe, const Target& target) const
{
    const uint32_t side = field->info.surfaceSize;
    assert(target.first.size() == size_t(6) * side * side && target.links.size() == target.first.size() * desc.rays);
    const std::span<const gpu::SurfaceTexel> own = texels.subspan(probe * target.first.size(), target.first.size());
    parallelFor(size_t(6) * side,
                [&](size_t row)
                {
                    twin::Gatherer text(*triangles, *field, *lights, desc, gap, palette, target.links);
                    const int face = int(row / side), y = int(row % side);
                    for (int x = 0; x < int(side); ++x)
                    {
                        text.slot = row * side + size_t(x);
                        target.first[text.slot] = target.light[text.slot] = vec4(0.0f);
                        if (!target.tilts.empty()) target.tilts[text.slot] = vec4(0.0f);
                        if (!(own[text.slot].normal & gpu::kSurfaceKnown)) continue;
                        const auto surface = text.surfacePointAt(probe, face, x, y);
                        vec3 plane = surface.normal, point = text.probeHeader(probe).centre + surface.at;
                        const auto exact = text.findSurface(probe, point, plane);
                        if (exact)
                        {
                            point = (exact->position - field->info.origin) / field->info.scale;
                            plane = exact->normal;
                        }
                        else
                            point += 5e-4f * glm::length(surface.at) * plane; // off it by what its distance is packed to
                        point += 2.0f * gap / field->info.scale * plane;
                        const vec3 normal =
                            field->info.surfaceDirections != 0 ? surface.normal : text.unpackNormal8(own[text.slot].normal);
                        const auto got = text.gatherAt(point, normal, plane, text.pixelOfTexel(glm::uvec3(x, y, face)));
                        target.sending[text.slot] =
                            exact ? text.sending(own[text.slot], *exact, got.emitters) : own[text.slot];
                        target.light[text.slot].w = got.variance;
                        target.first[text.slot] = vec4(got.light, text.knowsTooLittle(got.ends, got.asked) ? gpu::kNotKnown : got.reach);
                        if (!target.tilts.empty()) target.tilts[text.slot] = vec4(text.alongPlane(got.tilt, normal), 0.0f, 0.0f);
                    }
                });
}

TriangleGather::Cells TriangleGather::gatherCells() const
{
    const glm::ivec3 count = twin::LightFieldTwin<float>(*field, {}).lightCells();
    const size_t cells = size_t(count.x) * size_t(count.y) * size_t(count.z);
    Cells found{std::vector<uint32_t>(cells), std::vector<uint32_t>(6 * cells * desc.rays, gpu::kLinkNone),
                std::vector<vec3>(6 * cells, vec3(-1.0f))};
    parallelFor(cells,
                [&](size_t cell)
                {
                    const glm::ivec3 at(int(cell % size_t(count.x)), int(cell / size_t(count.x) % size_t(count.y)),
                                   int(cell / (size_t(count.x) * size_t(count.y))));
                    for (int facing = 0; facing < 6; ++facing)
                    {
                        const size_t index = 6 * cell + size_t(facing);
                        twin::Gatherer text(*triangles, *field, *lights, desc, gap, palette,
                                            std::span(found.links).subspan(index * desc.rays, desc.rays));
                        if (facing == 0) found.places[cell] = text.openPlace(at);
                        if (found.places[cell] == 0) return;
                        const vec3 axis = text.faceDirection(facing, vec3(0.0f, 0.0f, 1.0f));
                        const auto got = text.gatherAt(text.cellPlace(at, found.places[cell]), axis, axis, glm::uvec2(cell, facing));
                        if (!text.knowsTooLittle(got.ends, float(desc.rays))) found.straight[index] = got.light;
                    }
                });
    return found;
}

void TriangleGather::lightCells(const Cells& cells, std::span<const uint32_t> sent, std::span<uint32_t> words) const
{
    assert(words.size() == gpu::kCellWords * cells.places.size());
    twin::Gatherer text(*triangles, *field, *lights, desc, gap, palette, {});
    for (size_t cell = 0; cell < cells.places.size(); ++cell)
    {
        uint32_t* const own = &words[gpu::kCellWords * cell];
        own[6] = cells.places[cell];
        for (size_t facing = 0; facing < 6; ++facing)
        {
            const size_t index = 6 * cell + facing;
            twin::Gatherer::Ends ends{};
            vec3 sum(0.0f);
            for (const uint32_t link : std::span(cells.links).subspan(index * desc.rays, desc.rays))
                if (text.countEnd(ends, link)) sum += palette[text.tintOfLink(link)] * text.unpackSharedExponent(sent[text.texelOfLink(link)]);
            own[facing] = cells.straight[index].x < 0.0f ? 0u : text.packKnownLight(cells.straight[index] + text.perRay(ends) * sum);
        }
    }
}

} // namespace sconce
