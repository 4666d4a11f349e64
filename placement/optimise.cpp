#include "placement/optimise.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "base/random.h"
#include "placement/skeleton.h"

namespace sconce
{
namespace
{

constexpr float kStepDecay = 0.65f; // a round

/// Ratios of fitness lie so near to one that the paper's test accepts nearly all; this power makes one per cent less a coin's toss.
constexpr float kSharpness = 70.0f;

/// The views of all probes and, per target, the best worth without one of them.
class Views
{
public:
    Views(const Visibility& visibility, const ViewTargets& targets, std::span<const vec3> positions)
        : wide(targets.size()), weights(targets.weights)
    {
        rows.assign(positions.size(), std::vector<uint8_t>(wide));
        tbb::parallel_for(size_t(0), positions.size(), [&](size_t k) { targets.rate(visibility, positions[k], rows[k]); });
        first.assign(wide, 0);
        second.assign(wide, 0);
        for (size_t k = 0; k < rows.size(); ++k)
            for (size_t s = 0; s < wide; ++s) enter(s, rows[k][s]);
    }

    /// Best worth of each target without probe k: a target whose best is not probe k's keeps it, as does one with two equals.
    void without(size_t k, std::vector<uint8_t>& best) const
    {
        best.resize(wide);
        const std::vector<uint8_t>& row = rows[k];
        for (size_t s = 0; s < wide; ++s) best[s] = row[s] == first[s] ? second[s] : first[s];
    }

    void replace(size_t k, std::vector<uint8_t>& row)
    {
        std::swap(rows[k], row);
        for (size_t s = 0; s < wide; ++s)
        {
            const uint8_t left = row[s], entered = rows[k][s];
            if (left == entered) continue;
            if (left < second[s] || left == 0) // it was neither of the two best
            {
                enter(s, entered);
                continue;
            }
            first[s] = second[s] = 0;
            for (const std::vector<uint8_t>& one : rows) enter(s, one[s]);
        }
    }

    const std::vector<uint8_t>& row(size_t k) const { return rows[k]; }

    uint64_t fitness() const
    {
        const std::vector<uint8_t> nothing(wide, 0);
        return gainOf(first, nothing.data(), weights);
    }

private:
    void enter(size_t s, uint8_t worth)
    {
        second[s] = std::max(second[s], std::min(first[s], worth));
        first[s] = std::max(first[s], worth);
    }

