#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "placement/skeleton.h"
#include "placement/view_targets.h"

namespace sconce
{

/// The worth of each candidate's view of each surfel.
struct ViewTable
{
    size_t surfels = 0;
    SurfelWeights weights;
    std::vector<uint8_t> values; // [candidates][surfels]

    size_t candidates() const { return surfels ? values.size() / surfels : 0; }
    uint64_t total() const { return weights.total(surfels); }
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
