#include "runtime/bake/emitter_patches.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/numbers.h"

namespace sconce
{
namespace
{

constexpr size_t kLanes = 4;
constexpr size_t kColumns = 11;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float)))); // of GCC and clang, for any processor

Lanes squareRoots(Lanes of)
{
    for (size_t i = 0; i < kLanes; ++i) of[i] = std::sqrt(of[i]);
    return of;
}

struct Vectors
{
    Lanes x, y, z;
};

Lanes dot(const Vectors& a, glm::vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// takenAlong() of brdf_text.h, of cosines that aren't negative.
Lanes takenAlong(Lanes cosine, float grazing)
{
    const Lanes one = Lanes{} + 1.0f, away = one - (cosine < one ? cosine : one), squared = away * away;
    return 1.0f + grazing * (1.0f / 21.0f - squared * squared * away);
}

} // namespace

EmitterPatches::EmitterPatches(std::span<const gpu::GpuLight> patches)
    : count(patches.size()), stride((count + kLanes - 1) / kLanes * kLanes), columns(kColumns * stride, 0.0f)
{
    for (size_t i = 0; i < count; ++i)
    {
        const gpu::GpuLight& patch = patches[i];
        const float row[kColumns] = {patch.position.x,  patch.position.y,  patch.position.z,  patch.direction.x,
                                     patch.direction.y, patch.direction.z, patch.intensity.x, patch.intensity.y,
                                     patch.intensity.z, patch.area,        patch.innerCone};
        for (size_t column = 0; column < kColumns; ++column) columns[column * stride + i] = row[column];
    }
}

void EmitterPatches::weigh(glm::vec3 point, glm::vec3 normal, glm::vec3 plane, float grazing, float near, std::vector<float>& weights) const
{
    weights.resize(stride);
    const Lanes none{};
    for (size_t i = 0; i < stride; i += kLanes)
    {
        const auto column = [&](size_t of)
        {
            Lanes lanes;
            std::memcpy(&lanes, &columns[of * stride + i], sizeof lanes);
            return lanes;
        };
        Vectors to{column(0) - point.x, column(1) - point.y, column(2) - point.z};
        const Lanes least = none + 1e-14f, squared = to.x * to.x + to.y * to.y + to.z * to.z, d2 = squared < least ? least : squared;
        const Lanes distance = squareRoots(d2), area = column(9);
        to = {to.x / distance, to.y / distance, to.z / distance};
        const Lanes facing = -(to.x * column(3) + to.y * column(4) + to.z * column(5));
        const Lanes behind = column(10) > none ? none : -facing, seen = facing < none ? behind : facing;
        const Lanes attenuation = seen * area / d2;
        const Lanes luminous =
            column(6) * attenuation * kLuminance.x + column(7) * attenuation * kLuminance.y + column(8) * attenuation * kLuminance.z;
        const Lanes along = dot(to, normal), above = along < none ? none : along;
        Lanes cosine = dot(to, plane) > none ? above : none;
        cosine = d2 < near * area ? none : cosine;
        if (grazing > 0.0f) cosine *= takenAlong(cosine, grazing);
        cosine *= luminous;
        std::memcpy(&weights[i], &cosine, sizeof cosine);
    }
    weights.resize(count);
}

} // namespace sconce
