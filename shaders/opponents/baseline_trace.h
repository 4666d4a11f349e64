// The opponents' loop over probes: from a ray to its result. kBaseline (baseline.h) says whose.
//   B0       the supplement's: the eight corners of the grid cell of the origin, +3 mod 8, indices that wrap at the far borders
//   B0+      the paper's first probe, nearest to the ray's line, and its re-pick of the cell as the ray proceeds; borders clamped
//   others   the ranked list of the octree's leaf at the point reached, and when that is used up those a little further on; probes tried
//            without progress are left out. Wang et al. keep their index in a sparse voxel octree of at most four probes a voxel; ours
//            (svo/octree.h), which does the same in fewer bytes, stands in for it. A probe lost by a back face asks again at that point.
// Shared text, see baseline_b0.h; needs rankedProbesAt, radianceWord.

SCONCE_CONST bool kFromOctree = kBaseline == kBaselineB0PlusOctree || kBaseline == kBaselineWang;
SCONCE_CONST int kB0Tries = 8;        // probes of a cell
SCONCE_CONST int kBaselineLimit = 64; // probes of a ray, over all cells
SCONCE_CONST int kListLimit = 25;     // the same of one whose probes come from lists

struct BaselineChoice
{
    uint probe;
    // grid
    ivec3 cell;
    int corner;
    int tries;
    // lists
    TriedProbes tried;
    real tClear; // t at which the tried set was last cleared
    int indexReads;
};

SCONCE_FN uint baselineProbe(SCONCE_INOUT(B0Ray) ray, real tMax)
{
    B0Octants cut = b0Octants(ray, tMax);
    bool stopped = false;
    for (int i = 0; i < 4 && !stopped; ++i)
    {
        if (cut.t[i + 1] - cut.t[i] < real(0.001) / real(field.scale)) continue;
        B0Line line = b0Project(ray, cut.t[i], cut.t[i + 1]);
        if (kBaseline == kBaselineWang) stopped = wangSegment(ray, line);
        else stopped = b0Segment(ray, line);
    }
    return stopped ? b0Resolve(ray) : kMiss;
}

SCONCE_FN vec3 b0GridPoint(vec3 p) { return (p - vec3(field.gridOrigin)) / vec3(field.gridStep); }

/// The last cell along an axis. The supplement's has corners beyond the grid, which wrap round; all of the last true cell's are probes.
SCONCE_FN real b0LastCell(uint count)
{
    if (kPublished) return real(count - 1u);
    return real(max(int(count) - 2, 0));
}

SCONCE_FN ivec3 b0Cell(vec3 p)
{
    vec3 g = b0GridPoint(p);
    return ivec3(int(clamp(floor(g.x), real(0.0), b0LastCell(field.gridX))), int(clamp(floor(g.y), real(0.0), b0LastCell(field.gridY))),
                 int(clamp(floor(g.z), real(0.0), b0LastCell(field.gridZ))));
}

/// Corner of the cell whose probe is nearest to the point in grid units, bits xyz; corners beyond the grid are those within it.
SCONCE_FN int b0NearestCorner(vec3 p, ivec3 cell)
{
    vec3 g = b0GridPoint(p) - vec3(real(cell.x), real(cell.y), real(cell.z));
    return (g.x > real(0.5) && cell.x + 1 < int(field.gridX) ? 1 : 0) | (g.y > real(0.5) && cell.y + 1 < int(field.gridY) ? 2 : 0) |
           (g.z > real(0.5) && cell.z + 1 < int(field.gridZ) ? 4 : 0);
}

SCONCE_FN uint b0ProbeIndex(ivec3 cell, int corner)
{
    uint x = uint(cell.x + (corner & 1));
    uint y = uint(cell.y + ((corner >> 1) & 1));
    uint z = uint(cell.z + (corner >> 2));
    if (kPublished) return (x + field.gridX * (y + field.gridY * z)) & (field.probeCount - 1u); // counts are powers of two
    x = min(x, field.gridX - 1u);
    y = min(y, field.gridY - 1u);
    z = min(z, field.gridZ - 1u);
    return x + field.gridX * (y + field.gridY * z);
}

/// Corner of the cell whose probe is nearest to the ray's line, from `origin` on (McGuire et al. 2017, section 4.2).
SCONCE_FN int b0NearestToLine(vec3 origin, vec3 direction, ivec3 cell)
{
    int nearest = 0;
    real least = real(3e38);
    for (int corner = 0; corner < 8; ++corner)
    {
        vec3 away = vec3(probeHeader(b0ProbeIndex(cell, corner)).centre) - origin;
        real along = max(dot(away, direction), real(0.0));
        real apart = dot(away, away) - along * along;
        if (apart < least)
        {
            least = apart;
            nearest = corner;
        }
    }
    return nearest;
}

