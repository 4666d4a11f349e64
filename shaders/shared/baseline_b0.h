// Baseline B0+: the tracer of McGuire et al. 2017, "Real-Time Global Illumination using Precomputed Light Field Probes", section 4, on a
// uniform grid of octahedral probes, rebuilt from the paper's formulas and constants, with its known defects mended: exact stepping of both
// levels (no texel is jumped), the largest of the three denominators for the ray's radial distance, the hand-over point taken where the
// step begins, the paper's re-pick of the cell as the ray proceeds, borders clamped. Rays start 1 cm off their surface (the caller's part).
// Shared text, see probe_trace.h; needs distanceWord, radianceWord and `field` with a grid and the octahedral chart.

SCONCE_CONST int kB0Tries = 8;    // probes of a cell
SCONCE_CONST int kB0Limit = 64;   // probes of a ray, over all cells

struct B0Ray
{
    vec3 relative;  // origin relative to the probe
    vec3 direction;
    uint probe;
    real tMin;      // resumes here
    int reads;
    vec2 pixel;
    uint word;
    real t;
};

/// Distance from the probe, in direction v, of the point of the ray that lies in that direction.
SCONCE_FN real b0Radial(vec3 o, vec3 d, vec3 v)
{
    vec3 n = cross(o, d);
    vec3 m = cross(v, d);
    real ax = abs(m.x), ay = abs(m.y), az = abs(m.z);
    real r = ax >= ay && ax >= az ? n.x / m.x : (ay >= az ? n.y / m.y : n.z / m.z);
    return r > real(0.0) ? r : real(0.0); // NaN too
}

SCONCE_FN vec3 b0Direction(vec2 pixel) { return directionFromOctahedral(pixel / real(field.faceSize)); }

SCONCE_FN uint b0Fetch(SCONCE_INOUT(B0Ray) ray, int x, int y)
{
    int n = int(field.faceSize);
    ++ray.reads;
    return distanceWord(ray.probe * field.wordsPerProbe + uint(min(max(y, 0), n - 1) * n + min(max(x, 0), n - 1)));
}

SCONCE_FN uint b0FetchLow(SCONCE_INOUT(B0Ray) ray, int x, int y)
{
    int n = int(field.faceSize);
    int m = n / int(kLowFactor);
    ++ray.reads;
    return distanceWord(ray.probe * field.wordsPerProbe + uint(n * n + min(max(y, 0), m - 1) * m + min(max(x, 0), m - 1)));
}

/// Where the line P0 + l dP leaves the cell of `size` texels that it is in just after l.
SCONCE_FN real b0CellExit(vec2 P0, vec2 dP, real l, int size, SCONCE_OUT(ivec2) cell)
{
    vec2 p = P0 + (l + real(1e-6)) * dP;
    cell = ivec2(int(floor(p.x / real(size))), int(floor(p.y / real(size))));
    real bx = real(size) * (real(cell.x) + (dP.x > real(0.0) ? real(1.0) : real(0.0)));
    real by = real(size) * (real(cell.y) + (dP.y > real(0.0) ? real(1.0) : real(0.0)));
    real lx = abs(dP.x) > real(1e-9) ? (bx - P0.x) / dP.x : real(2.0);
    real ly = abs(dP.y) > real(1e-9) ? (by - P0.y) / dP.y : real(2.0);
    return min(real(1.0), max(min(lx, ly), l + real(1e-6)));
}

