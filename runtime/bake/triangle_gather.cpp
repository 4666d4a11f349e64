#include "runtime/bake/triangle_gather.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <ranges>
#include <utility>

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
using gpu::kLightDirectional;
using gpu::kLightSpot;
using gpu::kLinkDark;
using gpu::kLinkNone;
using gpu::kLinkSky;
using gpu::kLinkSurface;
using gpu::kLinkTexelBits;
using gpu::kMostShadowRays;
using gpu::kMostSlope;
using gpu::pairOfRay;
using gpu::randomPair;

constexpr float kFar = 1e6f; // field units, in place of the length of a ray that nothing stops

/// The shared text with rays to triangles, for one texel at a time.
struct Gatherer : LightFieldTwin<float>
{
#include "shaders/shared/brdf_text.h"

#include "shaders/shared/delta_light.h"
#include "shaders/shared/gathered_rays.h"
#include "shaders/shared/polygon_light.h"

    const ExactRays& triangles;
    const gpu::LightsHeader& lightsHeader;
    std::span<const GpuLight> lights;
    std::span<const EmittingTriangle> emitters;
    TriangleGather::Desc desc;
    float gap;
    std::span<const glm::vec4> palette;
    std::span<const float> straight; // TriangleGather::straight
    const EmitterPatches& patches;
    std::span<uint32_t> links;                            // of the probe
    size_t slot = 0;                                      // of the texel in it
    std::vector<float> running;                           // sums of the emitters' weights, up to each and with it
    std::array<vec3, gpu::kReflectionsCounted> brought{}; // light of emitters and sky that the rays have brought by reflections, summed
    float firstMet = 0.0f;                                // length of the last ray to what it met first; kBack, kSeen
    std::span<float> lengths;                             // of each ray, like `firstMet`; empty: not asked for
    std::span<const Outside> outside;                     // TriangleGather::Openness

    Gatherer(const ExactRays& rays, const FieldData& data, const LightList& list, const TriangleGather::Desc& wanted, float offset,
             std::span<const glm::vec4> tints, std::span<const float> ofMaterials, const EmitterPatches& ofEmitters,
             std::span<uint32_t> into)
        : LightFieldTwin<float>(data, {}), triangles(rays), lightsHeader(list.header), lights(list.lights), emitters(list.emitters),
          desc(wanted), gap(offset), palette(tints), straight(ofMaterials), patches(ofEmitters), links(into)
    {
    }

    vec3 worldOf(vec3 point) const
    {
        return field.origin + field.scale * point;
    }
    uint gatherRays() const
    {
        return desc.rays;
    }
    uint shadowRays() const
    {
        return desc.shadowRays;
    }
    void keepLink(uint i, uint link)
    {
        links[size_t(i) * (links.size() / desc.rays) + slot] = link;
        if (!lengths.empty()) lengths[i] = std::exchange(firstMet, 0.0f);
    }

    bool emitterReaches(vec3 point, vec3 toLight, float distance_, vec3) const
    {
        return !triangles.occluded(worldOf(point), toLight, (1.0f - 1e-4f) * field.scale * distance_ - 2.0f * gap);
    }