    size_t wide;
    SurfelWeights weights;
    std::vector<std::vector<uint8_t>> rows;
    std::vector<uint8_t> first, second;
};

struct Proposal
{
    vec3 position{0.0f};
    uint64_t gain = 0; // over the other probes; 0 where illegal
    std::vector<uint8_t> row;
};

void rate(Proposal& proposal, const LegalSpace& legal, const ViewTargets& targets, float clearance, const std::vector<uint8_t>& others)
{
    proposal.gain = 0;
    if (!legal.allows(proposal.position, clearance)) return;
    proposal.row.resize(targets.size());
    targets.rate(legal.visibility, proposal.position, proposal.row, others); // where others see better, nothing is gained
    proposal.gain = gainOf(proposal.row, others.data(), targets.weights);
}

} // namespace

float sampleLinear(float f0, float f1, float uniform)
{
    const float sum = f0 + f1;
    if (!(sum > 0.0f)) return uniform;
    const float root = std::sqrt(std::max(0.0f, f0 * f0 + (f1 - f0) * sum * uniform));
    const float below = f0 + root; // zero only for f0 = 0 and uniform = 0
    return below > 0.0f ? std::clamp(sum * uniform / below, 0.0f, 1.0f) : 0.0f;
}

vec3 sampleCube(const std::array<float, 8>& fitness, std::span<const float, 7> uniforms)
{
    float x[4], onEdge[4], y[2], onSquare[2];
    for (int edge = 0; edge < 4; ++edge)
    {
        const float low = fitness[size_t(2 * edge)], high = fitness[size_t(2 * edge + 1)];
        x[edge] = sampleLinear(low, high, uniforms[size_t(edge)]);
        onEdge[edge] = glm::mix(low, high, x[edge]);
    }
    for (int square = 0; square < 2; ++square)
    {
        y[square] = sampleLinear(onEdge[2 * square], onEdge[2 * square + 1], uniforms[size_t(4 + square)]);
        onSquare[square] = glm::mix(onEdge[2 * square], onEdge[2 * square + 1], y[square]);
    }
    const float z = sampleLinear(onSquare[0], onSquare[1], uniforms[6]);
    const auto along = [&](int square) { return vec3(glm::mix(x[2 * square], x[2 * square + 1], y[square]), y[square], 0.0f); };
    const vec3 low = along(0), high = along(1);
    return {glm::mix(low.x, high.x, z), glm::mix(low.y, high.y, z), z};
}

Status optimisePositions(const LegalSpace& legal, const ViewTargets& targets, std::vector<vec3>& positions,
                         const OptimiseSettings& settings, const Progress& progress)
{
    if (settings.refine == Refine::none || positions.empty() || targets.size() == 0) return success();
    Views views(legal.visibility, targets, positions);
    // Worse positions are accepted at times, so that the last set may not be the best one met.
    std::vector<vec3> best = positions;
    uint64_t bestFitness = views.fitness();
    float step = settings.step > 0.0f ? settings.step : 0.25f * targets.spacing;
    std::vector<uint8_t> others;
    std::array<Proposal, 8> supports;
    Proposal drawn;
    for (uint32_t round = 0; round < settings.rounds; ++round, step *= kStepDecay)
    {
        for (size_t k = settings.fixed; k < positions.size(); ++k)
        {
            if (!report(progress, "refinement", (double(round) + double(k) / double(positions.size())) / double(settings.rounds)))
                return Error{ErrorCode::cancelled, "The refinement of probes was cancelled."};
            Random random(settings.seed, round * positions.size() + k);
            views.without(k, others);
            // A probe away from walls stays so; one that was put near a wall, before a gap, may stay near.
            const bool comfortable =
                settings.comfort > 0.0f && legal.visibility.distance(positions[k], settings.comfort) >= settings.comfort;
            const float clearance = comfortable ? settings.comfort : settings.clearance;
            // Gains over what the other probes see: the fitness of the whole set, but for a constant.
            const uint64_t present = gainOf(views.row(k), others.data(), targets.weights);
            // The support cube of Wang et al. 2019, section 3.3. Corners that are not legal gain 0 and are never taken.
            tbb::parallel_for(size_t(0), supports.size(),
                              [&](size_t corner)
                              {
                                  const vec3 side((corner & 1) ? 1 : -1, (corner & 2) ? 1 : -1, (corner & 4) ? 1 : -1);
                                  supports[corner].position = positions[k] + step * side;
                                  rate(supports[corner], legal, targets, clearance, others);
                              });
            Proposal* proposal =
                &*std::max_element(supports.begin(), supports.end(), [](const Proposal& a, const Proposal& b) { return a.gain < b.gain; });
            if (settings.refine == Refine::stochastic)
            {
                std::array<float, 8> fitness;
                std::array<float, 7> uniforms;
                for (size_t corner = 0; corner < 8; ++corner) fitness[corner] = float(supports[corner].gain);
                for (float& uniform : uniforms) uniform = random.uniform();
                drawn.position = positions[k] + step * (2.0f * sampleCube(fitness, uniforms) - 1.0f);
                rate(drawn, legal, targets, clearance, others);
                // The corners are rated already: the best of them stands in for a draw that is worse.
                if (drawn.gain > proposal->gain) proposal = &drawn;
            }
            // No gain is also what an illegal position has.
            if (proposal->gain == 0) continue;
            bool accepted = proposal->gain > present;
            // A worse one at times, or a probe stays at the first local best. A present gain of 0 has no worse one, and no ratio.
            if (!accepted && settings.refine != Refine::gradient && present > 0)
                accepted = random.uniform() < std::pow(float(proposal->gain) / float(present), kSharpness);
            if (!accepted) continue;
            positions[k] = proposal->position;
            // Rated again without a floor: the proposal's row lacks what the others see better, and they may move.
            targets.rate(legal.visibility, positions[k], proposal->row);
            views.replace(k, proposal->row);
        }
        if (const uint64_t fitness = views.fitness(); fitness > bestFitness) bestFitness = fitness, best = positions;
    }
    positions = best;
    return success();
}

} // namespace sconce
