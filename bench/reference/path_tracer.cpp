#include "bench/reference/path_tracer.h"

#include <algorithm>
#include <cmath>

namespace sconce
{
namespace
{

constexpr uint32_t kFirstRoulette = 6; // scatterings before paths may be ended at random

float largest(vec3 v)
{
    return std::max({v.x, v.y, v.z});
}
bool any(vec3 v)
{
    return v.x != 0.0f || v.y != 0.0f || v.z != 0.0f;
}

/// Veach and Guibas 1995, balance heuristic.
float balance(float own, float other)
{
    return own / (own + other);
}

/// Share of the samples that go to the specular lobe, by what the lobes reflect toward the viewer.
float specularShare(const BrdfLobes& lobes)
{
    const float specular = largest(specularColor(lobes)), diffuse = largest(lobes.diffuse);
    if (!(diffuse > 0.0f)) return 1.0f;
    return std::clamp(specular / (specular + diffuse), 0.1f, 0.9f);
}

} // namespace

PathTracer::PathTracer(const RayScene& scene_, std::optional<float> roughnessOverride, uint32_t bounceCount)
    : rays(scene_), scene(scene_.scene()), emitters(scene_.scene()), roughness(roughnessOverride), bounces(bounceCount)
{
}

ShadingPoint PathTracer::shade(const SurfaceHit& hit, vec3 view) const
{
    const SurfacePoint material = evaluateMaterial(scene, hit.material, hit.uv);
    ShadingPoint point;
    point.position = hit.position;
    const float side = glm::dot(hit.geometricNormal, view) < 0.0f ? -1.0f : 1.0f;
    point.geometricNormal = side * hit.geometricNormal;
    point.normal = side * hit.shadingNormal;
    if (!(glm::dot(point.normal, view) > 0.0f)) point.normal = point.geometricNormal;
    point.surface = {vec3(material.baseColor), material.metallic, roughness.value_or(material.roughness)};
    point.lobes = lobesAt(point.surface, glm::dot(point.normal, view));
    point.viewer = viewerOfLobes(point.normal, view, scene.materials[hit.material].retroreflective);
    point.emission = material.emission;
    return point;
}

BrdfValue PathTracer::reflect(const ShadingPoint& point, vec3 light) const
{
    if (!(glm::dot(point.geometricNormal, light) > 0.0f)) return {vec3(0.0f), vec3(0.0f)};
    BrdfValue value = evaluateLobes(point.lobes, point.surface.roughness, point.normal, point.viewer, light);
    const float cosine = std::max(glm::dot(point.normal, light), 0.0f);
    value.diffuse *= cosine;
    value.specular *= cosine;
    return value;
}

float PathTracer::scatterPdf(const ShadingPoint& point, vec3 light) const
{
    const float share = specularShare(point.lobes);
    const float diffuse = std::max(glm::dot(point.normal, light), 0.0f) / kBrdfPi;
    if (isMirror(point.surface.roughness)) return (1.0f - share) * diffuse;
    return share * visibleNormalPdf(point.normal, point.viewer, light, ggxAlpha(point.surface.roughness)) + (1.0f - share) * diffuse;
}

std::optional<PathTracer::Scatter> PathTracer::scatter(const ShadingPoint& point, Random& random) const
{
    const vec3 view = point.viewer;
    const float nv = glm::dot(point.normal, view);
    if (!(nv > 0.0f)) return std::nullopt;
    const float share = specularShare(point.lobes);
    const bool specular = random.uniform() < share;
    const vec2 u = random.uniform2();
    Scatter sample;
    if (specular && isMirror(point.surface.roughness))
    {
        sample.direction = glm::normalize(2.0f * nv * point.normal - view);
        if (!(glm::dot(sample.direction, point.geometricNormal) > 0.0f)) return std::nullopt;
        sample.specular = specularColor(point.lobes) / share;
        return sample;
    }
    const TangentFrame frame = tangentFrame(point.normal);
    if (specular)
    {
        const vec3 micro = toWorld(frame, sampleVisibleNormal(toTangent(frame, view), ggxAlpha(point.surface.roughness), u));
        sample.direction = glm::normalize(2.0f * glm::dot(view, micro) * micro - view);
    }
    else
        sample.direction = glm::normalize(toWorld(frame, sampleCosine(u)));
    sample.pdf = scatterPdf(point, sample.direction);
    if (!(sample.pdf > 0.0f)) return std::nullopt;
    const BrdfValue value = reflect(point, sample.direction);
    sample.diffuse = value.diffuse / sample.pdf;
    sample.specular = value.specular / sample.pdf;
    return sample;
}

vec3 PathTracer::punctual(const ShadingPoint& point, const Light& light) const
{
    vec3 toLight = -light.direction;
    float distance = std::numeric_limits<float>::infinity();
    float scale = 1.0f;
    if (light.type != LightType::directional)
    {
        toLight = light.position - point.position;
        distance = glm::length(toLight);
        if (!(distance > 0.0f)) return vec3(0.0f);
        toLight /= distance;
        scale = distanceAttenuation(distance, light.range);
        if (light.type == LightType::spot) scale *= spotAttenuation(-glm::dot(toLight, light.direction), light.innerCone, light.outerCone);
    }
    const BrdfValue value = reflect(point, toLight);
    const vec3 seen = (value.diffuse + value.specular) * light.intensity * scale;
    if (!any(seen) || rays.occluded(start(point), toLight, std::max(distance - 2.0f * rays.offset(), 0.0f))) return vec3(0.0f);
    return seen;
}

BrdfValue PathTracer::emitterLight(const ShadingPoint& point, Random& random) const
{
    BrdfValue none{vec3(0.0f), vec3(0.0f)};
    if (emitters.empty()) return none;
    const Emitters::Sample sample = emitters.draw(random);
    const vec3 origin = start(point);
    vec3 direction = sample.position - origin;
    const float distance = glm::length(direction);
    if (!(distance > 2.0f * rays.offset())) return none;
    direction /= distance;
    const float cosine = std::abs(glm::dot(geometricNormal(scene, sample.triangle), direction));
    if (!(cosine > 0.0f)) return none;
    const float pdf = sample.areaPdf * distance * distance / cosine;
    BrdfValue value = reflect(point, direction);
    if (!any(value.diffuse) && !any(value.specular)) return none;
    const vec3 emission = evaluateMaterial(scene, scene.triangleMaterial[sample.triangle], sample.uv).emission;
    if (!any(emission)) return none;
    // Seen when the first thing on the way is the drawn triangle itself, so that no epsilon can hide or reveal it, or one at its place that
    // doesn't shine itself: of two lamps at one place one is met, and only its draws count. What lies behind was met through a hole of it.
    const auto hit = rays.closest(origin, direction);
    const auto isAtItsPlace = [&]
    { return std::abs(hit->t - distance) <= 2.0f * rays.offset() && emitters.areaPdf(hit->triangle) == 0.0f; };
    if (!hit || (hit->triangle != sample.triangle && !isAtItsPlace())) return none;
    const float weight = balance(pdf, scatterPdf(point, direction)) / pdf;
    value.diffuse *= emission * weight;
    value.specular *= emission * weight;
    return value;
}

PathLight PathTracer::trace(vec3 origin, vec3 direction, vec3 textured, Random& random) const
{
    PathLight light;
    auto hit = rays.closest(origin, direction);
    if (!hit)
    {
        light.direct = scene.sky;
        return light;
    }
    if (textured != direction) hit = rays.texturedBy(*hit, origin, textured);
    ShadingPoint point = shade(*hit, -direction);
    // In full: no draw of an emitter stands for what the eye sees itself.
    light.direct = point.emission;
    for (const Light& source : scene.lights) light.direct += punctual(point, source);

    vec3 diffuse(1.0f), glossy(1.0f); // the path's weight by the lobe that passed it on at the first hit
    // The picture's own point, then one that a probe sees by direct light alone, then one more for every bounce of the bake: the reference
    // has the light that the field has.
    for (uint32_t vertex = 1; vertex <= bounces + 2; ++vertex)
    {
        // Beyond the first hit both lobes pass light on, and the first hit's lobe alone says to which term it counts.
        const BrdfValue emitted = emitterLight(point, random);
        const vec3 both = emitted.diffuse + emitted.specular;
        light.diffuse += diffuse * (vertex == 1 ? emitted.diffuse : both);
        light.glossy += glossy * (vertex == 1 ? emitted.specular : both);
        // One light, drawn at random, stands for all; at the first hit, which shows most, all were summed above.
        if (vertex > 1 && !scene.lights.empty())
        {
            const auto count = static_cast<uint32_t>(scene.lights.size());
            const vec3 seen = punctual(point, scene.lights[random.below(count)]) * static_cast<float>(count);
            light.diffuse += diffuse * seen;
            light.glossy += glossy * seen;
        }

        const auto next = scatter(point, random);
        if (!next) break;
        diffuse *= vertex == 1 ? next->diffuse : next->diffuse + next->specular;
        glossy *= vertex == 1 ? next->specular : next->diffuse + next->specular;
        // Russian roulette by the larger weight of the two lobes; dividing by the chance to go on keeps the mean.
        if (vertex >= kFirstRoulette)
        {
            const float keep = std::min(1.0f, std::max(largest(diffuse), largest(glossy)));
            if (random.uniform() >= keep) break;
            diffuse /= keep;
            glossy /= keep;
        }
        if (!any(diffuse) && !any(glossy)) break;

        const vec3 from = start(point);
        hit = rays.closest(from, next->direction);
        if (!hit)
        {
            // In full, since the sky is only ever met by chance and never drawn.
            light.diffuse += diffuse * scene.sky;
            light.glossy += glossy * scene.sky;
            break;
        }
        point = shade(*hit, -next->direction);
        if (any(point.emission))
        {
            // The same light as emitterLight() draws, found by chance: the balance heuristic shares it between the two. A mirror's ray has
            // no density (pdf 0), no draw of an emitter could have found it, and it counts in full.
            const float cosine = std::abs(glm::dot(hit->geometricNormal, next->direction));
            const float areaPdf = emitters.areaPdf(hit->triangle);
            float weight = 1.0f;
            if (next->pdf > 0.0f && areaPdf > 0.0f && cosine > 0.0f) weight = balance(next->pdf, areaPdf * hit->t * hit->t / cosine);
            light.diffuse += diffuse * point.emission * weight;
            light.glossy += glossy * point.emission * weight;
        }
    }
    return light;
}

} // namespace sconce
