// Which probes a voxel lists: the judging and ranking that builds the octree. Shared text: GLSL, or C++ inside a struct that names `real`,
// holds `build` (OctreeBuild) and defines uint distanceWord(uint), vec3 probeCentre(uint), uint surfelKey(uint),
// bool holdsSurfels() (false: no slot of the voxel's block has one), uint candidateCount() and uvec2 candidateOf(uint) (those of the voxel's block: of its region, those that sightOf leaves, in order, with kSeesAll) and
// uvec2 listOf(ivec3 node, ivec3 size): a list of the level read, which has `size` nodes.
//
// The same bytes on every device: only sums, products, comparisons and integers, each rounded once (SCONCE_EXACT), and no division, root
// or library function, whose last bits differ between devices.
//
// A voxel is judged at points of free space in it and at the surfaces in it, each from the side it is seen from: a probe below a floor
// sees the free space of a voxel that the floor divides, but not the floor's upper side. After Wang et al. 2019, section 4.1.

SCONCE_CONST real kSpread = real(0.375);  // of those, voxels from the centre per axis
SCONCE_CONST real kLift = real(0.1);      // voxels that a surface sample is judged in front of its surface
SCONCE_CONST uint kSurfaceWeight = 2u;    // a surface sample counts as so many of free space: rays start at surfaces
SCONCE_CONST uint kNewWeight = 8u;        // what the probes ranked before don't see counts so much more
SCONCE_CONST int kMostSeeing = 64;        // candidates that see something of a voxel, at most; later ones weigh least
SCONCE_CONST uint kKeyFactor = 2654435761u;  // odd: sample number -> key is one to one and mixes probes and places
SCONCE_CONST uint kKeyInverse = 244002641u;  // kKeyFactor * kKeyInverse = 1 modulo 2^32

/// 1 / x to 1e-6 for x from 1e-30 to 1e30: a guess from the bits of x, and Newton's iteration.
SCONCE_FN real reciprocal(real x)
{
    SCONCE_EXACT real y = uintBitsToFloat(0x7ef311c7u - floatBitsToUint(x));
    y = y * (real(2.0) - x * y);
    y = y * (real(2.0) - x * y);
    y = y * (real(2.0) - x * y);
    return y;
}

/// 1 / sqrt(x) to 1e-5, in the same way.
SCONCE_FN real reciprocalRoot(real x)
{
    SCONCE_EXACT real y = uintBitsToFloat(0x5f3759dfu - (floatBitsToUint(x) >> 1));
    SCONCE_EXACT real half_ = real(0.5) * x;
    y = y * (real(1.5) - half_ * y * y);
    y = y * (real(1.5) - half_ * y * y);
    return y;
}

/// unpackGradient of texel.h without its division.
SCONCE_FN real exactGradient(uint bits)
{
    int value = int(bits & 0xffu);
    if (value > 127) value -= 256;
    SCONCE_EXACT real g = real(value * abs(value)) * (kGradientScale * real(1.0 / 16129.0));
    return g;
}

SCONCE_FN uint faceWord(uint probe, int face, int x, int y)
{
    return distanceWord(probe * build.wordsPerProbe + uint(face) * (build.wordsPerProbe / 6u) + uint(y) * build.faceSize + uint(x));
}

/// Whether a probe's map shows nothing in front of a point.
/// @param eye  the probe's centre, which is read once for all points
SCONCE_FN bool probeSees(uint probe, vec3 eye, vec3 point)
{
    SCONCE_EXACT vec3 p = point - eye;
    int face = dominantFace(p);
    vec3 f = faceCoordinates(face, p);
    if (!(f.z > real(1e-6))) return true; // the centre itself
    SCONCE_EXACT real q = reciprocal(f.z);
    SCONCE_EXACT real x = real(0.5) * real(build.faceSize) * (f.x * q + real(1.0));
    SCONCE_EXACT real y = real(0.5) * real(build.faceSize) * (f.y * q + real(1.0));
    int last = int(build.faceSize) - 1;
    int ix = clamp(int(x), 0, last);
    int iy = clamp(int(y), 0, last);
    uint word = faceWord(probe, face, ix, iy);
    SCONCE_EXACT real centre = halfToReal(word);
    if (centre == real(0.0)) return true; // sky
    SCONCE_EXACT real dx = x - real(ix) - real(0.5);
    SCONCE_EXACT real dy = y - real(iy) - real(0.5);
    SCONCE_EXACT real plane = centre * (real(1.0) + exactGradient(word >> 16) * dx + exactGradient(word >> 24) * dy);
    SCONCE_EXACT real bound = plane * (real(1.0) - build.slack);
    return q >= bound;
}

