#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "placement/free_space.h"
#include "placement/probe_set.h"
#include "placement/surface_samples.h"
#include "placement/visibility.h"

namespace sconce
{

/// A position that a probe may take, and what proposed it.
struct Candidate
{
    enum class Origin : uint8_t
    {
        ridge,  // on the skeleton of the free space, by the distance field
        ball,   // the same by ball shrinking
        spread, // random free point
        gap,    // before a surface point that the others see badly
        kept,   // given by the user: stays, and counts as one of the probes asked for
        added,  // given by the user: stays, beside the probes asked for
    };
    vec3 position{0.0f};
    Origin origin = Origin::spread;
};

/// Where a probe may be.
struct LegalSpace
{
    const Visibility& visibility;
    const FreeSpace& space;
    std::span<const Pin> pins = {}; // of which the forbidden places count

    /// Every position must have this: reachable, at least `clearance` metres from every triangle (exactly, not by the field), and in no
    /// forbidden place.
    bool allows(vec3 point, float clearance) const;
};

/// Candidates on the skeleton: reachable cells on ridges of the distance field, in clusters of which the ridge cell nearest to the
/// centroid stands for all (a bare centroid may fall in solid). A ridge is where the nearest surface changes, so that the field's slope, 1
/// elsewhere, drops. Source: Wang et al. 2019, section 3.1.
/// @param count  about how many; the cluster size follows from it
std::vector<Candidate> skeletonCandidates(const LegalSpace& legal, size_t count, float clearance);

/// Random legal positions, evenly spread over the reachable space; fewer than `count` when the clearance forbids most.
std::vector<Candidate> spreadCandidates(const LegalSpace& legal, size_t count, float clearance, uint64_t seed);

/// Positions before surface points that others leave unseen.
std::vector<Candidate> gapCandidates(const LegalSpace& legal, std::span<const Surfel> gaps, size_t count, float clearance, uint64_t seed);

} // namespace sconce
