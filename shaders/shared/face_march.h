// A ray through one probe: its pieces on the cube's faces, the march over a face's chain, and what it comes to there. Shared text, see
// probe_trace.h; needs ray_state.h, face_chain.h, chart.h and texel.h.
//
// Along one cube face the pixel P, q = 1/W and t q are linear in one screen parameter s in [0,1], and a surfel's plane is linear in (P, q):
// the march needs no division, root or normalisation. It steps a Hi-Z chain (Uludag 2014, "Hi-Z Screen-Space Cone-Traced Reflections";
// Wang et al. 2019, section 4.2) whose cells hold bounding planes (face_chain.h), and ends in the plane of one surfel.

/// Pixels are mirrored about the middle of this many texels, whole cells of every level, so that cells stay cells.
SCONCE_FN int mirrorSize() { return int((field.faceSize + 63u) & ~63u); }

// A probe's map is six faces, or, where onOctahedron(), one octahedral map of eight octants (chart.h); "face" stands for either.
SCONCE_FN int mapFace(vec3 p) { return onOctahedron() ? octantOf(p) : dominantFace(p); }
SCONCE_FN vec3 mapCoordinates(int face, vec3 p) { return onOctahedron() ? octantCoordinates(face, p) : faceCoordinates(face, p); }
SCONCE_FN vec3 mapDirection(int face, vec3 uvw) { return onOctahedron() ? octantDirection(face, uvw) : faceDirection(face, uvw); }
SCONCE_FN vec3 mapNormal(int face, vec3 g) { return onOctahedron() ? octantNormal(face, g) : faceDirection(face, g); }

/// First word of the map that a face of a probe lies on.
SCONCE_FN uint mapWords(uint probe, int face)
{
    return probe * field.wordsPerProbe + (onOctahedron() ? 0u : uint(face) * (field.wordsPerProbe / 6u));
}

