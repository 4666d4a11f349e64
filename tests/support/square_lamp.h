#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/scene.h"

namespace sconce::testing_support
{

/// Mean radiance, weighted by the cosine, from a square lamp of radiance 1 about `middle`, parallel to y = 0: brute force over its cells.
/// @param mirror  colour at normal incidence of a metal mirror in y = 0 that it is seen in; 1: none
inline double fromSquareLamp(vec3 middle, float half, vec3 at, vec3 normal, double mirror = 1.0)
{
    constexpr int kCells = 200;
    const double cell = 2.0 * half / kCells;
    double sum = 0.0;
    for (int i = 0; i < kCells * kCells; ++i)
    {
        const glm::dvec3 point(middle.x - half + (i % kCells + 0.5) * cell, middle.y, middle.z - half + (i / kCells + 0.5) * cell);
        const glm::dvec3 to = point - glm::dvec3(at);
        const double d2 = glm::dot(to, to), d = std::sqrt(d2);
        const double cosine = std::abs(to.y) / d, reflected = mirror + (1.0 - mirror) * std::pow(1.0 - cosine, 5.0);
        sum += reflected * std::max(glm::dot(to, glm::dvec3(normal)) / d, 0.0) * cosine * cell * cell / (std::numbers::pi * d2);
    }
    return sum;
}

} // namespace sconce::testing_support
