#include "bench/race/trace_score.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

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

/// Standard error of a share of rays whose viewpoints, not whose rays, are independent: that of a ratio of sums over clusters (Cochran
/// 1977, "Sampling Techniques", section 9A.2, all clusters as likely).
double unsureByViewpoint(std::span<const uint32_t> viewpoints, const std::vector<bool>& counts)
{
    if (viewpoints.empty()) return 0.0;
    struct Cluster
    {
        double rays = 0.0, counted = 0.0;
    };
    std::map<uint32_t, Cluster> clusters;
    double all = 0.0;
    for (size_t i = 0; i < viewpoints.size(); ++i)
    {
        Cluster& cluster = clusters[viewpoints[i]];
        cluster.rays += 1.0;
        if (counts[i]) cluster.counted += 1.0, all += 1.0;
    }
    const double rays = double(viewpoints.size()), number = double(clusters.size());
    if (number < 2.0) return 0.0;
    double squares = 0.0;
    for (const auto& [viewpoint, cluster] : clusters) squares += std::pow(cluster.counted - all / rays * cluster.rays, 2.0);
    return std::sqrt(squares * number / (number - 1.0)) / rays;
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

TraceScore scoreTraces(const RaySet& set, std::span<const TracedRay> traced, bool farther)
{
    const std::vector<RayTruth>& truth = farther ? set.fartherTruth : set.truth;
    assert(truth.size() == traced.size());
    TraceScore score;
    score.rays = set.size();
    if (traced.empty()) return score;
    std::vector<bool> near(traced.size()), exactly(traced.size());
    size_t verdicts[4]{}, exact = 0, assumed1 = 0, assumed02 = 0;
    const auto isExact = [&](size_t i) { return !truth[i].hit || std::abs(traced[i].t - truth[i].t) <= 0.002f * set.diagonal; };
    std::vector<uint32_t> handoffs, distanceReads, indexReads;
    for (size_t i = 0; i < traced.size(); ++i)
    {
        const TraceVerdict verdict = judge(truth[i], traced[i], set.diagonal);
        ++verdicts[static_cast<size_t>(verdict)];
        near[i] = verdict == TraceVerdict::right;
        exactly[i] = near[i] && isExact(i);
        if (exactly[i]) ++exact;
        TracedRay taken = traced[i];
        if (taken.status == TraceStatus::unknown) taken.status = TraceStatus::hit;
        if (judge(truth[i], taken, set.diagonal) == TraceVerdict::right) ++assumed1, assumed02 += isExact(i);
        handoffs.push_back(traced[i].handoffs);
        distanceReads.push_back(traced[i].distanceReads);
        indexReads.push_back(traced[i].indexReads);
    }
    const auto share = [&](size_t count) { return static_cast<double>(count) / static_cast<double>(traced.size()); };
    score.right1 = share(verdicts[0]);
    score.right02 = share(exact);
    score.right1Unsure = unsureByViewpoint(set.viewpoints, near);
    score.right02Unsure = unsureByViewpoint(set.viewpoints, exactly);
    score.falseHit = share(verdicts[1]);
    score.leak = share(verdicts[2]);
    score.unresolved = share(verdicts[3]);
    score.assumed1 = share(assumed1);
    score.assumed02 = share(assumed02);
    score.handoffs = spreadOf(std::move(handoffs));
    score.distanceReads = spreadOf(std::move(distanceReads));
    score.indexReads = spreadOf(std::move(indexReads));
    return score;
}

} // namespace sconce