/// The piece of the ray from r.ta to where it leaves the face, the free ball's surroundings or the field.
SCONCE_FN void setUpSegment(SCONCE_INOUT(RayState) r)
{
    // inside the ball about the centre nothing can be met: leave it (this also removes the singularity at W = 0)
    real b = dot(r.relative, r.direction);
    vec3 nearest = r.relative - b * r.direction;
    real h2 = r.freeBall * r.freeBall - dot(nearest, nearest);
    real ballIn = real(3e38);
    if (h2 > real(0.0))
    {
        real h = sqrt(h2);
        real ballOut = h - b;
        if (r.ta >= -h - b && r.ta < ballOut)
        {
            r.ta = ballOut;
            r.nextFace = -2;
        }
        else if (r.ta < -h - b) ballIn = -h - b;
    }
    ++r.segments;
    if (r.ta >= r.tMax || r.nextFace == -1)
    {
        r.t = r.tMax;
        r.status = kMiss;
        r.phase = kPhaseDone;
        return;
    }
    if (r.segments > kMaxSegments)
    {
        r.t = max(r.t, r.ta);
        r.phase = kPhaseChoose;
        return;
    }
    r.face = r.nextFace >= 0 ? r.nextFace : mapFace(r.relative + r.ta * r.direction);

    vec3 f0 = mapCoordinates(r.face, r.relative);
    vec3 f1 = mapCoordinates(r.face, r.direction);
    real tb = r.tMax;
    int next = -1;
    if (ballIn < tb)
    {
        tb = ballIn;
        next = -2;
    }
    for (int plane = 0; plane < (onOctahedron() ? 3 : 4); ++plane)
    {
        real side = (plane & 1) != 0 ? real(1.0) : real(-1.0); // W - U, W + U, W - V, W + V
        real g0 = f0.z + side * (plane < 2 ? f0.x : f0.y);
        real g1 = f1.z + side * (plane < 2 ? f1.x : f1.y);
        if (onOctahedron())
        {
            side = ((r.face >> plane) & 1) != 0 ? real(-1.0) : real(1.0); // x, y, z = 0
            g0 = side * r.relative[plane];
            g1 = side * r.direction[plane];
        }
        if (g1 < real(0.0))
        {
            real t = -g0 / g1;
            if (t < tb)
            {
                tb = t;
                int axis = (r.face >> 1) + (plane < 2 ? 1 : 2);
                next = onOctahedron() ? r.face ^ (1 << plane) : 2 * (axis % 3) + (plane & 1);
            }
        }
    }
    r.tb = max(tb, r.ta);
    r.nextFace = next;

    real size = real(field.faceSize);
    real Wa = f0.z + r.ta * f1.z;
    real Wb = f0.z + r.tb * f1.z;
    if (!(Wa > real(0.0)) || !(Wb > real(0.0))) // a corner of rounding: nothing of the ray lies on this face
    {
        r.ta = r.tb;
        if (r.tb <= r.t) r.nextFace = -2;
        return;
    }
    real qa = real(1.0) / Wa;
    real qb = real(1.0) / Wb;
    real edge = real(0.000244140625); // 2^-12 texel: a ray that lies in a face's border belongs to this side of it
    vec2 Pa = vec2(clamp(real(0.5) * size * ((f0.x + r.ta * f1.x) * qa + real(1.0)), edge, size - edge),
                   clamp(real(0.5) * size * ((f0.y + r.ta * f1.y) * qa + real(1.0)), edge, size - edge));
    vec2 Pb = vec2(clamp(real(0.5) * size * ((f0.x + r.tb * f1.x) * qb + real(1.0)), edge, size - edge),
                   clamp(real(0.5) * size * ((f0.y + r.tb * f1.y) * qb + real(1.0)), edge, size - edge));
    r.mirrorX = Pb.x < Pa.x ? -1 : 0;
    r.mirrorY = Pb.y < Pa.y ? -1 : 0;
    real mirror = real(mirrorSize());
    if (r.mirrorX != 0)
    {
        Pa.x = mirror - Pa.x;
        Pb.x = mirror - Pb.x;
    }
    if (r.mirrorY != 0)
    {
        Pa.y = mirror - Pa.y;
        Pb.y = mirror - Pb.y;
    }
    r.P = Pa;
    r.dP = Pb - Pa;
    r.iP = vec2(real(1.0) / max(r.dP.x, real(1e-12)), real(1.0) / max(r.dP.y, real(1e-12)));
    r.q0 = qa;
    r.dq = qb - qa;
    r.idq = r.dq < real(0.0) ? real(1.0) / r.dq : real(0.0);
    r.tq0 = r.ta * qa;
    r.dtq = r.tb * qb - r.tq0;
    r.ix = int(Pa.x);
    r.iy = int(Pa.y);
    r.ex = int(Pb.x);
    r.ey = int(Pb.y);
    r.s = real(0.0);
    r.level = min(r.segments == 1 ? quality.startLevel : quality.coarsestLevel, int(field.topLevel));
    r.faceWords = mapWords(r.probe, r.face);
    r.phase = kPhaseMarch;
}

/// q of a texel's plane minus q of the ray is linear in s: value at s = 0 and slope. Positive g: the ray is nearer than the surface.
SCONCE_FN vec2 planeLine(SCONCE_IN(RayState) r, uint word, real cx, real cy)
{
    real qc = halfToReal(word);
    real gx = qc * unpackGradient(word >> 16);
    real gy = qc * unpackGradient(word >> 24);
    if (r.mirrorX != 0) gx = -gx;
    if (r.mirrorY != 0) gy = -gy;
    return vec2(r.q0 - (qc + gx * (r.P.x - cx) + gy * (r.P.y - cy)), r.dq - (gx * r.dP.x + gy * r.dP.y));
}

