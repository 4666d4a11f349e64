#include "bench/race/ray_sets.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "base/random.h"
#include "bench/opponents/baselines.h"
#include "shaders/shared/brdf.h"

namespace sconce
{
namespace
{

constexpr int kTries = 1000; // per ray, before the viewpoints count as blind

struct Ray
{
    vec3 origin;
    vec3 direction;
    uint64_t place; // in the order of the viewpoints' pictures
};

/// The place of a point of the unit square along the Z-order curve of 2^16 x 2^16 cells.
uint64_t zOrder(vec2 u)
{
    uint64_t code = 0;
    const auto x = static_cast<uint64_t>(u.x * 65536.0f), y = static_cast<uint64_t>(u.y * 65536.0f);
    for (int bit = 0; bit < 16; ++bit) code |= ((x >> bit & 1u) << (2 * bit)) | ((y >> bit & 1u) << (2 * bit + 1));
    return code;
}

vec3 uniformDirection(vec2 u)
{
    const float z = 1.0f - 2.0f * u.x;
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return {r * std::cos(2.0f * kBrdfPi * u.y), r * std::sin(2.0f * kBrdfPi * u.y), z};
}

Ray viewRay(std::span<const Camera> cameras, std::span<const vec3> points, Random& random)
{
    const uint32_t pick = random.below(static_cast<uint32_t>(cameras.size() + points.size()));
    const vec2 u = random.uniform2();
    const uint64_t place = static_cast<uint64_t>(pick) << 32 | zOrder(u);
    if (pick >= cameras.size()) return {points[pick - cameras.size()], uniformDirection(u), place};
    const Camera& camera = cameras[pick];
    const float half = std::tan(0.5f * camera.verticalFov);
    const vec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
    const vec3 up = glm::normalize(glm::cross(right, camera.forward));
    return {camera.eye, glm::normalize(glm::normalize(camera.forward) + half * ((2.0f * u.x - 1.0f) * right + (2.0f * u.y - 1.0f) * up)),
            place};
}

RayTruth truthOf(const RayScene& rays, vec3 origin, vec3 direction)
{
    const auto hit = rays.closest(origin, direction);
    if (!hit) return {};
    const float side = glm::dot(hit->geometricNormal, direction) > 0.0f ? -1.0f : 1.0f;
    return {true, hit->t, hit->position, side * hit->geometricNormal, hit->triangle};
}

RaySet emptySet(const RayScene& rays, size_t count)
{
    RaySet set;
    set.origins.resize(count);
    set.directions.resize(count);
    set.normals.resize(count, vec3(0.0f));
    set.startCosine.resize(count, 1.0f);
    set.truth.resize(count);
    set.fartherTruth.resize(count);
    const Bounds bounds = rays.scene().bounds();
    set.diagonal = bounds.empty() ? 0.0f : bounds.diagonal();
    return set;
}

template <class T> std::vector<T> inOrder(const std::vector<T>& values, std::span<const uint32_t> order)
{
    std::vector<T> sorted;
    sorted.reserve(values.size());
    for (uint32_t i : order) sorted.push_back(values[i]);
    return sorted;
}

void sortByPlace(RaySet& set, const std::vector<uint64_t>& places)
{
    std::vector<uint32_t> order(places.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](uint32_t i) { return places[i]; });
    set.origins = inOrder(set.origins, order);
    set.directions = inOrder(set.directions, order);
    set.normals = inOrder(set.normals, order);
    set.startCosine = inOrder(set.startCosine, order);
    for (uint32_t i : order) set.viewpoints.push_back(uint32_t(places[i] >> 32));
    set.truth = inOrder(set.truth, order);
    set.fartherTruth = inOrder(set.fartherTruth, order);
}

} // namespace

Result<RaySet> glossyRays(const RayScene& rays, std::span<const Camera> cameras, std::span<const vec3> points,
                          const GlossyRaySettings& settings)
{
    if (cameras.empty() && points.empty())
        return Error{ErrorCode::badArgument, "glossy rays need a viewpoint; give a camera or an interior point"};
    if (!(settings.alphaLow >= 1e-3f && settings.alphaLow <= settings.alphaHigh && settings.alphaHigh <= 1.0f))
        return Error{ErrorCode::badArgument, fmt::format("glossy rays' alpha range is {:f} to {:f}; choose 0.001 <= low <= high <= 1",
                                                         settings.alphaLow, settings.alphaHigh)};
    RaySet set = emptySet(rays, settings.count);
    std::vector<uint64_t> places(settings.count);
    std::atomic<bool> blind{false};
    tbb::parallel_for(uint32_t(0), settings.count,
                      [&](uint32_t i)
                      {
                          // A hint to stop early, no more: it orders nothing, and the answer is read after all threads are done.
                          if (blind.load(std::memory_order_relaxed)) return;
                          Random random(settings.seed, i, 0);
                          for (int attempt = 0; attempt < kTries; ++attempt)
                          {
                              const Ray view = viewRay(cameras, points, random);
                              const float alpha = std::lerp(settings.alphaLow, settings.alphaHigh, random.uniform());
                              const vec2 u = random.uniform2();
                              const auto seen = rays.closest(view.origin, view.direction);
                              if (!seen) continue;
                              const vec3 back = -view.direction;
                              const float side = glm::dot(seen->geometricNormal, back) < 0.0f ? -1.0f : 1.0f;
                              const vec3 geometric = side * seen->geometricNormal;
                              vec3 normal = side * seen->shadingNormal;
                              if (!(glm::dot(normal, back) > 0.0f)) normal = geometric;
                              const TangentFrame frame = tangentFrame(normal);
                              const vec3 micro = toWorld(frame, sampleVisibleNormal(toTangent(frame, back), alpha, u));
                              const vec3 direction = glm::normalize(2.0f * glm::dot(back, micro) * micro - back);
                              const float cosine = glm::dot(direction, geometric);
                              if (!(cosine > 0.0f) || !(glm::dot(direction, normal) > 0.0f)) continue;
                              places[i] = view.place;
                              set.origins[i] = seen->position + 1e-4f * set.diagonal * geometric;
                              set.directions[i] = direction;
                              set.normals[i] = geometric;
                              set.startCosine[i] = cosine;
                              set.truth[i] = truthOf(rays, set.origins[i], direction);
                              set.fartherTruth[i] = truthOf(rays, set.origins[i] + kFartherStart * geometric, direction);
                              return;
                          }
                          blind.store(true);
                      });
    if (blind.load())
        return Error{ErrorCode::badInput,
                     fmt::format("the viewpoints of scene '{}' see no surface in {} tries; give a camera or point that looks at the scene",
                                 rays.scene().name, kTries)};
    sortByPlace(set, places);
    return set;
}

RaySet raySetFrom(const RayScene& rays, std::span<const vec3> origins, std::span<const vec3> directions)
{
    assert(origins.size() == directions.size());
    RaySet set = emptySet(rays, origins.size());
    tbb::parallel_for(size_t(0), origins.size(),
                      [&](size_t i)
                      {
                          set.origins[i] = origins[i];
                          set.directions[i] = directions[i];
                          set.truth[i] = set.fartherTruth[i] = truthOf(rays, origins[i], directions[i]); // no normal to start off along
                      });
    return set;
}

} // namespace sconce
