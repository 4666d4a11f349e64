#pragma once

#include <vector>

#include "placement/skeleton.h"

namespace sconce
{

/// Candidates on the medial axis by ball shrinking: a ball that touches the surface at a sample point, tangentially, shrinks until no
/// other sample lies in it; its centre is equally far from two surfaces. Samples are taken on the reachable surface, so no tessellation of
/// the input is needed. Balls whose samples are alike in position and orientation are joined before: each group gives the centroid of its
/// centres, or, where a probe may not be there (in solid, too near a wall), the legal centre nearest to the centroid.
/// Sources: Ma, Bae, Choi 2012, "3D medial axis point approximation using nearest neighbors and the normal field"; Wang et al. 2019,
/// section 3.1 (joining by position and orientation).
/// @param count  at most so many, but no fewer than six groups (one an orientation); the size of the groups follows from it
std::vector<Candidate> ballCandidates(const Scene& scene, const LegalSpace& legal, size_t count, float clearance, uint64_t seed);

} // namespace sconce