/// Cell of a level, row-major, of (mirrored) texel x, y.
SCONCE_FN uint cellIndex(SCONCE_IN(RayState) r, int x, int y, int level)
{
    int last = (mirrorSize() >> level) - 1;
    int cx = x >> level;
    int cy = y >> level;
    cx = r.mirrorX != 0 ? last - cx : cx;
    cy = r.mirrorY != 0 ? last - cy : cy;
    return uint(cy) * chainWidth(field.faceSize, level) + uint(cx);
}

/// Slack of the hit rule at q, relative to the distance: no more than a texel is wide, so that a room in a landscape keeps its own measure.
SCONCE_FN real slack(real q) { return min(quality.epsilon * real(field.diagonal) * q, real(2.0) / real(field.faceSize)); }

/// Whether the ray, q between qs and qe, is behind everything in a cell by more than any surfel's thickness: what its texels would say one
/// by one, said at once.
SCONCE_FN bool behindCell(SCONCE_INOUT(RayState) r, uint index, real qs, real qe)
{
    uint cell = chainOffset(field.faceSize, r.level) - field.faceSize * field.faceSize + index;
    uint word = distanceWord(r.faceWords + chainNearWords(field.faceSize, int(field.topLevel)) + cell / 2u);
    ++r.distanceReads;
    real footprint = real(2.0) / real(field.faceSize);
    real thickest = quality.tolerance * footprint * real(8.84) + slack(max(qs, qe)); // 1/0.12 + 1/2
    return max(qs, qe) * (real(1.0) + thickest) < farBoundIn(word, cell);
}

SCONCE_FN void endSegment(SCONCE_INOUT(RayState) r)
{
    r.t = max(r.t, r.tb);
    r.ta = max(r.tb, r.ta);
    r.phase = kPhaseSegment;
}

SCONCE_FN real timeAt(SCONCE_IN(RayState) r, real s) { return (r.tq0 + s * r.dtq) / (r.q0 + s * r.dq); }

SCONCE_FN void rememberSurfel(SCONCE_INOUT(RayState) r, real s)
{
    real size = real(mirrorSize());
    vec2 p = vec2(clamp(r.P.x + s * r.dP.x, real(r.ix), real(r.ix) + real(1.0)), clamp(r.P.y + s * r.dP.y, real(r.iy), real(r.iy) + real(1.0)));
    r.pixel = vec2(r.mirrorX != 0 ? size - p.x : p.x, r.mirrorY != 0 ? size - p.y : p.y);
    r.hitWord = r.word;
    r.lastProbe = r.probe;
    r.lastFace = r.face;
}

/// Extent on its surface of a texel of the current face, field units.
SCONCE_FN real texelExtent(SCONCE_IN(RayState) r, uint word)
{
    real gx = unpackGradient(word >> 16);
    real gy = unpackGradient(word >> 24);
    return max(sqrt(gx * gx + gy * gy), real(2.0) / real(field.faceSize)) / max(r.q0 + r.s * r.dq, real(1e-12));
}

/// s at which the ray crosses a border of texels, along one axis. From the border alone: the same number whichever level's cell ends there.
SCONCE_FN real sAtBorder(int border, real p, real inverse) { return (real(border) - p) * inverse; }

/// s at which the ray comes into its texel; 0 in the one that the segment starts in.
SCONCE_FN real sEntry(SCONCE_IN(RayState) r)
{
    return max(max(sAtBorder(r.ix, r.P.x, r.iP.x), sAtBorder(r.iy, r.P.y, r.iP.y)), real(0.0));
}

/// The border through which the ray came into its texel: 0 none, 1 in x, 2 in y.
SCONCE_FN int entryAxis(SCONCE_IN(RayState) r)
{
    real sx = sAtBorder(r.ix, r.P.x, r.iP.x);
    real sy = sAtBorder(r.iy, r.P.y, r.iP.y);
    if (max(sx, sy) <= real(0.0)) return 0;
    return sx > sy ? 1 : 2;
}

