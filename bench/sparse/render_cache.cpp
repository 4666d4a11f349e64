#include "bench/sparse/render_cache.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace sconce
{
namespace
{

constexpr uint32_t kNone = ~0u;
constexpr float kBehind = 0.1f;         // relative difference of distance by which one point is behind another
constexpr float kOldest = 64.0f;        // frames: older counts alike
constexpr float kLeastPriority = 0.01f; // of a pixel whose point is new: a wish for it returns
constexpr float kHasty = 16.0f;         // frames: what points of before have aged by, at least, where light is seen to have changed
constexpr float kOther = 0.1f;          // relative difference of colours that is a change
constexpr int kAround = 3;              // pixels to each side that a change, and the mean in a gap, reaches
constexpr size_t kLooked = 8;           // slots looked at for the oldest

float difference(vec3 a, vec3 b)
{
    const vec3 off = glm::abs(a - b), of = glm::max(glm::max(a, b), vec3(0.01f));
    return std::max({off.x / of.x, off.y / of.y, off.z / of.z});
}

/// How much a new sample is wanted where the one that is shown is so old: the oldest by far the most.
float wishFor(float age)
{
    const float share = std::min(age / kOldest, 1.0f);
    return std::max(kLeastPriority, 0.5f * share * share);
}

/// Calls with each pixel within `reach` of one, itself among them.
template <class F> void around(int x, int y, int reach, const RenderCache::Desc& desc, F&& call)
{
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, int(desc.height) - 1); ++v)
        for (int u = std::max(x - reach, 0); u <= std::min(x + reach, int(desc.width) - 1); ++u)
            call(u, v, size_t(v) * desc.width + size_t(u));
}

} // namespace

RenderCache::RenderCache(const Desc& wanted) : desc(wanted)
{
    const size_t pixels = size_t(desc.width) * desc.height;
    points.resize(size_t(desc.points * float(pixels)));
    nearest.assign(pixels, kNone);
    depth.assign(pixels, 0.0f);
    shown.assign(pixels, vec3(0.0f));
    priority.assign(pixels, 1.0f);
}

void RenderCache::project(const Camera& camera)
{
    const Pinhole pinhole(camera, desc.width, desc.height);
    const vec3 right = pinhole.right / glm::dot(pinhole.right, pinhole.right), up = pinhole.up / glm::dot(pinhole.up, pinhole.up);
    std::ranges::fill(nearest, kNone);
    std::ranges::fill(depth, std::numeric_limits<float>::infinity());
    for (uint32_t i = 0; i < points.size(); ++i)
    {
        Point& point = points[i];
        if (point.age == kEmpty) continue;
        point.age += 1.0f;
        const vec3 way = point.position - pinhole.eye;
        const float along = glm::dot(way, pinhole.forward);
        if (!(along > 0.0f)) continue;
        const vec2 at = 0.5f * (vec2(glm::dot(way, right), -glm::dot(way, up)) / along + 1.0f) * vec2(desc.width, desc.height);
        if (!(at.x >= 0.0f && at.y >= 0.0f && at.x < float(desc.width) && at.y < float(desc.height))) continue;
        const size_t pixel = size_t(at.y) * desc.width + size_t(at.x);
        if (along < depth[pixel]) depth[pixel] = along, nearest[pixel] = i;
    }
    if (desc.culls) cull();
    interpolate();
}

