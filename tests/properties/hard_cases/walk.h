#pragma once

#include <algorithm>
#include <cmath>

#include "bench/race/ray_sets.h"
#include "runtime/field/tracer_cpu.h"

namespace sconce::testing_support
{

/// Traces rays one turn of the tracer's state machine at a time, and keeps the worst of what must stay bounded. The bounds are derived:
/// turns, see turnLimit() in probe_trace.h; t never falls but for a second opinion, which a ray asks once: it starts
/// before the first answer's surfel, and may return to that answer.
template <class Real> class Walk
{
public:
    using V = glm::vec<3, Real>;
    Walk(const FieldData& data, const gpu::TraceQuality& quality) : field(data), text(data, quality) {}

    /// World-space ray; the answer in metres.
    TracedRay trace(V origin, V direction, double* t = nullptr, V normal = V(0))
    {
        auto r = text.startRay((origin - V(field.info.origin)) / Real(field.info.scale), direction, normal);
        const int limit = text.turnLimit();
        int turns = 0, falls = 0;
        while (r.phase != text.kPhaseDone && turns < limit)
        {
            const Real before = r.t;
            const bool opinion = r.asked.opinionT >= Real(0);
            text.turn(r);
            ++turns;
            if (!(r.t >= before))
            {
                ++falls;
                fallsOutsideOpinions += !opinion;
            }
        }
        ++rays;
        const auto result = text.resultOf(r);
        notFinite += !std::isfinite(double(result.t));
        limitReached += r.phase != text.kPhaseDone;
        worstTurns = std::max(worstTurns, double(turns) / limit);
        worstFalls = std::max(worstFalls, falls);
        worstReads = std::max(worstReads, result.distanceReads);
        if (t) *t = double(result.t) * field.info.scale;
        return {TraceStatus(result.status), float(result.t * Real(field.info.scale)), uint32_t(result.handoffs),
                uint32_t(result.distanceReads), uint32_t(result.indexReads)};
    }

    size_t rays = 0, limitReached = 0, fallsOutsideOpinions = 0, notFinite = 0;
    double worstTurns = 0.0; // share of the limit
    int worstFalls = 0, worstReads = 0;

private:
    const FieldData& field;
    twin::LightFieldTwin<Real> text;
};

template <class Real> std::vector<TracedRay> walkAll(Walk<Real>& walk, const RaySet& set)
{
    std::vector<TracedRay> out;
    for (size_t i = 0; i < set.size(); ++i)
        out.push_back(walk.trace(glm::vec<3, Real>(set.origins[i]), glm::vec<3, Real>(set.directions[i]), nullptr,
                                 glm::vec<3, Real>(set.normals[i])));
    return out;
}

} // namespace sconce::testing_support