/// The surfel that surface sample `number` shows; false for sky. The normal is unit and faces the probe.
SCONCE_FN bool surfelOf(uint number, SCONCE_OUT(vec3) position, SCONCE_OUT(vec3) normal)
{
    position = vec3(real(0.0), real(0.0), real(0.0));
    normal = position;
    uint x = build.sampleStep * (number % build.sampleSide) + build.sampleStep / 2u;
    uint row = number / build.sampleSide;
    uint y = build.sampleStep * (row % build.sampleSide) + build.sampleStep / 2u;
    uint map = row / build.sampleSide;
    int face = int(map % 6u);
    uint probe = map / 6u;
    uint word = faceWord(probe, face, int(x), int(y));
    real q = halfToReal(word);
    if (q == real(0.0)) return false;
    SCONCE_EXACT real w = reciprocal(q);
    SCONCE_EXACT real u = (real(x) + real(0.5)) * build.texelWidth - real(1.0);
    SCONCE_EXACT real v = (real(y) + real(0.5)) * build.texelWidth - real(1.0);
    SCONCE_EXACT vec3 seen = vec3(u * w, v * w, w);
    SCONCE_EXACT vec3 at = probeCentre(probe) + faceDirection(face, seen);
    position = at;
    SCONCE_EXACT real gu = exactGradient(word >> 16) * real(0.5) * real(build.faceSize);
    SCONCE_EXACT real gv = exactGradient(word >> 24) * real(0.5) * real(build.faceSize);
    SCONCE_EXACT real gw = real(1.0) - u * gu - v * gv;
    SCONCE_EXACT real length2 = gu * gu + gv * gv + gw * gw;
    SCONCE_EXACT real scale = -reciprocalRoot(length2);
    SCONCE_EXACT vec3 unit = vec3(gu * scale, gv * scale, gw * scale);
    normal = faceDirection(face, unit);
    return true;
}

/// Index of a surfel's slot, of its voxel, octant in the voxel and side; kNoSurfel outside the voxels.
SCONCE_FN uint surfelSlot(vec3 position, vec3 normal)
{
    SCONCE_EXACT vec3 g = (position - vec3(build.low)) * build.inverseVoxel;
    vec3 limit = vec3(build.count);
    if (!(g.x >= real(0.0) && g.y >= real(0.0) && g.z >= real(0.0) && g.x < limit.x && g.y < limit.y && g.z < limit.z)) return kNoSurfel;
    ivec3 twice = ivec3(int(real(2.0) * g.x), int(real(2.0) * g.y), int(real(2.0) * g.z));
    ivec3 voxel = ivec3(twice.x >> 1, twice.y >> 1, twice.z >> 1);
    int octant = (twice.x & 1) | ((twice.y & 1) << 1) | ((twice.z & 1) << 2);
    int side = (dominantFace(normal) & 1) << 3;
    uint index = uint(voxel.x) + uint(build.count.x) * (uint(voxel.y) + uint(build.count.y) * uint(voxel.z));
    return index * kSurfelSlots + uint(octant | side);
}

SCONCE_FN uint regionOf(ivec3 voxel)
{
    return uint(voxel.x >> build.regionShift) +
        uint(build.regions.x) * (uint(voxel.y >> build.regionShift) + uint(build.regions.y) * uint(voxel.z >> build.regionShift));
}

// What a probe's chain tells of a block of voxels (and half a voxel around it) at once. It saves time and changes no list.
SCONCE_CONST int kSightUnsure = 0;
SCONCE_CONST int kSightNone = 1; // it sees nothing there
SCONCE_CONST int kSightAll = 2;  // nothing is before any point there

