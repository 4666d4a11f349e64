// A ray through one probe: its pieces on the cube's faces, the march over a face's chain, and what it comes to there. Shared text, see
// probe_trace.h; needs ray_state.h, face_chain.h, chart.h and texel.h.
//
// Along one cube face the pixel P, q = 1/W and t q are linear in one screen parameter s in [0,1], and a surfel's plane is linear in (P, q):
// the march needs no division, root or normalisation. It steps a Hi-Z chain (Uludag 2014, "Hi-Z Screen-Space Cone-Traced Reflections";
// Wang et al. 2019, section 4.2) whose cells hold bounding planes (face_chain.h), and ends in the plane of one surfel.

SCONCE_CONST real kNever = real(3e38);    // a t beyond every ray's
SCONCE_CONST real kNoLength = real(1e-12); // keeps divisors from 0: far below what a step of a texel, or the slowest change over one, comes to
// A ray that lies in the border of a face belongs to this side of it, by so many texels: 2^-12, which a float still holds at N = 2,048.
SCONCE_CONST real kFaceBorder = real(0.000244140625);
SCONCE_CONST real kBehind = real(0.00048828125); // 2^-11 texel, more than rounding can put a point ahead of the texel it is in
SCONCE_CONST real kSegmentEnd = real(0.99999);   // s from which on the rest of a segment is rounding
SCONCE_CONST real kBeforeBound = real(0.9999);   // share of the way to a cell's bound that is taken: rounding must not overshoot it
SCONCE_CONST real kLeastCosine = real(0.12); // of a ray to a surfel: at a smaller one the surfel's thickness along the ray would grow without end
SCONCE_CONST real kThickest = real(8.84);    // 1 / kLeastCosine + 1 / 2, rounded up: a surfel's greatest thickness in footprints
SCONCE_CONST real kProgress = real(1e-4);    // share of the diagonal that a ray must come on to ask probes again
SCONCE_CONST real kAtEntry = real(0.25);     // footprints that a surfel may lie before the ray where a probe has just taken it over
SCONCE_CONST real kDekker = real(4097.0);    // 2^12 + 1: splits the 24 bits of a float into halves
SCONCE_CONST int kCoarsestCell = 64;         // texels a side of the coarsest level's cells

/// Pixels are mirrored about the middle of this many texels, whole cells of every level, so that cells stay cells.
SCONCE_FN int mirrorSize() { return (int(field.faceSize) + kCoarsestCell - 1) & ~(kCoarsestCell - 1); }

/// Of a texel: its width relative to its distance along the face's axis.
SCONCE_FN real footprint() { return real(2.0) / real(field.faceSize); }

// A probe's map is six faces, or, where onOctahedron(), one octahedral map of eight octants (chart.h); "face" stands for either.
SCONCE_FN int mapFace(vec3 p) { return onOctahedron() ? octantOf(p) : dominantFace(p); }
SCONCE_FN vec3 mapCoordinates(int face, vec3 p) { return onOctahedron() ? octantCoordinates(face, p) : faceCoordinates(face, p); }
SCONCE_FN vec3 mapDirection(int face, vec3 uvw) { return onOctahedron() ? octantDirection(face, uvw) : faceDirection(face, uvw); }
SCONCE_FN vec3 mapNormal(int face, vec3 g) { return onOctahedron() ? octantNormal(face, g) : faceDirection(face, g); }

/// First word of the map that a face of a probe lies on.
SCONCE_FN uint mapWords(uint probe, int face)
{
    return mapSlot(probe) * field.wordsPerProbe + (onOctahedron() ? 0u : uint(face) * (field.wordsPerProbe / 6u));
}

/// First word of the block that a texel of a face is in, whose words begin there.
SCONCE_FN uint blockWords(uint faceWords, uint x, uint y) { return faceWords + kDistanceBlockWords * ((y / 4u) * (field.faceSize / 4u) + x / 4u); }

/// A texel of a face whose words begin there, as a word of level 0 (texel.h).
SCONCE_FN uint texelWord(uint faceWords, uint x, uint y)
{
    if (!mapsInBlocks()) return distanceWord(faceWords + y * field.faceSize + x);
    uint block = blockWords(faceWords, x, y);
    uint row = distanceWord(block + 4u + (y & 3u));
    return blockTexel(distanceWord(block + blockPlane(row, x & 3u)), row, x & 3u, y & 3u);
}

