// One probe of baselines B0 and B0+: the tracer of McGuire et al. 2017, "Real-Time Global Illumination using Precomputed Light Field
// Probes", section 4, on octahedral probes, rebuilt from the paper's and its supplement's formulas and constants. kBaseline switches what
// differs. B0 (kBaselineB0) keeps the supplement's defects; B0+ mends them:
//   the ray's distance in a direction  one of two denominators by a fixed test     | the largest of three
//   hand-over point                    direction where the run of fine texels began | where the step began
//   last texel of a segment            may go untested                             | tested
// One more is left as it is: a step is one texel along the longer axis and may jump a corner of a texel on the shorter one. Visiting every
// texel that the line touches made B0+ slower and less right.
// In both, the hit test stands behind the march loops, where it costs the other lanes nothing; its results do not depend on that.
// Shared text, see shared/probe_trace.h; needs distanceWord, `field` with the octahedral chart, whose info.topLevel is log2 of its low factor, and kBaseline.

SCONCE_CONST bool kPublished = kBaseline == kBaselineB0;

struct B0Ray
{
    vec3 relative;  // origin relative to the probe
    vec3 direction;
    uint probe;
    real tMin;      // resumes here
    int reads;
    real t;         // of a hit
    vec2 pixel;     // of the last texel that stopped the march
    uint word;
    // where the march stopped
    bool certain;   // the ray is behind everything the texel shows: nothing to test
    real nearest;   // the lesser distance of the ray from the probe over the step
    vec3 before;    // hand-over point, relative to the probe
};

/// Distance from the probe, in direction v, of the point of the ray that lies in that direction.
SCONCE_FN real b0Radial(SCONCE_IN(B0Ray) ray, vec3 v)
{
    vec3 o = ray.relative;
    vec3 d = ray.direction;
    real r;
    if (kPublished)
    {
        real first = v.y * d.z - v.z * d.y;
        r = abs(first) > real(0.1) ? (o.y * d.z - o.z * d.y) / first : (o.x * d.y - o.y * d.x) / (v.x * d.y - v.y * d.x);
    }
    else
    {
        vec3 n = cross(o, d);
        vec3 m = cross(v, d);
        real ax = abs(m.x), ay = abs(m.y), az = abs(m.z);
        r = ax >= ay && ax >= az ? n.x / m.x : (ay >= az ? n.y / m.y : n.z / m.z);
    }
    return r > real(0.0) ? r : real(0.0); // NaN too
}

SCONCE_FN vec3 b0Direction(vec2 pixel) { return directionFromOctahedral(pixel / real(field.faceSize)); }

SCONCE_FN real b0Distance(uint word) { return (word & 0xffffu) == 0x7c00u ? real(1e9) : halfToReal(word); }

SCONCE_FN uint b0Fetch(SCONCE_INOUT(B0Ray) ray, int x, int y)
{
    int n = int(field.faceSize);
    ++ray.reads;
    return distanceWord(ray.probe * field.wordsPerProbe + uint(min(max(y, 0), n - 1) * n + min(max(x, 0), n - 1)));
}

SCONCE_FN int b0LowFactor() { return 1 << int(field.topLevel); }

SCONCE_FN real b0FetchLow(SCONCE_INOUT(B0Ray) ray, int x, int y)
{
    int n = int(field.faceSize);
    int m = n >> int(field.topLevel);
    ++ray.reads;
    return b0Distance(distanceWord(ray.probe * field.wordsPerProbe + uint(n * n + min(max(y, 0), m - 1) * m + min(max(x, 0), m - 1))));
}

SCONCE_FN void b0Stop(SCONCE_INOUT(B0Ray) ray, vec2 pixel, uint word, real nearest, vec3 before)
{
    ray.pixel = pixel;
    ray.word = word;
    ray.nearest = nearest;
    ray.before = before;
    ray.certain = false;
}

/// The hit rule at the texel where the march stopped.
SCONCE_FN uint b0Resolve(SCONCE_INOUT(B0Ray) ray)
{
    real tBefore = dot(ray.before - ray.relative, ray.direction);
    if (ray.certain)
    {
        ray.tMin = max(ray.tMin, tBefore);
        return kUnknown;
    }
    real r = b0Distance(ray.word);
    vec3 v = b0Direction(ray.pixel);
    vec3 n = unpackNormal8(ray.word >> 16);
    real t = dot(r * v - ray.relative, ray.direction);
    real metres = real(field.scale);
    real thickness = (real(0.03) + real(0.47) * max(dot(ray.direction, v), real(0.0)) * (real(2.0) - abs(dot(ray.direction, n))) *
                                       clamp(real(0.1) * t * metres, real(0.05), real(1.0))) / metres;
    if (ray.nearest < r + thickness && dot(n, ray.direction) < real(0.0))
    {
        ray.t = t;
        return kHit;
    }
    ray.tMin = max(ray.tMin, min(t, tBefore));
    return kUnknown;
}

/// A straight line P0 + l dP, l in [0,1], over the map's texels.
struct B0Line
{
    vec2 P0;
    vec2 dP;
};