/// The fine texels of the segment between l0 and l1.
SCONCE_FN uint b0FineMarch(SCONCE_INOUT(B0Ray) ray, vec2 P0, vec2 dP, real l0, real l1)
{
    real l = l0;
    vec3 va = b0Direction(P0 + l * dP);
    real ra = b0Radial(ray.relative, ray.direction, va);
    for (int i = 0; i < 4 * int(kLowFactor) && l < l1; ++i)
    {
        ivec2 cell;
        real le = min(b0CellExit(P0, dP, l, 1, cell), l1);
        vec3 vb = b0Direction(P0 + le * dP);
        real rb = b0Radial(ray.relative, ray.direction, vb);
        uint word = b0Fetch(ray, cell.x, cell.y);
        real r = (word & 0xffffu) == 0x7c00u ? real(1e9) : halfToReal(word);
        if (max(ra, rb) >= r)
        {
            vec2 sampled = P0 + real(0.5) * (l + le) * dP;
            vec3 v = b0Direction(sampled);
            vec3 n = unpackNormal8(word >> 16);
            real th = dot(r * v - ray.relative, ray.direction);
            real metres = real(field.scale);
            real tau = (real(0.03) + real(0.47) * max(dot(ray.direction, v), real(0.0)) * (real(2.0) - abs(dot(ray.direction, n))) *
                                         clamp(real(0.1) * th * metres, real(0.05), real(1.0))) / metres;
            if (min(ra, rb) < r + tau && dot(n, ray.direction) < real(0.0))
            {
                ray.t = th;
                ray.pixel = sampled;
                ray.word = word;
                return kHit;
            }
            ray.pixel = sampled;
            ray.word = word;
            ray.tMin = max(ray.tMin, min(th, dot(ra * va - ray.relative, ray.direction)));
            return kUnknown;
        }
        l = le;
        ra = rb;
        va = vb;
    }
    return kMiss;
}

/// One straight piece of the ray's image: within an octant of the map.
SCONCE_FN uint b0Segment(SCONCE_INOUT(B0Ray) ray, real t0, real t1)
{
    real bump = real(0.001) / real(field.scale); // 1 mm: keeps both ends off the octants' borders, which have two images
    vec3 start = ray.relative + (t0 + bump) * ray.direction;
    vec3 end = ray.relative + (t1 - bump) * ray.direction;
    real tiny = real(0.032) / real(field.scale);
    if (dot(start, start) < tiny * tiny) start = ray.direction;
    vec2 P0 = octahedralFromDirection(start) * real(field.faceSize);
    vec2 dP = octahedralFromDirection(end) * real(field.faceSize) - P0;
    real l = real(0.0);
    for (int i = 0; i < 4 * int(field.faceSize / kLowFactor) + 4 && l < real(1.0); ++i)
    {
        ivec2 cell;
        real le = b0CellExit(P0, dP, l, int(kLowFactor), cell);
        real nearest = halfToReal(b0FetchLow(ray, cell.x, cell.y));
        real ra = b0Radial(ray.relative, ray.direction, b0Direction(P0 + l * dP));
        real rb = b0Radial(ray.relative, ray.direction, b0Direction(P0 + le * dP));
        if (nearest < max(ra, rb))
        {
            uint status = b0FineMarch(ray, P0, dP, l, le);
            if (status != kMiss) return status;
        }
        l = le;
    }
    return kMiss;
}

SCONCE_FN uint b0Probe(SCONCE_INOUT(B0Ray) ray, real tMax)
{
    real t[5];
    for (int a = 0; a < 3; ++a)
    {
        real cross_ = abs(ray.direction[a]) > real(1e-9) ? -ray.relative[a] / ray.direction[a] : real(-1.0);
        t[a + 1] = clamp(cross_, ray.tMin, tMax);
    }
    t[0] = ray.tMin;
    t[4] = tMax;
    real low = min(t[1], t[2]), high = max(t[1], t[2]);
    t[1] = min(low, t[3]);
    real middle = max(low, t[3]);
    t[2] = min(middle, high);
    t[3] = max(middle, high);
    for (int i = 0; i < 4; ++i)
    {
        if (t[i + 1] - t[i] < real(0.001) / real(field.scale)) continue;
        uint status = b0Segment(ray, t[i], t[i + 1]);
        if (status != kMiss) return status;
    }
    return kMiss;
}

SCONCE_FN ivec3 b0Cell(vec3 p)
{
    vec3 g = (p - vec3(field.gridOrigin)) / vec3(field.gridStep);
    return ivec3(int(clamp(floor(g.x), real(0.0), real(field.gridX - 1u))), int(clamp(floor(g.y), real(0.0), real(field.gridY - 1u))),
                 int(clamp(floor(g.z), real(0.0), real(field.gridZ - 1u))));
}