/// Where the words of a face's coarser levels and far bounds lie, from where they would without blocks.
SCONCE_FN uint behindTexels(uint offset) { return mapsInBlocks() ? offset - wordsOfBlocksSaved(field.faceSize) : offset; }

/// Inside the ball about the centre nothing can be met: a segment that starts there starts where the ray leaves it (this also removes the
/// singularity at W = 0).
/// @return  where the ray comes into the ball, if that lies ahead, else kNever
SCONCE_FN real leaveFreeBall(SCONCE_INOUT(RayState) r)
{
    real b = dot(r.visit.relative, r.ray.direction);
    vec3 nearest = r.visit.relative - b * r.ray.direction;
    real h2 = r.visit.freeBall * r.visit.freeBall - dot(nearest, nearest);
    real ballIn = kNever;
    if (h2 > real(0.0))
    {
        real h = sqrt(h2);
        real ballOut = h - b;
        if (r.segment.ta >= -h - b && r.segment.ta < ballOut)
        {
            r.segment.ta = ballOut;
            r.segment.nextFace = kFaceToSearch;
        }
        else if (r.segment.ta < -h - b) ballIn = -h - b;
    }
    return ballIn;
}

/// Whether the ray, or what this probe may cost it, ends before another segment.
SCONCE_FN bool endsBeforeSegment(SCONCE_INOUT(RayState) r)
{
    if (r.segment.ta >= r.ray.tMax || r.segment.nextFace == kFaceNone)
    {
        r.t = r.ray.tMax;
        r.status = kMiss;
        r.phase = kPhaseDone;
        return true;
    }
    if (r.visit.segments <= kMaxSegments) return false;
    r.t = max(r.t, r.segment.ta);
    r.phase = kPhaseChoose;
    return true;
}

/// Where the segment ends, and on which face the ray goes on: behind the nearest of the face's side planes, unless the ray comes into the free
/// ball, or leaves the field, before. The next face is that plane's, never found from the point, which may be rounded to either side.
/// @param f0, f1  the ray's origin and direction in the face's coordinates
SCONCE_FN void findExit(SCONCE_INOUT(RayState) r, vec3 f0, vec3 f1, real ballIn)
{
    real tb = r.ray.tMax;
    int next = kFaceNone;
    if (ballIn < tb)
    {
        tb = ballIn;
        next = kFaceToSearch;
    }
    int face = r.segment.face;
    for (int plane = 0; plane < (onOctahedron() ? 3 : 4); ++plane)
    {
        real side = (plane & 1) != 0 ? real(1.0) : real(-1.0); // W - U, W + U, W - V, W + V
        real g0 = f0.z + side * (plane < 2 ? f0.x : f0.y);
        real g1 = f1.z + side * (plane < 2 ? f1.x : f1.y);
        if (onOctahedron())
        {
            side = ((face >> plane) & 1) != 0 ? real(-1.0) : real(1.0); // x, y, z = 0
            g0 = side * r.visit.relative[plane];
            g1 = side * r.ray.direction[plane];
        }
        if (g1 < real(0.0))
        {
            real t = -g0 / g1;
            if (t < tb)
            {
                tb = t;
                int axis = (face >> 1) + (plane < 2 ? 1 : 2);
                next = onOctahedron() ? face ^ (1 << plane) : 2 * (axis % 3) + (plane & 1);
            }
        }
    }
    r.segment.tb = max(tb, r.segment.ta);
    r.segment.nextFace = next;
}

