#include "placement/select.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include <tbb/parallel_for.h>

namespace sconce
{
namespace
{

void raise(std::vector<uint8_t>& best, std::span<const uint8_t> row)
{
    for (size_t s = 0; s < row.size(); ++s) best[s] = std::max(best[s], row[s]);
}

uint64_t newlySeen(std::span<const uint8_t> row, const std::vector<uint8_t>& best, const SurfelWeights& weights)
{
    uint64_t common = 0, rare = 0;
    for (size_t s = 0; s < weights.common; ++s) common += row[s] != 0 && best[s] == 0;
    for (size_t s = weights.common; s < row.size(); ++s) rare += row[s] != 0 && best[s] == 0;
    return common * weights.commonWeight + rare * weights.rareWeight;
}

/// A candidate and an upper bound of its gain: gains only fall as more is chosen (Minoux 1978, lazy evaluation).
struct Bound
{
    uint64_t gain;
    uint32_t candidate;
    bool operator<(const Bound& other) const { return gain != other.gain ? gain < other.gain : candidate > other.candidate; }
};

} // namespace

Status extendTable(ViewTable& table, const Visibility& visibility, const ViewTargets& targets, std::span<const Candidate> candidates,
                   const Progress& progress)
{
    table.surfels = targets.size();
    table.weights = targets.weights;
    const size_t held = table.candidates();
    table.values.resize(candidates.size() * targets.size());
    constexpr size_t kChunk = 128; // candidates between two reports
    for (size_t first = held; first < candidates.size(); first += kChunk)
    {
        if (!report(progress, "visibility", double(first) / double(candidates.size())))
            return Error{ErrorCode::cancelled, "The choice of probes was cancelled."};
        tbb::parallel_for(first, std::min(first + kChunk, candidates.size()),
                          [&](size_t candidate)
                          {
                              uint8_t* row = table.values.data() + candidate * targets.size();
                              targets.rate(visibility, candidates[candidate].position, {row, targets.size()});
                          });
    }
    return success();
}

std::vector<uint32_t> chooseGreedily(const ViewTable& table, size_t count, float coverage, size_t fixed)
{
    const size_t wanted = count ? std::min(count, table.candidates()) : table.candidates();
    const auto enough = uint64_t(std::ceil(double(coverage) * double(table.total())));
    std::vector<uint8_t> best(table.surfels, 0);
    std::vector<uint32_t> chosen;
    uint64_t seen = 0;
    size_t barren = 0; // barren: choices in a row that saw nothing new
    for (uint32_t candidate = 0; candidate < fixed; ++candidate)
    {
        seen += newlySeen(table.row(candidate), best, table.weights);
        raise(best, table.row(candidate));
        chosen.push_back(candidate);
    }
    std::vector<Bound> bounds(table.candidates() - fixed);
    tbb::parallel_for(size_t(0), bounds.size(),
                      [&](size_t i) {
                          bounds[i] = {gainOf(table.row(fixed + i), best.data(), table.weights), uint32_t(fixed + i)};
                      });
    std::priority_queue<Bound> queue(std::less<Bound>(), std::move(bounds));
    while (chosen.size() < wanted && !queue.empty() && (count || (seen < enough && barren < 16)))
    {
        Bound top = queue.top();
        queue.pop();
        const uint64_t gain = gainOf(table.row(top.candidate), best.data(), table.weights);
        // Its gain has fallen below another's bound since it was reckoned: it waits with what it is now.
        if (!queue.empty() && Bound{gain, top.candidate} < queue.top())
        {
            queue.push({gain, top.candidate});
            continue;
        }
        const uint64_t fresh = newlySeen(table.row(top.candidate), best, table.weights);
        seen += fresh;
        barren = fresh ? 0 : barren + 1;
        raise(best, table.row(top.candidate));
        chosen.push_back(top.candidate);
    }
    // The barren ones at the end only see better what is seen: a coverage doesn't need them.
    if (!count) chosen.resize(chosen.size() - std::min(barren, chosen.size()));
    return chosen;
}

std::vector<uint8_t> bestValues(const ViewTable& table, std::span<const uint32_t> chosen)
{
    std::vector<uint8_t> best(table.surfels, 0);
    for (uint32_t candidate : chosen) raise(best, table.row(candidate));
    return best;
}

void improveByExchange(const ViewTable& table, std::vector<uint32_t>& chosen, int rounds, size_t fixed)
{
    std::vector<uint64_t> gains(table.candidates());
    for (int round = 0; round < rounds; ++round)
    {
        bool improved = false;
        // The best value of each surfel without slot k: prefix over the slots before it and suffix over those after it.
        std::vector<uint8_t> before(table.surfels, 0);
        std::vector<std::vector<uint8_t>> after(chosen.size() + 1, std::vector<uint8_t>(table.surfels, 0));
        for (size_t k = chosen.size(); k-- > 0;)
        {
            after[k] = after[k + 1];
            raise(after[k], table.row(chosen[k]));
        }
        for (size_t k = 0; k < chosen.size(); ++k)
        {
            if (chosen[k] < fixed)
            {
                raise(before, table.row(chosen[k]));
                continue;
            }
            std::vector<uint8_t> without = before;
            raise(without, after[k + 1]);
            tbb::parallel_for(size_t(0), gains.size(), [&](size_t c) { gains[c] = gainOf(table.row(c), without.data(), table.weights); });
            const size_t best = size_t(std::max_element(gains.begin(), gains.end()) - gains.begin());
            if (gains[best] > gains[chosen[k]])
            {
                chosen[k] = uint32_t(best);
                improved = true;
            }
            raise(before, table.row(chosen[k]));
        }
        if (!improved) return;
    }
}

void pruneNeedless(const ViewTable& table, std::vector<uint32_t>& chosen, size_t fixed)
{
    std::vector<uint32_t> seenBy(table.surfels, 0);
    std::vector<std::pair<size_t, size_t>> bySight; // surfels seen, slot
    for (size_t k = 0; k < chosen.size(); ++k)
    {
        size_t seen = 0;
        const auto row = table.row(chosen[k]);
        for (size_t s = 0; s < row.size(); ++s) seenBy[s] += row[s] != 0, seen += row[s] != 0;
        bySight.emplace_back(seen, k);
    }
    std::sort(bySight.begin(), bySight.end());
    std::vector<uint8_t> needless(chosen.size(), 0);
    for (const auto& [seen, k] : bySight)
    {
        const auto row = table.row(chosen[k]);
        bool alone = chosen[k] < fixed;
        for (size_t s = 0; s < row.size() && !alone; ++s) alone = row[s] != 0 && seenBy[s] == 1;
        if (alone) continue;
        needless[k] = 1;
        for (size_t s = 0; s < row.size(); ++s) seenBy[s] -= row[s] != 0;
    }
    size_t kept = 0;
    for (size_t k = 0; k < chosen.size(); ++k)
        if (!needless[k]) chosen[kept++] = chosen[k];
    chosen.resize(kept);
}

std::vector<float> orderByGain(const ViewTable& table, std::vector<uint32_t>& chosen)
{
    std::vector<uint8_t> best(table.surfels, 0);
    std::vector<float> shares;
    for (size_t k = 0; k < chosen.size(); ++k)
    {
        size_t pick = k;
        uint64_t most = 0;
        for (size_t other = k; other < chosen.size(); ++other)
        {
            const uint64_t fresh = newlySeen(table.row(chosen[other]), best, table.weights);
            if (fresh > most) most = fresh, pick = other;
        }
        std::rotate(chosen.begin() + ptrdiff_t(k), chosen.begin() + ptrdiff_t(pick), chosen.begin() + ptrdiff_t(pick) + 1);
        raise(best, table.row(chosen[k]));
        shares.push_back(table.surfels ? float(double(most) / double(table.total())) : 0.0f);
        if (most == 0) // nothing new from any of the rest: their order stays
        {
            shares.resize(chosen.size(), 0.0f);
            break;
        }
    }
    return shares;
}

std::vector<float> sharesAlone(const ViewTable& table, std::span<const uint32_t> chosen)
{
    std::vector<uint32_t> seenBy(table.surfels, 0);
    for (uint32_t candidate : chosen)
        for (size_t s = 0; s < table.surfels; ++s) seenBy[s] += table.row(candidate)[s] != 0;
    std::vector<float> shares;
    for (uint32_t candidate : chosen)
    {
        uint64_t alone = 0;
        for (size_t s = 0; s < table.surfels; ++s)
            if (table.row(candidate)[s] != 0 && seenBy[s] == 1) alone += table.weights.of(s);
        shares.push_back(table.surfels ? float(double(alone) / double(table.total())) : 0.0f);
    }
    return shares;
}

} // namespace sconce