    uint endOfRay(vec3 point, vec3 direction, vec3, vec2 lots, float& t, vec3& emitted)
    {
        // What asks lights draws apart, so that rays' ways don't depend on them.
        const uint64_t lot = std::bit_cast<uint32_t>(lots.x), other = std::bit_cast<uint32_t>(lots.y);
        Random random(lot, other, slot), ofLights(lot, other, kOfLights | slot);
        vec3 from = worldOf(point), tint(1.0f);
        t = kFar;
        emitted = vec3(0.0f);
        float density = 0.0f; // over solid angle, of the reflection that the ray comes by
        for (int turn = 0;; ++turn)
        {
            const auto hit = triangles.closest(from, direction);
            if (turn == 0 && hit) t = hit->t / field.scale;
            if (turn == 0) firstMet = hit && isInner(hit->triangle, direction) ? kBack : t;
            if (!hit && turn == 0) return kLinkSky;
            if (!hit)
            {
                broughtBy(turn) += tint * field.sky; // a link to the sky has no room for the colour
                return kLinkDark;
            }
            if (const EmittingTriangle* emitter = emitterMet(hit->triangle, direction))
            {
                const float distance_ = hit->t / field.scale, d2 = distance_ * distance_;
                if (turn == 0)
                    emitted += isNearPatch(d2, emitter->patch) ? emitter->emission : vec3(0.0f);
                else
                    broughtBy(turn) += tint * emitter->emission *
                                       (density / (density + densityOfPatch(d2, facingOf(*emitter, direction), emitter->patch)));
            }
            const Place place = placeOf(*hit, direction);
            const BrdfLobes lobes = lobesAt(place.surface, -dot(place.shading, direction));
            const vec3 color = specularColor(lobes);
            const float all = luminance(color), onward = shareOnward(place.surface, all);
            if (onward > 0.0f)
                broughtBy(turn + 1) += tint * (onward / std::max(all, 1e-6f)) * emittersBySpecular(lobes, place, direction, ofLights);
            broughtBy(turn + 1) += tint * straightBySpecular(place, direction, ofLights);
            from = place.position + 2.0f * gap * place.normal;
            if (turn < kMostTurns && random.uniform() < onward)
            {
                tint *= color / all;
                density = reflectBy(place, random, direction);
                continue;
            }
            const uint found = texelAt((place.position - field.origin) / field.scale, place.normal, random.uniform());
            if (found != kLinkSurface && turn == 0) firstMet = kSeen;
            if (found != kLinkSurface) return found | nearestTint(tint, turn) << kLinkTexelBits;
            // No probe sees the place: there the ray is scattered itself. Of what shines without extent and of lamps all is sent to all
            // sides, as texels send it, see sending() and directOf().
            const vec3 scattered = scatteredBy(place.surface);
            const float goesOn = luminance(scattered);
            const vec3 sent =
                hemisphericalAlbedo(place.surface) / (1.0f - shareOnward(place.surface, luminance(hemisphericalSpecular(place.surface))));
            broughtBy(turn + 1) +=
                tint *
                (scattered * emittersByDiffuse(place, ofLights) +
                 sent * (shareToAllSides(place.surface) * deltaLightAt(place) + lampLightAt(place.position, place.normal, place.normal)) /
                     kBrdfPi);
            if (turn == kMostTurns || !(random.uniform() < goesOn)) return kLinkDark;
            tint *= scattered / goesOn;
            const vec3 up = sampleCosine(random.uniform2());
            direction = normalize(toWorld(tangentFrame(place.normal), up));
            density = std::max(up.z, 1e-6f) / kBrdfPi;
        }
    }
    static constexpr int kMostTurns = 64; // on a ray's way to a texel: of spaces that no probe sees all light comes by them
    static constexpr uint64_t kOfLights = uint64_t(1) << 32;

    struct Place
    {
        vec3 position;        // world
        vec3 normal, shading; // unit, on the side that is met
        BrdfSurface surface;
        uint32_t material;
        bool retroreflective;
    };

    /// That a place's lobes are for, of a ray along `direction`.
    static vec3 viewerAt(const Place& place, vec3 direction)
    {
        return viewerOfLobes(place.shading, -direction, place.retroreflective);
    }

    Place placeOf(const ExactRays::Hit& hit, vec3 direction) const
    {
        const Scene& scene = triangles.scene();
        const uvec3 corner = scene.triangles[hit.triangle];
        const vec3 share(1.0f - hit.barycentrics.x - hit.barycentrics.y, hit.barycentrics);
        const auto blend = [&](const auto& of) { return share.x * of[corner.x] + share.y * of[corner.y] + share.z * of[corner.z]; };
        Place place{blend(scene.positions), facing(hit.triangle, direction), vec3(0.0f), {}, scene.triangleMaterial[hit.triangle], false};
        const vec3 smooth_ = blend(scene.normals);
        place.shading = dot(smooth_, smooth_) > 1e-12f ? normalize(smooth_) : place.normal;
        if (dot(place.shading, place.normal) < 0.0f) place.shading = -place.shading;
        if (dot(place.shading, direction) > -kLeastCosine) place.shading = place.normal;
        const sconce::SurfacePoint look = evaluateMaterial(scene, place.material, blend(scene.uvs));
        place.surface = {clamp(vec3(look.baseColor), 0.0f, 1.0f), look.metallic, look.roughness};
        place.retroreflective = scene.materials[place.material].retroreflective;
        return place;
    }
    static constexpr float kLeastCosine = 1e-3f; // of a shading normal to the ray

    /// How many of the rays that meet a surface its specular lobe turns on.
    /// @param reflected  share of white light, [0,1]
    static float shareOnward(const BrdfSurface& surface, float reflected)
    {
        return surface.roughness > kRoughestLobe ? 0.0f : std::min(reflected, kMostOnward);
    }
    static constexpr float kMostOnward = 0.75f; // so that rays that end count not too much each; the rest of a metal's light is scattered

