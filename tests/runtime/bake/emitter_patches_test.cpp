// Patches weighed several at once against the shaders' own text, patch by patch.
#include <bit>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "runtime/bake/emitter_patches.h"
#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using Text = Pure<float>;

glm::vec3 unit(Random& random)
{
    return glm::normalize(glm::vec3(random.uniform(), random.uniform(), random.uniform()) - 0.5f);
}

std::vector<gpu::GpuLight> somePatches(size_t count, Random& random)
{
    std::vector<gpu::GpuLight> patches(count);
    for (gpu::GpuLight& patch : patches)
    {
        patch.position = 4.0f * glm::vec3(random.uniform(), random.uniform(), random.uniform());
        patch.direction = unit(random);
        patch.intensity = 9.0f * glm::vec3(random.uniform(), random.uniform(), random.uniform());
        patch.area = 0.05f * random.uniform();
        patch.innerCone = random.uniform() < 0.5f ? 1.0f : 0.0f;
    }
    return patches;
}

/// As surface_gather.h writes it.
float weightOf(const gpu::GpuLight& patch, glm::vec3 point, glm::vec3 normal, glm::vec3 plane, float grazing, float near)
{
    const glm::vec3 away = patch.position - point;
    const float d2 = std::max(glm::dot(away, away), 1e-14f);
    const glm::vec3 toLight = away / std::sqrt(d2);
    const glm::vec3 irradiance =
        patch.intensity * Text::patchAttenuation(-glm::dot(toLight, patch.direction), d2, patch.area, 0.0f, patch.innerCone > 0.0f);
    float cosine = glm::dot(plane, toLight) > 0.0f && !(d2 < near * patch.area) ? std::max(glm::dot(normal, toLight), 0.0f) : 0.0f;
    cosine *= Text::takenAlong(cosine, grazing);
    return cosine * Text::luminance(irradiance);
}

TEST(EmitterPatches, AreWeighedTogetherAsOneByOneToTheBit)
{
    constexpr float kNear = 9.0f;
    Random random(7, 0, 0);
    size_t lit = 0, dark = 0, near = 0;
    std::vector<float> weights;
    for (const size_t count : {0, 1, 3, 4, 5, 1000})
    {
        const std::vector<gpu::GpuLight> patches = somePatches(count, random);
        const EmitterPatches together(patches);
        for (int place = 0; place < 200; ++place)
        {
            // Some on a patch itself, where the least distance counts.
            const glm::vec3 point = count > 0 && place % 20 == 0 ? patches[size_t(place) % count].position
                                                                 : 4.0f * glm::vec3(random.uniform(), random.uniform(), random.uniform());
            const glm::vec3 plane = unit(random), normal = glm::normalize(plane + 0.3f * unit(random));
            const float grazing = place % 3 == 0 ? 0.0f : 2.0f * random.uniform();
            together.weigh(point, normal, plane, grazing, kNear, weights);
            ASSERT_EQ(weights.size(), count);
            for (size_t i = 0; i < count; ++i)
            {
                const float alone = weightOf(patches[i], point, normal, plane, grazing, kNear);
                ASSERT_EQ(std::bit_cast<uint32_t>(weights[i]), std::bit_cast<uint32_t>(alone)) << weights[i] << ", alone " << alone;
                ++(alone > 0.0f ? lit : dark);
                near += glm::dot(patches[i].position - point, patches[i].position - point) < kNear * patches[i].area ? 1 : 0;
            }
        }
    }
    EXPECT_GT(lit, 20000u);
    EXPECT_GT(dark, 20000u);
    EXPECT_GT(near, 1000u);
}

} // namespace
} // namespace sconce