SCONCE_FN BaselineChoice beginChoice(vec3 origin, vec3 direction)
{
    BaselineChoice c;
    c.probe = kNoProbe;
    c.cell = ivec3(0, 0, 0);
    c.corner = 0;
    c.tries = 0;
    c.tried = noneTried();
    c.tClear = real(0.0);
    c.indexReads = 0;
    if (!kFromOctree)
    {
        c.cell = b0Cell(origin);
        if (kPublished) c.corner = b0NearestCorner(origin, c.cell);
        else c.corner = b0NearestToLine(origin, direction, c.cell);
        c.probe = b0ProbeIndex(c.cell, c.corner);
    }
    return c;
}

/// The grid's next probe once the last one lost the ray at `at`. False: all eight of the cell were asked.
SCONCE_FN bool nextOfGrid(SCONCE_INOUT(BaselineChoice) c, vec3 at, vec3 direction)
{
    ++c.tries;
    bool moved = false;
    if (!kPublished)
    {
        ivec3 now = b0Cell(at);
        moved = now.x != c.cell.x || now.y != c.cell.y || now.z != c.cell.z;
        if (moved)
        {
            c.cell = now;
            c.corner = b0NearestToLine(at, direction, now);
            c.tries = 0;
        }
    }
    // Along an axis of one probe corners are asked twice, the second time from where the ray has come to: left out, more rays stay unresolved.
    if (!moved) c.corner = (c.corner + 3) & 7;
    c.probe = b0ProbeIndex(c.cell, c.corner);
    return c.tries < kB0Tries;
}

/// The lists' best probe not yet tried at t. False: there is none.
SCONCE_FN bool nextOfLists(SCONCE_INOUT(BaselineChoice) c, vec3 origin, vec3 direction, real t)
{
    if (t > c.tClear + kProgress * real(field.diagonal))
    {
        keepLastTried(c.tried);
        c.tClear = t;
    }
    for (int list = 0; list < kLookAheads; ++list)
    {
        uvec4 ranked = rankedProbesAt(origin + (t + lookAhead(list) * real(field.voxel)) * direction, c.indexReads);
        for (int k = 0; k < kRanked; ++k)
        {
            if (wasTried(c.tried, ranked[k])) continue;
            if (c.tried.count >= kMaxTried) return false;
            c.probe = ranked[k];
            addTried(c.tried, c.probe);
            return true;
        }
    }
    return false;
}

/// Where an opponent's ray stands between two probes.
struct BaselineWalk
{
    B0Ray ray;
    BaselineChoice choice;
    vec3 origin;
    vec3 direction;
    real tMax;
    uint status;
    uint seenBy; // probe of the texel that stopped the march, which a lost ray shows
    int asked;   // probes
    bool asks;   // whether there is one to ask, choice.probe
};

/// How far off its origin a ray starts: the supplement's, a millimetre.
SCONCE_FN real baselineAhead() { return kPublished ? real(0.001) / real(field.scale) : real(0.0); }

/// A ray at its start, world space; one that is not finite, or has no unit direction, asks nobody: a MISS at t = 0.
SCONCE_FN BaselineWalk beginBaseline(vec3 from, vec3 towards)
{
    // Nothing is looked up at what is no number.
    bool can = canTrace(from, towards);
    vec3 origin = vec3(field.origin);
    vec3 direction = vec3(real(0.0), real(0.0), real(1.0));
    if (can)
    {
        origin = from;
        direction = towards;
    }
    BaselineWalk w;
    w.origin = (origin - vec3(field.origin)) / real(field.scale) + baselineAhead() * direction;
    w.direction = direction;
    w.status = kUnknown;
    w.seenBy = kNoProbe;
    w.asked = 0;
    w.ray.direction = direction;
    w.ray.reads = 0;
    w.ray.tMin = real(0.0);
    w.ray.t = real(0.0);
    w.ray.pixel = vec2(real(0.0), real(0.0));
    w.ray.word = 0u;
    w.ray.certain = false;
    w.ray.nearest = real(0.0);
    w.ray.before = w.origin;
    w.ray.probe = kNoProbe;
    w.ray.relative = w.origin;
    w.tMax = kPublished ? real(10000.0) / real(field.scale) : fieldExit(w.origin, direction);
    w.choice = beginChoice(w.origin, direction);
    w.asks = kFromOctree ? nextOfLists(w.choice, w.origin, direction, w.ray.tMin) : true;
    if (!can)
    {
        w.asks = false;
        w.status = kMiss;
        w.tMax = -baselineAhead();
        w.choice.indexReads = 0;
    }
    return w;
}

