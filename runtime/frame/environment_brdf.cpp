#include "runtime/frame/environment_brdf.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "shaders/shared/brdf.h"
#include "shaders/shared/frame.h"

namespace sconce
{

namespace
{

constexpr uint32_t kSamples = 512;

float radicalInverse(uint32_t bits) // base 2
{
    bits = (bits << 16) | (bits >> 16);
    bits = ((bits & 0x00ff00ffu) << 8) | ((bits & 0xff00ff00u) >> 8);
    bits = ((bits & 0x0f0f0f0fu) << 4) | ((bits & 0xf0f0f0f0u) >> 4);
    bits = ((bits & 0x33333333u) << 2) | ((bits & 0xccccccccu) >> 2);
    bits = ((bits & 0x55555555u) << 1) | ((bits & 0xaaaaaaaau) >> 1);
    return float(bits >> 8) / 16777216.0f;
}

glm::vec2 reflected(float cosine, float alpha)
{
    const glm::vec3 view(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
    glm::dvec2 sum(0.0);
    for (uint32_t i = 0; i < kSamples; ++i)
    {
        const glm::vec3 halfway = sampleVisibleNormal(view, alpha, {(float(i) + 0.5f) / float(kSamples), radicalInverse(i)});
        const glm::vec3 light = glm::reflect(-view, halfway);
        if (light.z <= 0.0f) continue;
        const float weight = 4.0f * view.z * light.z * smithVisibility(light.z, view.z, alpha) / smithMasking(view.z, alpha);
        const float schlick = fresnelSchlick(glm::vec3(0.0f), glm::dot(view, halfway)).x;
        sum += glm::dvec2(weight * (1.0f - schlick), weight * schlick);
    }
    return sum / double(kSamples);
}

} // namespace

std::vector<glm::vec2> environmentBrdf()
{
    constexpr uint32_t n = gpu::kEnvironmentBrdfSide;
    std::vector<glm::vec2> table(size_t(n) * n);
    parallelFor(n,
                [&](size_t row)
                {
                    const float root = float(row) / float(n - 1), alpha = ggxAlpha(root); // alpha is roughness squared
                    for (uint32_t x = 0; x < n; ++x) table[row * n + x] = reflected(std::max(float(x) / float(n - 1), 1e-3f), alpha);
                });
    return table;
}

} // namespace sconce