/// The segment's image: pixels, mirrored so that the march only ever goes up, q and t q, all linear in s.
/// @return  false: a corner of rounding, nothing of the ray lies on this face
SCONCE_FN bool projectSegment(SCONCE_INOUT(Segment) g, vec3 f0, vec3 f1)
{
    real size = real(field.faceSize);
    real Wa = f0.z + g.ta * f1.z;
    real Wb = f0.z + g.tb * f1.z;
    if (!(Wa > real(0.0)) || !(Wb > real(0.0))) return false;
    real qa = real(1.0) / Wa;
    real qb = real(1.0) / Wb;
    vec2 Pa = vec2(clamp(real(0.5) * size * ((f0.x + g.ta * f1.x) * qa + real(1.0)), kFaceBorder, size - kFaceBorder),
                   clamp(real(0.5) * size * ((f0.y + g.ta * f1.y) * qa + real(1.0)), kFaceBorder, size - kFaceBorder));
    vec2 Pb = vec2(clamp(real(0.5) * size * ((f0.x + g.tb * f1.x) * qb + real(1.0)), kFaceBorder, size - kFaceBorder),
                   clamp(real(0.5) * size * ((f0.y + g.tb * f1.y) * qb + real(1.0)), kFaceBorder, size - kFaceBorder));
    g.mirrorX = Pb.x < Pa.x;
    g.mirrorY = Pb.y < Pa.y;
    real mirror = real(mirrorSize());
    if (g.mirrorX)
    {
        Pa.x = mirror - Pa.x;
        Pb.x = mirror - Pb.x;
    }
    if (g.mirrorY)
    {
        Pa.y = mirror - Pa.y;
        Pb.y = mirror - Pb.y;
    }
    g.P = Pa;
    g.dP = Pb - Pa;
    g.iP = vec2(real(1.0) / max(g.dP.x, kNoLength), real(1.0) / max(g.dP.y, kNoLength));
    g.q0 = qa;
    g.dq = qb - qa;
    g.tq0 = g.ta * qa;
    g.dtq = g.tb * qb - g.tq0;
    g.ix = int(Pa.x);
    g.iy = int(Pa.y);
    g.ex = int(Pb.x);
    g.ey = int(Pb.y);
    g.s = real(0.0);
    return true;
}

/// The piece of the ray from segment.ta to where it leaves the face, the free ball's surroundings or the field.
SCONCE_FN void setUpSegment(SCONCE_INOUT(RayState) r)
{
    real ballIn = leaveFreeBall(r);
    ++r.visit.segments;
    if (endsBeforeSegment(r)) return;
    r.segment.face = r.segment.nextFace >= 0 ? r.segment.nextFace : mapFace(r.visit.relative + r.segment.ta * r.ray.direction);
    vec3 f0 = mapCoordinates(r.segment.face, r.visit.relative);
    vec3 f1 = mapCoordinates(r.segment.face, r.ray.direction);
    findExit(r, f0, f1, ballIn);
    if (!projectSegment(r.segment, f0, f1))
    {
        r.segment.ta = r.segment.tb;
        if (r.segment.tb <= r.t) r.segment.nextFace = kFaceToSearch;
        return;
    }
    r.segment.level = min(r.visit.segments == 1 ? quality.startLevel : quality.coarsestLevel, int(field.topLevel));
    r.segment.faceWords = mapWords(r.visit.probe, r.segment.face);
    r.phase = kPhaseMarch;
}

/// q of a texel's plane minus q of the ray is linear in s: value at s = 0 and slope. Positive g: the ray is nearer than the surface.
SCONCE_FN vec2 planeLine(SCONCE_IN(Segment) g, uint word, real cx, real cy)
{
    real qc = halfToReal(word);
    real gx = qc * unpackGradient(word >> 16);
    real gy = qc * unpackGradient(word >> 24);
    if (g.mirrorX) gx = -gx;
    if (g.mirrorY) gy = -gy;
    return vec2(g.q0 - (qc + gx * (g.P.x - cx) + gy * (g.P.y - cy)), g.dq - (gx * g.dP.x + gy * g.dP.y));
}

/// A row or column of a level's cells, of a texel's that may be mirrored.
SCONCE_FN uint cellOf(int texel, bool mirrored, int level)
{
    int last = (mirrorSize() >> level) - 1;
    int cell = texel >> level;
    return uint(mirrored ? last - cell : cell);
}

/// Cell of a level, row-major, of (mirrored) texel x, y.
SCONCE_FN uint cellIndex(SCONCE_IN(Segment) g, int x, int y, int level)
{
    return cellOf(y, g.mirrorY, level) * chainWidth(field.faceSize, level) + cellOf(x, g.mirrorX, level);
}

