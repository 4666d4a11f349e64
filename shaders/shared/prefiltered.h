// A probe's radiance prefiltered by round lobes of growing width, in small octahedral maps: what rough reflections read. A lobe is filtered
// over the sphere, not over the map, and a look-up folds at the map's border, so no edge of a chart shows; Wang et al. 2019, section 6 and
// figure 13, leave the seams of octahedral mips open. Shared text, see texel.h and chart.h; needs prefilteredWord(uint).

SCONCE_CONST float kFinestLobe = 0.05f; // standard deviation of level 0's lobe, radians: about one of its texels
SCONCE_CONST float kLobeGrowth = 2.5f;  // of the width from level to level

/// The texel that one outside an octahedral map of n texels a side stands for: the border is mirrored about its middle.
SCONCE_PURE ivec2 foldOctahedral(int x, int y, int n)
{
    if (x < 0)
    {
        x = -1 - x;
        y = n - 1 - y;
    }
    if (x >= n)
    {
        x = 2 * n - 1 - x;
        y = n - 1 - y;
    }
    if (y < 0)
    {
        y = -1 - y;
        x = n - 1 - x;
    }
    if (y >= n)
    {
        y = 2 * n - 1 - y;
        x = n - 1 - x;
    }
    return ivec2(x, y);
}

/// The four texels of a bilinear look-up, as y * n + x, and their weights.
struct OctahedralTaps
{
    uvec4 texel;
    vec4 weight;
};

/// Within the map; a number that is none is 0, so that no look-up leaves it.
SCONCE_PURE real withinMap(real u) { return u > real(0.0) ? min(u, real(1.0)) : real(0.0); }

/// Of an octahedral map of n texels a side; across its border the look-up goes on where the sphere does.
SCONCE_PURE OctahedralTaps octahedralTaps(vec2 uv, int n)
{
    real x = withinMap(uv.x) * real(n) - real(0.5);
    real y = withinMap(uv.y) * real(n) - real(0.5);
    int x0 = int(floor(x));
    int y0 = int(floor(y));
    real fx = x - floor(x);
    real fy = y - floor(y);
    ivec2 a = foldOctahedral(x0, y0, n);
    ivec2 b = foldOctahedral(x0 + 1, y0, n);
    ivec2 c = foldOctahedral(x0, y0 + 1, n);
    ivec2 d = foldOctahedral(x0 + 1, y0 + 1, n);
    OctahedralTaps taps;
    taps.texel = uvec4(uint(a.y * n + a.x), uint(b.y * n + b.x), uint(c.y * n + c.x), uint(d.y * n + d.x));
    taps.weight = vec4((real(1.0) - fx) * (real(1.0) - fy), fx * (real(1.0) - fy), (real(1.0) - fx) * fy, fx * fy);
    return taps;
}

SCONCE_FN vec3 prefilteredLevel(uint probe, int level, vec2 uv)
{
    int n = int(kPrefilteredSize) >> level;
    uint before = (4u * kPrefilteredSize * kPrefilteredSize - 4u * uint(n * n)) / 3u; // words of the finer levels
    uint first = probe * kPrefilteredWords + before;
    OctahedralTaps taps = octahedralTaps(uv, n);
    return taps.weight.x * unpackRadiance(prefilteredWord(first + taps.texel.x)) +
           taps.weight.y * unpackRadiance(prefilteredWord(first + taps.texel.y)) +
           taps.weight.z * unpackRadiance(prefilteredWord(first + taps.texel.z)) +
           taps.weight.w * unpackRadiance(prefilteredWord(first + taps.texel.w));
}

/// Mean radiance that arrives at a probe's centre in a round lobe about a direction, W/(m^2 sr); emission and sky are in it. Trilinear over
/// direction and width. Cost: 8 reads.
/// @param width  standard deviation of the lobe, radians
SCONCE_FN vec3 prefilteredRadiance(uint probe, vec3 direction, real width)
{
    real wide = max(width, real(kFinestLobe));
    real level = min(log2(wide / real(kFinestLobe)) / log2(real(kLobeGrowth)), real(kPrefilteredLevels - 1));
    int finer = min(int(level), kPrefilteredLevels - 2);
    vec2 uv = octahedralFromDirection(direction);
    real blend = level - real(finer);
    return (real(1.0) - blend) * prefilteredLevel(probe, finer, uv) + blend * prefilteredLevel(probe, finer + 1, uv);
}

/// What GGX reflects into, as a round lobe: its axis moves from the mirror direction towards the normal with roughness (Lagarde and de
/// Rousiers 2014, "Moving Frostbite to Physically Based Rendering", section 4.9.3), and half of the visible normals lie within atan(alpha),
/// so half of the reflected rays within twice that; a round normal distribution has half within 1.18 deviations.
struct Lobe
{
    vec3 direction; // unit
    real width;     // standard deviation, radians
};

SCONCE_PURE Lobe reflectedLobe(vec3 normal, vec3 view, real alpha)
{
    Lobe lobe;
    vec3 mirrored = real(2.0) * dot(normal, view) * normal - view;
    real smoothness = max(real(1.0) - alpha, real(0.0));
    real towards = smoothness * (sqrt(smoothness) + alpha);
    lobe.direction = normalize(normal + towards * (mirrored - normal));
    lobe.width = min(real(1.7) * atan(alpha), real(0.8)); // a hemisphere is no wider
    return lobe;
}