/// By the cells of the chain that the block covers: its nearest point lies behind the far bounds of all, or its farthest before the near bounds.
SCONCE_FN int sightOf(uint probe, ivec3 block)
{
    vec3 eye = probeCentre(probe);
    real nearest = real(0.0); // largest q of the block
    real farthest = real(1e30);
    vec2 low = vec2(real(build.faceSize), real(build.faceSize));
    vec2 high = vec2(real(0.0), real(0.0));
    int face = -1;
    for (int corner = 0; corner < 8; ++corner)
    {
        vec3 at = vec3(kBlock * block) - real(0.5) + real(kBlock + 1) * vec3(real(corner & 1), real((corner >> 1) & 1), real(corner >> 2));
        vec3 p = vec3(build.low) + build.voxel * at - eye;
        int own = dominantFace(p);
        if (corner > 0 && own != face) return kSightUnsure;
        face = own;
        vec3 f = faceCoordinates(face, p);
        if (!(f.z > real(1e-6))) return kSightUnsure;
        real q = reciprocal(f.z);
        vec2 pixel = vec2(real(0.5) * real(build.faceSize) * (f.x * q + real(1.0)), real(0.5) * real(build.faceSize) * (f.y * q + real(1.0)));
        nearest = max(nearest, q);
        farthest = min(farthest, q);
        low = min(low, pixel);
        high = max(high, pixel);
    }
    int last = int(build.faceSize) - 1;
    ivec2 first = ivec2(clamp(int(low.x - real(0.5)), 0, last), clamp(int(low.y - real(0.5)), 0, last));
    ivec2 end = ivec2(clamp(int(high.x + real(0.5)), 0, last), clamp(int(high.y + real(0.5)), 0, last));
    int level = 2;
    while (level < int(build.topLevel) && max((end.x >> level) - (first.x >> level), (end.y >> level) - (first.y >> level)) > 3) level += 2;
    if (level > int(build.topLevel)) return kSightUnsure; // the faces are too small for a chain
    uint ofFace = probe * build.wordsPerProbe + uint(face) * (build.wordsPerProbe / 6u);
    uint ofLevel = chainOffset(build.faceSize, level);
    uint ofBounds = ofFace + chainNearWords(build.faceSize, int(build.topLevel));
    real nearBound = real(0.0);
    real farBound = real(1e30);
    for (int y = first.y >> level; y <= end.y >> level; ++y)
        for (int x = first.x >> level; x <= end.x >> level; ++x)
        {
            uint cell = ofLevel + uint(y) * chainWidth(build.faceSize, level) + uint(x);
            uint plane = distanceWord(ofFace + cell);
            real spread = real(0.5) * real(1 << level) * (abs(exactGradient(plane >> 16)) + abs(exactGradient(plane >> 24)));
            nearBound = max(nearBound, halfToReal(plane) * (real(1.0) + spread));
            uint ofChain = cell - build.faceSize * build.faceSize;
            farBound = min(farBound, farBoundIn(distanceWord(ofBounds + ofChain / 2u), ofChain));
        }
    // A thousandth for the roundings of both sides, which other lengths stand behind.
    if (nearest < farBound * (real(0.999) - build.slack)) return kSightNone;
    return farthest >= nearBound * (real(1.001) - build.slack) ? kSightAll : kSightUnsure;
}

