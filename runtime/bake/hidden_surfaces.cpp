#include "runtime/bake/hidden_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "base/random.h"
#include "runtime/field/tracer_cpu.h"
#include "scene/closed_parts.h"

namespace sconce
{
namespace
{

constexpr double kPointsOfVoxel = 8.0; // of a surface that is as large as a voxel's face
constexpr double kMostPoints = 4e6;    // voxels are larger where there were more
constexpr uint32_t kPlacesOfKey = 8;   // that are gathered at
constexpr uint32_t kTried = 32;        // that are asked, to find them
constexpr uint32_t kTriedStep = 13;    // from one to the next: coprime to them, so that all have their turn, and the first lie far apart
constexpr uint32_t kRaysOfPlace = 8;
constexpr uint32_t kRaysOfTried = 16;
constexpr float kTight = 0.5f;            // of a voxel: farther than this a ray goes far
constexpr float kWholly = 4.0f;           // times as much of what probes see before a place makes it count wholly
constexpr float kOpen = 0.5f;             // share of rays that must, of a place in a space of its own
constexpr size_t kMostKeysOfProbe = 1024; // voxels are larger where there were more
constexpr double kMostKeys = 2147483648.0;
constexpr uint64_t kHiddenStream = 19; // of random numbers

using Place = HiddenPlaces::Place;

struct Text : twin::LightFieldTwin<float>
{
    explicit Text(const FieldData& lit) : LightFieldTwin<float>(lit, {}) {}

