// Light of places that no probe sees: a coarse grid of cells, each with the light that falls on six facings at one place in the open. What moves,
// and what is too thin or too hidden for a map, is lit by it. Shared text, see probe_trace.h; needs surfaceWord(uint) and planeSeen() besides.
//
// The cells lie over the octree's box, 2^cellShift of its finest voxels a side, x fastest, after the texels of all probes in the same words:
// the light on the facings +x, -x, +y, -y, +z, -z, as a texel's, and the place. What two opposite facings have in common is blended by the squares of the
// normal, as all light is in the ambient cube of McTaggart 2004, "Half-Life 2 / Valve Source Shading"; what they differ by is linear in the normal, as
// irradiance is in the first order of spherical harmonics: by squares alone a ball under a lamp is a third too dark.

SCONCE_CONST real kLeastOfNormal = real(0.5); // share of a normal, by its squares, whose light a cell must know
SCONCE_CONST real kCellPlaces = real(1024.0); // steps of a place across a cell

SCONCE_FN ivec3 lightCells()
{
    int more = (1 << field.cellShift) - 1;
    return ivec3(((field.topCells.x << field.topShift) + more) >> field.cellShift, ((field.topCells.y << field.topShift) + more) >> field.cellShift,
                 ((field.topCells.z << field.topShift) + more) >> field.cellShift);
}

/// Texels of all probes.
SCONCE_FN uint surfaceTexels() { return field.probeCount * 6u * field.surfaceSize * field.surfaceSize; }

/// Index of a cell's first word.
SCONCE_FN uint cellWords(ivec3 cell)
{
    ivec3 count = lightCells();
    uint tilts = field.surfaceDirections != 0u ? (surfaceTexels() + 1u) / 2u : 0u; // surface_light.h
    return surfaceTexels() + tilts + kCellWords * uint(cell.x + count.x * (cell.y + count.y * cell.z));
}

/// Where in the field a cell's light was gathered.
SCONCE_FN vec3 cellPlace(ivec3 cell, uint place)
{
    vec3 within = vec3(real(place & 1023u), real((place >> 10) & 1023u), real((place >> 20) & 1023u)) + vec3(real(0.5));
    return vec3(field.boundsLow) + real(field.voxel) * real(1 << field.cellShift) * (vec3(real(cell.x), real(cell.y), real(cell.z)) + within / kCellPlaces);
}

/// Light on a normal along one axis, from its two facings, of which one may be enough: rgb, and whether it is known.
SCONCE_FN vec4 axisLight(uint first, real along)
{
    uint plus = surfaceWord(first);
    uint minus = surfaceWord(first + 1u);
    uint faced = along < real(0.0) ? minus : plus;
    if (faced == 0u) return vec4(real(0.0));
    vec3 high = unpackSharedExponent(plus == 0u ? minus : plus);
    vec3 low = unpackSharedExponent(minus == 0u ? plus : minus);
    return vec4(real(0.5) * (along * along * (high + low) + along * (high - low)), real(1.0));
}

/// Light at a point from the eight cells about it that the same probe sees: so that a wall keeps its sides apart. Cost: up to 56 reads, and up to 12
/// of planes.
/// @param lifted  point in the open before it, whose probes are `ranked`
/// @return  rgb: mean of the arriving radiance, weighted by the cosine; a: 0 where no cell knows
SCONCE_FN vec4 cellLightAt(vec3 lifted, vec3 normal, uvec4 ranked)
{
    uint eye = ranked.x;
    bool best = false; // by its maps, if they are there
    for (int k = kRanked - 1; k >= 0; --k)
    {
        bool sees = !hiddenFromProbe(ranked[k], lifted - vec3(probeHeader(ranked[k]).centre));
        if (!sees || (best && !holdsMaps(ranked[k]))) continue;
        eye = ranked[k];
        best = best || holdsMaps(eye);
    }
    vec3 centre = vec3(probeHeader(eye).centre);
    ivec3 count = lightCells();
    vec3 at = (lifted - vec3(field.boundsLow)) / (real(field.voxel) * real(1 << field.cellShift)) - vec3(real(0.5));
    ivec3 low = ivec3(clamp(int(floor(at.x)), 0, count.x - 1), clamp(int(floor(at.y)), 0, count.y - 1), clamp(int(floor(at.z)), 0, count.z - 1));
    vec3 f = clamp(at - vec3(real(low.x), real(low.y), real(low.z)), vec3(real(0.0)), vec3(real(1.0)));
    vec4 sum = vec4(real(0.0));
    for (int corner = 0; corner < 8; ++corner)
    {
        ivec3 to = ivec3(corner & 1, (corner >> 1) & 1, corner >> 2);
        ivec3 cell = ivec3(min(low.x + to.x, count.x - 1), min(low.y + to.y, count.y - 1), min(low.z + to.z, count.z - 1));
        uint first = cellWords(cell);
        uint place = surfaceWord(first + 6u);
        if ((place & kCellKnown) == 0u) continue;
        vec3 from = cellPlace(cell, place);
        if (hiddenFromProbe(eye, from - centre)) continue;
        // Some of each, so that one cell of eight that knows is enough.
        real weight = (to.x != 0 ? f.x : real(1.0) - f.x) * (to.y != 0 ? f.y : real(1.0) - f.y) * (to.z != 0 ? f.z : real(1.0) - f.z) + real(1e-3);
        vec4 x = axisLight(first, normal.x);
        vec4 y = axisLight(first + 2u, normal.y);
        vec4 z = axisLight(first + 4u, normal.z);
        // What is known of the normal stands for the rest of it.
        real known = x.w * normal.x * normal.x + y.w * normal.y * normal.y + z.w * normal.z * normal.z;
        if (known < kLeastOfNormal) continue;
        vec3 light = vec3(x.x, x.y, x.z) + vec3(y.x, y.y, y.z) + vec3(z.x, z.y, z.z);
        sum += weight * vec4(max(light, vec3(real(0.0))) / known, real(1.0));
    }
    if (!(sum.w > real(0.0))) return sum;
    return vec4(vec3(sum.x, sum.y, sum.z) / sum.w, real(1.0));
}
