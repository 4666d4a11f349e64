// Light of surfaces that no probe sees: a mean for each voxel and facing that has some, in a table of open addressing. Shared text, see probe_trace.h;
// needs surfaceWord(uint), light_cells.h and surface_light.h's refined words besides.
//
// The table lies after the refined texels, of hidden >> kHiddenShiftBits slots of two words: the key, 0 where it is empty, and the light as a texel's.
// A voxel is 2^(hidden's lower bits) finest ones a side.

SCONCE_FN bool holdsHidden() { return field.hidden != 0u; }

SCONCE_FN int hiddenShift() { return int(field.hidden & ((1u << kHiddenShiftBits) - 1u)); }

SCONCE_FN ivec3 hiddenVoxels()
{
    int shift = hiddenShift();
    int more = (1 << shift) - 1;
    return ivec3(((field.topCells.x << field.topShift) + more) >> shift, ((field.topCells.y << field.topShift) + more) >> shift,
                 ((field.topCells.z << field.topShift) + more) >> shift);
}

/// Place in voxels; within it a surface's.
SCONCE_FN vec3 hiddenPlace(vec3 point) { return (point - vec3(field.boundsLow)) / (real(field.voxel) * real(1 << hiddenShift())); }

/// A voxel's key for surfaces that face a way, as dominantFace() has it; 0 outside.
SCONCE_FN uint hiddenKey(ivec3 voxel, int facing)
{
    ivec3 count = hiddenVoxels();
    if (voxel.x < 0 || voxel.y < 0 || voxel.z < 0 || voxel.x >= count.x || voxel.y >= count.y || voxel.z >= count.z) return 0u;
    return 1u + uint(facing) + 6u * uint(voxel.x + count.x * (voxel.y + count.y * voxel.z));
}

/// Slot where the search for a key begins (Knuth 1973, "The Art of Computer Programming", vol. 3, 6.4: multiplicative hashing).
SCONCE_PURE uint hiddenSlot(uint key, uint slots)
{
    uint mixed = key * 2654435769u;
    return (mixed ^ (mixed >> 15)) % slots;
}

/// 0 where nothing is known.
SCONCE_FN uint hiddenWord(uint key)
{
    if (key == 0u) return 0u;
    uint slots = field.hidden >> kHiddenShiftBits;
    uint slot = hiddenSlot(key, slots);
    uint table = refinedWords() + kFineWords * field.refinedTexels;
    for (int i = 0; i < kHiddenTries; ++i)
    {
        uint at = table + 2u * ((slot + uint(i)) % slots);
        uint found = surfaceWord(at);
        if (found == key) return surfaceWord(at + 1u);
        if (found == 0u) return 0u;
    }
    return 0u;
}

/// Light at a surface point from the voxels through which its plane goes in the four columns about it, along the axis that it faces: other floors
/// above and below have light of their own. Cost: about 14 reads.
/// @return  rgb: mean of the arriving radiance, weighted by the cosine; a: 0 where its own voxel has none
SCONCE_FN vec4 hiddenLightAt(vec3 point, vec3 normal)
{
    vec3 place = hiddenPlace(point);
    int facing = dominantFace(normal);
    int axis = facing >> 1;
    int u = axis == 0 ? 1 : 0;
    int v = axis == 2 ? 1 : 2;
    ivec3 voxel = ivec3(int(floor(place.x)), int(floor(place.y)), int(floor(place.z)));
    vec4 sum = vec4(real(0.0));
    uint own = hiddenWord(hiddenKey(voxel, facing));
    if (own == 0u) return sum;
    real lowU = floor(place[u] - real(0.5));
    real lowV = floor(place[v] - real(0.5));
    real fu = place[u] - real(0.5) - lowU;
    real fv = place[v] - real(0.5) - lowV;
    for (int column = 0; column < 4; ++column)
    {
        real du = real(column & 1);
        real dv = real(column >> 1);
        voxel[u] = int(lowU + du);
        voxel[v] = int(lowV + dv);
        voxel[axis] = int(floor(place[axis] - (normal[u] * (du - fu) + normal[v] * (dv - fv)) / normal[axis]));
        uint word = hiddenWord(hiddenKey(voxel, facing));
        if (word == 0u) continue;
        real weight = (du > real(0.0) ? fu : real(1.0) - fu) * (dv > real(0.0) ? fv : real(1.0) - fv) + real(1e-3);
        sum += weight * vec4(unpackSharedExponent(word), real(1.0));
    }
    if (!(sum.w > real(0.0))) return vec4(unpackSharedExponent(own), real(1.0));
    return vec4(vec3(sum.x, sum.y, sum.z) / sum.w, real(1.0));
}
