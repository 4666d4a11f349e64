#include "bench/opponents/octahedral_field.h"

#include <fmt/format.h>

#include "base/parallel.h"
#include "runtime/field/field_space.h"
#include "runtime/field/tracer_cpu.h"
#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using Text = twin::LightFieldTwin<float>;

struct FaceTexel
{
    int face;
    glm::vec2 at; // pixels
    uint32_t index;
};

FaceTexel faceTexelOf(Text& text, uint32_t size, glm::vec3 direction)
{
    const int face = text.dominantFace(direction);
    const glm::vec3 uvw = text.faceCoordinates(face, direction);
    const glm::vec2 at = glm::clamp((0.5f * glm::vec2(uvw) / uvw.z + 0.5f) * float(size), 0.0f, float(size) - 0.001f);
    return {face, at, uint32_t(at.y) * size + uint32_t(at.x)};
}

/// The word of an octahedral texel in whose middle `direction` lies: the plane that the face texel shows there, in the octant's chart.
uint32_t octahedralWord(Text& text, const FaceTexel& from, uint32_t word, glm::vec3 direction, uint32_t size)
{
    if ((word & 0xffffu) == 0) return 0;
    const glm::vec2 off = from.at - glm::floor(from.at) - 0.5f;
    const float q = text.halfToReal(word) * (1.0f + text.unpackGradient(word >> 16) * off.x + text.unpackGradient(word >> 24) * off.y);
    const glm::vec3 point = direction / (q * text.faceCoordinates(from.face, direction).z); // relative to the probe
    const int octant = text.octantOf(direction);
    const glm::vec3 uvw = text.octantCoordinates(octant, point);
    const glm::vec3 gradient = text.octantGradient(octant, text.texelNormal(from.face, from.at, word));
    const float facing = glm::dot(gradient, uvw) / uvw.z;
    const float perTexel = facing != 0.0f ? 2.0f / (float(size) * facing) : 0.0f;
    return text.packTexel(1.0f / uvw.z, gradient.x * perTexel, gradient.y * perTexel);
}

} // namespace

FieldData octahedralCopy(const FieldData& faces, uint32_t size, uint32_t topLevel, uint32_t words)
{
    FieldData made;
    made.info = faces.info;
    made.info.chart = gpu::kChartOctahedral;
    made.info.faceSize = made.resolution = size;
    made.info.topLevel = topLevel;
    made.info.wordsPerProbe = words;
    made.probes = faces.probes;
    made.irradiance = faces.irradiance;
    made.prefiltered = faces.prefiltered;
    made.patches = faces.patches;
    made.octree = faces.octree;
    made.bounces = faces.bounces;
    made.sceneName = faces.sceneName;
    made.effects = faces.effects;
    made.distance.assign(size_t(words) * faces.probes.size(), 0);
    if (!faces.radiance.empty()) made.radiance.assign(size_t(size) * size * faces.probes.size(), 0);
    return made;
}

Result<FieldData> octahedralField(const FieldData& faces, uint32_t size)
{
    if (faces.info.chart != gpu::kChartCube)
        return Error{ErrorCode::badInput,
                     "Our tracer's octahedral maps are made from cube faces, these are octahedral. Bake with --chart cube."};
    if (inBlocks(faces.info))
        return Error{ErrorCode::badInput, "Our tracer's octahedral maps are made from texels, and this field's are in blocks. Bake "
                                          "without --compact."};
    if (size == 0 || size % 64 != 0)
        return Error{ErrorCode::badArgument,
                     fmt::format("Our tracer's octahedral maps need a multiple of 64 texels a side, not {}.", size)};
    const uint32_t topLevel = coarsestLevel(size);
    FieldData made = octahedralCopy(faces, size, topLevel, Pure<float>::chainWords(size, int(topLevel)));
    const uint32_t faceSize = faces.info.faceSize;
    parallelFor(faces.probes.size(),
                [&](size_t probe)
                {
                    Text text(faces, {});
                    uint32_t* words = made.distance.data() + probe * made.info.wordsPerProbe;
                    const uint32_t* source = faces.distance.data() + probe * faces.info.wordsPerProbe;
                    for (uint32_t i = 0; i < size * size; ++i)
                    {
                        const glm::vec3 direction = text.directionFromOctahedral((glm::vec2(i % size, i / size) + 0.5f) / float(size));
                        const FaceTexel from = faceTexelOf(text, faceSize, direction);
                        words[i] =
                            octahedralWord(text, from, source[from.face * (faces.info.wordsPerProbe / 6) + from.index], direction, size);
                        if (!made.radiance.empty())
                            made.radiance[probe * size * size + i] =
                                faces.radiance[(probe * 6 + size_t(from.face)) * faceSize * faceSize + from.index];
                    }
                    buildChain(words, size);
                });
    return made;
}

} // namespace sconce
