#pragma once

#include <optional>
#include <span>

#include "runtime/field/field_data.h"
#include "runtime/sconce.h"
#include "runtime/vulkan/pipeline.h"

namespace sconce
{

/// What groups are in the scene.
std::vector<LightGroupDesc> groupsOf(std::span<const LightGroup> groups);

/// Sets a field's light to its groups' shares, each times its weight: what LightGroups does on the device, by the same text.
/// @param weights  of the groups, as LightGroups::set() takes them
/// Errors: badArgument. Cost: a read of each word of each share, on all cores.
Status mixGroups(FieldData& field, std::span<const vec3> weights);

/// What stands behind the handle LightGroups.
struct LightGroups::State
{
    std::shared_ptr<Gpu> gpu;
    LightField field;
    std::vector<LightGroup> groups; // without their words
    struct Part
    {
        uint32_t kind;            // gpu::kMix...
        const Buffer* target;     // of the field
        uint32_t words;           // of a share
        Buffer shares;            // [group][word]
        VkDeviceAddress live = 0; // a share more, of weight 1; 0: none
    };
    std::vector<Part> parts;
    std::optional<size_t> shareOfMaps; // the part of a field that streams whose shares a FieldStream copies, [group][slot][word]
    Buffer weightBuffer;
    Pipeline pipeline;
    std::vector<vec3> weights;
    bool changed = false; // since the last record
    uint64_t bytes = 0;
    std::unique_ptr<LightField::State, void (*)(LightField::State*)> mixes{nullptr, nullptr}; // the field's; last: it goes before the field
};

/// @param data  that `field` was made from
/// @param radiance  whether the shares of radiance are mixed, too
/// Errors: as LightGroups::load().
Result<LightGroups> makeLightGroups(Gpu& gpu, const LightField& field, const FieldData& data, bool radiance = true);

/// LightGroups::record(), whether anything was set or not.
void recordMix(LightGroups::State& state, VkCommandBuffer cmd, GpuTimer* timer) noexcept;

/// Mixes the radiance of maps whose shares have been copied to slots of a pool, by the weights that were recorded last. Between barriers of
/// the caller's.
void recordSlotMix(LightGroups::State& state, VkCommandBuffer cmd, std::span<const uint32_t> slots) noexcept;

/// The sky of all groups, each times its weight.
vec3 mixedSky(std::span<const LightGroup> groups, std::span<const vec3> weights);

} // namespace sconce
