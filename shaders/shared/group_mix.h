// A field's light as the sum of its groups' shares, each times its weight (FieldData::groups). Shared text, see probe_trace.h; needs
// mixGroups(), mixWeight(uint group) and mixShare(uint group, uint index), a word of a group's share, besides.
//
// Words that hold no light are the same in all shares: of texels that are not known or refined, a hidden surface's key, a cell's place.

SCONCE_FN uint mixedRadiance(uint index)
{
    vec3 sum = vec3(real(0.0));
    for (uint g = 0u; g < mixGroups(); ++g) sum += mixWeight(g) * unpackRadiance(mixShare(g, index));
    return packRadiance(sum);
}

/// Of surface light: a texel's word, a cell's of one facing, a finer texel's, a hidden surface's.
SCONCE_FN uint mixedLight(uint index)
{
    uint first = mixShare(0u, index);
    if (first == 0u || isRefined(first)) return first;
    vec3 sum = vec3(real(0.0));
    for (uint g = 0u; g < mixGroups(); ++g) sum += mixWeight(g) * unpackSharedExponent(mixShare(g, index));
    return packKnownLight(sum);
}

/// How a texel's light leans: a tilt is a moment over the light, and moments are linear.
SCONCE_FN uint mixedTilt(uint texel)
{
    vec2 sum = vec2(real(0.0));
    real all = real(0.0);
    for (uint g = 0u; g < mixGroups(); ++g)
    {
        uint word = mixShare(g, texel);
        if (isRefined(word)) word = mixShare(g, refinedWords() + kFineWords * (word - kRefinedWord));
        real light = luminance(mixWeight(g) * unpackSharedExponent(word));
        sum += light * unpackTilt(mixShare(g, surfaceTexels() + texel / 2u) >> (16u * (texel & 1u)));
        all += light;
    }
    return packTilt(all > real(0.0) ? sum / all : vec2(real(0.0)));
}

/// A word of FieldData::surfaceLight.
SCONCE_FN uint mixedSurface(uint index)
{
    uint texels = surfaceTexels();
    uint cells = cellWords(ivec3(0, 0, 0));
    uint refined = refinedWords();
    uint hidden = refined + kFineWords * field.refinedTexels;
    if (index >= texels && index < cells)
    {
        uint texel = 2u * (index - texels);
        return mixedTilt(texel) | (texel + 1u < texels ? mixedTilt(texel + 1u) << 16 : 0u);
    }
    bool isPlace = index >= cells && index < refined && (index - cells) % kCellWords == kCellWords - 1u;
    bool isKey = index >= hidden && ((index - hidden) & 1u) == 0u;
    return isPlace || isKey ? mixShare(0u, index) : mixedLight(index);
}
