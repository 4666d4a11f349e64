#include "tests/support/vulkan_faults.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <set>
#include <tuple>
#include <utility>

#include <dlfcn.h>
#include <execinfo.h>

#include "tests/support/kept_pipelines.h"

namespace sconce::testing_support
{
namespace
{

constexpr VkResult kMemory[] = {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY};
constexpr VkResult kMapping[] = {VK_ERROR_MEMORY_MAP_FAILED, VK_ERROR_OUT_OF_HOST_MEMORY};
constexpr VkResult kQueue[] = {VK_ERROR_DEVICE_LOST, VK_ERROR_OUT_OF_DEVICE_MEMORY};
constexpr VkResult kInstance[] = {VK_ERROR_INITIALIZATION_FAILED, VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_INCOMPATIBLE_DRIVER};
constexpr VkResult kDevices[] = {VK_ERROR_INITIALIZATION_FAILED, VK_ERROR_OUT_OF_HOST_MEMORY};
constexpr VkResult kDevice[] = {VK_ERROR_DEVICE_LOST, VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_TOO_MANY_OBJECTS};
constexpr VkResult kHost[] = {VK_ERROR_OUT_OF_HOST_MEMORY};

// Function, the kind of what it makes (what goes with its pool has none), and how it may fail.
#define SCONCE_FALLIBLE(X)                                                                                                                 \
    X(AllocateCommandBuffers, "", kMemory)                                                                                                 \
    X(AllocateDescriptorSets, "", kMemory)                                                                                                 \
    X(AllocateMemory, "Memory", kMemory)                                                                                                   \
    X(BeginCommandBuffer, "", kMemory)                                                                                                     \
    X(BindBufferMemory, "", kMemory)                                                                                                       \
    X(BindImageMemory, "", kMemory)                                                                                                        \
    X(CreateBuffer, "Buffer", kMemory)                                                                                                     \
    X(CreateBufferView, "BufferView", kMemory)                                                                                             \
    X(CreateCommandPool, "CommandPool", kMemory)                                                                                           \
    X(CreateComputePipelines, "Pipeline", kMemory)                                                                                         \
    X(CreateDebugUtilsMessengerEXT, "Messenger", kHost)                                                                                    \
    X(CreateDescriptorPool, "DescriptorPool", kMemory)                                                                                     \
    X(CreateDescriptorSetLayout, "DescriptorSetLayout", kMemory)                                                                           \
    X(CreateDevice, "Device", kDevice)                                                                                                     \
    X(CreateFence, "Fence", kMemory)                                                                                                       \
    X(CreateGraphicsPipelines, "Pipeline", kMemory)                                                                                        \
    X(CreateImage, "Image", kMemory)                                                                                                       \
    X(CreateImageView, "ImageView", kMemory)                                                                                               \
    X(CreateInstance, "Instance", kInstance)                                                                                               \
    X(CreatePipelineLayout, "PipelineLayout", kMemory)                                                                                     \
    X(CreateQueryPool, "QueryPool", kMemory)                                                                                               \
    X(CreateSampler, "Sampler", kMemory)                                                                                                   \
    X(CreateShaderModule, "ShaderModule", kMemory)                                                                                         \
    X(DeviceWaitIdle, "", kQueue)                                                                                                          \
    X(EndCommandBuffer, "", kMemory)                                                                                                       \
    X(EnumeratePhysicalDevices, "", kDevices)                                                                                              \
    X(GetQueryPoolResults, "", kQueue)                                                                                                     \
    X(MapMemory, "", kMapping)                                                                                                             \
    X(QueueSubmit, "", kQueue)                                                                                                             \
    X(ResetCommandPool, "", kMemory)                                                                                                       \
    X(ResetFences, "", kMemory)                                                                                                            \
    X(WaitForFences, "", kQueue)

// Function, and the kind of what it takes back.
#define SCONCE_TAKERS(X)                                                                                                                   \
    X(DestroyBuffer, "Buffer")                                                                                                             \
    X(DestroyBufferView, "BufferView")                                                                                                     \
    X(DestroyCommandPool, "CommandPool")                                                                                                   \
    X(DestroyDebugUtilsMessengerEXT, "Messenger")                                                                                          \
    X(DestroyDescriptorPool, "DescriptorPool")                                                                                             \
    X(DestroyDescriptorSetLayout, "DescriptorSetLayout")                                                                                   \
    X(DestroyDevice, "Device")                                                                                                             \
    X(DestroyFence, "Fence")                                                                                                               \
    X(DestroyImage, "Image")                                                                                                               \
    X(DestroyImageView, "ImageView")                                                                                                       \
    X(DestroyInstance, "Instance")                                                                                                         \
    X(DestroyPipeline, "Pipeline")                                                                                                         \
    X(DestroyPipelineLayout, "PipelineLayout")                                                                                             \
    X(DestroyQueryPool, "QueryPool")                                                                                                       \
    X(DestroySampler, "Sampler")                                                                                                           \
    X(DestroyShaderModule, "ShaderModule")                                                                                                 \
    X(FreeMemory, "Memory")

#define SCONCE_CALLED(name, makes, errors)                                                                                                 \
    struct Of##name                                                                                                                        \
    {                                                                                                                                      \
        static constexpr std::string_view function = "vk" #name, kind = makes;                                                             \
        static constexpr std::span<const VkResult> fails = errors;                                                                         \
        static inline PFN_vk##name real = nullptr;                                                                                         \
    };
SCONCE_FALLIBLE(SCONCE_CALLED)
#undef SCONCE_CALLED
#define SCONCE_CALLED(name, takes)                                                                                                         \
    struct Of##name                                                                                                                        \
    {                                                                                                                                      \
        static constexpr std::string_view function = "vk" #name, kind = takes;                                                             \
        static inline PFN_vk##name real = nullptr;                                                                                         \
    };
SCONCE_TAKERS(SCONCE_CALLED)
#undef SCONCE_CALLED

void* const kNobodys = reinterpret_cast<void*>(uintptr_t(0xdead0bad)); // what no driver has made

struct State
{
    bool on = false, lost = false, works = false; // works: the device was given work that nobody has waited for
    std::optional<VulkanFault> fault;
    size_t met = 0; // calls that the fault counts
    VulkanWatch seen;
    std::multiset<std::pair<std::string_view, uint64_t>> alive;
    KeptPipelines pipelines;
};
State& state()
{
    static State& made = *new State; // to the end of the program, whoever calls then
    return made;
}

/// @param line  where a call returns to
size_t siteOf(const void* line)
{
    void* frames[64];
    void** const end = frames + backtrace(frames, int(std::size(frames)));
    size_t hash = 0;
    for (void** frame = std::find(frames, end, line); frame < end; ++frame)
        if (*frame != line) hash = (hash ^ reinterpret_cast<uintptr_t>(*frame)) * 0x9e3779b97f4a7c15ull;
    return hash;
}

/// Counts a call. @return  how it fails; VK_SUCCESS: it is made
VkResult faultOf(std::string_view function, const void* line, std::span<const VkResult> errors)
{
    if (!state().on) return VK_SUCCESS;
    state().seen.calls.push_back({function, reinterpret_cast<uintptr_t>(line), siteOf(line), errors});
    const bool saysLost = std::ranges::find(errors, VK_ERROR_DEVICE_LOST) != errors.end();
    if (state().lost) return saysLost ? VK_ERROR_DEVICE_LOST : VK_SUCCESS;
    if (!state().fault || (!state().fault->function.empty() && state().fault->function != function)) return VK_SUCCESS;
    if (state().met++ != state().fault->call) return VK_SUCCESS;
    state().lost = state().fault->lost && saysLost;
    state().seen.given = state().lost ? VK_ERROR_DEVICE_LOST : errors[state().fault->error % errors.size()];
    return state().seen.given;
}

template <class T> uint64_t numberOf(T handle)
{
    return uint64_t(reinterpret_cast<uintptr_t>(handle));
}

/// A lost device ends its work before it says so: nothing of it runs on then.
void stopWork()
{
    for (const auto& [kind, number] : state().alive)
        if (state().works && kind == "Device") OfDeviceWaitIdle::real(reinterpret_cast<VkDevice>(uintptr_t(number)));
    state().works = false;
}

/// The device may use what a call is of, as long as nobody has waited for its work.
void expectIdle(std::string_view function)
{
    if (!state().works) return;
    state().seen.wrongs.push_back(std::string(function) + " while the device works");
    stopWork();
}

// What is made beside the call itself: pipelines that are there already aren't made again.
template <class Of, class Info>
VkResult makePipeline(VkDevice device, VkPipelineCache cache, uint32_t count, const Info* infos, const VkAllocationCallbacks* callbacks,
                      VkPipeline* made)
{
    const std::string key = state().pipelines.keyOf(*infos);
    if (const auto found = state().pipelines.kept.find(key); found != state().pipelines.kept.end())
    {
        *made = found->second;
        return VK_SUCCESS;
    }
    const VkResult result = Of::real(device, cache, count, infos, callbacks, made);
    if (result == VK_SUCCESS) state().pipelines.kept[key] = *made;
    return result;
}
template <class Of, class... Arguments> VkResult make(Arguments... arguments)
{
    return Of::real(arguments...);
}
template <class Of, class Info, class T> VkResult make(VkDevice device, const Info* info, const VkAllocationCallbacks* callbacks, T* made)
{
    const VkResult result = Of::real(device, info, callbacks, made);
    constexpr bool ofPipelines =
        std::is_same_v<T, VkShaderModule> || std::is_same_v<T, VkDescriptorSetLayout> || std::is_same_v<T, VkPipelineLayout>;
    if constexpr (ofPipelines)
        if (result == VK_SUCCESS) state().pipelines.note(*info, *made);
    return result;
}

template <class Of, class... Arguments> VkResult call(Arguments... arguments)
{
    [[maybe_unused]] const auto output = std::get<sizeof...(Arguments) - 1>(std::tie(arguments...));
    constexpr bool resets = std::is_same_v<Of, OfResetCommandPool> || std::is_same_v<Of, OfResetFences>;
    constexpr bool waits = std::is_same_v<Of, OfWaitForFences> || std::is_same_v<Of, OfDeviceWaitIdle>;
    constexpr bool nulls = std::is_same_v<Of, OfCreateComputePipelines> || std::is_same_v<Of, OfCreateGraphicsPipelines>;
    if constexpr (resets) expectIdle(Of::function);
    if (const VkResult fault = faultOf(Of::function, __builtin_return_address(0), Of::fails); fault != VK_SUCCESS)
    {
        if (fault == VK_ERROR_DEVICE_LOST) stopWork();
        using Output = std::remove_pointer_t<std::remove_const_t<decltype(output)>>;
        if constexpr (nulls)
            *output = VK_NULL_HANDLE;
        else if constexpr (!Of::kind.empty() || std::is_same_v<Of, OfMapMemory>)
            *output = static_cast<Output>(kNobodys);
        return fault;
    }
    VkResult result = VK_SUCCESS;
    if constexpr (nulls)
        result = makePipeline<Of>(arguments...);
    else
        result = make<Of>(arguments...);
    if constexpr (!Of::kind.empty())
        if (result == VK_SUCCESS) state().alive.emplace(Of::kind, numberOf(*output));
    if constexpr (std::is_same_v<Of, OfQueueSubmit>) state().works = state().works || result == VK_SUCCESS;
    if constexpr (waits) state().works = state().works && result != VK_SUCCESS;
    return result;
}

template <class Of, class... Arguments> void take(Arguments... arguments)
{
    const auto handle = std::get<sizeof...(Arguments) - 2>(std::tie(arguments...));
    if (handle == VK_NULL_HANDLE) return;
    expectIdle(Of::function);
    const auto found = state().alive.find({Of::kind, numberOf(handle)});
    if (found == state().alive.end())
    {
        state().seen.wrongs.push_back(std::string(Of::function) + " of what isn't there");
        return;
    }
    state().alive.erase(found);
    if constexpr (std::is_same_v<Of, OfDestroyDevice>)
    {
        for (const auto& [key, pipeline] : state().pipelines.kept) OfDestroyPipeline::real(handle, pipeline, nullptr);
        state().pipelines = {}; // there is one device
    }
    if constexpr (!std::is_same_v<Of, OfDestroyPipeline>) Of::real(arguments...);
}

// The function in place of one of the same type.
template <class Of, class... Arguments> PFN_vkVoidFunction inPlaceOf(VkResult(VKAPI_PTR*)(Arguments...))
{
    return reinterpret_cast<PFN_vkVoidFunction>(&call<Of, Arguments...>);
}
template <class Of, class... Arguments> PFN_vkVoidFunction inPlaceOf(void(VKAPI_PTR*)(Arguments...))
{
    return reinterpret_cast<PFN_vkVoidFunction>(&take<Of, Arguments...>);
}

PFN_vkGetDeviceProcAddr realGetDeviceProcAddr = nullptr;

PFN_vkVoidFunction watched(const char* name, PFN_vkVoidFunction real);

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name)
{
    return watched(name, realGetDeviceProcAddr(device, name));
}

PFN_vkVoidFunction watched(const char* name, PFN_vkVoidFunction real)
{
    if (!real) return real;
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
    {
        realGetDeviceProcAddr = reinterpret_cast<PFN_vkGetDeviceProcAddr>(real);
        return reinterpret_cast<PFN_vkVoidFunction>(&getDeviceProcAddr);
    }
#define SCONCE_WATCH(function, ...)                                                                                                        \
    if (std::strcmp(name, "vk" #function) == 0)                                                                                            \
    {                                                                                                                                      \
        Of##function::real = reinterpret_cast<PFN_vk##function>(real);                                                                     \
        return inPlaceOf<Of##function>(Of##function::real);                                                                                \
    }
    SCONCE_FALLIBLE(SCONCE_WATCH)
    SCONCE_TAKERS(SCONCE_WATCH)
#undef SCONCE_WATCH
    return real;
}

} // namespace

void watchVulkan(std::optional<VulkanFault> fault)
{
    state().on = true;
    state().lost = false;
    state().met = 0;
    state().fault = std::move(fault);
    state().seen = {};
}

VulkanWatch endVulkanWatch()
{
    state().on = state().lost = false;
    return std::move(state().seen);
}

std::map<std::string_view, size_t> aliveInVulkan()
{
    std::map<std::string_view, size_t> counts;
    for (const auto& [kind, number] : state().alive) ++counts[kind];
    return counts;
}

} // namespace sconce::testing_support

extern "C" VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance instance, const char* name)
{
    static void* const loader = dlopen("libvulkan.so.1", RTLD_NOW);
    static const auto real = reinterpret_cast<PFN_vkGetInstanceProcAddr>(loader ? dlsym(loader, "vkGetInstanceProcAddr") : nullptr);
    if (!real) return nullptr;
    return sconce::testing_support::watched(name, real(instance, name));
}