    /// Turns a ray by the specular lobe that it meets.
    /// @return  density of the new direction over solid angle
    float reflectBy(const Place& place, Random& random, vec3& direction) const
    {
        const TangentFrame tangents = tangentFrame(place.shading);
        const vec3 back = viewerAt(place, direction), view = toTangent(tangents, back);
        const float alpha = ggxAlpha(place.surface.roughness);
        const bool mirror = isMirror(place.surface.roughness);
        vec3 out(0.0f);
        for (int i = 0; i < kTries && !(dot(out, place.normal) > 0.0f); ++i)
            out = toWorld(tangents, reflect(-view, mirror ? vec3(0.0f, 0.0f, 1.0f) : sampleVisibleNormal(view, alpha, random.uniform2())));
        direction = dot(out, place.normal) > 0.0f ? normalize(out) : reflect(direction, place.normal);
        return mirror ? kMirrorDensity : std::max(visibleNormalPdf(place.shading, back, direction, alpha), 1e-6f);
    }
    static constexpr float kMirrorDensity = 1e20f;

    /// Density over solid angle by which the patches of all emitters are drawn at a place.
    float densityOfPatch(float d2, float facing_, float patch) const
    {
        return d2 / std::max(facing_ * patch * float(lightsHeader.emitterCount), 1e-12f);
    }

    const EmittingTriangle* emitterMet(uint32_t triangle, vec3 direction) const
    {
        const auto found = std::ranges::lower_bound(emitters, triangle, {}, &EmittingTriangle::triangle);
        return found != emitters.end() && found->triangle == triangle && facingOf(*found, direction) > 0.0f ? &*found : nullptr;
    }

    /// Cosine at an emitter to a ray that meets it; 0 on a side that is dark.
    float facingOf(const EmittingTriangle& emitter, vec3 direction) const
    {
        const float cosine = -dot(geometricNormal(triangles.scene(), emitter.triangle), direction);
        return emitter.side == 0 ? std::abs(cosine) : std::max(float(emitter.side) * cosine, 0.0f);
    }

    /// A patch of an emitter, drawn evenly.
    struct Drawn
    {
        vec3 toLight;      // unit
        vec3 emission;     // 0: its light doesn't arrive
        float density = 0; // over solid angle, of all patches
    };

    /// What it gives and what rays along a lobe meet count by the balance heuristic (Veach and Guibas 1995, "Optimally Combining Sampling
    /// Techniques for Monte Carlo Rendering").
    Drawn drawPatch(const Place& place, Random& random) const
    {
        Drawn drawn{vec3(0.0f), vec3(0.0f)};
        if (lightsHeader.emitterCount == 0) return drawn;
        const GpuLight& light = lights[lightsHeader.deltaCount + random.below(lightsHeader.emitterCount)];
        const vec3 point = (place.position - field.origin) / field.scale, away = light.position - point;
        const float d2 = std::max(dot(away, away), 1e-14f), distance_ = sqrt(d2);
        drawn.toLight = away / distance_;
        const float cosine = -dot(light.direction, drawn.toLight), faced = light.innerCone > 0.0f ? cosine : std::abs(cosine);
        if (!(dot(drawn.toLight, place.normal) > 0.0f) || !(dot(drawn.toLight, place.shading) > 0.0f) || !(faced > 0.0f)) return drawn;
        drawn.density = densityOfPatch(d2, faced, light.area);
        if (emitterReaches(point + 2.0f * gap / field.scale * place.normal, drawn.toLight, distance_, place.normal))
            drawn.emission = light.intensity;
        return drawn;
    }

    /// Light straight from emitters that a specular lobe reflects against a ray.
    vec3 emittersBySpecular(const BrdfLobes& lobes, const Place& place, vec3 direction, Random& random) const
    {
        if (isMirror(place.surface.roughness)) return vec3(0.0f);
        const Drawn light = drawPatch(place, random);
        if (light.emission == vec3(0.0f)) return vec3(0.0f);
        const float density =
            light.density + visibleNormalPdf(place.shading, viewerAt(place, direction), light.toLight, ggxAlpha(place.surface.roughness));
        return evaluateLobes(lobes, place.surface.roughness, place.shading, viewerAt(place, direction), light.toLight).specular *
               (dot(light.toLight, place.shading) / density) * light.emission;
    }

