// Asks a light field by a shader of its own, ask.comp, and prints what it says. Device and buffers are those of the host beside it.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <stdexcept>
#include <string>

#include <sconce/sconce.h>

#include "ask.h"
#include "ask_comp.h"
#include "vulkan_base.h"

namespace
{

constexpr const char* kUsage = R"(usage: ask FIELD.sconce --point X,Y,Z --normal X,Y,Z --ray X,Y,Z --light X,Y,Z [--validation]
  --point    a place on a surface, metres
  --normal   of that surface, on the side that is looked at
  --ray      direction of a ray from the point
  --light    a place that light may come from, metres
)";

struct Options
{
    std::string field;
    Question question{};
    bool validation = false;
};

vec3 vectorOf(const std::string& text, const std::string& option)
{
    vec3 v;
    int read = 0;
    const int found = std::sscanf(text.c_str(), "%f,%f,%f%n", &v.x, &v.y, &v.z, &read);
    if (found != 3 || size_t(read) != text.size() || !std::isfinite(glm::length(v)))
        throw std::invalid_argument(option + " is '" + text + "'; write it as 0,1.5,-2");
    return v;
}

vec3 directionOf(const std::string& text, const std::string& option)
{
    const vec3 v = vectorOf(text, option);
    if (!(glm::length(v) > 0.0f)) throw std::invalid_argument(option + " is '" + text + "', which is no direction; give one of any length");
    return glm::normalize(v);
}

Options parse(int argc, char** argv)
{
    Options options;
    int given = 0;
    for (int i = 1; i < argc; ++i)
    {
        const std::string word = argv[i];
        const std::string value = i + 1 < argc ? argv[i + 1] : "";
        const int before = given++;
        if (word == "--point")
            options.question.point = vectorOf(value, word);
        else if (word == "--normal")
            options.question.normal = directionOf(value, word);
        else if (word == "--ray")
            options.question.direction = directionOf(value, word);
        else if (word == "--light")
            options.question.light = vectorOf(value, word);
        else
        {
            given = before;
            if (word == "--validation")
                options.validation = true;
            else if (word.starts_with("-") || !options.field.empty())
                throw std::invalid_argument("'" + word + "' is not expected\n" + kUsage);
            else
                options.field = word;
            continue;
        }
        ++i; // past the value
    }
    if (options.field.empty() || given < 4)
        throw std::invalid_argument(std::string("a light field and four vectors are needed\n") + kUsage);
    return options;
}

template <class T> T valueOf(sconce::Result<T> result)
{
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(*result);
}

Answer ask(const Vulkan& vulkan, const sconce::LightField& field, Question question)
{
    const Buffer buffer =
        vulkan.makeBuffer(sizeof(Answer), vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eShaderDeviceAddress, true);
    question.answer = buffer.address;
    const vk::DescriptorSetLayout set = field.layout();
    const vk::PushConstantRange push{vk::ShaderStageFlagBits::eCompute, 0, sizeof(Question)};
    const vk::raii::PipelineLayout layout(
        vulkan.device, {.setLayoutCount = 1, .pSetLayouts = &set, .pushConstantRangeCount = 1, .pPushConstantRanges = &push});
    const auto constants = field.constants();
    const vk::SpecializationMapEntry entries[] = {{0, 0, sizeof(uint32_t)}, {1, sizeof(uint32_t), sizeof(uint32_t)}};
    const vk::SpecializationInfo specialization{2, entries, sizeof(constants), constants.data()};
    const vk::raii::Pipeline pipeline = vulkan.computePipeline(ask_comp, *layout, &specialization);
    vulkan.run(
        [&](vk::CommandBuffer cmd)
        {
            cmd.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline);
            cmd.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout, 0, vk::DescriptorSet(field.descriptorSet()), {});
            cmd.pushConstants<Question>(*layout, vk::ShaderStageFlagBits::eCompute, 0, question);
            cmd.dispatch(1, 1, 1);
            const vk::MemoryBarrier2 toHost{.srcStageMask = vk::PipelineStageFlagBits2::eComputeShader,
                                            .srcAccessMask = vk::AccessFlagBits2::eShaderStorageWrite,
                                            .dstStageMask = vk::PipelineStageFlagBits2::eHost,
                                            .dstAccessMask = vk::AccessFlagBits2::eHostRead};
            cmd.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &toHost});
        });
    Answer answer;
    std::memcpy(&answer, buffer.mapped, sizeof(answer));
    return answer;
}

void print(const char* what, vec3 v, const char* unit)
{
    std::printf("%s %.4f %.4f %.4f%s\n", what, double(v.x), double(v.y), double(v.z), unit);
}

int run(const Options& options)
{
    const auto missing = [](VkInstance instance, VkPhysicalDevice device)
    { return sconce::missingFeatures(vkGetInstanceProcAddr, instance, device); };
    const Vulkan vulkan(missing, sconce::requireFeatures, options.validation);
    sconce::HostVulkan lent;
    lent.instance = *vulkan.instance;
    lent.physicalDevice = *vulkan.physicalDevice;
    lent.device = *vulkan.device;
    lent.queueFamily = vulkan.family;
    lent.queue = *vulkan.queue;
    lent.getInstanceProcAddr = vkGetInstanceProcAddr;
    const auto device = valueOf(sconce::Device::create(lent));
    const auto field = valueOf(sconce::LightField::load(device, options.field));
    const Answer answer = ask(vulkan, field, options.question);

    constexpr float pi = std::numbers::pi_v<float>; // irradiance of a mean radiance
    if (answer.arriving.x >= 0.0f) print("irradiance", pi * answer.arriving, " W/m^2");
    print("irradiance of what surfaces reflect", pi * answer.reflected, " W/m^2");
    const char* ends[] = {"misses all", "hits", "is not known beyond"};
    std::printf("the ray %s at %.4f m\n", ends[std::min(answer.status, 2u)], double(answer.distance));
    print("  place", answer.place, " m");
    print("  normal", answer.facing, "");
    print("  radiance", answer.radiance, " W/(m^2 sr)");
    std::printf("the light %s\n", answer.reaches ? "reaches the point" : "is hidden from the point");
    if (vulkan.validationMessages() > 0) throw std::runtime_error("the validation layer has found faults");
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    try
    {
        return run(parse(argc, argv));
    }
    catch (const std::invalid_argument& misuse)
    {
        std::fprintf(stderr, "ask: %s\n", misuse.what());
        return 2;
    }
    catch (const std::exception& failure)
    {
        std::fprintf(stderr, "ask: %s\n", failure.what());
        return 1;
    }
}
