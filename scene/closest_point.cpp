#include "scene/closest_point.h"

namespace sconce
{

vec3 closestPointOnTriangle(vec3 p, vec3 a, vec3 b, vec3 c)
{
    const vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0.0f && d2 <= 0.0f) return a;
    const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0.0f && d4 <= d3) return b;
    const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0.0f && d5 <= d6) return c;
    const auto onEdge = [&p](vec3 from, vec3 to) // a zero-length edge is its end point
    {
        const vec3 edge = to - from;
        const float length2 = glm::dot(edge, edge);
        return length2 > 0.0f ? from + glm::clamp(glm::dot(p - from, edge) / length2, 0.0f, 1.0f) * edge : from;
    };
    const float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    const float area = va + vb + vc; // zero for a degenerate triangle: its edges answer
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f && area > 0.0f) return onEdge(a, b);
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f && area > 0.0f) return onEdge(a, c);
    if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f && area > 0.0f) return onEdge(b, c);
    if (area > 0.0f) return a + ab * (vb / area) + ac * (vc / area);
    vec3 best = onEdge(a, b);
    for (const vec3 other : {onEdge(a, c), onEdge(b, c)})
        if (glm::distance(other, p) < glm::distance(best, p)) best = other;
    return best;
}

} // namespace sconce