/// Word of a texel, or of a level's cell. Lanes that march beside each other read on different levels: of a block's words the first is read with the
/// others' cells.
SCONCE_FN uint cellWord(SCONCE_IN(Segment) g, int x, int y, int level)
{
    uint at = g.faceWords + behindTexels(chainOffset(field.faceSize, level)) + cellIndex(g, x, y, level);
    if (!mapsInBlocks()) return distanceWord(at);
    uint cx = cellOf(x, g.mirrorX, 0);
    uint cy = cellOf(y, g.mirrorY, 0);
    uint block = blockWords(g.faceWords, cx, cy);
    uint word = distanceWord(level == 0 ? block + 4u + (cy & 3u) : at);
    if (level != 0) return word;
    return blockTexel(distanceWord(block + blockPlane(word, cx & 3u)), word, cx & 3u, cy & 3u);
}

/// Slack of the hit rule at q, relative to the distance: no more than a texel is wide, so that a room in a landscape keeps its own measure.
SCONCE_FN real slack(real q) { return min(quality.epsilon * real(field.diagonal) * q, footprint()); }

/// Whether the ray, q between qs and qe, is behind everything in a cell by more than any surfel's thickness: what its texels would say one
/// by one, said at once.
SCONCE_FN bool behindCell(SCONCE_INOUT(RayState) r, uint index, real qs, real qe)
{
    uint cell = chainOffset(field.faceSize, r.segment.level) - field.faceSize * field.faceSize + index;
    uint word = distanceWord(r.segment.faceWords + behindTexels(chainNearWords(field.faceSize, int(field.topLevel))) + cell / 2u);
    ++r.cost.distanceReads;
    real thickest = quality.tolerance * footprint() * kThickest + slack(max(qs, qe));
    return max(qs, qe) * (real(1.0) + thickest) < farBoundIn(word, cell);
}

SCONCE_FN void endSegment(SCONCE_INOUT(RayState) r)
{
    r.t = max(r.t, r.segment.tb);
    r.segment.ta = max(r.segment.tb, r.segment.ta);
    r.phase = kPhaseSegment;
}

SCONCE_FN real timeAt(SCONCE_IN(Segment) g, real s) { return (g.tq0 + s * g.dtq) / (g.q0 + s * g.dq); }

SCONCE_FN void rememberSurfel(SCONCE_INOUT(RayState) r, real s)
{
    real size = real(mirrorSize());
    real x = real(r.segment.ix);
    real y = real(r.segment.iy);
    vec2 p = vec2(clamp(r.segment.P.x + s * r.segment.dP.x, x, x + real(1.0)), clamp(r.segment.P.y + s * r.segment.dP.y, y, y + real(1.0)));
    r.surfel.pixel = vec2(r.segment.mirrorX ? size - p.x : p.x, r.segment.mirrorY ? size - p.y : p.y);
    r.surfel.word = r.segment.word;
    r.surfel.probe = r.visit.probe;
    r.surfel.face = r.segment.face;
}

/// Extent on its surface of a texel of the current face, field units.
SCONCE_FN real texelExtent(SCONCE_IN(Segment) g, uint word)
{
    real gx = unpackGradient(word >> 16);
    real gy = unpackGradient(word >> 24);
    return max(sqrt(gx * gx + gy * gy), footprint()) / max(g.q0 + g.s * g.dq, kNoLength);
}

/// s at which the ray crosses a border of texels, along one axis. From the border alone: the same number whichever level's cell ends there.
SCONCE_FN real sAtBorder(int border, real p, real inverse) { return (real(border) - p) * inverse; }

/// s at which the ray comes into its texel; 0 in the one that the segment starts in.
SCONCE_FN real sEntry(SCONCE_IN(Segment) g)
{
    return max(max(sAtBorder(g.ix, g.P.x, g.iP.x), sAtBorder(g.iy, g.P.y, g.iP.y)), real(0.0));
}

/// The border through which the ray came into its texel: 0 none, 1 in x, 2 in y.
SCONCE_FN int entryAxis(SCONCE_IN(Segment) g)
{
    real sx = sAtBorder(g.ix, g.P.x, g.iP.x);
    real sy = sAtBorder(g.iy, g.P.y, g.iP.y);
    if (max(sx, sy) <= real(0.0)) return 0;
    return sx > sy ? 1 : 2;
}

