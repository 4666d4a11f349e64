// The tracer: one ray through the light field. Shared text: GLSL, or C++ inside a struct that names `real` and holds
// `field` (LightFieldInfo), `quality` (TraceQuality), and defines ProbeHeader probeHeader(uint), uint distanceWord(uint), octreeTexel(),
// bool readsFarBounds(), int probeOrder(), bool onOctahedron(), bool shortTurns().
//
// What one probe can't tell of a ray (UNKNOWN, face_march.h) is handed to the next probe of the octree's leaf at that point, with the ray
// re-entered BEFORE the cell that blocked it, so that the next probe misses nothing (Donow 2016, section on back faces).
// All lengths are field units (light_field.h).

struct TraceResult
{
    uint status;      // kHit, kMiss, kUnknown
    real t;           // field units: the hit, or the last point reached
    uint probe;       // that answered; kNoProbe: none
    int face;         // where the surfel lies; -1: none
    vec2 pixel;
    uint word;
    int handoffs;
    int distanceReads;
    int indexReads;
    real confidence;  // [0,1], see RayHit
};

SCONCE_CONST real kBeyondBounds = real(0.02); // share of the diagonal that the field's box is enlarged by, so that a wall on its border is met
SCONCE_CONST real kBeyondBox = real(4.0);     // diagonals: further than from any point of the enlarged box to any other
SCONCE_CONST real kParallel = real(1e-12);    // a direction's part below which it never comes to a plane across it

// How far ahead of the point that a ray has come to, in voxels, the lists of leaves are asked, one after another: just beyond it, since what
// stopped the ray lies there, then in the next voxels. Also what the opponents with lists ask.
SCONCE_CONST int kLookAheads = 3;
SCONCE_FN real lookAhead(int list) { return list == 0 ? real(0.02) : (list == 1 ? real(0.75) : real(1.75)); }
SCONCE_CONST real kLookBack = real(-0.02); // voxels: a second opinion is asked of the leaf on the near side of the surface

SCONCE_CONST real kAtStart = real(0.5);   // voxels from its origin within which a ray is at the surface it starts on
SCONCE_CONST real kFreeShare = real(0.5); // of a probe's free radius: what is skipped, with room for what rounding did to the distances
SCONCE_CONST real kNearerSquared = real(0.81); // a second opinion comes from at most 0.9 of the distance: else it sees no finer
SCONCE_CONST real kOpinionTexels = real(2.0);  // of the first answer's, before it: where the second opinion starts

SCONCE_CONST real kLargest = real(1e18);   // of what an origin may hold: its square is still a number
SCONCE_CONST real kUnitWithin = real(1e-3); // of a unit direction's squared length

SCONCE_CONST int kTurnsAProbe = 64; // see turnLimit
SCONCE_CONST int kTurnsATexel = 6;

// Of confidenceOf, as they were measured.
SCONCE_CONST real kWrongFirst = real(0.01);     // share of wrong answers of the first probe
SCONCE_CONST int kMostDoublings = 6;            // hand-offs that double it
SCONCE_CONST real kWrongMost = real(0.6);
SCONCE_CONST real kTrustContinued = real(0.92); // of a hit behind a surfel, in a surface that goes on
SCONCE_CONST real kTrustFirst = real(0.85);     // the same in the probe's first texel
SCONCE_CONST real kWrongExtent = real(4.0);     // wrong share by the texel's extent over the diagonal
SCONCE_CONST real kWrongExtentMost = real(0.3);

/// The time at which the ray leaves the field's box, enlarged; 0 when it never is inside.
SCONCE_FN real fieldExit(vec3 o, vec3 d)
{
    vec3 low = vec3(field.sceneLow) - kBeyondBounds * real(field.diagonal);
    vec3 high = vec3(field.sceneHigh) + kBeyondBounds * real(field.diagonal);
    real enter = real(0.0);
    real leave = kBeyondBox * real(field.diagonal) + length(o);
    for (int a = 0; a < 3; ++a)
    {
        if (abs(d[a]) < kParallel)
        {
            if (o[a] < low[a] || o[a] > high[a]) return real(0.0);
            continue;
        }
        real t0 = (low[a] - o[a]) / d[a];
        real t1 = (high[a] - o[a]) / d[a];
        enter = max(enter, min(t0, t1));
        leave = min(leave, max(t0, t1));
    }
    return leave > enter ? leave : real(0.0);
}