    /// Light straight from lights of no extent that a coat reflects against a ray: shareToAllSides() leaves it out. Lobes sharper than some
    /// are widened, or rays would find their light by chance; shadow rays to the rest are drawn by how much it is.
    vec3 straightBySpecular(const Place& place, vec3 direction, Random& random) const
    {
        if (place.surface.roughness > kRoughestLobe || !(place.surface.metallic < 1.0f)) return vec3(0.0f);
        const float roughness = std::max(place.surface.roughness, kSharpestFound), view = -dot(place.shading, direction);
        const BrdfLobes coat = lobesAt({vec3(0.0f), 0.0f, roughness}, view);
        const vec3 point = (place.position - field.origin) / field.scale + 2.0f * gap / field.scale * place.normal;
        vec3 sum(0.0f);
        for (const GpuLight& light : lights.first(lightsHeader.deltaCount))
        {
            const DeltaLight at = deltaLightAt(light, light.type, point, 2.0f * field.diagonal);
            const float cosine = dot(at.toLight, place.shading);
            if (!(luminance(at.irradiance) > 0.0f) || !(cosine > 0.0f) || !(dot(at.toLight, place.normal) > 0.0f)) continue;
            const float sent = cosine * evaluateLobes(coat, roughness, place.shading, viewerAt(place, direction), at.toLight).specular.x;
            const float asked = std::min(sent / kSurelyAsked, 1.0f);
            if (random.uniform() < asked && emitterReaches(point, at.toLight, at.distance, place.normal))
                sum += (1.0f - place.surface.metallic) * sent / asked * at.irradiance;
        }
        return sum;
    }
    static constexpr float kSharpestFound = 0.3f; // roughness
    static constexpr float kSurelyAsked = 0.02f;  // radiance sent over irradiance from which on a shadow ray is surely traced

    /// Mean radiance that arrives straight from emitters, weighted by the cosine.
    vec3 emittersByDiffuse(const Place& place, Random& random) const
    {
        const Drawn light = drawPatch(place, random);
        if (light.emission == vec3(0.0f)) return vec3(0.0f);
        const float cosine = dot(light.toLight, place.normal) / kBrdfPi;
        return cosine / (light.density + cosine) * light.emission;
    }

    /// Irradiance from lights of no extent, of metals as much of it as they send on.
    vec3 deltaLightAt(const Place& place) const
    {
        const float lean = grazingOfSurface(place.surface.metallic, place.surface.roughness, 0.0f);
        const vec3 point = (place.position - field.origin) / field.scale + 2.0f * gap / field.scale * place.normal;
        vec3 sum(0.0f);
        for (const GpuLight& light : lights.first(lightsHeader.deltaCount))
        {
            const DeltaLight at = deltaLightAt(light, light.type, point, 2.0f * field.diagonal);
            const float cosine = dot(at.toLight, place.normal);
            if (cosine > 0.0f && luminance(at.irradiance) > 0.0f && emitterReaches(point, at.toLight, at.distance, place.normal))
                sum += cosine * takenAlong(cosine, lean) * at.irradiance;
        }
        return sum;
    }

    /// Irradiance from the field's lamps: what their outlines give, by as much of them as rays reach.
    /// @param position  world
    /// @param normal    unit, for shading; `plane`: the surface's own
    vec3 lampLightAt(vec3 position, vec3 normal, vec3 plane) const
    {
        const vec3 point = (position - field.origin) / field.scale + 2.0f * gap / field.scale * plane;
        const TangentFrame tangents = tangentFrame(normal);
        vec3 sum(0.0f);
        for (const gpu::Lamp& lamp : source.lamps)
        {
            const auto corner = [&](int i) { return toTangent(tangents, lamp.corner[i] - point); };
            if (!(dot(point - lamp.centre, lamp.normal) > 0.0f)) continue;
            const float given = polygonIrradiance(corner(0), corner(1), corner(2), corner(3));
            if (!(given > 0.0f)) continue;
            int reached = 0;
            for (int i = 0; i < kLampRays * kLampRays; ++i)
            {
                const vec2 at = (vec2(i % kLampRays, i / kLampRays) + 0.5f) / float(kLampRays);
                const vec3 to = mix(mix(lamp.corner[0], lamp.corner[1], at.x), mix(lamp.corner[3], lamp.corner[2], at.x), at.y) - point;
                const float far = length(to);
                reached += dot(to, plane) > 0.0f && emitterReaches(point, to / far, far, plane) ? 1 : 0;
            }
            sum += lamp.radiance * (given * float(reached) / float(kLampRays * kLampRays));
        }
        return sum;
    }
    static constexpr int kLampRays = 2; // along each side of a lamp

