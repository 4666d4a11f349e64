#include "runtime/bake/patches.h"

// What a probe sees, as a few discs that throw diffuse light: the patches of shaders/shared/light_lookup.h.
#include <cmath>

#include "base/parallel.h"
#include "runtime/field/tracer_cpu.h"

namespace sconce
{
namespace
{

using Text = twin::LightFieldTwin<float>;

/// Sums over the texels of a window, by solid angle.
struct Window
{
    glm::vec3 light{0.0f}, normal{0.0f};
    float q = 0.0f, seen = 0.0f, all = 0.0f;
};

void addTexel(Text& text, Window& window, int face, glm::ivec2 at, uint32_t word, glm::vec3 light)
{
    const float size = float(text.field.faceSize);
    const glm::vec2 uv = (glm::vec2(at) + 0.5f) * (2.0f / size) - 1.0f;
    const float stretch = 1.0f + glm::dot(uv, uv), solid = 1.0f / (stretch * std::sqrt(stretch));
    window.all += solid;
    if ((word & 0xffffu) == 0) return; // sky
    window.seen += solid;
    window.q += solid * text.halfToReal(word);
    window.normal += solid * text.texelNormal(face, glm::vec2(at) + 0.5f, word);
    window.light += solid * light;
}

/// A window half of sky gives half of the light: patchIrradiance() takes every window's whole solid angle.
void store(Text& text, const Window& window, uint32_t index, uint32_t* out)
{
    const float length = glm::length(window.normal);
    out[0] = out[1] = 0;
    if (!(window.seen > 0.0f) || !(length > 0.0f)) return;
    out[0] = text.realToHalf(window.q / window.seen) | (text.packNormal8(window.normal / length) << 16);
    out[1] = text.packRadianceDithered(window.light / window.all, text.ditherOf(index));
}

void makeOf(Text& text, const FieldData& field, size_t probe, std::span<const uint32_t> surfaces, std::span<const uint32_t> emitted,
            uint32_t* out)
{
    const int size = int(field.info.faceSize), side = gpu::kPatchSide;
    const uint32_t* words = field.distance.data() + probe * field.info.wordsPerProbe;
    for (int face = 0; face < 6; ++face)
    {
        Window windows[gpu::kPatchSide * gpu::kPatchSide];
        const size_t first = (probe * 6 + size_t(face)) * size_t(size) * size_t(size);
        for (int i = 0; i < size * size; ++i)
        {
            const glm::ivec2 at(i % size, i / size);
            const size_t texel = first + size_t(i);
            glm::vec3 light(0.0f);
            if (surfaces[texel] != 0) light = text.unpackRadiance(field.radiance[texel]);
            if (!emitted.empty()) light = glm::max(light - text.unpackRadiance(emitted[texel]), glm::vec3(0.0f));
            Window& window = windows[at.y * side / size * side + at.x * side / size];
            addTexel(text, window, face, at, words[size_t(face) * (field.info.wordsPerProbe / 6) + size_t(i)], light);
        }
        for (int i = 0; i < side * side; ++i)
        {
            const uint32_t index = uint32_t(face * side * side + i);
            store(text, windows[i], index, out + 2 * index);
        }
    }
}

} // namespace

void makePatches(FieldData& field, std::span<const uint32_t> surfaces, std::span<const uint32_t> emitted)
{
    field.patches.clear();
    if (field.info.chart != gpu::kChartCube) return;
    field.patches.resize(size_t(2) * gpu::kPatches * field.probes.size());
    parallelFor(field.probes.size(),
                [&](size_t probe)
                {
                    Text text(field, {});
                    makeOf(text, field, probe, surfaces, emitted, field.patches.data() + size_t(2) * gpu::kPatches * probe);
                });
}

} // namespace sconce
