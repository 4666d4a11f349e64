// What a driver says of the code that it makes of passes: registers, spills, instructions, subgroups; whichever figures it has.
//   sconce_pass_statistics FILE.spv[:ID=VALUE,...]... [--constant ID=VALUE]... [--device NAME]
// The .spv files are those that the build makes. RADV says it without hardware: RADV_FORCE_FAMILY=NAVI21, and its ICD in VK_DRIVER_FILES.
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/gpu/spirv_interface.h"
#include "bench/race/tracer_race.h"
#include "runtime/vulkan/made_device.h"
#include "runtime/vulkan/pipeline.h"

namespace sconce
{
namespace
{

using Json = nlohmann::ordered_json;

struct Pass
{
    std::string file;
    std::vector<ShaderConstant> constants;
};

struct Options
{
    std::vector<std::string> passes, constants;
    std::string device;
};

Result<ShaderConstant> constantOf(std::string_view text)
{
    ShaderConstant constant{};
    const size_t equals = text.find('=');
    const auto number = [](std::string_view digits, uint32_t& value)
    {
        const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        return fault == std::errc() && end == digits.data() + digits.size();
    };
    if (equals == std::string_view::npos || !number(text.substr(0, equals), constant.id) ||
        !number(text.substr(equals + 1), constant.value))
        return Error{ErrorCode::badArgument, fmt::format("'{}' is no constant: write ID=VALUE, both whole numbers", text)};
    return constant;
}

Result<Pass> passOf(const std::string& text, std::vector<ShaderConstant> constants)
{
    const size_t colon = text.rfind(':');
    Pass pass{text.substr(0, colon), std::move(constants)};
    for (size_t at = colon; at != std::string::npos;)
    {
        const size_t next = text.find(',', at + 1);
        const auto constant = constantOf(std::string_view(text).substr(at + 1, next == std::string::npos ? next : next - at - 1));
        if (!constant) return constant.error();
        pass.constants.push_back(*constant);
        at = next;
    }
    return pass;
}

Result<std::vector<uint32_t>> codeOf(const std::string& file)
{
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (!in || bytes.size() % 4 != 0)
        return Error{ErrorCode::badInput, fmt::format("{} can't be read as SPIR-V: give a .spv file of the build", file)};
    std::vector<uint32_t> code(bytes.size() / 4);
    std::memcpy(code.data(), bytes.data(), bytes.size());
    return code;
}

/// A device whose pipelines tell what they were compiled to.
struct TellingDevice
{
    std::unique_ptr<MadeDevice> made;
    PFN_vkGetPipelineExecutablePropertiesKHR properties;
    PFN_vkGetPipelineExecutableStatisticsKHR statistics;
};

Result<TellingDevice> tellingDevice(const std::string& name)
{
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR feature{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR};
    feature.pipelineExecutableInfo = VK_TRUE;
    const char* extension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
    OwnDevice::Desc desc;
    desc.device = name;
    auto made = makeDevice(desc, {}, {&extension, 1}, &feature);
    if (!made) return made.error();
    const HostVulkan& host = (*made)->host;
    const auto get = [&](const char* function)
    {
        const auto ofDevice = reinterpret_cast<PFN_vkGetDeviceProcAddr>(host.getInstanceProcAddr(host.instance, "vkGetDeviceProcAddr"));
        return ofDevice(host.device, function);
    };
    TellingDevice telling;
    telling.properties = reinterpret_cast<PFN_vkGetPipelineExecutablePropertiesKHR>(get("vkGetPipelineExecutablePropertiesKHR"));
    telling.statistics = reinterpret_cast<PFN_vkGetPipelineExecutableStatisticsKHR>(get("vkGetPipelineExecutableStatisticsKHR"));
    telling.made = std::move(*made);
    return telling;
}

Json valueOf(const VkPipelineExecutableStatisticKHR& statistic)
{
    switch (statistic.format)
    {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
        return statistic.value.b32 != 0;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
        return statistic.value.i64;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
        return statistic.value.u64;
    default:
        return statistic.value.f64;
    }
}

/// Of the one executable that a compute pipeline is on every driver.
Result<Json> statisticsOf(const TellingDevice& device, const Gpu& gpu, const Pipeline& pipeline)
{
    VkPipelineInfoKHR info{VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR};
    info.pipeline = pipeline.handle();
    uint32_t count = 1;
    VkPipelineExecutablePropertiesKHR properties{VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR};
    VkResult result = device.properties(gpu.host.device, &info, &count, &properties);
    if (result < 0 || count == 0) return gpu.failure("vkGetPipelineExecutablePropertiesKHR", result);
    VkPipelineExecutableInfoKHR executable{VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR};
    executable.pipeline = pipeline.handle();
    result = device.statistics(gpu.host.device, &executable, &count, nullptr);
    std::vector<VkPipelineExecutableStatisticKHR> all(result == VK_SUCCESS ? count : 0,
                                                      {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
    if (result == VK_SUCCESS) result = device.statistics(gpu.host.device, &executable, &count, all.data());
    if (result != VK_SUCCESS) return gpu.failure("vkGetPipelineExecutableStatisticsKHR", result);
    Json json{{"subgroup_size", properties.subgroupSize}};
    for (const auto& statistic : all) json[statistic.name] = valueOf(statistic);
    return json;
}

Result<Json> compile(const TellingDevice& device, Gpu& gpu, const Pass& pass)
{
    const auto code = codeOf(pass.file);
    if (!code) return code.error();
    const auto interface = spirvInterface(*code);
    if (!interface) return Error{interface.error().code, fmt::format("{}: {}", pass.file, interface.error().message)};
    // A layout for each set up to the last, empty ones too.
    std::vector<VkDescriptorSetLayout> layouts;
    for (uint32_t set = 0; !interface->bindings.empty() && set <= interface->bindings.back().set; ++set)
    {
        std::vector<VkDescriptorSetLayoutBinding> bindings;
        for (const SpirvInterface::Binding& one : interface->bindings)
            if (one.set == set) bindings.push_back({one.binding, one.type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
        const auto layout = gpu.setLayout(bindings);
        if (!layout) return layout.error();
        layouts.push_back(*layout);
    }
    constexpr uint32_t kMostPushBytes = 128; // that every device has
    const auto pipeline = Pipeline::compute(gpu, *code, layouts, interface->pushes ? kMostPushBytes : 0, pass.constants,
                                            VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR);
    if (!pipeline) return Error{pipeline.error().code, fmt::format("{}: {}", pass.file, pipeline.error().message)};
    auto statistics = statisticsOf(device, gpu, *pipeline);
    if (!statistics) return statistics.error();
    Json constants = Json::object();
    for (const ShaderConstant& constant : pass.constants) constants[std::to_string(constant.id)] = constant.value;
    return Json{{"pass", std::filesystem::path(pass.file).stem()}, {"constants", constants}, {"statistics", *statistics}};
}

Result<Json> compileAll(const Options& options)
{
    std::vector<ShaderConstant> common;
    for (const std::string& text : options.constants)
    {
        const auto constant = constantOf(text);
        if (!constant) return constant.error();
        common.push_back(*constant);
    }
    const auto device = tellingDevice(options.device);
    if (!device) return device.error();
    const auto gpu = Gpu::create(device->made->host);
    if (!gpu) return gpu.error();
    Json passes = Json::array();
    for (const std::string& text : options.passes)
    {
        const auto pass = passOf(text, common);
        if (!pass) return pass.error();
        auto compiled = compile(*device, **gpu, *pass);
        if (!compiled) return compiled.error();
        passes.push_back(std::move(*compiled));
    }
    const std::string name = device->made->name();
    std::string driver;
    if (const auto devices = deviceSummary())
        for (const DeviceSummary& one : *devices)
            if (one.name == name) driver = one.driver;
    return Json{{"device", name}, {"driver", driver}, {"passes", passes}};
}

} // namespace
} // namespace sconce

int main(int argc, char** argv)
{
    CLI::App app{"What a driver says of the code that it makes of passes, as JSON"};
    sconce::Options options;
    app.add_option("PASS", options.passes, "FILE.spv of a compute pass, and its own constants: FILE.spv:ID=VALUE,...")->required();
    app.add_option("--constant", options.constants, "ID=VALUE of every pass that has the constant; repeatable (default: none)");
    app.add_option("--device", options.device, "Vulkan device, by number or part of its name (default: the best)");
    CLI11_PARSE(app, argc, argv);
    const auto all = sconce::compileAll(options);
    if (!all) return sconce::exitCodeOf(all.error());
    std::cout << all->dump(1) << std::endl;
    return 0;
}