    /// What a surface scatters of the light of the rays that don't go on by its specular lobe, which are as many fewer.
    vec3 scatteredBy(const BrdfSurface& surface) const
    {
        const vec3 specular = hemisphericalSpecular(surface);
        const float white = luminance(specular), onward = shareOnward(surface, white);
        const vec3 rest = hemisphericalDiffuse(surface) + specular * (1.0f - onward / std::max(white, 1e-6f));
        return min(rest / (1.0f - onward), vec3(1.0f));
    }

    static constexpr int kTries = 4; // for a direction above the surface

    /// @param reflections  of the ray; more than the colours tell are as many as they do
    uint nearestTint(vec3 tint, int reflections) const
    {
        const float told = std::min(float(reflections), palette.back().w);
        uint nearest = 0;
        float off = kFar;
        for (uint i = 0; i < palette.size(); ++i)
        {
            const float own = distance(vec3(palette[i]), tint);
            if (palette[i].w == told && own < off) nearest = i, off = own;
        }
        return nearest;
    }

    /// Where light goes that comes by so many reflections, at least one.
    vec3& broughtBy(int reflections)
    {
        return brought[std::min(size_t(reflections), brought.size()) - 1];
    }
    /// The mean of a place's rays.
    vec3 allBrought(const Ends& ends) const
    {
        vec3 sum(0.0f);
        for (const vec3& light : brought) sum += light;
        return sum / std::max(ends.all, 1.0f);
    }

    /// A texel with what it sends of the light of lamps.
    gpu::SurfaceTexel withLamps(gpu::SurfaceTexel known, vec3 position, vec3 plane) const
    {
        if (!source.lamps.empty())
            known.sent =
                packSharedExponent(unpackSharedExponent(known.sent) +
                                   unpackRootOfColor(known.albedo) * lampLightAt(position, unpackNormal8(known.normal), plane) / kBrdfPi);
        return known;
    }

    /// What a texel sends, see TriangleGather::Target: to the rays that end there, which are as many fewer as go on.
    gpu::SurfaceTexel sending(gpu::SurfaceTexel known, const Place& place) const
    {
        const vec3 all = max(hemisphericalAlbedo(place.surface), vec3(1e-6f));
        const float onward = shareOnward(place.surface, luminance(hemisphericalSpecular(place.surface)));
        known.albedo = packRootOfColor(scatteredBy(place.surface) / all * unpackRootOfColor(known.albedo));
        known.sent = packSharedExponent(unpackSharedExponent(known.sent) / (1.0f - onward));
        return known;
    }

    /// What a texel sends of light straight from lights of no extent over what arrives, see TriangleGather::Target::direct.
    uint directOf(const gpu::SurfaceTexel& known, const Place& place) const
    {
        const float onward = shareOnward(place.surface, luminance(hemisphericalSpecular(place.surface)));
        return packSharedExponent(straight[place.material] * shareToAllSides(place.surface) * unpackRootOfColor(known.albedo) /
                                  (1.0f - onward));
    }

    /// A patch seen from within some of its widths is no disc on its axis: there rays that meet its triangle count.
    static bool isNearPatch(float d2, float patch)
    {
        return d2 < kNearPatch * patch;
    }
    static constexpr float kNearPatch = 9.0f; // of its area
    static float discOf(float)
    {
        return 0.0f;
    }

    /// Normal of a triangle on the side that a ray along `direction` meets.
    vec3 facing(uint32_t triangle, vec3 direction) const
    {
        const vec3 normal = geometricNormal(triangles.scene(), triangle);
        return dot(normal, direction) > 0.0f ? -normal : normal;
    }

