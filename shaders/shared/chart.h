// Charts of a probe map: cube faces and the octahedral map (Cigolle et al. 2014, "A Survey of Efficient Representations for Independent
// Unit Vectors"; Engelhardt and Dachsbacher 2008, "Octahedron Environment Maps"). Shared text, see texel.h.
#if defined(__cplusplus) || !defined(SCONCE_CHART) // C++ includes it once for each precision
#define SCONCE_CHART

/// Coordinates of a probe-relative point on a face: (U, V, W); the point is seen by the face when W > 0 and |U|,|V| <= W.
SCONCE_PURE vec3 faceCoordinates(int face, vec3 p)
{
    real s = (face & 1) != 0 ? real(-1.0) : real(1.0);
    if (face < 2) return vec3(p.y, p.z, s * p.x);
    if (face < 4) return vec3(p.z, p.x, s * p.y);
    return vec3(p.x, p.y, s * p.z);
}

/// The inverse of faceCoordinates.
SCONCE_PURE vec3 faceDirection(int face, vec3 uvw)
{
    real s = (face & 1) != 0 ? real(-1.0) : real(1.0);
    if (face < 2) return vec3(s * uvw.z, uvw.x, uvw.y);
    if (face < 4) return vec3(uvw.y, s * uvw.z, uvw.x);
    return vec3(uvw.x, uvw.y, s * uvw.z);
}

/// The face that sees a direction; ties go to the lower axis, zero to face 0.
SCONCE_PURE int dominantFace(vec3 p)
{
    real ax = abs(p.x), ay = abs(p.y), az = abs(p.z);
    if (ax >= ay && ax >= az) return p.x < real(0.0) ? 1 : 0;
    if (ay >= az) return p.y < real(0.0) ? 3 : 2;
    return p.z < real(0.0) ? 5 : 4;
}

// The octahedral map as eight charts like the faces: within an octant (bit a: axis a is negative) a point's place on the map and
// W = |x| + |y| + |z| are projective in p, so that straight lines stay straight and q = 1/W is linear over planes. All octants lie on one map.

/// (U, V, W) of a probe-relative point in an octant; the map's pixel is N/2 (U/W + 1, V/W + 1), as a face's is.
SCONCE_PURE vec3 octantCoordinates(int octant, vec3 p)
{
    vec3 s = vec3((octant & 1) != 0 ? real(-1.0) : real(1.0), (octant & 2) != 0 ? real(-1.0) : real(1.0), (octant & 4) != 0 ? real(-1.0) : real(1.0));
    real fold = (octant & 4) != 0 ? s.z * p.z : real(0.0); // the lower half is folded out
    return vec3(p.x + s.x * fold, p.y + s.y * fold, s.x * p.x + s.y * p.y + s.z * p.z);
}

/// The inverse of octantCoordinates.
SCONCE_PURE vec3 octantDirection(int octant, vec3 uvw)
{
    vec3 s = vec3((octant & 1) != 0 ? real(-1.0) : real(1.0), (octant & 2) != 0 ? real(-1.0) : real(1.0), (octant & 4) != 0 ? real(-1.0) : real(1.0));
    real u = s.x * uvw.x;
    real v = s.y * uvw.y;
    if ((octant & 4) != 0) return vec3(s.x * (uvw.z - v), s.y * (uvw.z - u), uvw.z - u - v);
    return vec3(uvw.x, uvw.y, uvw.z - u - v);
}

/// Direction, not unit, of the normal of a plane from the gradient (of U, V, W) of a linear function over an octant: the transpose of
/// octantCoordinates.
SCONCE_PURE vec3 octantNormal(int octant, vec3 g)
{
    vec3 s = vec3((octant & 1) != 0 ? real(-1.0) : real(1.0), (octant & 2) != 0 ? real(-1.0) : real(1.0), (octant & 4) != 0 ? real(-1.0) : real(1.0));
    real fold = (octant & 4) != 0 ? s.x * g.x + s.y * g.y : real(0.0);
    return vec3(g.x + s.x * g.z, g.y + s.y * g.z, s.z * (g.z + fold));
}

/// The transpose of octantDirection: a normal to the gradient.
SCONCE_PURE vec3 octantGradient(int octant, vec3 n)
{
    vec3 s = vec3((octant & 1) != 0 ? real(-1.0) : real(1.0), (octant & 2) != 0 ? real(-1.0) : real(1.0), (octant & 4) != 0 ? real(-1.0) : real(1.0));
    if ((octant & 4) != 0) return vec3(-s.x * (s.y * n.y + n.z), -s.y * (s.x * n.x + n.z), s.x * n.x + s.y * n.y + n.z);
    return vec3(n.x - s.x * n.z, n.y - s.y * n.z, n.z);
}

SCONCE_PURE int octantOf(vec3 p) { return (p.x < real(0.0) ? 1 : 0) | (p.y < real(0.0) ? 2 : 0) | (p.z < real(0.0) ? 4 : 0); }

/// Octahedral square [0,1]^2 of a direction (any length but zero).
SCONCE_PURE vec2 octahedralFromDirection(vec3 d)
{
    real n = abs(d.x) + abs(d.y) + abs(d.z);
    real x = d.x / n, y = d.y / n;
    if (d.z < real(0.0))
    {
        real fx = (real(1.0) - abs(y)) * (x < real(0.0) ? real(-1.0) : real(1.0));
        real fy = (real(1.0) - abs(x)) * (y < real(0.0) ? real(-1.0) : real(1.0));
        x = fx;
        y = fy;
    }
    return vec2(real(0.5) * x + real(0.5), real(0.5) * y + real(0.5));
}

/// Unit direction of a point of the octahedral square.
SCONCE_PURE vec3 directionFromOctahedral(vec2 uv)
{
    real x = real(2.0) * uv.x - real(1.0), y = real(2.0) * uv.y - real(1.0);
    real z = real(1.0) - abs(x) - abs(y);
    if (z < real(0.0))
    {
        real fx = (real(1.0) - abs(y)) * (x < real(0.0) ? real(-1.0) : real(1.0));
        real fy = (real(1.0) - abs(x)) * (y < real(0.0) ? real(-1.0) : real(1.0));
        x = fx;
        y = fy;
    }
    return normalize(vec3(x, y, z));
}

/// A unit vector in 16 bits, 8 + 8.
SCONCE_PURE uint packNormal8(vec3 n)
{
    vec2 uv = octahedralFromDirection(n);
    return uint(floor(uv.x * real(255.0) + real(0.5))) | (uint(floor(uv.y * real(255.0) + real(0.5))) << 8);
}

SCONCE_PURE vec3 unpackNormal8(uint bits)
{
    return directionFromOctahedral(vec2(real(bits & 0xffu) / real(255.0), real((bits >> 8) & 0xffu) / real(255.0)));
}

#endif
