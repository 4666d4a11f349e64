#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "placement/surface_samples.h"
#include "placement/visibility.h"

namespace sconce
{

/// What a view of a surfel is worth: 0 when it is not seen, else kSeen to kSeen + kBetter, growing with viewQuality. That a surfel is seen
/// at all is worth as much as kSeen / kBetter steps from the worst view to the best. Whole numbers, so that sums are the same in any order.
inline constexpr uint8_t kSeen = 249;
inline constexpr uint8_t kBetter = 6;

/// How many surfels of the scene one of a set stands for.
struct SurfelWeights
{
    size_t common = 0; // the first so many surfels have commonWeight, the others rareWeight
    uint32_t commonWeight = 1;
    uint32_t rareWeight = 1;

    uint32_t of(size_t surfel) const { return surfel < common ? commonWeight : rareWeight; }
    uint64_t total(size_t surfels) const { return uint64_t(common) * commonWeight + uint64_t(surfels - common) * rareWeight; }
};

/// How much the weighted sum of best values grows with one more row.
uint64_t gainOf(std::span<const uint8_t> row, const uint8_t* best, const SurfelWeights& weights = {});

/// Surfels laid out for many questions from probes: along a Morton curve, so that rays to neighbours are traced together.
struct ViewTargets
{
    std::vector<Surfel> surfels;
    std::vector<vec3> lifted; // positions off their surface by Visibility::epsilon()
    float spacing = 1.0f;     // metres, for viewQuality
    SurfelWeights weights;

    ViewTargets() = default;
    ViewTargets(const Visibility& visibility, std::vector<Surfel> samples, float spacing);
    /// The common ones first.
    ViewTargets(const Visibility& visibility, std::vector<Surfel> common, uint32_t commonWeight, std::vector<Surfel> rare,
                uint32_t rareWeight, float spacing);
    size_t size() const { return surfels.size(); }
    /// values[s] = what a probe's view of surfel s is worth where that is more than floor[s], else 0; no floor is one of zeros. Where a
    /// view can't exceed the floor no ray is cast.
    void rate(const Visibility& visibility, vec3 probe, std::span<uint8_t> values, std::span<const uint8_t> floor = {}) const;
};

/// How many probes see each surfel, counted up to `most`.
std::vector<uint8_t> countViews(const Visibility& visibility, std::span<const Surfel> surfels, std::span<const vec3> probes, float spacing,
                                uint8_t most);

/// Samples to judge sets of probes by that differ from a given one in few probes. Of the draws those that at most a probe or two see are
/// kept (what an exchange wins or loses), and a share of the rest with the weight of all: the same expectation as all draws give, from a
/// fraction of the views. Stratified sampling (Cochran 1977, "Sampling Techniques", chapter 5).
/// @param budget  about how many to keep of the common ones, and at most how many of the rare
/// @param unseen  out: draws that no probe sees
ViewTargets stratifiedTargets(const Visibility& visibility, const std::vector<Surfel>& draws, std::span<const vec3> probes, size_t budget,
                              float spacing, std::vector<Surfel>& unseen);

} // namespace sconce