    /// Whether nothing is between a surface point and a probe.
    bool reaches(uint probe, vec3 point, vec3 normal) const
    {
        const vec3 from = worldOf(point) + 2.0f * gap * normal, to = worldOf(vec3(probeHeader(probe).centre)) - from;
        const float away = length(to);
        return !(away > 0.0f && triangles.occluded(from, to / away, away));
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
            // By its texels it may see what is within one of them of a sheet, on the other side.
            if (!isSeenBy(ranked[best], fromProbe, normal) || !reaches(ranked[best], point, normal)) continue;
            const uint found = texelShowing(ranked[best], fromProbe, normal, lot);
            if (found != kLinkSurface) return found;
        }
        return kLinkSurface;
    }

    static constexpr float kOffWall = 0.75f; // voxels: nearer to its own wall a probe behind that may seem to see a point
    /// TriangleGather::Point::seen.
    float seenShare(vec3 point, vec3 normal, uvec2 sample, std::span<const uint32_t> ends, float grazing)
    {
        const TangentFrame tangents = tangentFrame(normal);
        uint seen = 0;
        for (uint i = 0; i < ends.size(); ++i)
            seen +=
                lengths[i] == kSeen || (ends[i] == kLinkSky && passesSeen(point, normal, gatherDirection(tangents, sample, i, grazing)));
        return float(seen) / float(ends.size());
    }
    bool passesSeen(vec3 point, vec3 normal, vec3 direction)
    {
        for (const float voxels : {2.0f, 6.0f})
            if (voxels * dot(direction, normal) > kOffWall && isSeen(point + voxels * field.voxel * direction)) return true;
        return false;
    }

    static constexpr float kBack = -1.0f, kSeen = 2.0f * kFar; // in place of a length: to a side that isn't outside, to what a probe sees
    /// Whether a ray meets a side that isn't outside.
    bool isInner(uint32_t triangle, vec3 direction) const
    {
        const float outer = !outside.empty() && outside[triangle] == Outside::back ? -1.0f : 1.0f;
        return outer * dot(geometricNormal(triangles.scene(), triangle), direction) > 0.0f;
    }

    /// TriangleGather::Point::open.
    float openShare(float near) const
    {
        const auto all = float(lengths.size());
        if (float(std::ranges::count(lengths, kBack)) > kMostBacks * all) return 0.0f;
        return float(std::ranges::count_if(lengths, [&](float to) { return to > near; })) / all;
    }

    static constexpr float kMostBacks =
        0.125f; // of rays, of a place that is not within something solid; what stands in one another has fronts within, too

    bool isSeen(vec3 point)
    {
        int reads = 0;
        const uvec4 ranked = rankedProbesAt(point, reads);
        for (int k = 0; k < kRanked; ++k)
            if (!hiddenFromProbe(ranked[k], point - probeHeader(ranked[k]).centre)) return true;
        return false;
    }

    /// Mean radiance that a place's rays bring from the texels where they ended.
    vec3 broughtTo(std::span<const uint32_t> ends, const TriangleGather::Sent& sent)
    {
        Ends count{};
        vec3 sum(0.0f);
        for (const uint32_t link : ends)
        {
            if (!countEnd(count, link)) continue;
            const vec4 tint = palette[tintOfLink(link)];
            sum += vec3(tint) * unpackSharedExponent(sent[size_t(tint.w)][texelOfLink(link)]);
        }
        return perRay(count) * sum;
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

    // What surface_gather.h asks: the sums of weights are kept from one question to the other.
    real weighEmitters(vec3 point, vec3 normal, vec3 plane, real grazing)
    {
        patches.weigh(point, normal, plane, grazing, kNearPatch, running);
        float total = 0.0f;
        for (float& weight : running) weight = total += weight;
        return total;
    }
    real passedBy(uint i, real, vec3, vec3, vec3, real) const
    {
        return running[i - lightsHeader.deltaCount];
    }
};

} // namespace
} // namespace twin

namespace
{

/// Of each material, how much of the light straight from lights its surface sends, over what it would by its albedo: normal textures
/// spread, and the mean of what many normals get of a light is less than what their mean gets. probe_face.glsl finds the same from mips.
std::vector<float> straightShares(const Scene& scene)
{
    constexpr int kSteps = 64; // places of a texture, along each side
    std::vector<float> shares(scene.materials.size(), 1.0f);
    for (uint32_t material = 0; material < shares.size(); ++material)
    {
        if (scene.materials[material].normalTexture.image < 0) continue;
        vec3 sum(0.0f);
        for (int i = 0; i < kSteps * kSteps; ++i)
            sum += 2.0f * readNormalTexture(scene, material, (vec2(i % kSteps, i / kSteps) + 0.5f) / float(kSteps)) - 1.0f;
        const float together = std::min(glm::length(sum) / float(kSteps * kSteps), 1.0f);
        shares[material] = 2.0f * together / (1.0f + together);
    }
    return shares;
}

/// TriangleGather::tints(): white of no reflection, then white and the colours that the scene's metals give what they reflect, the farthest
/// from those before first, where they differ visibly; of one reflection, and of more where there is room for all of them again.
std::vector<vec4> reflectedTints(const Scene& scene)
{
    constexpr int kSteps = 8;              // places of a texture, along each side
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
    while (chosen.size() + 1 < gpu::kTints)
    {
        const auto off = [&](vec3 tint)
        { return std::ranges::min(chosen | std::views::transform([&](vec3 other) { return glm::distance(tint, other); })); };
        const auto farthest = std::ranges::max_element(all, {}, off);
        if (farthest == all.end() || !(off(*farthest) > kVisiblyOther)) break;
        chosen.push_back(*farthest);
    }
    std::vector<vec4> tints{vec4(1.0f, 1.0f, 1.0f, 0.0f)};
    for (uint32_t turn = 1; turn <= gpu::kReflectionsCounted && tints.size() + chosen.size() <= gpu::kTints; ++turn)
        for (const vec3& tint : chosen) tints.emplace_back(tint, float(turn));
    return tints;
}

} // namespace

