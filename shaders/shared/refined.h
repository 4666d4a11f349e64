// Texels of the surface light that are refined, see surface_light.h. Shared text, see probe_trace.h; needs surfaceWord(uint) and light_cells.h besides.

SCONCE_PURE bool isRefined(uint word) { return word >= kRefinedWord; }

/// Index of the first word of all refined texels: after the cells.
SCONCE_FN uint refinedWords() { return cellWords(ivec3(0, 0, lightCells().z)); }

/// Word of a refined texel: 0: its mean; then of its finer ones, row by row.
SCONCE_FN uint refinedWord(uint word, uint index)
{
    return surfaceWord(refinedWords() + kFineWords * (word - kRefinedWord) + index);
}

/// Of a finer texel among those of a refined one.
SCONCE_PURE uint fineIndex(int x, int y)
{
    int within = (1 << kFineLog) - 1;
    return uint(1 + (x & within) + ((y & within) << kFineLog));
}
