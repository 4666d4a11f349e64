// Which probes a point asks. Shared text: GLSL, or C++ inside a struct that names `real`, holds `field` (LightFieldInfo) and defines
// uvec4 octreeTexel(ivec3). Layout of the texture: svo/octree.h. After Wang et al. 2019, section 4.1 (leaf-only octree in a 3D texture).

/// (quotient, remainder). By a float's quotient, set right by one where it was rounded over: lanes of a vector divide integers one by one.
SCONCE_FN ivec2 quotient(int number, int divisor)
{
    int q = int((real(number) + real(0.5)) / real(divisor));
    int rest = number - q * divisor;
    if (rest < 0)
    {
        --q;
        rest += divisor;
    }
    if (rest >= divisor)
    {
        ++q;
        rest -= divisor;
    }
    return ivec2(q, rest);
}

SCONCE_FN ivec3 octreeBrickTexel(uint brick)
{
    ivec2 row = quotient(int(brick), int(field.bricks.x));
    ivec2 layer = quotient(row.x, int(field.bricks.y));
    return ivec3(2 * row.y, 2 * layer.y, 2 * layer.x);
}

/// Finest voxel of a point in field space; a point outside the bounds, or not a number, gets the nearest one.
SCONCE_FN ivec3 octreeVoxel(vec3 p)
{
    ivec3 count = ivec3(field.topCells.x << field.topShift, field.topCells.y << field.topShift, field.topCells.z << field.topShift);
    vec3 v = (p - vec3(field.boundsLow)) / real(field.voxel);
    // min(a, b) is b only when b < a: with the number first, a NaN becomes the number
    real x = max(real(0.0), min(real(count.x) - real(0.5), v.x));
    real y = max(real(0.0), min(real(count.y) - real(0.5), v.y));
    real z = max(real(0.0), min(real(count.z) - real(0.5), v.z));
    return ivec3(int(x), int(y), int(z));
}

/// The up to four ranked probes of the leaf that holds p (field space), best first; a leaf with fewer repeats some. Cost: 1 + topShift
/// reads at most, added to `reads`.
SCONCE_FN uvec4 rankedProbesAt(vec3 p, SCONCE_INOUT(int) reads)
{
    ivec3 voxel = octreeVoxel(p);
    ivec3 top = ivec3(voxel.x >> field.topShift, voxel.y >> field.topShift, voxel.z >> field.topShift);
    ivec3 topBricks = ivec3((field.topCells.x + 1) >> 1, (field.topCells.y + 1) >> 1, (field.topCells.z + 1) >> 1);
    uint brick = uint((top.x >> 1) + topBricks.x * ((top.y >> 1) + topBricks.y * (top.z >> 1)));
    ivec3 child = ivec3(top.x & 1, top.y & 1, top.z & 1);
    uvec4 texel = octreeTexel(octreeBrickTexel(brick) + child);
    ++reads;
    for (int level = field.topShift - 1; level >= 0 && texel.w == field.marker; --level)
    {
        brick = field.marker == 255u ? (texel.x | (texel.y << 8) | (texel.z << 16)) : (texel.x | (texel.y << 16));
        child = ivec3((voxel.x >> level) & 1, (voxel.y >> level) & 1, (voxel.z >> level) & 1);
        texel = octreeTexel(octreeBrickTexel(brick) + child);
        ++reads;
    }
    return texel;
}

SCONCE_CONST int kMaxTried = 12; // probes remembered as tried without progress: three lists of four

/// The probes a ray has asked at one place, newest first, two to a word, the newer in the lower half: a field has at most 65,535, and registers are
/// what a ray has least of. No array: one indexed by each lane is slow where lanes are vectors.
struct TriedProbes
{
    uvec3 newer;
    uvec3 older;
    int count;
};

SCONCE_FN TriedProbes noneTried()
{
    TriedProbes tried;
    tried.newer = uvec3(kNoProbe);
    tried.older = uvec3(kNoProbe);
    tried.count = 0;
    return tried;
}

/// Where a half of a word is 0 the result is not 0, and only there (Mycroft's test for a zero byte, on halves: Warren 2012, Hacker's Delight, section 6-1).
SCONCE_FN uint zeroHalves(uint word) { return (word - 0x00010001u) & ~word & 0x80008000u; }

SCONCE_FN bool wasTried(SCONCE_IN(TriedProbes) tried, uint probe)
{
    uint both = (probe & 0xffffu) * 0x00010001u;
    uint found = zeroHalves(tried.newer.x ^ both) | zeroHalves(tried.newer.y ^ both) | zeroHalves(tried.newer.z ^ both);
    found |= zeroHalves(tried.older.x ^ both) | zeroHalves(tried.older.y ^ both) | zeroHalves(tried.older.z ^ both);
    return found != 0u;
}

SCONCE_FN void addTried(SCONCE_INOUT(TriedProbes) tried, uint probe)
{
    tried.older = uvec3((tried.older.x << 16) | (tried.newer.z >> 16), (tried.older.y << 16) | (tried.older.x >> 16),
                        (tried.older.z << 16) | (tried.older.y >> 16));
    tried.newer = uvec3((tried.newer.x << 16) | (probe & 0xffffu), (tried.newer.y << 16) | (tried.newer.x >> 16),
                        (tried.newer.z << 16) | (tried.newer.y >> 16));
    ++tried.count;
}

/// Forgets all but the last, when the ray has moved on.
SCONCE_FN void keepLastTried(SCONCE_INOUT(TriedProbes) tried)
{
    uint last = tried.newer.x & 0xffffu;
    if (tried.count == 0) return;
    tried = noneTried();
    addTried(tried, last);
}