    bool isHidden(vec3 point, vec3 normal)
    {
        int reads = 0;
        return surfaceLightSeen(point, normal, point + 0.5f * field.voxel * normal, reads).light.probes == 0;
    }
    uint32_t keyOf(vec3 point, vec3 normal) { return hiddenKey(glm::ivec3(glm::floor(hiddenPlace(point))), dominantFace(normal)); }
};

double areaOf(const Scene& scene, uint32_t triangle)
{
    const glm::uvec3 corner = scene.triangles[triangle];
    const vec3 a = scene.positions[corner.x];
    return 0.5 * double(glm::length(glm::cross(scene.positions[corner.y] - a, scene.positions[corner.z] - a)));
}

/// log2 of finest voxels a side, so that neither points nor keys are too many.
uint32_t voxelShift(const FieldData& lit, double area)
{
    uint32_t shift = 0;
    for (;; ++shift)
    {
        const double side = double(lit.info.voxel) * lit.info.scale * double(1u << shift);
        const glm::dvec3 count = glm::ceil(glm::dvec3(glm::ivec3(lit.info.topCells) << lit.info.topShift) / double(1u << shift));
        if (shift == 15 ||
            (kPointsOfVoxel * 2.0 * area / (side * side) < kMostPoints && 6.0 * count.x * count.y * count.z + 1.0 < kMostKeys))
            return shift;
    }
}

/// Places on surfaces that no texel shows.
std::vector<Place> hiddenPlaces(const FieldData& lit, const TriangleGather& triangles, std::span<const Outside> outside, double spacing)
{
    const Scene& scene = triangles.scene();
    std::vector<std::vector<Place>> found(outside.size());
    parallelFor(
        outside.size(),
        [&](size_t triangle)
        {
            Text text(lit);
            Random random(kHiddenStream, uint64_t(triangle));
            const glm::uvec3 corner = scene.triangles[triangle];
            const vec3 a = scene.positions[corner.x], ab = scene.positions[corner.y] - a, ac = scene.positions[corner.z] - a;
            const vec3 across = glm::cross(ab, ac);
            if (!(glm::length(across) > 0.0f)) return;
            const double wanted = areaOf(scene, uint32_t(triangle)) / (spacing * spacing);
            const auto count = uint64_t(wanted + double(random.uniform()));
            for (uint64_t i = 0; i < count; ++i)
            {
                vec2 share = random.uniform2();
                if (share.x + share.y > 1.0f) share = 1.0f - share;
                const auto uv = [&](uint32_t vertex) { return scene.uvs[vertex]; };
                const SurfacePoint look =
                    evaluateMaterial(scene, scene.triangleMaterial[triangle],
                                     uv(corner.x) + share.x * (uv(corner.y) - uv(corner.x)) + share.y * (uv(corner.z) - uv(corner.x)));
                const vec3 on = (a + share.x * ab + share.y * ac - lit.info.origin) / lit.info.scale;
                for (const Outside side : {Outside::front, Outside::back})
                {
                    if (outside[triangle] != Outside::both && outside[triangle] != side) continue;
                    const vec3 normal = glm::normalize(float(side) * across), point = on + triangles.offset() * normal;
                    if (text.keyOf(on, normal) != 0 && text.isHidden(on, normal))
                        found[triangle].push_back({0, point, normal, triangles.grazingOf(look.metallic, look.roughness), 0.0f, false});
                }
            }
        });
    std::vector<Place> places;
    for (const auto& some : found) places.insert(places.end(), some.begin(), some.end());
    return places;
}

/// Keys of places in voxels of info.hidden.
std::vector<uint32_t> keysOf(std::span<const Place> places, const FieldData& lit, float offset)
{
    constexpr size_t kAtOnce = 4096;
    std::vector<uint32_t> keys(places.size());
    parallelFor((places.size() + kAtOnce - 1) / kAtOnce,
                [&](size_t part)
                {
                    Text text(lit);
                    for (size_t i = part * kAtOnce; i < std::min(places.size(), (part + 1) * kAtOnce); ++i)
                        keys[i] = text.keyOf(places[i].point - offset * places[i].normal, places[i].normal);
                });
    return keys;
}

/// Puts the numbers of places in the order of the places' keys, those of one key as they are.
/// @param keys  of the places
/// @return      how many keys there are
size_t orderByKey(std::vector<uint32_t>& order, std::span<const uint32_t> keys)
{
    std::vector<uint64_t> sorted(order.size()); // a key, and where its place was: faster to sort than places
    for (size_t i = 0; i < order.size(); ++i) sorted[i] = uint64_t(keys[order[i]]) << 32 | i;
    std::ranges::sort(sorted);
    const std::vector<uint32_t> before = order;
    size_t count = 0;
    for (size_t i = 0; i < sorted.size(); ++i)
    {
        order[i] = before[uint32_t(sorted[i])];
        count += i == 0 || sorted[i] >> 32 != sorted[i - 1] >> 32;
    }
    return count;
}

/// Places in an order, with their keys, and where each key's begin and end.
void arrange(HiddenPlaces& of, std::span<const uint32_t> order, std::span<const uint32_t> keys)
{
    std::vector<Place> arranged;
    arranged.reserve(order.size());
    for (const uint32_t i : order)
    {
        if (arranged.empty() || arranged.back().key != keys[i]) of.keys.emplace_back(arranged.size(), 0);
        arranged.push_back(of.places[i]);
        arranged.back().key = keys[i];
        of.keys.back().second = arranged.size();
    }
    of.places = std::move(arranged);
}

/// Mean light at some places of one key; 0 where what sees them no probe sees either, unless they are enclosed: the far
/// side of an outer wall.
uint32_t lightOf(std::span<const Place> places, Text& text, const TriangleGather& triangles, const TriangleGather::Sent& sent)
{
    vec3 sum(0.0f);
    float weights = 0.0f;
    bool seen = false, enclosed = true;
    for (uint32_t i = 0; i < places.size(); ++i)
    {
        const Place& place = places[i];
        // By other rays than those that told its weight: the same would favour what happens to be bright.
        const auto got = triangles.gatherAt(place.point, place.normal, place.grazing, kRaysOfPlace, {place.key, i}, sent);
        if (!got.known) continue;
        sum += place.weight * (got.straight + got.bounced);
        weights += place.weight;
        seen = seen || place.seen || got.seen > 0.0f;
        enclosed = enclosed && got.enclosed;
    }
    return weights > 0.0f && (seen || enclosed) ? text.packKnownLight(sum / weights) : 0;
}

/// Whether a place would be lit by what is known beside hidden surfaces: that of the open, which may be beyond a wall.
bool isLitWithout(const FieldData& lit, const Place& place, float offset)
{
    Text text(lit);
    const vec3 on = place.point - offset * place.normal;
    int reads = 0;
    return Text::luminance(text.surfaceLightAt(on, place.normal, place.normal, on + 0.5f * lit.info.voxel * place.normal, reads).light) >
           0.0f;
}

/// The table, of few slots in which every key is found. A key goes before those that are nearer to where their search begins (Celis 1986,
/// "Robin Hood Hashing"): in the order that they come they need twice the slots.
std::vector<uint32_t> tableOf(std::span<const uint32_t> keys, std::span<const uint32_t> light)
{
    for (size_t slots = keys.size() + keys.size() / 2 + 1;; slots += slots / 8 + 1)
    {
        std::vector<uint32_t> table(2 * slots);
        const auto put = [&](size_t i)
        {
            std::array<uint32_t, 2> entry{keys[i], light[i]};
            size_t at = Text::hiddenSlot(entry[0], uint32_t(slots));
            for (size_t turn = 0; turn < size_t(gpu::kHiddenTries); ++turn, at = (at + 1) % slots)
            {
                uint32_t* const slot = &table[2 * at];
                const bool empty = slot[0] == 0;
                const size_t turnThere = empty ? 0 : (at + slots - Text::hiddenSlot(slot[0], uint32_t(slots))) % slots;
                if (!empty && turnThere >= turn) continue;
                std::swap_ranges(entry.begin(), entry.end(), slot);
                if (empty) return true;
                turn = turnThere;
            }
            return false;
        };
        size_t done = 0;
        while (done < keys.size() && put(done)) ++done;
        if (done == keys.size()) return table;
    }
}

/// Of one key's places, of some all over the voxel, at most kPlacesOfKey: those before which something lies that a probe sees, and those in
/// spaces of their own, as a dark room beside a lit one. Nobody looks at what is sealed up, in a moulding or between two layers of a wall,
/// or within what stands in one another.
std::vector<Place> chosenOf(std::span<const Place> places, const TriangleGather& triangles, const TriangleGather::Sent& sent,
                            const TriangleGather::Openness& openness)
{
    std::vector<Place> chosen;
    const size_t tried = std::min<size_t>(places.size(), kTried);
    for (uint32_t turn = 0; turn < kTried && chosen.size() < kPlacesOfKey; ++turn)
    {
        const uint32_t i = (turn * kTriedStep) % kTried; // far from those before it
        if (i >= tried) continue;
        const Place& place = places[i * places.size() / tried];
        const auto got =
            triangles.gatherAt(place.point, place.normal, place.grazing, kRaysOfTried, {place.key, kPlacesOfKey + i}, sent, openness);
        if (!got.known || !(got.seen > 0.0f || got.open > kOpen)) continue;
        chosen.push_back(place);
        chosen.back().weight = got.open > kOpen ? 1.0f : std::min(kWholly * got.seen, 1.0f);
        chosen.back().seen = got.seen > 0.0f;
    }
    return chosen;
}

void choosePlaces(HiddenPlaces& of, const FieldData& lit, const TriangleGather& triangles, const TriangleGather::Sent& sent,
                  std::span<const Outside> outside)
{
    const TriangleGather::Openness openness{kTight * lit.info.voxel * float(1u << of.shift), outside};
    std::vector<std::vector<Place>> chosen(of.keys.size());
    parallelFor(chosen.size(),
                [&](size_t i)
                {
                    const auto [first, end] = of.keys[i];
                    chosen[i] = chosenOf(std::span(of.places).subspan(first, end - first), triangles, sent, openness);
                });
    of.places.clear();
    of.keys.clear();
    for (const std::vector<Place>& some : chosen)
    {
        if (some.empty()) continue;
        of.keys.emplace_back(of.places.size(), of.places.size() + some.size());
        of.places.insert(of.places.end(), some.begin(), some.end());
    }
}

/// The places that light is gathered at, and how large the voxels of their keys are.
HiddenPlaces findPlaces(FieldData& lit, const TriangleGather& triangles, const TriangleGather::Sent& sent)
{
    const Scene& scene = triangles.scene();
    double area = 0.0;
    for (uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle) area += areaOf(scene, triangle);
    const uint32_t shift = voxelShift(lit, area);
    lit.info.hidden = shift; // keys are of these voxels; there is no table yet
    const double side = double(lit.info.voxel) * lit.info.scale * double(1u << shift);
    HiddenPlaces found;
    std::vector<uint32_t> all(scene.triangles.size());
    std::iota(all.begin(), all.end(), 0u);
    const std::vector<Outside> outside = outsideOf(scene, all);
    found.places = hiddenPlaces(lit, triangles, outside, side / std::sqrt(kPointsOfVoxel));
    // From fine voxels to coarse ones: places of one voxel keep the order of the finer ones, so that few of them lie all over it.
    std::vector<uint32_t> order(found.places.size()), keys;
    std::iota(order.begin(), order.end(), 0u);
    for (;; ++lit.info.hidden)
    {
        keys = keysOf(found.places, lit, triangles.offset());
        if (orderByKey(order, keys) <= kMostKeysOfProbe * lit.info.probeCount || lit.info.hidden + 1 == 1u << gpu::kHiddenShiftBits) break;
    }
    arrange(found, order, keys);
    found.shift = std::exchange(lit.info.hidden, 0u); // that look-ups do without
    choosePlaces(found, lit, triangles, sent, outside);
    return found;
}

/// Light of each key; 0: not known.
std::vector<uint32_t> lightOfKeys(const FieldData& lit, const HiddenPlaces& of, const TriangleGather& triangles,
                                  const TriangleGather::Sent& sent)
{
    std::vector<uint32_t> found(of.keys.size());
    parallelFor(found.size(),
                [&](size_t i)
                {
                    Text text(lit);
                    const auto [first, end] = of.keys[i];
                    found[i] = lightOf(std::span(of.places).subspan(first, end - first), text, triangles, sent);
                });
    return found;
}

/// Keeps the keys that a table needs.
void dropNeedless(const FieldData& lit, HiddenPlaces& of, std::vector<uint32_t>& light, float offset)
{
    parallelFor(light.size(),
                [&](size_t i)
                {
                    if (light[i] == Text::kBlackWord && !isLitWithout(lit, of.places[of.keys[i].first], offset)) light[i] = 0;
                });
    size_t kept = 0;
    for (size_t i = 0; i < light.size(); ++i)
        if (light[i] != 0) of.keys[kept] = of.keys[i], light[kept++] = light[i];
    of.keys.resize(kept);
    light.resize(kept);
}

} // namespace

void lightHiddenSurfaces(FieldData& lit, const TriangleGather& triangles, const TriangleGather::Sent& sent,
                         std::optional<HiddenPlaces>* places)
{
    std::optional<HiddenPlaces> own;
    std::optional<HiddenPlaces>& of = places ? *places : own;
    const bool known = of.has_value();
    if (!known) of = findPlaces(lit, triangles, sent);
    std::vector<uint32_t> light = lightOfKeys(lit, *of, triangles, sent);
    if (known)
        std::ranges::replace(light, 0u, Text::kBlackWord); // in the light that found the places there is some
    else
        dropNeedless(lit, *of, light, triangles.offset());
    if (light.empty()) return;
    std::vector<uint32_t> keys;
    for (const auto& [first, end] : of->keys) keys.push_back(of->places[first].key);
    const std::vector<uint32_t> table = tableOf(keys, light);
    lit.info.hidden = of->shift | uint32_t(table.size() / 2) << gpu::kHiddenShiftBits;
    lit.surfaceLight.insert(lit.surfaceLight.end(), table.begin(), table.end());
}

std::vector<HiddenLinks> hiddenLinks(const FieldData& lit, const HiddenPlaces& of, const TriangleGather& triangles, uint32_t count)
{
    const size_t slots = lit.info.hidden >> gpu::kHiddenShiftBits, table = lit.surfaceLight.size() - hiddenWords(lit.info);
    std::vector<HiddenLinks> all(of.keys.size());
    parallelFor(all.size(),
                [&](size_t i)
                {
                    const auto [first, end] = of.keys[i];
                    const uint32_t key = of.places[first].key;
                    size_t slot = Text::hiddenSlot(key, uint32_t(slots));
                    while (lit.surfaceLight[table + 2 * slot] != key) slot = (slot + 1) % slots;
                    all[i].word = uint32_t(table + 2 * slot + 1);
                    float total = 0.0f, passed = 0.0f;
                    for (size_t k = first; k < end; ++k) total += of.places[k].weight;
                    for (size_t k = first; k < end; ++k)
                    {
                        const Place& place = of.places[k];
                        const auto before = uint32_t(float(count) * passed / total);
                        passed += place.weight;
                        const uint32_t own = (k + 1 == end ? count : uint32_t(float(count) * passed / total)) - before;
                        if (own == 0) continue;
                        const auto links = triangles.linksAt(place.point, place.normal, place.grazing, own, glm::uvec2(key, k - first));
                        all[i].links.insert(all[i].links.end(), links.begin(), links.end());
                    }
                });
    return all;
}

} // namespace sconce