/// Points between two that are nearer, on opposite sides: seen through gaps of a surface that has come nearer. (The paper's rule, being
/// farther than the mean of all about, takes what lies next to an outline away, too.)
void RenderCache::cull()
{
    std::vector<size_t> hidden;
    const auto isNearer = [&](int x, int y, float than)
    {
        if (x < 0 || y < 0 || x >= int(desc.width) || y >= int(desc.height)) return false;
        return (1.0f + kBehind) * depth[size_t(y) * desc.width + size_t(x)] < than; // infinite where there is none
    };
    for (int y = 0; y < int(desc.height); ++y)
        for (int x = 0; x < int(desc.width); ++x)
        {
            const size_t pixel = size_t(y) * desc.width + size_t(x);
            if (nearest[pixel] == kNone) continue;
            for (const glm::ivec2 step : {glm::ivec2(1, 0), glm::ivec2(0, 1), glm::ivec2(1, 1), glm::ivec2(1, -1)})
                if (isNearer(x + step.x, y + step.y, depth[pixel]) && isNearer(x - step.x, y - step.y, depth[pixel]))
                {
                    hidden.push_back(pixel);
                    break;
                }
        }
    for (const size_t pixel : hidden) nearest[pixel] = kNone;
}

vec3 RenderCache::between(int x, int y, int& known) const
{
    for (int reach = 1; reach <= kAround; ++reach)
    {
        vec3 sum(0.0f);
        float weights = 0.0f;
        known = 0;
        around(x, y, reach, desc,
               [&](int u, int v, size_t other)
               {
                   if (nearest[other] == kNone) return;
                   const float weight = 1.0f / float((u - x) * (u - x) + (v - y) * (v - y));
                   sum += weight * points[nearest[other]].colour;
                   weights += weight;
                   ++known;
               });
        if (weights > 0.0f) return sum / weights;
    }
    return shown[size_t(y) * desc.width + size_t(x)];
}

void RenderCache::interpolate()
{
    std::vector<vec3> picture(shown.size());
    for (int y = 0; y < int(desc.height); ++y)
        for (int x = 0; x < int(desc.width); ++x)
        {
            const size_t pixel = size_t(y) * desc.width + size_t(x);
            int known = 0;
            const bool own = nearest[pixel] != kNone;
            picture[pixel] = own ? points[nearest[pixel]].colour : between(x, y, known);
            priority[pixel] = own ? wishFor(points[nearest[pixel]].age) : 1.0f - 0.5f * float(std::min(known, 8)) / 8.0f;
        }
    shown = std::move(picture);
}

size_t RenderCache::holes() const
{
    return size_t(std::ranges::count(nearest, kNone));
}

size_t RenderCache::oldSlot()
{
    size_t oldest = hand;
    for (size_t i = 0; i < kLooked; ++i, hand = (hand + 1) % points.size())
    {
        if (points[hand].age == kEmpty) oldest = hand;
        if (points[oldest].age == kEmpty) break;
        if (points[hand].age > points[oldest].age) oldest = hand;
    }
    hand = (hand + 1) % points.size();
    return oldest;
}

void RenderCache::add(std::span<const uint32_t> pixels, std::span<const Point> samples)
{
    assert(pixels.size() == samples.size());
    struct Change
    {
        size_t pixel;
        vec3 before, after;
    };
    std::vector<Change> changes;
    for (size_t i = 0; i < pixels.size(); ++i)
    {
        const uint32_t before = nearest[pixels[i]];
        if (before != kNone && difference(points[before].colour, samples[i].colour) > kOther)
            changes.push_back({pixels[i], points[before].colour, samples[i].colour});
        const size_t slot = before != kNone ? before : oldSlot();
        points[slot] = samples[i];
        points[slot].age = 0.0f;
    }
    if (!desc.hastens) return;
    for (const Change& change : changes)
        around(int(change.pixel % desc.width), int(change.pixel / desc.width), kAround, desc,
               [&](int, int, size_t other)
               {
                   if (nearest[other] == kNone) return;
                   Point& point = points[nearest[other]];
                   // What is as it was before, and not as it is now, is of before.
                   if (difference(point.colour, change.before) < difference(point.colour, change.after))
                       point.age = std::max(point.age, kHasty);
               });
}

void RenderCache::replace(std::span<const Point> samples)
{
    points.assign(samples.begin(), samples.end());
    hand = 0;
}

} // namespace sconce