/// Where the ray meets the plane of the texel r.word (`plane`), or else comes into that texel. With x, y the texel's middle in pixels from the
/// face's centre, the plane is 1 = q (W + gx (N/2 U - x W) + gy (N/2 V - y W)); a border of texels at x is N/2 U = x W. Far from the probe the
/// t of a near hit is the difference of large numbers, so that the ray's start is taken to more digits than one number holds: what rounding
/// took from it relative to the probe comes back (Knuth's two-sum), and W is multiplied in two halves (Dekker 1971).
SCONCE_FN real timeOfEvent(SCONCE_IN(RayState) r, bool plane)
{
    int axis = plane ? 0 : entryAxis(r);
    if (!plane && axis == 0) return r.ta;
    vec3 start = mapCoordinates(r.face, r.relative);
    vec3 step = mapCoordinates(r.face, r.direction);
    SCONCE_EXACT vec3 centre = r.origin - r.relative;
    SCONCE_EXACT vec3 place = (r.origin - (r.relative + centre)) + (centre - vec3(probeHeader(r.probe).centre));
    vec3 lost = mapCoordinates(r.face, place);
    SCONCE_EXACT real wide = real(4097.0) * start.z;
    SCONCE_EXACT real high = wide - (wide - start.z);
    SCONCE_EXACT real low = (start.z - high) + lost.z;

    real half_ = real(0.5) * real(field.faceSize);
    real middle = plane ? real(0.5) : real(0.0);
    real x = (r.mirrorX != 0 ? real(mirrorSize() - r.ix) - middle : real(r.ix) + middle) - half_;
    real y = (r.mirrorY != 0 ? real(mirrorSize() - r.iy) - middle : real(r.iy) + middle) - half_;
    SCONCE_EXACT real fromX = ((half_ * start.x - x * high) - x * low) + half_ * lost.x;
    SCONCE_EXACT real fromY = ((half_ * start.y - y * high) - y * low) + half_ * lost.y;
    real alongX = half_ * step.x - x * step.z;
    real alongY = half_ * step.y - y * step.z;
    real q = halfToReal(r.word);
    real gx = unpackGradient(r.word >> 16);
    real gy = unpackGradient(r.word >> 24);
    SCONCE_EXACT real from = axis == 1 ? fromX : fromY;
    real along = axis == 1 ? alongX : alongY;
    if (plane)
    {
        from = ((q * high - real(1.0)) + q * low) + q * (gx * fromX + gy * fromY);
        along = q * (step.z + gx * alongX + gy * alongY);
    }
    real t = -from / (abs(along) > real(1e-12) ? along : real(1e-12));
    return min(max(t, r.ta), r.tb);
}

SCONCE_FN void endAsHit(SCONCE_INOUT(RayState) r, real s, real t)
{
    rememberSurfel(r, s);
    r.t = max(r.t, t);
    r.status = kHit;
    r.phase = kPhaseDone;
    if (r.opinionT == real(-1.0) && r.handoffs <= quality.maxHandoffs && quality.opinion > real(0.0) &&
        r.wordSize > quality.opinion * real(field.diagonal))
    {
        r.opinionT = r.t;
        r.phase = kPhaseChoose;
    }
}

SCONCE_FN void handOff(SCONCE_INOUT(RayState) r, real t)
{
    if (r.opinionT >= real(0.0))
    {
        if (t <= r.opinionReach) // no better known: the first answer, whose surfel is still remembered
        {
            r.t = r.opinionT;
            r.status = kHit;
            r.phase = kPhaseDone;
            return;
        }
        r.opinionT = real(-2.0);
    }
    rememberSurfel(r, r.s);
    if (r.event != kEventFirst && t > r.t) r.back = real(2.0) / real(field.faceSize) / (r.q0 + r.s * r.dq);
    r.t = max(r.t, t);
    r.phase = kPhaseChoose;
}

