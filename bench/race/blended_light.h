#pragma once

#include <span>
#include <vector>

#include "runtime/field/field_data.h"

namespace sconce
{

/// Light that follows its lights as an irradiance volume's does (DDGI; Majercik et al. 2019, section 3, and 2021, section 4): each frame
/// all surfaces send what they know, and what arrives is blended into what was there. On a field's own links, so that it has none of a
/// volume's errors of place, and no noise, whatever rays a frame would take: all that is left of the volume is its blending.
struct BlendSettings
{
    double hysteresis = 0.97; // share of what was there that stays
    double gamma = 1.0;       // values are blended as their roots of this order; the papers': 5
    bool detects = false; // changes, as what ships does: what was black is replaced, over kLargeChange of a root's difference less stays
                          // by kLessStays, and of a difference in luminance over kBrightChange a quarter is taken
};

// As shipped in NVIDIA's RTXGI (DDGI SDK 1.3), of roots.
inline constexpr float kLargeChange = 0.25f, kLessStays = 0.75f, kBrightChange = 0.1f, kTakenOfBright = 0.25f;

class BlendedLight
{
public:
    /// @param field   with live links; kept by reference
    /// @param direct  of each texel of surface light, irradiance / pi, RGB9E5: light straight from lights, which is there at once
    BlendedLight(const FieldData& field, std::span<const uint32_t> direct, const BlendSettings& settings);

    void frame();
    /// Light that arrives over surfaces, irradiance / pi, of each texel; black where it shows none.
    std::span<const vec3> bounced() const { return light; }

private:
    vec3 gathered(size_t texel) const;

    const FieldData& data;
    BlendSettings blend;
    std::vector<vec3> direct, light, sent;
};

} // namespace sconce