TriangleGather::TriangleGather(const ExactRays& rays, const FieldData& data, std::span<const gpu::SurfaceTexel> known,
                               const LightList& list, const Desc& wanted)
    : triangles(&rays), field(&data), texels(known), lights(&list), desc(wanted), gap(rayOffset(rays.scene())),
      palette(reflectedTints(rays.scene())), straight(straightShares(rays.scene())),
      patches(std::span(list.lights).subspan(list.header.deltaCount, list.header.emitterCount))
{
    for (size_t i = 0; i < grazings.size(); ++i) grazings[i] = twin::Gatherer::grazingOfRoughness(float(i) / float(grazings.size() - 1));
    assert(desc.rays > 0 && desc.shadowRays <= gpu::kMostShadowRays && data.info.surfaceSize > 0);
}

float TriangleGather::grazingOf(float metallic, float roughness) const
{
    const float coat = grazings[size_t(roughness * float(grazings.size() - 1) + 0.5f)];
    return twin::Gatherer::grazingOfSurface(metallic, roughness, coat);
}

void TriangleGather::gather(uint32_t probe, const Target& target) const
{
    const uint32_t side = field->info.surfaceSize;
    assert(target.first.size() == size_t(6) * side * side && target.links.size() == target.first.size() * desc.rays);
    const std::span<const gpu::SurfaceTexel> own = texels.subspan(probe * target.first.size(), target.first.size());
    parallelFor(size_t(6) * side,
                [&](size_t row)
                {
                    twin::Gatherer text(*triangles, *field, *lights, desc, gap, palette, straight, patches, target.links);
                    const int face = int(row / side), y = int(row % side);
                    for (int x = 0; x < int(side); ++x)
                    {
                        text.slot = row * side + size_t(x);
                        target.first[text.slot] = target.light[text.slot] = vec4(0.0f);
                        for (size_t i = text.slot; i < target.reflected.size(); i += own.size()) target.reflected[i] = 0;
                        if (!target.direct.empty()) target.direct[text.slot] = 0;
                        if (!target.tilts.empty()) target.tilts[text.slot] = vec4(0.0f);
                        if (!(own[text.slot].normal & gpu::kSurfaceKnown)) continue;
                        text.brought = {};
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
                        const vec3 normal = field->info.surfaceDirections != 0 ? surface.normal : text.unpackNormal8(own[text.slot].normal);
                        const float grazing = exact ? grazingOf(exact->surface.metallic, exact->surface.roughness) : 0.0f;
                        const auto got = text.gatherAt(point, normal, plane, text.pixelOfTexel(glm::uvec3(x, y, face)), grazing);
                        gpu::SurfaceTexel lit = text.withLamps(own[text.slot], text.worldOf(point), plane);
                        lit.normal |= twin::Gatherer::packGrazing(grazing);
                        target.sending[text.slot] = exact ? text.sending(lit, *exact) : lit;
                        if (!target.direct.empty())
                            target.direct[text.slot] = exact ? text.directOf(own[text.slot], *exact)
                                                             : text.packSharedExponent(text.unpackRootOfColor(own[text.slot].albedo));
                        target.light[text.slot].w = got.variance;
                        for (size_t i = 0; i < text.brought.size(); ++i)
                            target.reflected[i * own.size() + text.slot] =
                                text.packSharedExponent(text.brought[i] / std::max(got.ends.all, 1.0f));
                        target.first[text.slot] = vec4(got.light, text.knowsTooLittle(got.ends, got.asked) ? gpu::kNotKnown : got.reach);
                        if (!target.tilts.empty()) target.tilts[text.slot] = vec4(text.alongPlane(got.tilt, normal), 0.0f, 0.0f);
                    }
                });
}

