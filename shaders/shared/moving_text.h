// What a shape that moves hides of a hemisphere, and where rays meet it. Shared text, see texel.h; needs brdf_text.h and polygon_light.h.
// Points and directions are in a shape's own axes, relative to its middle, where no other word is said.

/// A vector turned by a unit quaternion, (axis sin, cos) of half the angle.
SCONCE_PURE vec3 turnedBy(vec3 axis, real cosine, vec3 v)
{
    vec3 across = real(2.0) * cross(axis, v);
    return v + cosine * across + cross(axis, across);
}

struct ShapeDistance
{
    real away;    // from the shape; below 0: within
    vec3 outward; // unit
};

/// Of a capsule along y, of a sphere where its half length is 0.
SCONCE_PURE ShapeDistance distanceToRound(vec3 at, real radius, real halfLength)
{
    vec3 off = vec3(at.x, at.y - clamp(at.y, -halfLength, halfLength), at.z);
    real size = sqrt(dot(off, off));
    ShapeDistance found;
    found.away = size - radius;
    found.outward = size > real(1e-12) ? off / size : vec3(real(1.0), real(0.0), real(0.0));
    return found;
}

SCONCE_PURE ShapeDistance distanceToBox(vec3 at, vec3 half_)
{
    vec3 side = vec3(at.x < real(0.0) ? -real(1.0) : real(1.0), at.y < real(0.0) ? -real(1.0) : real(1.0), at.z < real(0.0) ? -real(1.0) : real(1.0));
    vec3 beyond = side * at - half_;
    vec3 outside = max(beyond, vec3(real(0.0)));
    real size = sqrt(dot(outside, outside));
    real most = max(beyond.x, max(beyond.y, beyond.z));
    ShapeDistance found;
    found.away = size + min(most, real(0.0));
    found.outward = size > real(1e-12) ? side * outside / size
                                       : side * vec3(beyond.x == most ? real(1.0) : real(0.0), beyond.x != most && beyond.y == most ? real(1.0) : real(0.0),
                                                     beyond.x != most && beyond.y != most ? real(1.0) : real(0.0));
    return found;
}

/// Where a ray from outside enters; below 0: nowhere. @param direction  of any length, in whose units the answer is
SCONCE_PURE real rayToBox(vec3 origin, vec3 direction, vec3 half_)
{
    real enters = -real(1e30);
    real leaves = real(1e30);
    for (int axis = 0; axis < 3; ++axis)
    {
        real along = direction[axis];
        if (abs(along) < real(1e-20))
        {
            if (abs(origin[axis]) > half_[axis]) return -real(1.0);
            continue;
        }
        real a = (-half_[axis] - origin[axis]) / along;
        real b = (half_[axis] - origin[axis]) / along;
        enters = max(enters, min(a, b));
        leaves = min(leaves, max(a, b));
    }
    return enters <= leaves ? enters : -real(1.0);
}

/// The same of a capsule along y, of a sphere where its half length is 0.
SCONCE_PURE real rayToRound(vec3 origin, vec3 direction, real radius, real halfLength)
{
    // From the point of the line that is nearest to the middle: a ray from afar would lose its digits in the squares.
    real size2 = dot(direction, direction);
    real shift = -dot(origin, direction) / size2;
    vec3 from = origin + shift * direction;
    real nearest = real(1e30);
    real a = direction.x * direction.x + direction.z * direction.z;
    if (halfLength > real(0.0) && a > real(1e-12) * size2)
    {
        real b = from.x * direction.x + from.z * direction.z;
        real root = b * b - a * (from.x * from.x + from.z * from.z - radius * radius);
        if (root >= real(0.0))
        {
            real t = (-b - sqrt(root)) / a;
            if (abs(from.y + t * direction.y) <= halfLength) nearest = t;
        }
    }
    for (int end = 0; end < 2; ++end)
    {
        real y = end == 0 ? halfLength : -halfLength;
        vec3 off = from - vec3(real(0.0), y, real(0.0));
        real b = dot(off, direction);
        real root = b * b - size2 * (dot(off, off) - radius * radius);
        if (root >= real(0.0)) nearest = min(nearest, (-b - sqrt(root)) / size2);
    }
    return nearest < real(1e30) ? nearest + shift : -real(1.0);
}

