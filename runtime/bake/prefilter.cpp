#include "runtime/bake/prefilter.h"

// Radiance prefiltered by round lobes: the maps of shaders/shared/prefiltered.h.
#include <cmath>
#include <span>

#include "base/parallel.h"
#include "runtime/field/tracer_cpu.h"

namespace sconce
{

namespace
{

using Text = twin::LightFieldTwin<float>;

constexpr int kSubsamples = 8; // a side, of a texel of the finest level

/// A map's directions and the solid angles of its texels, the same for every probe.
struct Directions
{
    explicit Directions(Text& text, int side) : n(side), direction(size_t(n) * n), solidAngle(size_t(n) * n)
    {
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
            {
                const glm::vec3 d = text.directionFromOctahedral((glm::vec2(x, y) + 0.5f) / float(n));
                const float l1 = std::abs(d.x) + std::abs(d.y) + std::abs(d.z); // 1 / distance of the octahedron's point
                direction[size_t(y) * n + x] = d;
                solidAngle[size_t(y) * n + x] = l1 * l1 * l1; // area over distance cubed; the constant cancels
            }
    }
    int n;
    std::vector<glm::vec3> direction;
    std::vector<float> solidAngle;
};

/// Mean of the map's texels under each texel of the finest level, by 8 x 8 directions.
std::vector<glm::vec3> finest(Text& text, const FieldData& field, size_t probe)
{
    constexpr int n = int(gpu::kPrefilteredSize), fine = n * kSubsamples;
    const int size = int(field.info.faceSize);
    const size_t first = probe * radianceWordsPerProbe(field.info.chart, field.info.faceSize);
    std::vector<glm::vec3> map(size_t(n) * n, glm::vec3(0.0f));
    for (int y = 0; y < fine; ++y)
        for (int x = 0; x < fine; ++x)
        {
            glm::vec2 uv = (glm::vec2(x, y) + 0.5f) / float(fine);
            int face = 0;
            if (field.info.chart == gpu::kChartCube)
            {
                const glm::vec3 d = text.directionFromOctahedral(uv);
                face = text.dominantFace(d);
                const glm::vec3 uvw = text.faceCoordinates(face, d);
                uv = glm::vec2(uvw.x, uvw.y) / uvw.z * 0.5f + 0.5f;
            }
            const glm::ivec2 at = glm::clamp(glm::ivec2(uv * float(size)), 0, size - 1);
            const size_t word = first + (size_t(face) * size_t(size) + size_t(at.y)) * size_t(size) + size_t(at.x);
            map[size_t(y / kSubsamples) * n + size_t(x / kSubsamples)] += text.unpackRadiance(field.radiance[word]);
        }
    for (glm::vec3& value : map) value /= float(kSubsamples * kSubsamples);
    return map;
}

/// The finest level's light under a round normal lobe about a direction.
glm::vec3 lobeMean(const Directions& from, std::span<const glm::vec3> light, glm::vec3 axis, float width)
{
    const float sharpness = 1.0f / (width * width), least = 1.0f - 8.0f / sharpness; // below it: e^-8
    glm::vec3 sum(0.0f);
    float weights = 0.0f;
    for (size_t i = 0; i < light.size(); ++i)
    {
        const float cosine = glm::dot(axis, from.direction[i]); // 1 - cosine is half the angle squared
        if (cosine < least) continue;
        const float weight = from.solidAngle[i] * std::exp(sharpness * (cosine - 1.0f));
        sum += weight * light[i];
        weights += weight;
    }
    return sum / weights;
}

} // namespace

void prefilterRadiance(FieldData& field)
{
    Text shared(field, {});
    std::vector<Directions> levels;
    for (int level = 0; level < gpu::kPrefilteredLevels; ++level) levels.emplace_back(shared, int(gpu::kPrefilteredSize) >> level);
    field.prefiltered.assign(field.probes.size() * gpu::kPrefilteredWords, 0);
    parallelFor(field.probes.size(),
                [&](size_t probe)
                {
                    Text text(field, {});
                    const std::vector<glm::vec3> light = finest(text, field, probe);
                    uint32_t* out = field.prefiltered.data() + probe * gpu::kPrefilteredWords;
                    for (const glm::vec3& value : light) *out++ = text.packRadiance(value);
                    float width = Text::kFinestLobe;
                    for (int level = 1; level < gpu::kPrefilteredLevels; ++level)
                    {
                        width *= Text::kLobeGrowth;
                        for (const glm::vec3& axis : levels[size_t(level)].direction)
                            *out++ = text.packRadiance(lobeMean(levels[0], light, axis, width));
                    }
                });
}

} // namespace sconce
