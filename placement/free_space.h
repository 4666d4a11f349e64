#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/knobs.h"
#include "base/progress.h"
#include "base/result.h"
#include "placement/distance_field.h"
#include "placement/visibility.h"
#include "scene/scene.h"

namespace sconce
{

class Random;

/// What counts beside what is enclosed.
struct OpenSpace
{
    // Metres above ground that a viewer stands on, out to the scene's box; 0: bare ground doesn't count; none: kStanding where a seed is
    // on open ground and kMostGroundLeftOut of the ground that seeds reach would be left out.
    std::optional<float> ground = {};
    std::optional<Bounds> box = {};   // all free space in it that is reached, and nothing else
    const Visibility* walk = nullptr; // a mesh that one can walk on, in place of all ground that isn't steep; must outlive the search
};

/// The space that is lit: where a viewer can be, and hence where probes may be.
///
/// 1. A cell is free when its centre is farther than kBlocked cells from every surface: two neighbouring centres on either side of a
///    surface, however thin, can't both be free, so walls thinner than a cell still separate.
/// 2. Free cells are joined through faces. Those joined to a seed count: the `--inside` points, else the cameras, else the region with the
///    most enclosed volume.
///    Of what is joined to points and cameras, those places count that a ball of kPassage gets to, and what lies around its way: hollow
///    walls and floors of two-sided surfaces are joined to rooms through cracks.
/// 3. Open scenes: the fill ends at the scene's box, raised a little. Of what it reaches, a cell is kept when it is enclosed: at least
///    kEnclosedShare of its rays between the horizon and 60 degrees above it hit something, and kGroundShare of those within 45 degrees of
///    straight down; and when not most of its hits are on the backs of single-sided surfaces (the underside of a terrain). So courts,
///    streets and roofless halls are kept, while a bare plane around a house, the air above the roofs and the void around a building are
///    not. If every seed is indoors (kIndoors of all its rays hit), so is the space: kIndoorEnclosedShare holds
///    instead, and cells join a seed through kept cells only; a seed in the garden keeps the garden. If no cell is enclosed, the whole
///    reached space is kept.
/// 4. With OpenSpace::ground, or where hardly any ground is enclosed, reached cells count, too, that lie no higher than that above a
/// surface that one can stand on (kWalkable), or
///    above OpenSpace::walk, which lies no deeper than kUnderGround below what the scene shows there; with OpenSpace::box the reached cells
///    in it, in place of rule 3.
struct FreeSpace
{
    DistanceField field;
    std::vector<uint8_t> reachable; // [cells] 1: free, reached and kept
    std::vector<uint32_t> cells;    // indices of the reachable cells, ascending
    Bounds bounds;                  // of the reachable cells
    double volume = 0.0;            // cubic metres
    float ground = 0.0f;            // metres above open ground that count

    bool contains(vec3 point) const
    {
        const glm::ivec3 cell = field.cellAt(point);
        return field.inside(cell) && reachable[field.index(cell)] != 0;
    }
    float distanceAt(vec3 point) const // metres, of the cell; 0 outside the box
    {
        const glm::ivec3 cell = field.cellAt(point);
        return field.inside(cell) ? field.distance[field.index(cell)] : 0.0f;
    }
    /// A point evenly spread over the reachable cells that is on the same side of every surface as its cell's centre.
    vec3 randomPoint(Random& random) const;
};

inline constexpr float kPassage = 0.25f;       // of the mean distance to surfaces: half the width of the least way from a seed,
inline constexpr float kWidestPassage = 0.3f;  // metres, but no more than this: a person, so that doors stay open in a cathedral
inline constexpr float kBlocked = 0.51f;       // cells; a little above one half, for rounding
inline constexpr float kEnclosedShare = 0.12f; // of the rays between the horizon and 60 degrees up
inline constexpr float kIndoorEnclosedShare = 0.6f;
inline constexpr float kIndoors = 0.99f;          // of all rays
inline constexpr float kGroundShare = 0.4f;       // of the rays within 45 degrees of straight down; one half at the open front of a box
inline constexpr float kWalkable = 0.7f;          // least cosine of the ground's normal with the vertical: 45 degrees
inline constexpr float kStanding = 2.5f;          // metres: a person and an arm
inline constexpr float kMostGroundLeftOut = 0.9f; // by area: a viewer in a desert with a ruin walks in the desert
inline constexpr float kUnderGround = 0.3f;       // metres
inline constexpr uint32_t kDefaultVoxels = knobs::distanceVoxels.value;

/// @param inside  world points, metres, that say which space counts; empty: the cameras, else the largest enclosed region
/// @param voxels  most cells of the distance field
/// Errors: badArgument when an inside point lies in solid or outside the scene, badInput when nothing is free, cancelled.
Result<FreeSpace> findFreeSpace(const Scene& scene, const Visibility& visibility, std::span<const vec3> inside,
                                uint32_t voxels = kDefaultVoxels, const Progress& progress = {}, const OpenSpace& open = {});

} // namespace sconce
