#include "bench/race/blended_light.h"

#include <algorithm>

#include "base/parallel.h"
#include "runtime/field/tracer_cpu.h"
#include "shaders/shared/bake_passes.h"
#include "shaders/shared/sample_pair.h"

namespace sconce::twin
{
using gpu::kLinkDark;
using gpu::kLinkNone;
using gpu::kLinkSky;
using gpu::kLinkSurface;
using gpu::kLinkTexelBits;
using gpu::kMostSlope;
using gpu::pairOfRay;

/// The shared text of links.
struct LinkText : LightFieldTwin<float>
{
    using LightFieldTwin<float>::LightFieldTwin;

#include "shaders/shared/brdf_text.h"

#include "shaders/shared/gathered_rays.h"
};
} // namespace sconce::twin

namespace sconce
{
namespace
{
using Text = twin::LinkText;
}

BlendedLight::BlendedLight(const FieldData& field, std::span<const uint32_t> directWords, const BlendSettings& settings)
    : data(field), blend(settings), direct(directWords.size()), light(directWords.size(), vec3(0.0f)), sent(directWords.size())
{
    for (size_t i = 0; i < direct.size(); ++i) direct[i] = Text::unpackSharedExponent(directWords[i]);
}

vec3 BlendedLight::gathered(size_t texel) const
{
    const LiveTransport& live = data.live;
    const size_t ofProbe = size_t(6) * data.info.surfaceSize * data.info.surfaceSize;
    const size_t first = texel / ofProbe * live.links * ofProbe + texel % ofProbe;
    Text text(data, {});
    Text::Ends ends{};
    vec3 sum(0.0f);
    for (uint32_t i = 0; i < live.links; ++i)
    {
        const uint32_t link = live.texelLinks[first + i * ofProbe];
        if (text.countEnd(ends, link)) sum += live.tints[text.tintOfLink(link)] * sent[text.texelOfLink(link)];
    }
    return text.perRay(ends) * sum;
}

void BlendedLight::frame()
{
    const auto known = [&](size_t i) { return (data.live.texels[i].normal & gpu::kSurfaceKnown) != 0; };
    parallelFor(sent.size(),
                [&](size_t i)
                {
                    const gpu::LiveTexel& texel = data.live.texels[i];
                    const vec3 albedo = glm::min(Text::unpackRootOfColor(texel.albedo), vec3(gpu::kMostLiveAlbedo));
                    sent[i] = known(i) ? albedo * light[i] + Text::unpackSharedExponent(texel.direct) * direct[i] : vec3(0.0f);
                });
    const auto root = vec3(float(1.0 / blend.gamma)), power = vec3(float(blend.gamma));
    parallelFor(light.size(),
                [&](size_t i)
                {
                    if (!known(i)) return;
                    const vec3 was = glm::pow(light[i], root);
                    vec3 change = glm::pow(gathered(i), root) - was;
                    float stays = float(blend.hysteresis);
                    if (blend.detects)
                    {
                        if (light[i] == vec3(0.0f)) stays = 0.0f;
                        const vec3 size = glm::abs(change);
                        if (std::max({size.r, size.g, size.b}) > kLargeChange) stays = std::max(0.0f, stays - kLessStays);
                        if (Text::luminance(change) > kBrightChange) change *= kTakenOfBright;
                    }
                    light[i] = glm::pow(glm::max(was + (1.0f - stays) * change, vec3(0.0f)), power);
                });
}

} // namespace sconce
