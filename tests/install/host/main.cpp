// A host with its own Vulkan objects asks a light field for 100 rays, once through the library's pass and once through its own shader.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include "host_trace.h"
#include "runtime/field/light_field.h"
#include "runtime/field/light_field_file.h"
#include "runtime/frame/indirect_light.h"
#include "scene/builtin_scenes.h"

namespace
{

struct Vulkan
{
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    uint32_t family = 0;

    ~Vulkan()
    {
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
    features13.synchronization2 = features13.dynamicRendering = VK_TRUE;
    VkPhysicalDeviceVulkan12Features features12{};
    features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    features12.pNext = &features13;
    features12.bufferDeviceAddress = features12.scalarBlockLayout = VK_TRUE;
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
    return true;
}

int fail(const std::string& sentence)
{
    std::fprintf(stderr, "host: %s\n", sentence.c_str());
    return 1;
}

/// Directions spread evenly over the sphere (Fibonacci lattice), from the middle of the Cornell box.
std::vector<sconce::gpu::Ray> spreadRays(int count)
{
    std::vector<sconce::gpu::Ray> rays;
    for (int i = 0; i < count; ++i)
    {
        const float y = 1.0f - (2.0f * float(i) + 1.0f) / float(count), ring = std::sqrt(1.0f - y * y), turn = 2.39996323f * float(i);
        rays.push_back({glm::vec3(0.0f, 1.2f, 0.4f), glm::vec3(ring * std::cos(turn), y, ring * std::sin(turn))});
    }
    return rays;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2) return fail("usage: host FIELD.sconce");
    if (!sconce::makeBuiltinScene("cornell")) return fail("sconce::scene has no Cornell box");
    Vulkan vulkan;
    if (!vulkan.create()) return fail("there is no Vulkan device that can run the library");
    sconce::HostVulkan lent;
    lent.instance = vulkan.instance;
    lent.physicalDevice = vulkan.physicalDevice;
    lent.device = vulkan.device;
    lent.queueFamily = vulkan.family;
    lent.queue = vulkan.queue;
    lent.getInstanceProcAddr = vkGetInstanceProcAddr;
    const auto gpu = sconce::Gpu::create(lent);
    if (!gpu) return fail(gpu.error().message);
    const auto data = sconce::loadField(argv[1]);
    if (!data) return fail(data.error().message);
    const auto field = sconce::LightField::create(**gpu, *data);
    if (!field) return fail(field.error().message);
    const auto light = sconce::IndirectLight::create(**gpu, *field, {.width = 16, .height = 16, .effects = {}, .glossyShader = {}});
    if (!light) return fail(light.error().message);

    const std::vector<sconce::gpu::Ray> rays = spreadRays(100);
    std::vector<sconce::gpu::RayHit> ours(rays.size()), theirs(rays.size());
    auto tracer = sconce::RayTracer::create(**gpu, *field);
    auto hostTracer = sconce::RayTracer::create(**gpu, *field, host_trace);
    if (!tracer || !hostTracer) return fail("a tracer could not be made");
    if (!tracer->trace(rays, ours) || !hostTracer->trace(rays, theirs)) return fail("the rays could not be traced");
    int share[3] = {};
    for (const sconce::gpu::RayHit& hit : ours) ++share[hit.status];
    std::printf("%d hit, %d miss, %d unknown\n", share[1], share[0], share[2]);
    if (std::memcmp(ours.data(), theirs.data(), ours.size() * sizeof(ours[0])) != 0) return fail("the host's shader got other answers");
    // The box is open on one side, a sixth of all directions at most from near its middle.
    return share[1] >= 70 ? 0 : fail("too few rays hit the box");
}
