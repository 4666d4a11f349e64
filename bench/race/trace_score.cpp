#include "bench/race/trace_score.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sconce
{
namespace
{

Spread spreadOf(std::vector<uint32_t> values)
{
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    double sum = 0.0;
    for (uint32_t v : values) sum += v;
    const auto rank = static_cast<size_t>(std::ceil(0.95 * static_cast<double>(values.size())));
    return {sum / static_cast<double>(values.size()), values[rank - 1], values.back()};
}

} // namespace

TraceVerdict judge(const RayTruth& truth, const TracedRay& traced, float diagonal)
{
    if (traced.status == TraceStatus::unknown) return TraceVerdict::unresolved;
    if (traced.status == TraceStatus::miss) return truth.hit ? TraceVerdict::leak : TraceVerdict::right;
    if (!std::isfinite(traced.t)) return TraceVerdict::unresolved;
    if (!truth.hit) return TraceVerdict::falseHit;
    const float beyond = traced.t - truth.t;
    if (std::abs(beyond) <= 0.01f * diagonal) return TraceVerdict::right;
    return beyond < 0.0f ? TraceVerdict::falseHit : TraceVerdict::leak;
}

TraceScore scoreTraces(const RaySet& set, std::span<const TracedRay> traced)
{
    assert(set.size() == traced.size());
    TraceScore score;
    score.rays = set.size();
    if (traced.empty()) return score;
    size_t verdicts[4]{}, exact = 0;
    std::vector<uint32_t> handoffs, distanceReads, indexReads;
    for (size_t i = 0; i < traced.size(); ++i)
    {
        const TraceVerdict verdict = judge(set.truth[i], traced[i], set.diagonal);
        ++verdicts[static_cast<size_t>(verdict)];
        if (verdict == TraceVerdict::right) exact += !set.truth[i].hit || std::abs(traced[i].t - set.truth[i].t) <= 0.002f * set.diagonal;
        handoffs.push_back(traced[i].handoffs);
        distanceReads.push_back(traced[i].distanceReads);
        indexReads.push_back(traced[i].indexReads);
    }
    const auto share = [&](size_t count) { return static_cast<double>(count) / static_cast<double>(traced.size()); };
    score.right1 = share(verdicts[0]);
    score.right02 = share(exact);
    score.falseHit = share(verdicts[1]);
    score.leak = share(verdicts[2]);
    score.unresolved = share(verdicts[3]);
    score.handoffs = spreadOf(std::move(handoffs));
    score.distanceReads = spreadOf(std::move(distanceReads));
    score.indexReads = spreadOf(std::move(indexReads));
    return score;
}

} // namespace sconce
