#pragma once

#include <span>

#include "runtime/field/field_data.h"
#include "runtime/field/light_groups.h"
#include "runtime/sconce.h"

namespace sconce
{

/// What stands behind the handle LiveLight.
struct LiveLight::State
{
    /// What is still to be done of a probe's light.
    struct Probe
    {
        vec3 centre;         // world
        bool direct = true;  // light straight from lights is not of these lights
        bool lit = false;    // in this round
        bool chosen = false; // for the record in the making
    };
    std::shared_ptr<Gpu> gpu;
    LightField field;
    LightGroups groups;
    uint32_t links = 0, places = 0, refinedCount = 0, lightCount = 0;
    std::vector<Probe> probes;
    uint32_t next = 0; // of the probes that take their turn
    uint32_t bounces =
        0; // until light is settled: of all probes together, since each is lit by the others. A round lights every probe once,
    uint32_t ofRound = 0; // by so many bounces
    std::vector<Light> lights;
    std::vector<gpu::GpuLight> packed; // in the field's space
    Buffer texels, texelLinks, placeWords, placeLinks, refined, tints, lightBuffer, list, addresses;
    Buffer direct, bounced, tilts, sent, sentNext, surface, irradiance, prefiltered;
    Pipeline directPass, bouncePass, filterPass, placePass, finePass, mapPass, lobePass;
    bool moved = false;               // lights since the last record
    std::vector<uint32_t> others;     // that need light and wait; reserved
    std::vector<uint32_t> turn, dark; // of a record: probes that are lit, and of them those whose direct light is made; reserved
    std::vector<VkBufferCopy> copies; // reserved
    uint64_t bytes = 0;
};

/// @param field  made from `data`; passes that trace it must be made afterwards
/// Errors: as LiveLight::load().
Result<LiveLight> makeLiveLight(Gpu& gpu, const LightField& field, const FieldData& data);

/// Lights a field anew on the device, until its light is settled: what a bake ends with. From no live light on, so that the same lights
/// give the same bytes, whatever the field's were.
/// @param field  with FieldData::live and groups; gets `lights`
/// @param weights  of its groups
/// @param mostBounces  of that light, before it is settled
/// Errors: as LiveLight::set(), deviceFailure.
Status relightField(Gpu& gpu, FieldData& field, std::span<const Light> lights, std::span<const vec3> weights,
                    uint32_t mostBounces = knobs::bounces.most);

/// Whether two lights give the same, whatever they are called.
bool sameLight(const Light& a, const Light& b);

/// What is wrong with lights that are to move, as a sentence without its full stop; empty where nothing is.
std::string lightFault(std::span<const Light> lights);

} // namespace sconce