TriangleGather::FinePoints TriangleGather::gatherFiner(uint32_t probe, glm::uvec3 texel, const Sent& sent) const
{
    constexpr uint32_t kSide = 1u << gpu::kFineLog;
    std::vector<uint32_t> links(desc.rays);
    twin::Gatherer text(*triangles, *field, *lights, desc, gap, palette, straight, patches, links);
    FinePoints found;
    for (uint32_t i = 0; i < found.size(); ++i)
    {
        const glm::uvec3 at(kSide * texel.x + i % kSide, kSide * texel.y + i / kSide, texel.z);
        const auto surface = text.surfacePointOf(probe, int(at.z), int(at.x), int(at.y), kSide * field->info.surfaceSize);
        const vec3 seen = text.probeHeader(probe).centre + surface.at;
        // What the packed distance isn't exact for isn't refined.
        const auto exact = surface.width > 0.0f ? text.findSurface(probe, seen, surface.normal) : std::nullopt;
        if (!exact) continue;
        const vec3 point = (exact->position - field->info.origin) / field->info.scale + 2.0f * gap / field->info.scale * exact->normal;
        const vec3 normal = field->info.surfaceDirections != 0 ? surface.normal : exact->shading;
        text.brought = {};
        const auto got = text.gatherAt(point, normal, exact->normal, text.pixelOfTexel(at),
                                       grazingOf(exact->surface.metallic, exact->surface.roughness));
        if (text.knowsTooLittle(got.ends, got.asked)) continue;
        found[i] = {got.light, text.broughtTo(links, sent) + text.allBrought(got.ends), got.variance, got.room, got.reach, true, 1.0f, 1.0f,
                    false};
    }
    return found;
}

TriangleGather::Point TriangleGather::gatherAt(vec3 point, vec3 normal, float grazing, uint32_t rays, glm::uvec2 sample, const Sent& sent,
                                               const Openness& openness) const
{
    std::vector<uint32_t> links(rays);
    std::vector<float> lengths(rays);
    Desc fewer = desc;
    fewer.rays = rays;
    twin::Gatherer text(*triangles, *field, *lights, fewer, gap, palette, straight, patches, links);
    text.lengths = lengths;
    text.outside = openness.outside;
    const auto got = text.gatherAt(point, normal, normal, sample, grazing);
    return {got.light,
            text.broughtTo(links, sent) + text.allBrought(got.ends),
            got.variance,
            got.room,
            got.reach,
            !text.knowsTooLittle(got.ends, got.asked),
            text.seenShare(point, normal, sample, links, grazing),
            text.openShare(openness.near),
            std::ranges::find(links, gpu::kLinkSky) == links.end()};
}

std::vector<uint32_t> TriangleGather::linksAt(vec3 point, vec3 normal, float grazing, uint32_t rays, glm::uvec2 sample) const
{
    std::vector<uint32_t> links(rays);
    Desc fewer = desc;
    fewer.rays = rays;
    twin::Gatherer text(*triangles, *field, *lights, fewer, gap, palette, straight, patches, links);
    text.gatherAt(point, normal, normal, sample, grazing);
    return links;
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
                        twin::Gatherer text(*triangles, *field, *lights, desc, gap, palette, straight, patches,
                                            std::span(found.links).subspan(index * desc.rays, desc.rays));
                        if (facing == 0) found.places[cell] = text.openPlace(at);
                        if (found.places[cell] == 0) return;
                        const vec3 axis = text.faceDirection(facing, vec3(0.0f, 0.0f, 1.0f));
                        const auto got = text.gatherAt(text.cellPlace(at, found.places[cell]), axis, axis, glm::uvec2(cell, facing), 0.0f);
                        if (!text.knowsTooLittle(got.ends, float(desc.rays))) found.straight[index] = got.light + text.allBrought(got.ends);
                    }
                });
    return found;
}

void TriangleGather::lightCells(const Cells& cells, const Sent& sent, std::span<uint32_t> words) const
{
    assert(words.size() == gpu::kCellWords * cells.places.size());
    parallelFor(cells.places.size(),
                [&](size_t cell)
                {
                    twin::Gatherer text(*triangles, *field, *lights, desc, gap, palette, straight, patches, {});
                    uint32_t* const own = &words[gpu::kCellWords * cell];
                    own[6] = cells.places[cell];
                    for (size_t facing = 0; facing < 6; ++facing)
                    {
                        const size_t index = 6 * cell + facing;
                        const std::span<const uint32_t> ends = std::span(cells.links).subspan(index * desc.rays, desc.rays);
                        own[facing] =
                            cells.straight[index].x < 0.0f ? 0u : text.packKnownLight(cells.straight[index] + text.broughtTo(ends, sent));
                    }
                });
}

} // namespace sconce
