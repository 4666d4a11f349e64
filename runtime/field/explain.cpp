#include "runtime/field/explain.h"

#include <algorithm>
#include <ranges>

#include <fmt/format.h>

#include "runtime/field/quality.h"
#include "runtime/field/tracer_cpu.h"

namespace sconce
{
namespace
{

using Twin = twin::LightFieldTwin<float>;
using glm::vec3;

Twin twinOf(const FieldData& field)
{
    return Twin(field, Quality{}.trace);
}

vec3 fieldPoint(const FieldData& field, vec3 world)
{
    return (world - field.info.origin) / field.info.scale;
}

/// How far along the way from a probe to a point (relative to it) the surface is that it sees there, metres; 0: it sees none before the
/// point.
float seenBefore(Twin& text, uint32_t probe, vec3 fromProbe)
{
    const float behind = glm::dot(text.planeSeen(probe, fromProbe), fromProbe);
    return behind > 1.0f ? glm::length(fromProbe) / behind * text.field.scale : 0.0f;
}

struct Asked
{
    AskedProbe told;
    float density = 0.0f; // surfaceDensity(): what lights first, and its weight
    Twin::SurfaceTaps taps{};
};

Asked ask(Twin& text, uint32_t probe, vec3 point, vec3 facing)
{
    Asked asked;
    const vec3 fromProbe = point - vec3(text.probeHeader(probe).centre);
    const float scale = text.field.scale, away = glm::length(fromProbe);
    asked.told.probe = probe;
    asked.told.distance = away * scale;
    asked.told.cosine = away > 0.0f ? -glm::dot(fromProbe, facing) / away : 0.0f;
    asked.density = text.surfaceDensity(probe, point, facing);
    if (!(asked.density > 0.0f)) return asked;
    if (!text.isSeenBy(probe, fromProbe, facing))
    {
        asked.told.verdict = Verdict::hidden;
        // The point that isSeenBy() asks about: a texel's width before the surface.
        asked.told.seen = seenBefore(text, probe, fromProbe + away * 2.0f / float(text.field.faceSize) * facing);
        return asked;
    }
    asked.taps = text.surfaceTaps(probe, fromProbe, facing);
    if (!(asked.taps.weight > Twin::kSurfaceLeast))
    {
        asked.told.verdict = Verdict::noTexel;
        return asked;
    }
    asked.told.verdict = Verdict::spare;
    asked.told.texel = asked.taps.width * scale;
    asked.told.light = asked.taps.light / asked.taps.weight;
    return asked;
}

/// Those of several that light a point: the two that see most of it, as surfaceLightSeen() chooses them.
void chooseLighting(std::vector<Asked>& asked)
{
    std::vector<Asked*> able;
    for (Asked& one : asked)
        if (one.told.verdict == Verdict::spare) able.push_back(&one);
    std::ranges::stable_sort(able, std::greater<>(), [](const Asked* one) { return one->density; });
    if (able.size() > size_t(Twin::kSurfaceProbes)) able.resize(size_t(Twin::kSurfaceProbes));
    float weights = 0.0f;
    for (const Asked* one : able) weights += one->density * one->taps.weight;
    for (Asked* one : able)
    {
        one->told.verdict = Verdict::lights;
        one->told.share = one->density * one->taps.weight / weights;
    }
}

/// Notes where and how a ray leaves the probe that it is in.
void end(RayStretch& stretch, Twin& text, const Twin::RayState& ray)
{
    stretch.to = ray.t * text.field.scale;
    if (ray.status == Twin::kHit && ray.surfel.probe == stretch.probe)
        stretch.end = StretchEnd::met;
    else if (ray.t >= ray.ray.tMax)
        stretch.end = StretchEnd::left;
    else // as far on as the next probe is looked for
    {
        const vec3 onward = text.pointAt(ray.ray, ray.t + text.lookAhead(0) * text.field.voxel);
        stretch.seen = seenBefore(text, stretch.probe, onward - vec3(text.probeHeader(stretch.probe).centre));
        stretch.end = stretch.seen > 0.0f ? StretchEnd::hidden : StretchEnd::unsure;
    }
}

} // namespace

std::string AskedProbe::sentence() const
{
    const std::string who = fmt::format("probe {}, {:.2f} m off", probe, distance);
    switch (verdict)
    {
    case Verdict::lights:
        return fmt::format("{}: {:.0f} % of the light, by texels {:.1f} cm wide", who, 100.0f * share, 100.0f * texel);
    case Verdict::spare:
        return fmt::format("{}: sees it by texels {:.1f} cm wide, but two others see more of it", who, 100.0f * texel);
    case Verdict::grazes:
        return cosine <= 0.0f ? fmt::format("{}: behind the surface", who)
                              : fmt::format("{}: sees the surface at {:.1f} degrees to it, too little to light it", who,
                                            90.0f - glm::degrees(std::acos(std::min(cosine, 1.0f))));
    case Verdict::hidden:
        return fmt::format("{}: a surface {:.2f} m from it hides the place", who, seen);
    case Verdict::noTexel:
        return fmt::format("{}: sees the place, but no texel of its surface light there is of this surface", who);
    }
    return who;
}

std::string ExplainedSurface::sentence() const
{
    switch (from)
    {
    case 2:
        return "two probes' texels of this surface";
    case 1:
        return "one probe's texels of this surface";
    case 0:
        return "the nearest texel of a like surface: no texel shows this place";
    case -1:
        return "the mean of what is gathered at hidden surfaces of this voxel and facing: no probe sees this place";
    case -2:
        return "the cells of light in the open: nothing is known of this surface";
    case -3:
        return "the probes' irradiance in the open, without emitters and sky: nothing is known of this surface";
    default:
        return "nothing";
    }
}

std::string RayStretch::sentence() const
{
    const std::string where = fmt::format("{:.2f} to {:.2f} m: probe {}{}", from, to, probe, opinion ? ", asked again about the hit" : "");
    switch (end)
    {
    case StretchEnd::met:
        return where + ", which sees what the ray meets there";
    case StretchEnd::hidden:
        return fmt::format("{}; behind that a surface {:.2f} m from it hides the ray", where, seen);
    case StretchEnd::left:
        return where + ", where the ray leaves the scene";
    case StretchEnd::unsure:
        return where + ", which can't tell what comes there";
    }
    return where;
}

ExplainedSurface explainSurface(const FieldData& field, vec3 point, vec3 normal, vec3 facing)
{
    ExplainedSurface result;
    if (field.surfaceLight.empty()) return result;
    Twin text = twinOf(field);
    const vec3 at = fieldPoint(field, point);
    const vec3 lookUp = at + 0.5f * field.info.voxel * facing;
    int reads = 0;
    const Twin::SurfaceLight light = text.surfaceLightAt(at, normal, facing, lookUp, reads);
    result.from = light.probes;
    result.light = light.light;
    const glm::uvec4 ranked = text.rankedProbesAt(lookUp, reads);
    std::vector<Asked> asked;
    for (int k = 0; k < Twin::kRanked; ++k)
        if (std::ranges::none_of(asked, [&](const Asked& one) { return one.told.probe == ranked[k]; }))
            asked.push_back(ask(text, ranked[k], at, facing));
    chooseLighting(asked);
    for (const Asked& one : asked) result.asked.push_back(one.told);

    std::vector<Asked> others;
    for (uint32_t probe = 0; probe < field.info.probeCount; ++probe)
    {
        if (std::ranges::any_of(asked, [&](const Asked& one) { return one.told.probe == probe; })) continue;
        Asked one = ask(text, probe, at, facing);
        if (one.told.verdict == Verdict::spare) others.push_back(std::move(one));
    }
    std::ranges::stable_sort(others, std::greater<>(), [](const Asked& one) { return one.density; });
    for (const Asked& one : others) result.others.push_back(one.told);
    return result;
}

ExplainedRay explainRay(const FieldData& field, const gpu::Ray& ray)
{
    ExplainedRay result;
    Twin text = twinOf(field);
    Twin::RayState state = text.startRay(fieldPoint(field, ray.origin), ray.direction, ray.normal);
    const int limit = text.turnLimit();
    for (int i = 0; i < limit && state.phase != Twin::kPhaseDone; ++i)
    {
        if (state.phase == Twin::kPhaseChoose)
        {
            const bool opinion = text.wantsOpinion(state);
            text.chooseProbe(state);
            if (state.phase == Twin::kPhaseDone) break;
            result.way.push_back({.probe = state.visit.probe, .from = state.segment.ta * field.info.scale, .opinion = opinion});
        }
        text.turn(state);
        if (state.phase == Twin::kPhaseChoose || state.phase == Twin::kPhaseDone) end(result.way.back(), text, state);
    }
    result.hit = text.answerOf(ray.origin, ray.direction, text.resultOf(state));
    return result;
}

std::vector<uint32_t> probesThatSee(const FieldData& field, vec3 point, vec3 facing)
{
    Twin text = twinOf(field);
    const vec3 at = fieldPoint(field, point);
    std::vector<std::pair<float, uint32_t>> found;
    for (uint32_t probe = 0; probe < field.info.probeCount; ++probe)
    {
        const vec3 fromProbe = at - vec3(field.probes[probe].centre);
        if (glm::dot(fromProbe, facing) < 0.0f && text.isSeenBy(probe, fromProbe, facing))
            found.emplace_back(glm::dot(fromProbe, fromProbe), probe);
    }
    std::ranges::sort(found);
    std::vector<uint32_t> probes;
    for (const auto& [distance, probe] : found) probes.push_back(probe);
    return probes;
}

} // namespace sconce