/// Written without branches where it can be: lanes that march beside each other would take all of them in turn. Cells of coarse levels only
/// pass texels over: which texels a ray meets, and where it enters and leaves each, is the same number to the bit without them.
SCONCE_FN void march(SCONCE_INOUT(RayState) r)
{
    real behind = real(0.00048828125); // 2^-11 texel, more than rounding can put a point ahead of the texel it is in
    for (int step = 0; step < kMarchSteps; ++step)
    {
        int x = (r.ix >> r.level) << r.level;
        int y = (r.iy >> r.level) << r.level;
        int bx = x + (1 << r.level);
        int by = y + (1 << r.level);
        uint index = cellIndex(r, x, y, r.level);
        uint word = distanceWord(r.faceWords + chainOffset(field.faceSize, r.level) + index);
        ++r.distanceReads;
        real sx = sAtBorder(bx, r.P.x, r.iP.x);
        real sy = sAtBorder(by, r.P.y, r.iP.y);
        real se = max(min(min(sx, sy), real(1.0)), r.s);
        real half_ = real(0.5) * real(1 << r.level);
        vec2 line = planeLine(r, word, real(x) + half_, real(y) + half_);
        real gs = line.x + r.s * line.y;
        real ge = line.x + se * line.y;
        bool left = min(sx, sy) < r.s; // it is not in this cell any more: `behind` held it back
        bool blocked = (word & 0xffffu) != 0u && !left && min(gs, ge) < real(0.0);
        if (blocked && r.level == 0)
        {
            r.word = word;
            r.sEnd = se;
            r.phase = kPhaseFine;
            break;
        }
        if (readsFarBounds() && blocked && max(gs, ge) <= real(0.0) && behindCell(r, index, r.q0 + r.s * r.dq, r.q0 + se * r.dq))
        {
            r.word = word;
            r.event = r.fresh ? kEventFirst : kEventContinued;
            r.s = sEntry(r);
            handOff(r, timeOfEvent(r, false));
            break;
        }
        bool clip = blocked && gs > real(0.0); // in front so far: nothing of the cell is met before its bound
        real s = blocked ? r.s : se;
        if (clip) s = min(max(r.s + (se - r.s) * (gs / (gs - ge)) * real(0.9999), r.s), se);
        bool crossX = !blocked && sx <= sy;
        bool crossY = !blocked && !crossX;
        int cx = max(r.ix, min(int(r.P.x + s * r.dP.x - behind), min(r.ex, bx - 1)));
        int cy = max(r.iy, min(int(r.P.y + s * r.dP.y - behind), min(r.ey, by - 1)));
        int crossed = crossX ? bx : by;
        int up = r.level + 2;
        bool climbs = up <= int(field.topLevel) && up <= quality.coarsestLevel && (crossed & ((1 << up) - 1)) == 0;
        r.fresh = r.fresh && blocked && !(clip && (cx != r.ix || cy != r.iy));
        if (!blocked && ((se >= real(0.99999) && !left) || (crossX ? bx > r.ex : by > r.ey)))
        {
            endSegment(r);
            break;
        }
        r.ix = crossX ? bx : (clip || crossY ? cx : r.ix);
        r.iy = crossY ? by : (clip || crossX ? cy : r.iy);
        r.level = blocked ? r.level - 2 : (climbs ? up : r.level);
        r.s = s;
    }
}

