#include "bench/gpu/spirv_interface.h"

#include <algorithm>
#include <map>
#include <tuple>

#include <fmt/format.h>

namespace sconce
{
namespace
{

// Numbers of the specification; the headers that name them are in no package that the build needs.
constexpr uint32_t kMagic = 0x07230203, kHeaderWords = 5;
constexpr uint32_t kOpEntryPoint = 15, kOpTypeImage = 25, kOpTypeSampledImage = 27, kOpTypeStruct = 30, kOpTypePointer = 32,
                   kOpVariable = 59, kOpDecorate = 71;
constexpr uint32_t kDecorationBinding = 33, kDecorationDescriptorSet = 34;
constexpr uint32_t kStorageBufferClass = 12, kPushConstantClass = 9;
constexpr uint32_t kCompute = 5, kDimBuffer = 5, kReadOnlyImage = 1; // execution model; dimension; `Sampled` of an image

using Words = std::span<const uint32_t>;

struct Module
{
    std::map<uint32_t, uint32_t> sets, bindings; // by variable
    std::map<uint32_t, Words> types;             // the instruction by its result
    std::vector<Words> variables;
    bool compute = false;
};

Result<Module> read(Words code)
{
    if (code.size() < kHeaderWords || code[0] != kMagic)
        return Error{ErrorCode::badInput, "no SPIR-V: give a .spv file that the build made"};
    Module module;
    for (size_t at = kHeaderWords; at < code.size();)
    {
        const uint32_t length = code[at] >> 16;
        if (length == 0 || length > code.size() - at)
            return Error{ErrorCode::badInput, fmt::format("SPIR-V ends within its word {}: build it again", at)};
        const Words words = code.subspan(at, length);
        at += length;
        switch (words[0] & 0xffff)
        {
        case kOpEntryPoint:
            module.compute |= length > 1 && words[1] == kCompute;
            break;
        case kOpDecorate:
            if (length > 3 && words[2] == kDecorationDescriptorSet) module.sets[words[1]] = words[3];
            if (length > 3 && words[2] == kDecorationBinding) module.bindings[words[1]] = words[3];
            break;
        case kOpTypeImage:
        case kOpTypeSampledImage:
        case kOpTypeStruct:
        case kOpTypePointer:
            if (length > 1) module.types[words[1]] = words;
            break;
        case kOpVariable:
            if (length > 3) module.variables.push_back(words);
            break;
        default:
            break;
        }
    }
    return module;
}

Result<VkDescriptorType> descriptorType(const Module& module, Words variable)
{
    const auto refuse = [&]() -> Error
    {
        return {ErrorCode::badInput,
                fmt::format("variable {} is of a kind that no pass of Sconce declares: bind buffers, images and sampled "
                            "images one by one",
                            variable[2])};
    };
    const auto pointer = module.types.find(variable[1]);
    if (pointer == module.types.end() || pointer->second.size() < 4) return refuse();
    const auto type = module.types.find(pointer->second[3]);
    if (type == module.types.end()) return refuse();
    const Words words = type->second;
    switch (words[0] & 0xffff)
    {
    case kOpTypeStruct:
        return variable[3] == kStorageBufferClass ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case kOpTypeSampledImage:
        return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    case kOpTypeImage:
        if (words.size() < 8) return refuse();
        if (words[3] == kDimBuffer)
            return words[7] == kReadOnlyImage ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
        return words[7] == kReadOnlyImage ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    default:
        return refuse();
    }
}

} // namespace

Result<SpirvInterface> spirvInterface(Words code)
{
    const auto module = read(code);
    if (!module) return module.error();
    if (!module->compute) return Error{ErrorCode::badInput, "no compute shader: of other stages the driver's figures are not asked"};
    SpirvInterface made;
    for (const Words variable : module->variables)
    {
        made.pushes |= variable[3] == kPushConstantClass;
        const auto set = module->sets.find(variable[2]), binding = module->bindings.find(variable[2]);
        if (set == module->sets.end() || binding == module->bindings.end()) continue; // no resource
        const auto type = descriptorType(*module, variable);
        if (!type) return type.error();
        made.bindings.push_back({set->second, binding->second, *type});
    }
    std::ranges::sort(made.bindings, {}, [](const SpirvInterface::Binding& b) { return std::tuple(b.set, b.binding); });
    return made;
}

} // namespace sconce