/// Share of the hemisphere above a surface that a sphere hides, weighted by the cosine: its form factor, cut off by the horizon (Howell, "A Catalog of
/// Radiation Heat Transfer Configuration Factors", plane element to sphere). [0,1]
/// @param to  from the lit point to the sphere's middle
SCONCE_PURE real shareOfSphere(vec3 to, real radius, vec3 normal)
{
    real d2 = dot(to, to);
    real sine2 = radius * radius / max(d2, real(1e-30)); // of half the angle that it is seen under
    if (sine2 >= real(1.0)) return real(1.0);
    real cosine = dot(to, normal) / sqrt(d2);
    if (cosine * cosine >= sine2) return max(cosine, real(0.0)) * sine2;
    real tangent = sqrt((real(1.0) - sine2) / sine2); // of what is left to a right angle
    real beside = sqrt(max(real(1.0) - cosine * cosine, real(1e-30)));
    real below = sqrt(max(real(1.0) - cosine * cosine / sine2, real(0.0)));
    real turn = acos(clamp(-cosine * tangent / beside, -real(1.0), real(1.0)));
    return max(sine2 * (cosine * turn - below * tangent) + atan(below / tangent), real(0.0)) / kBrdfPi;
}

/// The same of a capsule along y: half of each end and the strip between them as it is seen. Exact for a sphere; within 0.02 for others (tests).
SCONCE_PURE real shareOfRound(vec3 at, real radius, real halfLength, vec3 normal)
{
    real high = shareOfSphere(vec3(real(0.0), halfLength, real(0.0)) - at, radius, normal);
    if (!(halfLength > real(0.0))) return high;
    real low = shareOfSphere(vec3(real(0.0), -halfLength, real(0.0)) - at, radius, normal);
    vec3 across = vec3(at.z, real(0.0), -at.x); // to the axis and to the view
    real off2 = dot(across, across);
    if (!(off2 > radius * radius)) return max(high, low); // along the axis
    // Where lines of sight touch the sides, before the axis.
    real before = radius * radius / off2;
    across = across * (radius * sqrt((real(1.0) - before) / off2));
    vec3 middle = vec3(at.x * before, real(0.0), at.z * before) - at;
    vec3 end = vec3(real(0.0), halfLength, real(0.0));
    TangentFrame tangents = tangentFrame(normal);
    real strip = polygonIrradiance(toTangent(tangents, middle - end - across), toTangent(tangents, middle - end + across),
                                   toTangent(tangents, middle + end + across), toTangent(tangents, middle + end - across)) / kBrdfPi;
    return min(max(real(0.5) * (high + low) + strip, max(high, low)), real(1.0));
}

/// The same of a box, from outside: its faces that are seen.
SCONCE_PURE real shareOfBox(vec3 at, vec3 half_, vec3 normal)
{
    TangentFrame tangents = tangentFrame(normal);
    real sum = real(0.0);
    for (int axis = 0; axis < 3; ++axis)
    {
        if (!(abs(at[axis]) > half_[axis])) continue;
        vec3 middle = -at;
        middle[axis] += at[axis] > real(0.0) ? half_[axis] : -half_[axis];
        vec3 u = vec3(real(0.0));
        vec3 v = vec3(real(0.0));
        u[(axis + 1) % 3] = half_[(axis + 1) % 3];
        v[(axis + 2) % 3] = half_[(axis + 2) % 3];
        sum += polygonIrradiance(toTangent(tangents, middle - u - v), toTangent(tangents, middle + u - v), toTangent(tangents, middle + u + v),
                                 toTangent(tangents, middle - u + v));
    }
    return min(sum / kBrdfPi, real(1.0));
}