/// Where the ray meets the plane of the texel segment.word (`plane`), or else comes into that texel. With x, y the texel's middle in pixels from the
/// face's centre, the plane is 1 = q (W + gx (N/2 U - x W) + gy (N/2 V - y W)); a border of texels at x is N/2 U = x W. Far from the probe the
/// t of a near hit is the difference of large numbers, so that the ray's start is taken to more digits than one number holds: what rounding
/// took from it relative to the probe comes back (Knuth's two-sum), and W is multiplied in two halves (Dekker 1971).
SCONCE_FN real timeOfEvent(SCONCE_IN(RayState) r, bool plane)
{
    int axis = plane ? 0 : entryAxis(r.segment);
    if (!plane && axis == 0) return r.segment.ta;
    vec3 start = mapCoordinates(r.segment.face, r.visit.relative);
    vec3 step = mapCoordinates(r.segment.face, r.ray.direction);
    SCONCE_EXACT vec3 centre = r.ray.origin - r.visit.relative;
    SCONCE_EXACT vec3 place = (r.ray.origin - (r.visit.relative + centre)) + (centre - vec3(probeHeader(r.visit.probe).centre));
    vec3 lost = mapCoordinates(r.segment.face, place);
    SCONCE_EXACT real wide = kDekker * start.z;
    SCONCE_EXACT real high = wide - (wide - start.z);
    SCONCE_EXACT real low = (start.z - high) + lost.z;

    real half_ = real(0.5) * real(field.faceSize);
    real middle = plane ? real(0.5) : real(0.0);
    real x = (r.segment.mirrorX ? real(mirrorSize() - r.segment.ix) - middle : real(r.segment.ix) + middle) - half_;
    real y = (r.segment.mirrorY ? real(mirrorSize() - r.segment.iy) - middle : real(r.segment.iy) + middle) - half_;
    SCONCE_EXACT real fromX = ((half_ * start.x - x * high) - x * low) + half_ * lost.x;
    SCONCE_EXACT real fromY = ((half_ * start.y - y * high) - y * low) + half_ * lost.y;
    real alongX = half_ * step.x - x * step.z;
    real alongY = half_ * step.y - y * step.z;
    real q = halfToReal(r.segment.word);
    real gx = unpackGradient(r.segment.word >> 16);
    real gy = unpackGradient(r.segment.word >> 24);
    SCONCE_EXACT real from = axis == 1 ? fromX : fromY;
    real along = axis == 1 ? alongX : alongY;
    if (plane)
    {
        from = ((q * high - real(1.0)) + q * low) + q * (gx * fromX + gy * fromY);
        along = q * (step.z + gx * alongX + gy * alongY);
    }
    real t = -from / (abs(along) > kNoLength ? along : kNoLength);
    return min(max(t, r.segment.ta), r.segment.tb);
}

SCONCE_FN void endAsHit(SCONCE_INOUT(RayState) r, real s, real t)
{
    rememberSurfel(r, s);
    r.t = max(r.t, t);
    r.status = kHit;
    r.phase = kPhaseDone;
    if (r.asked.opinionT == kOpinionOpen && r.cost.handoffs <= quality.maxHandoffs && quality.opinion > real(0.0) &&
        r.surfel.extent > quality.opinion * real(field.diagonal))
    {
        r.asked.opinionT = r.t;
        r.phase = kPhaseChoose;
    }
}

SCONCE_FN void handOff(SCONCE_INOUT(RayState) r, real t)
{
    if (r.asked.opinionT >= real(0.0))
    {
        if (t <= r.asked.opinionReach) // no better known: the first answer, whose surfel is still remembered
        {
            r.t = r.asked.opinionT;
            r.status = kHit;
            r.phase = kPhaseDone;
            return;
        }
        r.asked.opinionT = kOpinionAsked;
    }
    // What a ray shows that no probe answers: what hid it, of the first probe that brought it so far, for that sees most of the place. From a later
    // one, which stands out in the open, a sunlit roof may hide a room.
    if (r.surfel.probe == kNoProbe || t > r.t + kProgress * real(field.diagonal)) rememberSurfel(r, r.segment.s);
    if (r.surfel.event != kEventFirst && t > r.t) r.asked.back = footprint() / (r.segment.q0 + r.segment.s * r.segment.dq);
    r.t = max(r.t, t);
    r.phase = kPhaseChoose;
}

