#pragma once

#include <span>
#include <vector>

#include "bench/sparse/edge_image.h"

namespace sconce
{

/// What a picture without its light knows of each pixel: what a G-buffer holds.
struct SurfacePixels
{
    uint32_t width = 0, height = 0;
    vec3 eye{0.0f};
    std::vector<vec3> position, normal; // metres; 0, 0, 0: nothing is there
    std::vector<float> roughness;
};

/// What a sample says of a pixel about it.
enum class FillBy
{
    distance, // alone
    likeness, // whether the two show the same surface, as the frame's own fill has it (shaders/gbuffer_read.glsl)
    edges,    // whether one comes from one to the other and passes no edge
    both,
};

struct Filled
{
    std::vector<vec3> light;
    size_t samples = 0; // pixels whose light was asked for: the lattice's, and those that none of it says anything of
};

/// Light of all pixels from that of one of `every`, on a lattice: from samples up to one and a half cells off, each weighed by a tent, as
/// reconstruct.comp does. Complex pixels can't be told apart and take all that is near, as in Bala et al. 2003, section 6.
/// @param light  of every pixel; read where it is asked for alone
/// @param every  a square: 1, 4, 16, 64 ...
Filled fillSparse(const SurfacePixels& pixels, const EdgeImage& edges, std::span<const vec3> light, uint32_t every, FillBy by);

/// Colours with the edges of simple pixels smoothed: by the shares of area on both sides of their line, the far side's colour being that of
/// the pixel over there.
std::vector<vec3> smoothEdges(const EdgeImage& edges, std::span<const vec3> colours);

} // namespace sconce