/// Corner of the cell whose probe is nearest to the point, bits xyz.
SCONCE_FN int b0NearestCorner(vec3 p, ivec3 cell)
{
    vec3 g = (p - vec3(field.gridOrigin)) / vec3(field.gridStep) - vec3(real(cell.x), real(cell.y), real(cell.z));
    return (g.x > real(0.5) ? 1 : 0) | (g.y > real(0.5) ? 2 : 0) | (g.z > real(0.5) ? 4 : 0);
}

SCONCE_FN uint b0ProbeIndex(ivec3 cell, int corner)
{
    uint x = min(uint(cell.x + (corner & 1)), field.gridX - 1u);
    uint y = min(uint(cell.y + ((corner >> 1) & 1)), field.gridY - 1u);
    uint z = min(uint(cell.z + (corner >> 2)), field.gridZ - 1u);
    return x + field.gridX * (y + field.gridY * z);
}

/// One ray, field space, unit direction. Reads: distanceReads counts both levels.
SCONCE_FN TraceResult b0TraceRay(vec3 origin, vec3 direction)
{
    TraceResult result;
    result.status = kUnknown;
    result.probe = kNoProbe;
    result.face = -1;
    result.pixel = vec2(real(0.0), real(0.0));
    result.word = 0u;
    result.handoffs = 0;
    result.indexReads = 0;
    B0Ray ray;
    ray.direction = direction;
    ray.reads = 0;
    ray.tMin = real(0.0);
    ray.t = real(0.0);
    ray.pixel = vec2(real(0.0), real(0.0));
    ray.word = 0u;
    real tMax = fieldExit(origin, direction);
    ivec3 cell = b0Cell(origin);
    int corner = b0NearestCorner(origin, cell);
    int tries = 0;
    for (int i = 0; i < kB0Limit && tries < kB0Tries; ++i)
    {
        ray.probe = b0ProbeIndex(cell, corner);
        ray.relative = origin - vec3(probeHeader(ray.probe).centre);
        result.probe = ray.probe;
        result.handoffs = i;
        result.status = ray.tMin < tMax ? b0Probe(ray, tMax) : kMiss;
        if (result.status != kUnknown) break;
        ++tries;
        vec3 at = origin + ray.tMin * direction;
        ivec3 now = b0Cell(at);
        if (now.x != cell.x || now.y != cell.y || now.z != cell.z)
        {
            cell = now;
            corner = b0NearestCorner(at, cell);
            tries = 0;
        }
        else corner = (corner + 3) & 7;
    }
    result.t = result.status == kHit ? ray.t : (result.status == kMiss ? tMax : ray.tMin);
    if (result.status != kMiss && ray.word != 0u) // unknown: the last occluder seen, which the paper takes as hit
    {
        result.face = 0;
        result.pixel = ray.pixel;
        result.word = ray.word;
    }
    result.distanceReads = ray.reads;
    return result;
}

/// Radiance of a hit: bilinear at the hit pixel, as the supplement of the paper reads it.
SCONCE_FN vec3 b0Radiance(SCONCE_IN(TraceResult) hit)
{
    int n = int(field.faceSize);
    real x = clamp(hit.pixel.x - real(0.5), real(0.0), real(n) - real(1.001));
    real y = clamp(hit.pixel.y - real(0.5), real(0.0), real(n) - real(1.001));
    int x0 = int(x), y0 = int(y);
    real fx = x - real(x0), fy = y - real(y0);
    uint first = (hit.probe * field.faceSize + uint(y0)) * field.faceSize + uint(x0);
    return (real(1.0) - fy) * ((real(1.0) - fx) * unpackRadiance(radianceWord(first)) + fx * unpackRadiance(radianceWord(first + 1u))) +
           fy * ((real(1.0) - fx) * unpackRadiance(radianceWord(first + uint(n))) + fx * unpackRadiance(radianceWord(first + uint(n) + 1u)));
}