/// The run of fine texels from `entry` to `leave` (pixels): one texel a step along the longer axis, sampled at the step's middle. True: the
/// march stopped.
SCONCE_FN bool b0Fine(SCONCE_INOUT(B0Ray) ray, vec2 entry, vec2 leave)
{
    vec2 across = leave - entry;
    real steps = max(abs(across.x), abs(across.y));
    vec3 va = b0Direction(entry);
    real ra = b0Radial(ray, va);
    for (int i = 0; i < 2 * b0LowFactor() + 4 && real(i) <= steps; ++i)
    {
        vec2 middle = entry + min((real(i) + real(0.5)) / max(steps, real(1e-6)), real(1.0)) * across;
        vec3 vb = b0Direction(entry + min((real(i) + real(1.0)) / max(steps, real(1e-6)), real(1.0)) * across);
        real rb = b0Radial(ray, vb);
        uint word = b0Fetch(ray, int(middle.x), int(middle.y));
        if (max(ra, rb) >= b0Distance(word))
        {
            b0Stop(ray, middle, word, min(ra, rb), ra * va);
            return true;
        }
        ra = rb;
        if (!kPublished) va = vb; // the supplement measures its hand-over from where the run began
    }
    return false;
}

/// The walk over the low-resolution texels from `entry` (pixels) to P1. True: a texel that may hold the hit, entered at
/// `entry` and left at `leave`.
SCONCE_FN bool b0Low(SCONCE_INOUT(B0Ray) ray, SCONCE_INOUT(vec2) entry, vec2 P1, SCONCE_OUT(vec2) leave)
{
    real size = real(b0LowFactor());
    vec2 start = entry;
    vec2 p = entry / size;
    vec2 end = P1 / size;
    leave = P1;
    if (dot(end - p, end - p) < real(1e-4)) end = end + vec2(real(0.01), real(0.01));
    vec2 along = end - p;
    bool xMajor = abs(along.x) >= abs(along.y);
    vec2 dp = along / (xMajor ? abs(along.x) : abs(along.y)); // the longer axis advances by one
    for (int i = 0; i < 4 * (int(field.faceSize) >> int(field.topLevel)) + 4; ++i)
    {
        vec2 left = end - p;
        if ((xMajor ? left.x * dp.x : left.y * dp.y) <= real(0.0)) return false;
        ivec2 cell = ivec2(int(floor(p.x)), int(floor(p.y)));
        real bx = dp.x > real(0.0) ? real(cell.x) + real(1.0) - p.x : p.x - real(cell.x);
        real by = dp.y > real(0.0) ? real(cell.y) + real(1.0) - p.y : p.y - real(cell.y);
        real s = min(abs(dp.x) > real(1e-9) ? bx / abs(dp.x) : real(1e9), abs(dp.y) > real(1e-9) ? by / abs(dp.y) : real(1e9));
        entry = p * size;
        leave = (p + s * dp) * size;
        if (dot(leave - start, leave - start) > dot(P1 - start, P1 - start)) leave = P1;
        real nearest = b0FetchLow(ray, cell.x, cell.y);
        if (nearest < max(b0Radial(ray, b0Direction(entry)), b0Radial(ray, b0Direction(leave)))) return true;
        p += (s + real(0.001)) * dp;
    }
    return false;
}

SCONCE_FN bool b0Segment(SCONCE_INOUT(B0Ray) ray, SCONCE_IN(B0Line) line)
{
    vec2 P1 = line.P0 + line.dP;
    vec2 p = line.P0;
    vec2 leave;
    for (int i = 0; i < 4 * (int(field.faceSize) >> int(field.topLevel)) + 4; ++i)
    {
        if (!b0Low(ray, p, P1, leave)) return false;
        if (b0Fine(ray, p, leave)) return true;
        vec2 rest = P1 - p;
        real length_ = length(rest);
        // The supplement ends within a texel of the segment's end, which may go untested.
        if (!(length_ > real(0.0)) || dot(rest, P1 - leave) <= (kPublished ? real(1.0) : real(0.1)) * length_) return false;
        p = leave + real(0.1) / length_ * rest;
    }
    return false;
}

/// The image of the ray between t0 and t1, a straight line within an octant of the map.
SCONCE_FN B0Line b0Project(SCONCE_IN(B0Ray) ray, real t0, real t1)
{
    real bump = real(0.001) / real(field.scale); // 1 mm: keeps both ends off the octants' borders, which have two images
    vec3 start = ray.relative + (t0 + bump) * ray.direction;
    vec3 end = ray.relative + (t1 - bump) * ray.direction;
    if (dot(start, start) < real(0.001) / real(field.scale * field.scale)) start = ray.direction; // square metres
    B0Line line;
    line.P0 = octahedralFromDirection(start) * real(field.faceSize);
    line.dP = octahedralFromDirection(end) * real(field.faceSize) - line.P0;
    return line;
}

struct B0Octants
{
    real t[5]; // segment i lies between t[i] and t[i + 1]
};

/// Cuts the ray from ray.tMin to tMax where it crosses the coordinate planes through the probe: up to four segments.
SCONCE_FN B0Octants b0Octants(SCONCE_IN(B0Ray) ray, real tMax)
{
    B0Octants cut;
    for (int a = 0; a < 3; ++a)
    {
        real cross_ = abs(ray.direction[a]) > real(1e-9) ? -ray.relative[a] / ray.direction[a] : real(-1.0);
        cut.t[a + 1] = clamp(cross_, ray.tMin, tMax);
    }
    cut.t[0] = ray.tMin;
    cut.t[4] = tMax;
    real low = min(cut.t[1], cut.t[2]), high = max(cut.t[1], cut.t[2]);
    cut.t[1] = min(low, cut.t[3]);
    real middle = max(low, cut.t[3]);
    cut.t[2] = min(middle, high);
    cut.t[3] = max(middle, high);
    return cut;
}