/// Whether a ray is one: its origin finite, its direction unit.
SCONCE_FN bool canTrace(vec3 origin, vec3 direction)
{
    real sum = abs(origin.x) + abs(origin.y) + abs(origin.z) + dot(direction, direction);
    return sum < kLargest && abs(dot(direction, direction) - real(1.0)) < kUnitWithin;
}

/// Goes on in a probe, from t.
SCONCE_FN void enterProbe(SCONCE_INOUT(RayState) r, uint probe, real t)
{
    addTried(r.asked.tried, probe);
    askForMaps(probe);
    ++r.cost.handoffs;
    r.visit.probe = probe;
    ProbeHeader header = probeHeader(probe);
    r.visit.relative = r.ray.origin - vec3(header.centre);
    r.visit.freeBall = kFreeShare * real(header.freeRadius);
    r.visit.segments = 0;
    r.visit.fresh = true;
    r.segment.nextFace = kFaceToSearch;
    r.segment.ta = t;
    r.visit.tEntered = r.t;
    r.phase = kPhaseSegment;
}

/// Unit normal of a texel's plane, field space, facing the probe.
SCONCE_FN vec3 texelNormal(int face, vec2 pixel, uint word)
{
    real half_ = real(0.5) * real(field.faceSize);
    real u = (floor(pixel.x) + real(0.5)) / half_ - real(1.0);
    real v = (floor(pixel.y) + real(0.5)) / half_ - real(1.0);
    real qu = unpackGradient(word >> 16) * half_;
    real qv = unpackGradient(word >> 24) * half_;
    return -normalize(mapNormal(face, vec3(qu, qv, real(1.0) - u * qu - v * qv)));
}

SCONCE_FN vec3 pointAt(SCONCE_IN(FieldRay) ray, real t) { return ray.origin + t * ray.direction; }

/// Whether a hit waits for the word of a nearer probe.
SCONCE_FN bool wantsOpinion(SCONCE_IN(RayState) r) { return r.asked.opinionT >= real(0.0) && r.status == kHit; }

/// Whether a ray that no probe has answered may ask another one; else it is done, as a MISS or as UNKNOWN.
SCONCE_FN bool mayAskOn(SCONCE_INOUT(RayState) r)
{
    if (r.asked.opinionT >= real(0.0)) r.asked.opinionT = kOpinionAsked;
    r.status = r.t >= r.ray.tMax ? kMiss : kUnknown;
    if (r.t >= r.ray.tMax || r.cost.handoffs > quality.maxHandoffs) return false;
    if (r.t > r.asked.tClear + kProgress * real(field.diagonal))
    {
        keepLastTried(r.asked.tried);
        r.asked.tClear = r.t;
    }
    return true;
}

/// How early a probe is asked, of those of a leaf: the largest first.
/// @param way  from the probe to the point that the ray has come to
SCONCE_FN real sayInOrder(vec3 way, vec3 direction)
{
    if (probeOrder() == kOrderRanked) return real(0.0); // the first of the list is the first
    real along = dot(way, direction);
    real squared = dot(way, way) + real(1e-20);
    if (probeOrder() == kOrderParallel) return along * along / squared;
    if (probeOrder() == kOrderBehind) return along * abs(along) / squared;
    return along * along - squared;
}

