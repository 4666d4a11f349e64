#include "bench/sparse/corrective_textures.h"

#include <algorithm>
#include <cmath>

namespace sconce
{
namespace
{

constexpr float kOld = 16.0f;   // frames after which a texel is wanted again however small it is
constexpr float kLeast = 0.02f; // of the priority of a texel that was just met
constexpr float kDark = 0.05f;  // radiance below which differences count as if there were so much

uint64_t facingOf(vec3 normal)
{
    const vec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return uint64_t(2 * axis + (normal[axis] < 0.0f ? 1 : 0));
}

float greatest(vec3 of)
{
    return std::max({std::abs(of.x), std::abs(of.y), std::abs(of.z)});
}

} // namespace

std::vector<CorrectiveTextures::Corner> CorrectiveTextures::cornersOf(vec3 position, vec3 normal) const
{
    constexpr int64_t kHalf = int64_t(1) << 19; // 20 bits an axis
    const vec3 at = position / desc.texel - 0.5f, low = glm::floor(at), share = at - low;
    std::vector<Corner> corners;
    for (int corner = 0; corner < 8; ++corner)
    {
        uint64_t key = facingOf(normal);
        float weight = 1.0f;
        for (int axis = 0; axis < 3; ++axis)
        {
            const int bit = corner >> axis & 1;
            key = key << 20 | uint64_t(std::clamp<int64_t>(int64_t(low[axis]) + bit + kHalf, 0, 2 * kHalf - 1));
            weight *= bit ? share[axis] : 1.0f - share[axis];
        }
        if (weight > 0.0f) corners.push_back({key, weight});
    }
    return corners;
}

std::vector<vec3> CorrectiveTextures::correct(const SurfacePixels& pixels, std::span<const vec3> cheap, const std::vector<bool>& wanted)
{
    ++frame;
    width = pixels.width;
    priority.assign(cheap.size(), 0.0f);
    std::vector<vec3> picture(cheap.begin(), cheap.end());
    for (size_t i = 0; i < cheap.size(); ++i)
    {
        if (!wanted[i]) continue;
        vec3 sum(0.0f);
        float weights = 0.0f, age = 0.0f;
        for (const Corner& corner : cornersOf(pixels.position[i], pixels.normal[i]))
            if (const auto found = texels.find(corner.key); found != texels.end())
            {
                sum += corner.weight * found->second.difference;
                age += corner.weight * float(frame - found->second.frame);
                weights += corner.weight;
            }
        priority[i] = 1.0f;
        if (weights == 0.0f) continue;
        picture[i] = glm::max(cheap[i] + sum / weights, vec3(0.0f));
        const float off = greatest(sum / weights) / (greatest(picture[i]) + kDark), old = std::min(age / weights / kOld, 1.0f);
        priority[i] = std::max(kLeast, 0.5f * old * old * std::min(0.2f + off, 1.0f));
    }
    return picture;
}

void CorrectiveTextures::add(const SurfacePixels& pixels, std::span<const uint32_t> asked, std::span<const vec3> differences)
{
    for (size_t i = 0; i < asked.size(); ++i)
        for (const Corner& corner : cornersOf(pixels.position[asked[i]], pixels.normal[asked[i]]))
        {
            const auto [entry, isNew] = texels.try_emplace(corner.key);
            Texel& texel = entry->second;
            texel.difference = glm::mix(texel.difference, differences[i], isNew ? 1.0f : desc.blend * corner.weight);
            texel.frame = frame;
        }
}

} // namespace sconce
