#pragma once

#include <cstdint>
#include <vector>

#include "placement/free_space.h"
#include "placement/visibility.h"

namespace sconce
{

/// A position that a probe may take, and what proposed it.
struct Candidate
{
    enum class Origin : uint8_t
    {
        ridge,  // on the skeleton of the free space
        spread, // random free point
        gap,    // before a surface point that the others see badly
    };
    vec3 position{0.0f};
    Origin origin = Origin::spread;
};

/// Every position must have this: reachable and at least `clearance` metres from every triangle (exactly, not by the field).
bool legalPosition(const Visibility& visibility, const FreeSpace& space, vec3 point, float clearance);

/// Candidates on the skeleton: reachable cells on ridges of the distance field, in clusters of which the ridge cell nearest to the
/// centroid stands for all (a bare centroid may fall in solid). A ridge is where the nearest surface changes, so that the field's slope, 1
/// elsewhere, drops. Source: Wang et al. 2019, section 3.1.
/// @param count  about how many; the cluster size follows from it
std::vector<Candidate> skeletonCandidates(const Visibility& visibility, const FreeSpace& space, size_t count, float clearance);

/// Random legal positions, evenly spread over the reachable space; fewer than `count` when the clearance forbids most.
std::vector<Candidate> spreadCandidates(const Visibility& visibility, const FreeSpace& space, size_t count, float clearance, uint64_t seed);

} // namespace sconce