/// Asks the next probe.
SCONCE_FN void askNext(SCONCE_INOUT(BaselineWalk) w)
{
    vec2 pixel = w.ray.pixel;
    uint word = w.ray.word;
    real reached = w.ray.tMin;
    w.ray.probe = w.choice.probe;
    w.ray.relative = w.origin - vec3(probeHeader(w.ray.probe).centre);
    w.status = w.ray.tMin < w.tMax ? baselineProbe(w.ray, w.tMax) : kMiss;
    ++w.asked;
    w.asks = false;
    if (w.status == kMiss) return;
    // Of lists, as our tracer: of probes that bring a ray no further the first tells what a lost one shows. A grid's later ones are its cell's as well,
    // and tell more.
    bool further = !kFromOctree || w.status == kHit || w.seenBy == kNoProbe || w.ray.tMin > reached + kProgress * real(field.diagonal);
    if (!further)
    {
        w.ray.pixel = pixel;
        w.ray.word = word;
    }
    else if (!w.ray.certain) w.seenBy = w.ray.probe;
    if (w.status == kHit) return;
    if (kFromOctree) w.asks = nextOfLists(w.choice, w.origin, w.direction, w.ray.tMin);
    else w.asks = nextOfGrid(w.choice, w.origin + w.ray.tMin * w.direction, w.direction);
    w.asks = w.asks && w.asked < (kFromOctree ? kListLimit : kBaselineLimit);
}

/// What a ray has come to. distanceReads counts all levels of the maps.
SCONCE_FN TraceResult baselineResult(SCONCE_IN(BaselineWalk) w)
{
    TraceResult result;
    result.confidence = real(0.0); // the opponents have none
    result.status = w.status;
    result.probe = w.ray.probe;
    result.face = -1;
    result.pixel = vec2(real(0.0), real(0.0));
    result.word = 0u;
    result.handoffs = max(w.asked - 1, 0);
    result.t = baselineAhead() + (w.status == kHit ? w.ray.t : (w.status == kMiss ? w.tMax : w.ray.tMin));
    if (w.status != kMiss && w.seenBy != kNoProbe) // unknown: an occluder, which the paper takes as hit
    {
        result.probe = w.seenBy;
        result.face = 0;
        result.pixel = w.ray.pixel;
        result.word = w.ray.word;
    }
    if (kPublished && w.status != kHit && w.asked > 0)
    {
        // The supplement fills what was not hit, sky included, with what the grid point nearest to the origin sees in that direction.
        vec3 g = b0GridPoint(w.origin);
        ivec3 nearest = ivec3(int(clamp(floor(g.x + real(0.5)), real(0.0), real(field.gridX - 1u))),
                              int(clamp(floor(g.y + real(0.5)), real(0.0), real(field.gridY - 1u))),
                              int(clamp(floor(g.z + real(0.5)), real(0.0), real(field.gridZ - 1u))));
        result.probe = b0ProbeIndex(nearest, 0);
        result.face = 0;
        result.pixel = octahedralFromDirection(w.direction) * real(field.faceSize);
        result.word = 0u;
    }
    result.distanceReads = w.ray.reads;
    result.indexReads = w.choice.indexReads;
    return result;
}

/// Bilinear at the pixel, as the supplement reads it.
SCONCE_FN vec3 baselineRadiance(SCONCE_IN(TraceResult) hit)
{
    int n = int(field.faceSize);
    if (!holdsRadiance() && !holdsPrefiltered()) return vec3(real(0.0));
    if (!holdsRadiance()) return prefilteredRadiance(hit.probe, directionFromOctahedral(hit.pixel / real(n)), real(0.0));
    real x = hit.pixel.x - real(0.5), y = hit.pixel.y - real(0.5);
    int x0 = min(max(int(floor(x)), 0), n - 2);
    int y0 = min(max(int(floor(y)), 0), n - 2);
    real fx = clamp(x - real(x0), real(0.0), real(1.0));
    real fy = clamp(y - real(y0), real(0.0), real(1.0));
    uint first = (hit.probe * field.faceSize + uint(y0)) * field.faceSize + uint(x0);
    return (real(1.0) - fy) * ((real(1.0) - fx) * unpackRadiance(radianceWord(first)) + fx * unpackRadiance(radianceWord(first + 1u))) +
           fy * ((real(1.0) - fx) * unpackRadiance(radianceWord(first + uint(n))) + fx * unpackRadiance(radianceWord(first + uint(n) + 1u)));
}

/// The answer of an opponent's result.
SCONCE_FN RayHit baselineAnswer(vec3 origin, vec3 direction, SCONCE_IN(TraceResult) r)
{
    vec3 normal = vec3(real(0.0));
    vec3 radiance = vec3(real(0.0));
    if (r.face >= 0)
    {
        if (r.word != 0u) normal = unpackNormal8(r.word >> 16);
        radiance = baselineRadiance(r);
    }
    RayHit hit = answer(origin, direction, r, normal, radiance);
    if (kPublished && r.face >= 0) hit.radiance = vec3f(radiance); // the fill-in stands for the sky, too
    return hit;
}

/// A world-space ray through the light field with the opponent.
SCONCE_FN RayHit baselineQuery(vec3 origin, vec3 direction)
{
    BaselineWalk w = beginBaseline(origin, direction);
    while (w.asks) askNext(w);
    return baselineAnswer(origin, direction, baselineResult(w));
}
