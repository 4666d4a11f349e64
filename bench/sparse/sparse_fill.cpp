#include "bench/sparse/sparse_fill.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sconce
{
namespace
{

constexpr float kTent = 1.5f;         // cells that a sample reaches to each side
constexpr float kLeastWeight = 0.05f; // of the best sample: with less a pixel is asked for itself

/// How much another pixel shows the same surface: likeness() of shaders/gbuffer_read.glsl.
float likeness(const SurfacePixels& of, size_t pixel, size_t other)
{
    if (of.normal[pixel] == vec3(0.0f) || of.normal[other] == vec3(0.0f)) return of.normal[pixel] == of.normal[other] ? 1.0f : 0.0f;
    const float plane =
        100.0f * glm::dot(of.normal[pixel], of.position[other] - of.position[pixel]) / glm::distance(of.position[pixel], of.eye);
    const float rough = 8.0f * (of.roughness[pixel] - of.roughness[other]);
    return std::exp(-plane * plane - rough * rough) * std::pow(std::max(glm::dot(of.normal[pixel], of.normal[other]), 0.0f), 32.0f);
}

class Filler
{
public:
    Filler(const SurfacePixels& surfaces, const EdgeImage& image, std::span<const vec3> truth, uint32_t every, FillBy way)
        : pixels(surfaces), edges(image), light(truth), by(way), side(int(std::lround(std::sqrt(double(every))))),
          sums(truth.size(), vec3(0.0f)), weights(truth.size(), 0.0f), best(truth.size(), 0.0f)
    {
        assert(size_t(pixels.width) * pixels.height == light.size() && side >= 1 && uint32_t(side * side) == every);
    }

    Filled run()
    {
        Filled filled;
        filled.light.resize(light.size());
        std::vector<bool> asked(light.size(), false);
        for (int y = side / 2; y < int(pixels.height); y += side)
            for (int x = side / 2; x < int(pixels.width); x += side)
            {
                asked[at(x, y)] = true;
                spread(x, y);
            }
        for (size_t i = 0; i < light.size(); ++i)
        {
            asked[i] = asked[i] || best[i] < kLeastWeight;
            filled.light[i] = asked[i] ? light[i] : sums[i] / weights[i];
            filled.samples += asked[i] ? 1 : 0;
        }
        return filled;
    }

private:
    size_t at(int x, int y) const { return size_t(y) * pixels.width + size_t(x); }
    bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < int(pixels.width) && y < int(pixels.height); }
    bool byEdges() const { return by == FillBy::edges || by == FillBy::both; }
    bool isComplex(int x, int y) const { return edges.kind(uint32_t(x), uint32_t(y)) == EdgeImage::Kind::complex; }

    /// A sample's light to what it may reach.
    void spread(int x, int y)
    {
        const int reach = int(std::ceil(kTent * float(side))) - 1;
        const std::vector<bool> reached = byEdges() ? flood(x, y, reach) : std::vector<bool>();
        const int across = 2 * reach + 1;
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx)
            {
                if (!inside(x + dx, y + dy)) continue;
                if (byEdges() && !isComplex(x + dx, y + dy) && !reached[size_t((dy + reach) * across + dx + reach)]) continue;
                give(at(x, y), at(x + dx, y + dy), dx, dy);
            }
    }
    void give(size_t from, size_t to, int dx, int dy)
    {
        const float cells = kTent * float(side);
        float weight = (1.0f - float(std::abs(dx)) / cells) * (1.0f - float(std::abs(dy)) / cells);
        if (by == FillBy::likeness || by == FillBy::both) weight *= likeness(pixels, to, from);
        if (!(weight > 0.0f)) return;
        sums[to] += weight * light[from];
        weights[to] += weight;
        best[to] = std::max(best[to], weight);
    }
    /// Pixels about one that are joined to it, row by row.
    std::vector<bool> flood(int x, int y, int reach)
    {
        const int across = 2 * reach + 1;
        std::vector<bool> reached(size_t(across) * size_t(across), false);
        std::vector<glm::ivec2> next = {{0, 0}};
        reached[size_t(reach * across + reach)] = true;
        while (!next.empty())
        {
            const glm::ivec2 from = next.back();
            next.pop_back();
            for (const glm::ivec2 step : {glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(0, 1), glm::ivec2(0, -1)})
            {
                const glm::ivec2 to = from + step;
                if (std::max(std::abs(to.x), std::abs(to.y)) > reach || !inside(x + to.x, y + to.y)) continue;
                const size_t place = size_t((to.y + reach) * across + to.x + reach);
                if (reached[place] || !edges.joined(uint32_t(x + from.x), uint32_t(y + from.y), step.x, step.y)) continue;
                reached[place] = true;
                next.push_back(to);
            }
        }
        return reached;
    }

    const SurfacePixels& pixels;
    const EdgeImage& edges;
    std::span<const vec3> light;
    FillBy by;
    int side; // of a cell, pixels
    std::vector<vec3> sums;
    std::vector<float> weights, best;
};

} // namespace

Filled fillSparse(const SurfacePixels& pixels, const EdgeImage& edges, std::span<const vec3> light, uint32_t every, FillBy by)
{
    return Filler(pixels, edges, light, every, by).run();
}

std::vector<vec3> smoothEdges(const EdgeImage& edges, std::span<const vec3> colours)
{
    std::vector<vec3> smooth(colours.begin(), colours.end());
    for (uint32_t y = 0; y < edges.height(); ++y)
        for (uint32_t x = 0; x < edges.width(); ++x)
        {
            if (edges.kind(x, y) != EdgeImage::Kind::simple) continue;
            const EdgeImage::Line line = edges.line(x, y);
            const vec2 over = glm::round((line.offset > 0.0f ? 1.0f : -1.0f) * line.normal);
            const int otherX = int(x) + int(over.x), otherY = int(y) + int(over.y);
            if (otherX < 0 || otherY < 0 || otherX >= int(edges.width()) || otherY >= int(edges.height())) continue;
            const size_t own = size_t(y) * edges.width() + x, other = size_t(otherY) * edges.width() + size_t(otherX);
            const float share = edges.shareOfCentre(x, y);
            smooth[own] = share * colours[own] + (1.0f - share) * colours[other];
        }
    return smooth;
}

} // namespace sconce
