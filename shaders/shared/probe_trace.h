// The tracer: one ray through the light field. Shared text: GLSL, or C++ inside a struct that names `real` and holds
// `field` (LightFieldInfo), `quality` (TraceQuality), and defines ProbeHeader probeHeader(uint), uint distanceWord(uint), octreeTexel(),
// bool readsFarBounds(), bool onOctahedron().
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

/// The time at which the ray leaves the field's box, enlarged by 2 % so that a wall on its border is met; 0 when it never is inside.
SCONCE_FN real fieldExit(vec3 o, vec3 d)
{
    vec3 low = vec3(field.sceneLow) - real(0.02) * real(field.diagonal);
    vec3 high = vec3(field.sceneHigh) + real(0.02) * real(field.diagonal);
    real enter = real(0.0);
    real leave = real(4.0) * real(field.diagonal) + length(o);
    for (int a = 0; a < 3; ++a)
    {
        if (abs(d[a]) < real(1e-12))
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

/// Goes on in a probe, from t.
SCONCE_FN void enterProbe(SCONCE_INOUT(RayState) r, uint probe, real t)
{
    addTried(r.tried, probe);
    ++r.handoffs;
    r.probe = probe;
    ProbeHeader header = probeHeader(probe);
    r.relative = r.origin - vec3(header.centre);
    r.freeBall = real(0.5) * real(header.freeRadius);
    r.segments = 0;
    r.fresh = true;
    r.nextFace = -2;
    r.ta = t;
    r.tEntered = r.t;
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

/// Next probe. After a hit in a large texel (r.opinionT): one of the leaf there that stands nearer, for a second opinion; what it sees
/// counts, and where it comes to a dead end before the hit, or there is none, the hit stands. Else: the leaf's list at the point reached,
/// then the lists a little further on; the ray ends as UNKNOWN when all were asked. At its start a ray asks those of a list that stand before
/// the surface it starts on first: to one behind a thin sheet the start would look like a place on its own side.
SCONCE_FN void chooseProbe(SCONCE_INOUT(RayState) r)
{
    bool opinion = r.opinionT >= real(0.0) && r.status == kHit;
    if (!opinion)
    {
        if (r.opinionT >= real(0.0)) r.opinionT = real(-2.0);
        r.status = r.t >= r.tMax ? kMiss : kUnknown;
        if (r.t >= r.tMax || r.handoffs > quality.maxHandoffs)
        {
            r.phase = kPhaseDone;
            return;
        }
        if (r.t > r.tClear + real(1e-4) * real(field.diagonal))
        {
            keepLastTried(r.tried);
            r.tClear = r.t;
        }
    }
    vec3 own = r.relative + r.t * r.direction;
    real best = real(0.81) * dot(own, own); // of an opinion: 0.9 of the distance, squared
    uint found = kNoProbe;
    vec3 hitNormal = vec3(real(0.0));
    if (opinion) hitNormal = texelNormal(r.lastFace, r.pixel, r.hitWord);
    // One that gave the ray up where this probe took it over would be asked at the very border of its texel: it has answered.
    bool fromEntry = r.t - real(2.0) * r.wordSize <= r.tEntered;
    bool starts = r.t <= real(0.5) * real(field.voxel);
    for (int list = 0; list < 3 && found == kNoProbe; ++list)
    {
        real ahead = opinion ? real(-0.02) : (list == 0 ? real(0.02) : (list == 1 ? real(0.75) : real(1.75)));
        uint behind = kNoProbe;
        uvec4 ranked = rankedProbesAt(r.origin + (r.t + ahead * real(field.voxel)) * r.direction, r.indexReads);
        for (int k = 0; k < kRanked; ++k) // a constant bound: unrolled
        {
            if (k >= quality.ranked) break;
            vec3 centre = vec3(probeHeader(ranked[k]).centre); // outside of the branches, which lanes beside each other all take
            bool tried = wasTried(r.tried, ranked[k]);
            if (opinion)
            {
                vec3 to = centre - (r.origin + r.t * r.direction);
                bool asked = ranked[k] == r.probe || (fromEntry && tried);
                if (!asked && dot(to, to) < best && dot(to, hitNormal) > real(0.0))
                {
                    best = dot(to, to);
                    found = ranked[k];
                }
            }
            else if (found == kNoProbe && !tried)
            {
                bool faces = !starts || dot(centre - r.origin, r.startNormal) >= real(0.0);
                if (faces) found = ranked[k];
                else if (behind == kNoProbe) behind = ranked[k];
            }
        }
        if (found == kNoProbe) found = behind;
        if (opinion) break;
    }
    if (found == kNoProbe || (!opinion && r.tried.count >= kMaxTried))
    {
        r.phase = kPhaseDone;
        return;
    }
    real start = max(r.t - r.back, real(0.0));
    if (opinion)
    {
        r.opinionReach = r.t + r.wordSize;
        r.t = max(r.t - real(2.0) * r.wordSize, r.tEntered);
        start = r.t;
        r.status = kUnknown;
    }
    enterProbe(r, found, start);
    r.back = real(0.0);
}

SCONCE_FN RayState beginRay(vec3 origin, vec3 direction, vec3 normal)
{
    RayState r;
    r.origin = origin;
    r.direction = direction;
    r.startNormal = normal;
    r.tMax = fieldExit(origin, direction);
    r.t = real(0.0);
    r.status = kUnknown;
    r.phase = kPhaseChoose;
    r.probe = kNoProbe;
    r.back = real(0.0);
    r.opinionT = real(-1.0);
    r.opinionReach = real(0.0);
    r.tEntered = real(0.0);
    r.relative = vec3(real(0.0));
    r.wordSize = real(0.0);
    r.event = kEventCrossing;
    r.tClear = real(0.0);
    r.tried = noneTried();
    r.handoffs = 0;
    r.distanceReads = 0;
    r.indexReads = 0;
    r.pixel = vec2(real(0.0), real(0.0));
    r.hitWord = 0u;
    r.lastProbe = kNoProbe;
    r.lastFace = -1;
    r.segments = 0;
    r.face = 0;
    r.fresh = true;
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
SCONCE_FN int turnLimit() { return (quality.maxHandoffs + 1) * (64 + 6 * int(field.faceSize)); }

/// A ray at its start; one that is not finite, or has no unit direction, is done at once: a MISS at t = 0 with no probe. `normal`: see Ray.
SCONCE_FN RayState startRay(vec3 origin, vec3 direction, vec3 normal)
{
    RayState r = beginRay(origin, direction, normal);
    real sum = abs(origin.x) + abs(origin.y) + abs(origin.z) + dot(direction, direction);
    if (!(sum < real(1e18)) || !(abs(dot(direction, direction) - real(1.0)) < real(1e-3)))
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
    real doubled = real(1 << min(max(r.handoffs - 1, 0), 6));
    real confidence = real(1.0) - min(real(0.01) * doubled, real(0.6));
    if (r.status == kMiss) return confidence;
    real known = r.event == kEventCrossing ? real(1.0) : (r.event == kEventContinued ? real(0.92) : real(0.85));
    return confidence * known * (real(1.0) - min(real(4.0) * r.wordSize / real(field.diagonal), real(0.3)));
}

/// What a ray has come to; UNKNOWN when it is not done.
SCONCE_FN TraceResult resultOf(SCONCE_IN(RayState) r)
{
    TraceResult result;
    result.status = r.phase == kPhaseDone ? r.status : kUnknown;
    result.t = r.t;
    bool seen = result.status != kMiss && r.lastProbe != kNoProbe;
    result.probe = seen ? r.lastProbe : (result.status == kMiss ? r.probe : kNoProbe);
    result.face = seen ? r.lastFace : -1;
    result.pixel = r.pixel;
    result.word = seen ? r.hitWord : 0u;
    result.handoffs = max(r.handoffs - 1, 0);
    result.distanceReads = r.distanceReads;
    result.indexReads = r.indexReads;
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
