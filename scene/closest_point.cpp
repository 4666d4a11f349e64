#include "scene/closest_point.h"

#include <algorithm>

namespace sconce
{
namespace
{

constexpr float kNeedle = 1e-2f; // of the longest edge: of triangles lower than that, float's areas are mostly noise

template <class V> V closest(V p, V a, V b, V c)
{
    using Real = typename V::value_type;
    constexpr Real zero(0), one(1);
    const V ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const Real d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= zero && d2 <= zero) return a;
    const Real d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= zero && d4 <= d3) return b;
    const Real d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= zero && d5 <= d6) return c;
    const auto onEdge = [&p](V from, V to) // a zero-length edge is its end point
    {
        const V edge = to - from;
        const Real length2 = glm::dot(edge, edge);
        return length2 > zero ? from + glm::clamp(glm::dot(p - from, edge) / length2, zero, one) * edge : from;
    };
    const Real vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    const Real area = va + vb + vc; // zero for a degenerate triangle: its edges answer
    if (vc <= zero && d1 >= zero && d3 <= zero && area > zero) return onEdge(a, b);
    if (vb <= zero && d2 >= zero && d6 <= zero && area > zero) return onEdge(a, c);
    if (va <= zero && d4 - d3 >= zero && d5 - d6 >= zero && area > zero) return onEdge(b, c);
    if (area > zero) return a + ab * (vb / area) + ac * (vc / area);
    V best = onEdge(a, b);
    for (const V other : {onEdge(a, c), onEdge(b, c)})
        if (glm::distance(other, p) < glm::distance(best, p)) best = other;
    return best;
}

} // namespace

vec3 closestPointOnTriangle(vec3 p, vec3 a, vec3 b, vec3 c)
{
    const vec3 ab = b - a, ac = c - a, bc = c - b, normal = glm::cross(ab, ac);
    const float longest2 = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
    if (glm::dot(normal, normal) > kNeedle * kNeedle * longest2 * longest2) return closest(p, a, b, c);
    return vec3(closest(glm::dvec3(p), glm::dvec3(a), glm::dvec3(b), glm::dvec3(c)));
}

} // namespace sconce