/// Written without branches where it can be: lanes that march beside each other would take all of them in turn. Cells of coarse levels only
/// pass texels over: which texels a ray meets, and where it enters and leaves each, is the same number to the bit without them.
SCONCE_FN void march(SCONCE_INOUT(RayState) r)
{
    for (int step = 0; step < (shortTurns() ? kShortSteps : kMarchSteps); ++step)
    {
        int x = (r.segment.ix >> r.segment.level) << r.segment.level;
        int y = (r.segment.iy >> r.segment.level) << r.segment.level;
        int bx = x + (1 << r.segment.level);
        int by = y + (1 << r.segment.level);
        uint index = cellIndex(r.segment, x, y, r.segment.level);
        uint word = cellWord(r.segment, x, y, r.segment.level);
        ++r.cost.distanceReads;
        real sx = sAtBorder(bx, r.segment.P.x, r.segment.iP.x);
        real sy = sAtBorder(by, r.segment.P.y, r.segment.iP.y);
        real se = max(min(min(sx, sy), real(1.0)), r.segment.s);
        real half_ = real(0.5) * real(1 << r.segment.level);
        vec2 line = planeLine(r.segment, word, real(x) + half_, real(y) + half_);
        real gs = line.x + r.segment.s * line.y;
        real ge = line.x + se * line.y;
        bool left = min(sx, sy) < r.segment.s; // it is not in this cell any more: kBehind held it back
        bool blocked = (word & 0xffffu) != 0u && !left && min(gs, ge) < real(0.0);
        if (blocked && r.segment.level == 0)
        {
            r.segment.word = word;
            r.segment.sEnd = se;
            r.phase = kPhaseFine;
            break;
        }
        if (readsFarBounds() && blocked && max(gs, ge) <= real(0.0) && behindCell(r, index, r.segment.q0 + r.segment.s * r.segment.dq, r.segment.q0 + se * r.segment.dq))
        {
            r.segment.word = word;
            r.surfel.event = r.visit.fresh ? kEventFirst : kEventContinued;
            r.segment.s = sEntry(r.segment);
            handOff(r, timeOfEvent(r, false));
            break;
        }
        bool clip = blocked && gs > real(0.0); // in front so far: nothing of the cell is met before its bound
        real s = blocked ? r.segment.s : se;
        if (clip) s = min(max(r.segment.s + (se - r.segment.s) * (gs / (gs - ge)) * kBeforeBound, r.segment.s), se);
        bool crossX = !blocked && sx <= sy;
        bool crossY = !blocked && !crossX;
        int cx = max(r.segment.ix, min(int(r.segment.P.x + s * r.segment.dP.x - kBehind), min(r.segment.ex, bx - 1)));
        int cy = max(r.segment.iy, min(int(r.segment.P.y + s * r.segment.dP.y - kBehind), min(r.segment.ey, by - 1)));
        int crossed = crossX ? bx : by;
        int up = r.segment.level + 2;
        bool climbs = up <= int(field.topLevel) && up <= quality.coarsestLevel && (crossed & ((1 << up) - 1)) == 0;
        r.visit.fresh = r.visit.fresh && blocked && !(clip && (cx != r.segment.ix || cy != r.segment.iy));
        if (!blocked && ((se >= kSegmentEnd && !left) || (crossX ? bx > r.segment.ex : by > r.segment.ey)))
        {
            endSegment(r);
            break;
        }
        r.segment.ix = crossX ? bx : (clip || crossY ? cx : r.segment.ix);
        r.segment.iy = crossY ? by : (clip || crossX ? cy : r.segment.iy);
        r.segment.level = blocked ? r.segment.level - 2 : (climbs ? up : r.segment.level);
        r.segment.s = s;
    }
}