/// Whether the previous texel along the ray and this one show one surface: the plane of either predicts the other's distance.
SCONCE_FN bool continuesPrevious(SCONCE_INOUT(RayState) r, int axis, real tolerance)
{
    int px = axis == 1 ? r.ix - 1 : r.ix;
    int py = axis == 2 ? r.iy - 1 : r.iy;
    if (axis == 0 || px < 0 || py < 0) return false;
    uint before = distanceWord(r.faceWords + cellIndex(r, px, py, 0));
    ++r.distanceReads;
    if ((before & 0xffffu) == 0u) return false;
    real qb = halfToReal(before);
    real qc = halfToReal(r.word);
    real gb = unpackGradient(before >> (axis == 1 ? 16 : 24));
    real gc = unpackGradient(r.word >> (axis == 1 ? 16 : 24));
    if (axis == 1 ? r.mirrorX != 0 : r.mirrorY != 0)
    {
        gb = -gb;
        gc = -gc;
    }
    return abs(qb * (real(1.0) + gb) - qc) <= tolerance * qc || abs(qc * (real(1.0) - gc) - qb) <= tolerance * qb;
}

/// Goes on behind a texel.
SCONCE_FN void passTexel(SCONCE_INOUT(RayState) r)
{
    bool stepX = sAtBorder(r.ix + 1, r.P.x, r.iP.x) <= sAtBorder(r.iy + 1, r.P.y, r.iP.y);
    bool ends = r.sEnd >= real(0.99999) || (stepX ? r.ix + 1 > r.ex : r.iy + 1 > r.ey);
    r.s = r.sEnd;
    if (ends)
    {
        endSegment(r);
        return;
    }
    if (stepX) r.ix += 1;
    else r.iy += 1;
    r.phase = kPhaseMarch;
}

/// The ray is behind the plane of a texel somewhere in it: hit, free, or more than this probe can tell.
SCONCE_FN void fineEvent(SCONCE_INOUT(RayState) r)
{
    r.s = sEntry(r);
    if (r.s >= real(0.99999))
    {
        endSegment(r);
        return;
    }
    vec2 line = planeLine(r, r.word, real(r.ix) + real(0.5), real(r.iy) + real(0.5));
    real ga = line.x + r.s * line.y;
    real gb = line.x + r.sEnd * line.y;
    real qs = r.q0 + r.s * r.dq;
    real qe = r.q0 + r.sEnd * r.dq;
    real qc = halfToReal(r.word);
    real footprint = real(2.0) / real(field.faceSize); // of a texel, relative to its distance
    real epsilon = slack(qs);
    real gx = unpackGradient(r.word >> 16);
    real gy = unpackGradient(r.word >> 24);
    real slope = sqrt(gx * gx + gy * gy);
    real thickness = quality.tolerance * (min(slope, footprint / real(0.12)) + real(0.5) * footprint) + epsilon;

    bool first = r.fresh;
    r.fresh = false;
    r.event = ga >= real(0.0) ? kEventCrossing : (first ? kEventFirst : kEventContinued);
    r.wordSize = texelExtent(r, r.word);
    bool hit = false;
    real at = r.s;
    if (r.event == kEventCrossing) // a front side by construction: ga >= 0 > gb
    {
        at = min(max(-line.x / line.y, r.s), r.sEnd);
        hit = qc <= (r.q0 + at * r.dq) * (real(1.0) + thickness);
    }
    else if (gb * qs < ga * qe) // runs into the surface: g/q, proportional to the height over its plane, falls
    {
        real qNear = max(qs, qe);
        if (!first || r.handoffs > 1)
        {
            int axis = entryAxis(r);
            if (first || axis == 0) hit = qc <= qNear * (real(1.0) + real(0.25) * footprint + epsilon);
            else hit = qc <= qNear * (real(1.0) + thickness) && continuesPrevious(r, axis, footprint + epsilon);
        }
    }
    else // behind the plane and coming out of it: the ray's own start surface, seen a little too near, or the back of something
    {
        real cosine = max(footprint / max(slope, footprint), real(0.12));
        bool ownSurface = timeAt(r, r.s) * qc <= footprint / cosine + epsilon && -ga <= thickness * qs;
        if (ownSurface)
        {
            passTexel(r);
            return;
        }
    }
    real t = timeOfEvent(r, hit && r.event == kEventCrossing);
    if (hit) endAsHit(r, at, t);
    else handOff(r, t);
}
