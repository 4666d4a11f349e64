// A host that knows nothing but the installed package: with Vulkan objects of its own it asks a light field for 100 rays, twice in one
// command buffer through the library's pass, and once through a shader of its own.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include <sconce/sconce.h>

#include "host_trace.h"

namespace
{

struct Vulkan
{
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    uint32_t family = 0;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;

    ~Vulkan()
    {
        if (pool) vkDestroyCommandPool(device, pool, nullptr);
        if (device) vkDestroyDevice(device, nullptr);
        if (instance) vkDestroyInstance(instance, nullptr);
    }
    bool create();
};

bool Vulkan::create()
{
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo instanceInfo{};
    instanceInfo.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    instanceInfo.pApplicationInfo = &application;
    if (vkCreateInstance(&instanceInfo, nullptr, &instance) != VK_SUCCESS) return false;

    uint32_t count = 0;
    vkEnumeratePhysicalDevices(instance, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    vkEnumeratePhysicalDevices(instance, &count, devices.data());
    for (VkPhysicalDevice candidate : devices)
        if (!physicalDevice && sconce::missingFeatures(vkGetInstanceProcAddr, instance, candidate).empty()) physicalDevice = candidate;
    if (!physicalDevice) return false;
    vkGetPhysicalDeviceQueueFamilyProperties(physicalDevice, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physicalDevice, &count, families.data());
    constexpr VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    while (family < count && (families[family].queueFlags & needed) != needed) ++family;

    VkPhysicalDeviceVulkan13Features features13{};
    features13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    VkPhysicalDeviceVulkan12Features features12{};
    features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    features12.pNext = &features13;
    sconce::requireFeatures(features12, features13);
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queueInfo{};
    queueInfo.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queueInfo.queueFamilyIndex = family;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    VkDeviceCreateInfo deviceInfo{};
    deviceInfo.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    deviceInfo.pNext = &features12;
    deviceInfo.queueCreateInfoCount = 1;
    deviceInfo.pQueueCreateInfos = &queueInfo;
    if (vkCreateDevice(physicalDevice, &deviceInfo, nullptr, &device) != VK_SUCCESS) return false;
    vkGetDeviceQueue(device, family, 0, &queue);
    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.queueFamilyIndex = family;
    if (vkCreateCommandPool(device, &poolInfo, nullptr, &pool) != VK_SUCCESS) return false;
    VkCommandBufferAllocateInfo commandInfo{};
    commandInfo.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    commandInfo.commandPool = pool;
    commandInfo.commandBufferCount = 1;
    return vkAllocateCommandBuffers(device, &commandInfo, &commands) == VK_SUCCESS;
}

int fail(const std::string& sentence)
{
    std::fprintf(stderr, "host: %s\n", sentence.c_str());
    return 1;
}

/// A buffer that both sides see; never freed before the device, as this program is short.
template <class T> struct SharedBuffer
{
    const Vulkan& vulkan;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceAddress address = 0;
    T* values = nullptr;

    SharedBuffer(const Vulkan& host, size_t count) : vulkan(host)
    {
        VkBufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        info.size = count * sizeof(T);
        info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
        if (vkCreateBuffer(vulkan.device, &info, nullptr, &buffer) != VK_SUCCESS) return;
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(vulkan.device, buffer, &needs);
        VkPhysicalDeviceMemoryProperties kinds;
        vkGetPhysicalDeviceMemoryProperties(vulkan.physicalDevice, &kinds);
        constexpr VkMemoryPropertyFlags wanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        uint32_t kind = 0;
        while (kind < kinds.memoryTypeCount &&
               !((needs.memoryTypeBits >> kind & 1) && (kinds.memoryTypes[kind].propertyFlags & wanted) == wanted))
            ++kind;
        VkMemoryAllocateFlagsInfo flags{};
        flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
        flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
        VkMemoryAllocateInfo allocation{};
        allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        allocation.pNext = &flags;
        allocation.allocationSize = needs.size;
        allocation.memoryTypeIndex = kind;
        if (vkAllocateMemory(vulkan.device, &allocation, nullptr, &memory) != VK_SUCCESS) return;
        vkBindBufferMemory(vulkan.device, buffer, memory, 0);
        VkBufferDeviceAddressInfo asked{};
        asked.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
        asked.buffer = buffer;
        address = vkGetBufferDeviceAddress(vulkan.device, &asked);
        void* mapped = nullptr;
        if (vkMapMemory(vulkan.device, memory, 0, VK_WHOLE_SIZE, 0, &mapped) == VK_SUCCESS) values = static_cast<T*>(mapped);
    }
    SharedBuffer(const SharedBuffer&) = delete;
    ~SharedBuffer()
    {
        vkDestroyBuffer(vulkan.device, buffer, nullptr);
        vkFreeMemory(vulkan.device, memory, nullptr);
    }
};

/// The host's own pass: its layout has the light field's descriptor set and nothing else.
struct HostPass
{
    const Vulkan& vulkan;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;

    HostPass(const Vulkan& host, const sconce::LightField& field) : vulkan(host)
    {
        const VkDescriptorSetLayout set = field.layout();
        const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(sconce::gpu::TraceRaysPush)};
        VkPipelineLayoutCreateInfo layoutInfo{};
        layoutInfo.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
        layoutInfo.setLayoutCount = 1;
        layoutInfo.pSetLayouts = &set;
        layoutInfo.pushConstantRangeCount = 1;
        layoutInfo.pPushConstantRanges = &push;
        if (vkCreatePipelineLayout(vulkan.device, &layoutInfo, nullptr, &layout) != VK_SUCCESS) return;
        VkShaderModuleCreateInfo moduleInfo{};
        moduleInfo.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
        moduleInfo.codeSize = sizeof(host_trace);
        moduleInfo.pCode = host_trace;
        VkShaderModule shader = VK_NULL_HANDLE;
        if (vkCreateShaderModule(vulkan.device, &moduleInfo, nullptr, &shader) != VK_SUCCESS) return;
        const auto constants = field.constants();
        const VkSpecializationMapEntry entries[] = {{0, 0, 4}, {1, 4, 4}};
        const VkSpecializationInfo specialization{2, entries, sizeof(constants), constants.data()};
        VkComputePipelineCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
        info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        info.stage.module = shader;
        info.stage.pName = "main";
        info.stage.pSpecializationInfo = &specialization;
        info.layout = layout;
        vkCreateComputePipelines(vulkan.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
        vkDestroyShaderModule(vulkan.device, shader, nullptr);
    }
    HostPass(const HostPass&) = delete;
    ~HostPass()
    {
        vkDestroyPipeline(vulkan.device, pipeline, nullptr);
        vkDestroyPipelineLayout(vulkan.device, layout, nullptr);
    }
    void record(const sconce::LightField& field, const sconce::gpu::TraceRaysPush& push) const
    {
        const VkDescriptorSet set = field.descriptorSet();
        vkCmdBindPipeline(vulkan.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
        vkCmdBindDescriptorSets(vulkan.commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
        vkCmdPushConstants(vulkan.commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, &push);
        vkCmdDispatch(vulkan.commands, (push.count + 63) / 64, 1, 1);
    }
};

/// Directions spread evenly over the sphere (Fibonacci lattice), from the middle of the Cornell box.
void spreadRays(sconce::gpu::Ray* rays, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i)
    {
        const float y = 1.0f - (2.0f * float(i) + 1.0f) / float(count), ring = std::sqrt(1.0f - y * y), turn = 2.39996323f * float(i);
        rays[i] = {glm::vec3(0.0f, 1.2f, 0.4f), glm::vec3(ring * std::cos(turn), y, ring * std::sin(turn)), glm::vec3(0.0f)};
    }
}

/// A room of one quad, baked by the library: what a host without glTF does.
bool bakes(const sconce::Device& device, const std::string& file)
{
    sconce::Scene scene;
    scene.name = "quad";
    scene.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
    scene.normals.assign(4, {0, 1, 0});
    scene.uvs.assign(4, {0, 0});
    scene.triangles = {{0, 2, 1}, {0, 3, 2}};
    scene.triangleMaterial = {0, 0};
    scene.materials.emplace_back();
    scene.sky = glm::vec3(1.0f);
    const glm::vec3 probe(0.0f, 1.0f, 0.0f);
    sconce::BakeDesc desc;
    desc.resolution = 64;
    if (const auto baked = sconce::bakeLightField(device, scene, {&probe, 1}, desc, file); !baked)
    {
        fail(baked.error().message);
        return false;
    }
    const auto field = sconce::LightField::load(device, file);
    return field && field->info().probeCount == 1 && field->effectsOfFrames().diffuse && !field->effectsOfFrames().mirror;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2) return fail("usage: host FIELD.sconce");
    Vulkan vulkan;
    if (!vulkan.create()) return fail("there is no Vulkan device that can run the library");
    sconce::HostVulkan lent;
    lent.instance = vulkan.instance;
    lent.physicalDevice = vulkan.physicalDevice;
    lent.device = vulkan.device;
    lent.queueFamily = vulkan.family;
    lent.queue = vulkan.queue;
    lent.getInstanceProcAddr = vkGetInstanceProcAddr;
    if (sconce::Device::create(lent, {.major = 99})) return fail("a header of another version was taken");
    const auto device = sconce::Device::create(lent);
    if (!device) return fail(device.error().message);
    if (!bakes(*device, std::string(argv[1]) + ".baked")) return fail("the library's bake failed");
    const auto field = sconce::LightField::load(*device, argv[1]);
    if (!field) return fail(field.error().message);
    const auto light = sconce::IndirectLight::create(*device, *field, {.width = 16, .height = 16, .effects = field->effectsOfFrames()});
    if (!light) return fail(light.error().message);
    if (!light->diffuse().view || light->mirror().view) return fail("the Cornell box has diffuse light and no mirror");
    const auto tracer = sconce::RayTracer::create(*device, *field);
    if (!tracer) return fail(tracer.error().message);

    constexpr uint32_t count = 100, first = 40;
    SharedBuffer<sconce::gpu::Ray> rays(vulkan, count);
    SharedBuffer<sconce::gpu::RayHit> ours(vulkan, count), theirs(vulkan, count);
    const HostPass pass(vulkan, *field);
    if (!rays.values || !ours.values || !theirs.values || !pass.pipeline) return fail("the host's own objects could not be made");
    spreadRays(rays.values, count);
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    vkBeginCommandBuffer(vulkan.commands, &begin);
    tracer->record(vulkan.commands, rays.address, ours.address, first);
    tracer->record(vulkan.commands, rays.address + first * sizeof(sconce::gpu::Ray), ours.address + first * sizeof(sconce::gpu::RayHit),
                   count - first);
    pass.record(*field, {rays.address, theirs.address, count, 0});
    vkEndCommandBuffer(vulkan.commands);
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &vulkan.commands;
    if (vkQueueSubmit(vulkan.queue, 1, &submit, VK_NULL_HANDLE) != VK_SUCCESS || vkQueueWaitIdle(vulkan.queue) != VK_SUCCESS)
        return fail("the rays could not be traced");

    int share[3] = {};
    for (uint32_t i = 0; i < count; ++i) ++share[ours.values[i].status];
    std::printf("%d hit, %d miss, %d unknown\n", share[1], share[0], share[2]);
    if (std::memcmp(ours.values, theirs.values, count * sizeof(sconce::gpu::RayHit)) != 0)
        return fail("the host's shader got other answers");
    // The box is open on one side, a sixth of all directions at most from near its middle.
    return share[1] >= 70 ? 0 : fail("too few rays hit the box");
}