/// Whether the previous texel along the ray and this one show one surface: the plane of either predicts the other's distance.
SCONCE_FN bool continuesPrevious(SCONCE_INOUT(RayState) r, int axis, real tolerance)
{
    int px = axis == 1 ? r.segment.ix - 1 : r.segment.ix;
    int py = axis == 2 ? r.segment.iy - 1 : r.segment.iy;
    if (axis == 0 || px < 0 || py < 0) return false;
    uint before = cellWord(r.segment, px, py, 0);
    ++r.cost.distanceReads;
    if ((before & 0xffffu) == 0u) return false;
    real qb = halfToReal(before);
    real qc = halfToReal(r.segment.word);
    real gb = unpackGradient(before >> (axis == 1 ? 16 : 24));
    real gc = unpackGradient(r.segment.word >> (axis == 1 ? 16 : 24));
    if (axis == 1 ? r.segment.mirrorX : r.segment.mirrorY)
    {
        gb = -gb;
        gc = -gc;
    }
    return abs(qb * (real(1.0) + gb) - qc) <= tolerance * qc || abs(qc * (real(1.0) - gc) - qb) <= tolerance * qb;
}

/// Goes on behind a texel.
SCONCE_FN void passTexel(SCONCE_INOUT(RayState) r)
{
    bool stepX = sAtBorder(r.segment.ix + 1, r.segment.P.x, r.segment.iP.x) <= sAtBorder(r.segment.iy + 1, r.segment.P.y, r.segment.iP.y);
    bool ends = r.segment.sEnd >= kSegmentEnd || (stepX ? r.segment.ix + 1 > r.segment.ex : r.segment.iy + 1 > r.segment.ey);
    r.segment.s = r.segment.sEnd;
    if (ends)
    {
        endSegment(r);
        return;
    }
    if (stepX) r.segment.ix += 1;
    else r.segment.iy += 1;
    r.phase = kPhaseMarch;
}

/// The ray is behind the plane of a texel somewhere in it: hit, free, or more than this probe can tell.
SCONCE_FN void fineEvent(SCONCE_INOUT(RayState) r)
{
    r.segment.s = sEntry(r.segment);
    if (r.segment.s >= kSegmentEnd)
    {
        endSegment(r);
        return;
    }
    vec2 line = planeLine(r.segment, r.segment.word, real(r.segment.ix) + real(0.5), real(r.segment.iy) + real(0.5));
    real ga = line.x + r.segment.s * line.y;
    real gb = line.x + r.segment.sEnd * line.y;
    real qs = r.segment.q0 + r.segment.s * r.segment.dq;
    real qe = r.segment.q0 + r.segment.sEnd * r.segment.dq;
    real qc = halfToReal(r.segment.word);
    real wide = footprint();
    real epsilon = slack(qs);
    real gx = unpackGradient(r.segment.word >> 16);
    real gy = unpackGradient(r.segment.word >> 24);
    real slope = sqrt(gx * gx + gy * gy);
    real thickness = quality.tolerance * (min(slope, wide / kLeastCosine) + real(0.5) * wide) + epsilon;

    bool first = r.visit.fresh;
    r.visit.fresh = false;
    r.surfel.event = ga >= real(0.0) ? kEventCrossing : (first ? kEventFirst : kEventContinued);
    r.surfel.extent = texelExtent(r.segment, r.segment.word);
    bool hit = false;
    real at = r.segment.s;
    if (r.surfel.event == kEventCrossing) // a front side by construction: ga >= 0 > gb
    {
        at = min(max(-line.x / line.y, r.segment.s), r.segment.sEnd);
        hit = qc <= (r.segment.q0 + at * r.segment.dq) * (real(1.0) + thickness);
    }
    else if (gb * qs < ga * qe) // runs into the surface: g/q, proportional to the height over its plane, falls
    {
        real qNear = max(qs, qe);
        if (!first || r.cost.handoffs > 1)
        {
            int axis = entryAxis(r.segment);
            if (first || axis == 0) hit = qc <= qNear * (real(1.0) + kAtEntry * wide + epsilon);
            else hit = qc <= qNear * (real(1.0) + thickness) && continuesPrevious(r, axis, wide + epsilon);
        }
    }
    else // behind the plane and coming out of it: the ray's own start surface, seen a little too near, or the back of something
    {
        real cosine = max(wide / max(slope, wide), kLeastCosine);
        bool ownSurface = timeAt(r.segment, r.segment.s) * qc <= wide / cosine + epsilon && -ga <= thickness * qs;
        if (ownSurface)
        {
            passTexel(r);
            return;
        }
    }
    real t = timeOfEvent(r, hit && r.surfel.event == kEventCrossing);
    if (hit) endAsHit(r, at, t);
    else handOff(r, t);
}
