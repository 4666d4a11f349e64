#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "placement/skeleton.h"
#include "placement/surface_samples.h"
#include "scene/progress.h"
#include "scene/result.h"

namespace sconce
{

/// What a view of a surfel is worth: 0 when it is not seen, else kSeen + kBetter * viewQuality. That a surfel is seen at all is worth as
/// much as ten steps from the worst view to the best. Whole numbers, so that sums are the same in any order.
inline constexpr uint8_t kSeen = 232;
inline constexpr uint8_t kBetter = 23;

/// Surfels laid out for many questions from probes: along a Morton curve, so that rays to neighbours are traced together.
struct ViewTargets
{
    std::vector<Surfel> surfels;
    std::vector<vec3> lifted; // positions off their surface by Visibility::epsilon()
    float spacing = 1.0f;     // metres, for viewQuality

    ViewTargets() = default;
    ViewTargets(const Visibility& visibility, std::vector<Surfel> samples, float spacing);
    size_t size() const { return surfels.size(); }
    /// values[s] = what a probe's view of surfel s is worth.
    void rate(const Visibility& visibility, vec3 probe, std::span<uint8_t> values) const;
};

/// How much the sum of best values grows with one more row.
uint64_t gainOf(std::span<const uint8_t> row, const uint8_t* best);

/// The worth of each candidate's view of each surfel.
struct ViewTable
{
    size_t surfels = 0;
    std::vector<uint8_t> values; // [candidates][surfels]

    size_t candidates() const { return surfels ? values.size() / surfels : 0; }
    std::span<const uint8_t> row(size_t candidate) const { return {values.data() + candidate * surfels, surfels}; }
};

/// Adds the rows of the candidates that the table does not hold yet. Errors: cancelled.
Status extendTable(ViewTable& table, const Visibility& visibility, const ViewTargets& targets, std::span<const Candidate> candidates,
                   const Progress& progress);

/// Greedy cover (Nemhauser, Wolsey, Fisher 1978: within 1 - 1/e of the best): each next candidate adds most to the sum over surfels of the
/// best value so far. What is already seen can still gain quality, so probes beyond full coverage go where points are seen badly.
/// @param count  how many to choose; 0: until `coverage` of the surfels is seen, or no candidate sees another
/// @param fixed  the first so many candidates are chosen whatever they see, here and below
std::vector<uint32_t> chooseGreedily(const ViewTable& table, size_t count, float coverage, size_t fixed = 0);

/// Exchange (Teitz and Bart 1968): replaces a chosen candidate by a better one while that gains, at most `rounds` times through.
void improveByExchange(const ViewTable& table, std::vector<uint32_t>& chosen, int rounds, size_t fixed = 0);

/// Drops chosen candidates, least worth first, that see nothing which the others don't see.
void pruneNeedless(const ViewTable& table, std::vector<uint32_t>& chosen, size_t fixed = 0);

/// Sorts the chosen so that each next one sees most surfels that the earlier do not, and says which share that is.
std::vector<float> orderByGain(const ViewTable& table, std::vector<uint32_t>& chosen);

/// Share of the surfels that each chosen candidate alone sees.
std::vector<float> sharesAlone(const ViewTable& table, std::span<const uint32_t> chosen);

/// Best value of each surfel over the chosen candidates.
std::vector<uint8_t> bestValues(const ViewTable& table, std::span<const uint32_t> chosen);

} // namespace sconce