/// The probe to ask; kNoProbe: none is left. For a second opinion the one of the leaf at the hit that stands nearest of those that stand nearer,
/// and before the surface. Else the first in order of the leaf's list at the point reached that wasn't tried, then of the lists a little further on; at
/// its start a ray asks those of a list that stand before the surface it starts on first: to one behind a thin sheet the start would look like
/// a place on its own side.
/// One search for both, since what is written twice is in the program twice.
SCONCE_FN uint searchLeaves(SCONCE_INOUT(RayState) r, bool opinion)
{
    vec3 own = r.visit.relative + r.t * r.ray.direction;
    real best = kNearerSquared * dot(own, own);
    uint found = kNoProbe;
    vec3 hitNormal = vec3(real(0.0));
    if (opinion) hitNormal = texelNormal(r.surfel.face, r.surfel.pixel, r.surfel.word);
    // One that gave the ray up where this probe took it over would be asked at the very border of its texel: it has answered.
    bool fromEntry = r.t - kOpinionTexels * r.surfel.extent <= r.visit.tEntered;
    bool starts = r.t <= kAtStart * real(field.voxel);
    for (int list = 0; list < kLookAheads && found == kNoProbe; ++list)
    {
        real ahead = opinion ? kLookBack : lookAhead(list);
        uint behind = kNoProbe;
        real say = real(0.0);
        real sayBehind = real(0.0);
        uvec4 ranked = rankedProbesAt(pointAt(r.ray, r.t + ahead * real(field.voxel)), r.cost.indexReads);
        for (int k = 0; k < kRanked; ++k) // a constant bound: unrolled
        {
            if (k >= quality.ranked) break;
            vec3 centre = vec3(probeHeader(ranked[k]).centre); // outside of the branches, which lanes beside each other all take
            bool tried = wasTried(r.asked.tried, ranked[k]);
            if (!holdsMaps(ranked[k]))
            {
                if (!opinion && found == kNoProbe) askForMaps(ranked[k]);
                continue;
            }
            if (opinion)
            {
                vec3 to = centre - pointAt(r.ray, r.t);
                bool answered = ranked[k] == r.visit.probe || (fromEntry && tried);
                if (!answered && dot(to, to) < best && dot(to, hitNormal) > real(0.0))
                {
                    best = dot(to, to);
                    found = ranked[k];
                }
            }
            else if (!tried)
            {
                bool faces = !starts || dot(centre - r.ray.origin, r.ray.normal) >= real(0.0);
                real its = sayInOrder(pointAt(r.ray, r.t) - centre, r.ray.direction);
                if (faces && (found == kNoProbe || its > say))
                {
                    found = ranked[k];
                    say = its;
                }
                else if (!faces && (behind == kNoProbe || its > sayBehind))
                {
                    behind = ranked[k];
                    sayBehind = its;
                }
            }
        }
        if (found == kNoProbe) found = behind;
        if (opinion) break;
    }
    return found;
}

/// Goes back to a little before the hit, where a second opinion starts: what it sees counts; where it comes to a dead end before the hit, the
/// hit stands.
SCONCE_FN void goBackBeforeHit(SCONCE_INOUT(RayState) r)
{
    r.asked.opinionReach = r.t + r.surfel.extent;
    r.t = max(r.t - kOpinionTexels * r.surfel.extent, r.visit.tEntered);
    r.status = kUnknown;
}

SCONCE_FN void chooseProbe(SCONCE_INOUT(RayState) r)
{
    bool opinion = wantsOpinion(r);
    if (!opinion && !mayAskOn(r))
    {
        r.phase = kPhaseDone;
        return;
    }
    uint found = searchLeaves(r, opinion);
    if (found == kNoProbe || (!opinion && r.asked.tried.count >= kMaxTried))
    {
        r.phase = kPhaseDone;
        return;
    }
    real start = max(r.t - r.asked.back, real(0.0));
    if (opinion)
    {
        goBackBeforeHit(r);
        start = r.t;
    }
    enterProbe(r, found, start);
    r.asked.back = real(0.0);
}

