#pragma once

#include <span>

#include "scene/scene.h"

namespace sconce::test
{

/// A scene with one opaque material and no triangles.
Scene emptyScene();

/// Adds a rectangle corner, corner + u, corner + u + v, corner + v; its front is the side that cross(u, v) points to.
void addQuad(Scene& scene, vec3 corner, vec3 u, vec3 v, uint32_t material = 0);

/// Adds the six walls of a box, fronts inward (a room) or outward (a crate).
void addRoom(Scene& scene, vec3 low, vec3 high);
void addCrate(Scene& scene, vec3 low, vec3 high);

/// A closed room of the given size with its low corner at the origin.
Scene closedRoom(vec3 size);

/// A closed room of 6 x 3 x 4 m, cut by an infinitely thin wall at x = 4 into one part of 4 m and one of 2 m.
Scene dividedRoom();

/// A closed room of 6 x 3 x 4 m with a half-height wall, a crate and a pillar: nothing sees everything.
Scene furnishedRoom();

/// Distance by looking at every triangle, in double precision and with a formula of its own (projection, else the nearest edge).
double bruteDistance(const Scene& scene, vec3 point);

/// Whether a segment meets a triangle, by looking at every one: Möller and Trumbore 1997, in double precision. No tree, no Embree.
bool bruteBlocked(const Scene& scene, glm::dvec3 from, glm::dvec3 to);

} // namespace sconce::test