/// A voxel's list: up to four probes, 16 bits each, best first, 0xffff where there is none. Each rank goes to the candidate that sees most,
/// what the ranks before it don't see counting more, times its weight: nearness, and whether the voxel's region lies in its influence box.
SCONCE_FN uvec2 rankVoxel(ivec3 voxel)
{
    SCONCE_EXACT vec3 at = vec3(voxel) + real(0.5);
    SCONCE_EXACT vec3 centre = vec3(build.low) + build.voxel * at;
    uint index = uint(voxel.x) + uint(build.count.x) * (uint(voxel.y) + uint(build.count.y) * uint(voxel.z));
    vec3 surfaces[kSurfelSlots];
    vec3 normals[kSurfelSlots];
    uint samples = 0u;
    for (uint slot = 0u; slot < kSurfelSlots && holdsSurfels(); ++slot)
    {
        uint key = surfelKey(index * kSurfelSlots + slot);
        if (key == kNoSurfel) continue;
        vec3 position;
        vec3 normal;
        if (!surfelOf(key * kKeyInverse, position, normal)) continue;
        SCONCE_EXACT real lift = kLift * build.voxel;
        SCONCE_EXACT vec3 before = position + lift * normal;
        surfaces[samples] = before;
        normals[samples] = normal;
        ++samples;
    }
    uint all = (1u << (uint(kFreeSamples) + samples)) - 1u;
    uint seenBits[kMostSeeing];
    uvec2 seeing[kMostSeeing];
    int found = 0;
    int whole = 0;
    // Candidates come in order of falling weight: once four see all samples, no later one can rank.
    uint candidates = candidateCount();
    for (uint c = 0u; c < candidates && found < kMostSeeing && whole < kRanked; ++c)
    {
        uvec2 candidate = candidateOf(c);
        bool seesAll = (candidate.x & kSeesAll) != 0u;
        candidate.x &= ~kSeesAll;
        vec3 eye = probeCentre(candidate.x);
        uint bits = seesAll ? (1u << kFreeSamples) - 1u : 0u;
        for (int sample_ = 0; sample_ < kFreeSamples && !seesAll; ++sample_)
        {
            vec3 corner = vec3((sample_ & 1) != 0 ? real(1.0) : real(-1.0), (sample_ & 2) != 0 ? real(1.0) : real(-1.0),
                (sample_ & 4) != 0 ? real(1.0) : real(-1.0));
            if (sample_ == 8) corner = vec3(real(0.0), real(0.0), real(0.0));
            SCONCE_EXACT real reach = kSpread * build.voxel;
            SCONCE_EXACT vec3 point = centre + reach * corner;
            if (probeSees(candidate.x, eye, point)) bits |= 1u << sample_;
        }
        for (uint i = 0u; i < samples && holdsSurfels(); ++i)
        {
            SCONCE_EXACT vec3 to = eye - surfaces[i];
            vec3 n = normals[i];
            SCONCE_EXACT real height = to.x * n.x + to.y * n.y + to.z * n.z;
            if (height > real(0.0) && (seesAll || probeSees(candidate.x, eye, surfaces[i]))) bits |= 1u << (uint(kFreeSamples) + i);
        }
        if (bits == 0u) continue;
        seenBits[found] = bits;
        seeing[found] = candidate;
        ++found;
        if (bits == all) ++whole;
    }
    uint open_ = (1u << kFreeSamples) - 1u;
    uint covered = 0u;
    uint ranked[kRanked];
    for (int rank = 0; rank < kRanked; ++rank)
    {
        uint best = 0u;
        int chosen = -1;
        for (int i = 0; i < found; ++i)
        {
            uint bits = seenBits[i];
            uint fresh = bits & ~covered;
            uint gain = uint(bitCount(bits & open_)) + kSurfaceWeight * uint(bitCount(bits & ~open_)) +
                kNewWeight * (uint(bitCount(fresh & open_)) + kSurfaceWeight * uint(bitCount(fresh & ~open_)));
            uint score = gain * seeing[i].y;
            if (score > best)
            {
                best = score;
                chosen = i;
            }
        }
        ranked[rank] = 0xffffu;
        if (chosen >= 0)
        {
            ranked[rank] = seeing[chosen].x;
            covered |= seenBits[chosen];
            seenBits[chosen] = 0u;
        }
    }
    return uvec2(ranked[0] | (ranked[1] << 16), ranked[2] | (ranked[3] << 16));
}

/// The list of a voxel, or, where no probe sees it, that of its first neighbour that has one.
SCONCE_FN uvec2 filledList(ivec3 voxel, ivec3 size)
{
    uvec2 list = listOf(voxel, size);
    for (int side = 0; side < 6 && list.x == kNoList; ++side)
    {
        ivec3 neighbour = voxel;
        neighbour[side >> 1] += (side & 1) != 0 ? 1 : -1;
        if (neighbour[side >> 1] < 0 || neighbour[side >> 1] >= size[side >> 1]) continue;
        list = listOf(neighbour, size);
    }
    return list;
}

/// The list of a node from those of its eight children in a level of twice `size`: theirs when all that have one agree, none (both words
/// kNoList) when none has, else (kNoList, 0): the node stays a node.
SCONCE_FN uvec2 joinedList(ivec3 node, ivec3 size)
{
    uvec2 joined = uvec2(kNoList, kNoList);
    for (int child = 0; child < 8; ++child)
    {
        uvec2 list = listOf(2 * node + ivec3(child & 1, (child >> 1) & 1, child >> 2), 2 * size);
        if (list.x == kNoList && list.y == kNoList) continue;
        bool none = joined.x == kNoList && joined.y == kNoList;
        if (!none && (list.x != joined.x || list.y != joined.y)) return uvec2(kNoList, 0u);
        joined = list;
    }
    return joined;
}