SCONCE_FN RayState beginRay(vec3 origin, vec3 direction, vec3 normal)
{
    RayState r;
    r.ray.origin = origin;
    r.ray.direction = direction;
    r.ray.normal = normal;
    r.ray.tMax = fieldExit(origin, direction);
    r.t = real(0.0);
    r.status = kUnknown;
    r.phase = kPhaseChoose;
    r.visit.probe = kNoProbe;
    r.asked.back = real(0.0);
    r.asked.opinionT = kOpinionOpen;
    r.asked.opinionReach = real(0.0);
    r.visit.tEntered = real(0.0);
    r.visit.relative = vec3(real(0.0));
    r.surfel.extent = real(0.0);
    r.surfel.event = kEventCrossing;
    r.asked.tClear = real(0.0);
    r.asked.tried = noneTried();
    r.cost.handoffs = 0;
    r.cost.distanceReads = 0;
    r.cost.indexReads = 0;
    r.surfel.pixel = vec2(real(0.0), real(0.0));
    r.surfel.word = 0u;
    r.surfel.probe = kNoProbe;
    r.surfel.face = -1;
    r.visit.segments = 0;
    r.segment.face = 0;
    r.visit.fresh = true;
    return r;
}

SCONCE_FN void turn(SCONCE_INOUT(RayState) r)
{
    if (r.phase == kPhaseChoose) chooseProbe(r);
    if (r.phase == kPhaseSegment) setUpSegment(r);
    if (r.phase == kPhaseMarch) march(r);
    if (r.phase == kPhaseFine) fineEvent(r);
}

/// Turns after which a ray ends as UNKNOWN whatever it does: every march step advances a texel index or descends a level (at most 8 N
/// steps a segment, kMarchSteps a turn); a fine event that goes on advances one. Derived, never reached by a ray that makes progress.
SCONCE_FN int turnLimit() { return (quality.maxHandoffs + 1) * (kTurnsAProbe + kTurnsATexel * int(field.faceSize)); }

/// A ray at its start; one that is not finite, or has no unit direction, is done at once: a MISS at t = 0 with no probe. `normal`: see Ray.
SCONCE_FN RayState startRay(vec3 origin, vec3 direction, vec3 normal)
{
    RayState r = beginRay(origin, direction, normal);
    if (!canTrace(origin, direction))
    {
        r.status = kMiss;
        r.phase = kPhaseDone;
    }
    return r;
}

/// How much to trust an answer, from what was measured on glossy rays in Sponza: a hit that came about behind a surfel is wrong more often
/// than one that crossed its plane, each hand-off about doubles the share of wrong ones, and so do texels larger than the tolerance.
SCONCE_FN real confidenceOf(SCONCE_IN(RayState) r)
{
    if (r.phase != kPhaseDone || r.status == kUnknown) return real(0.0);
    real doubled = real(1 << min(max(r.cost.handoffs - 1, 0), kMostDoublings));
    real confidence = real(1.0) - min(kWrongFirst * doubled, kWrongMost);
    if (r.status == kMiss) return confidence;
    real known = r.surfel.event == kEventCrossing ? real(1.0) : (r.surfel.event == kEventContinued ? kTrustContinued : kTrustFirst);
    return confidence * known * (real(1.0) - min(kWrongExtent * r.surfel.extent / real(field.diagonal), kWrongExtentMost));
}

/// What a ray has come to; UNKNOWN when it is not done.
SCONCE_FN TraceResult resultOf(SCONCE_IN(RayState) r)
{
    TraceResult result;
    result.status = r.phase == kPhaseDone ? r.status : kUnknown;
    result.t = r.t;
    bool seen = result.status != kMiss && r.surfel.probe != kNoProbe;
    result.probe = seen ? r.surfel.probe : (result.status == kMiss ? r.visit.probe : kNoProbe);
    result.face = seen ? r.surfel.face : -1;
    result.pixel = r.surfel.pixel;
    result.word = seen ? r.surfel.word : 0u;
    result.handoffs = max(r.cost.handoffs - 1, 0);
    result.distanceReads = r.cost.distanceReads;
    result.indexReads = r.cost.indexReads;
    result.confidence = confidenceOf(r);
    return result;
}

/// One ray, field space, unit direction.
SCONCE_FN TraceResult traceRay(vec3 origin, vec3 direction, vec3 normal)
{
    RayState r = startRay(origin, direction, normal);
    int limit = turnLimit();
    for (int i = 0; i < limit && r.phase != kPhaseDone; ++i) turn(r);
    return resultOf(r);
}
