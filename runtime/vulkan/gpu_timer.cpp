#include "runtime/vulkan/gpu_timer.h"

#include "runtime/vulkan/gpu.h"

namespace sconce
{

struct GpuTimer::State
{
    std::shared_ptr<Gpu> gpu;
    Handle<VkQueryPool, &VulkanFunctions::DestroyQueryPool> queries; // none where the queue doesn't count time
    std::vector<const char*> names;                                  // sized once
    uint32_t used = 0;
};

GpuTimer::GpuTimer(std::unique_ptr<State> made) : state(std::move(made)) {}
GpuTimer::GpuTimer(GpuTimer&&) noexcept = default;
GpuTimer& GpuTimer::operator=(GpuTimer&&) noexcept = default;
GpuTimer::~GpuTimer() = default;

Result<GpuTimer> GpuTimer::create(Gpu& gpu, uint32_t maxScopes)
{
    if (maxScopes == 0) return Error{ErrorCode::badArgument, "maxScopes is 0; give the number of stretches to time, or leave it out"};
    auto made = std::make_unique<State>();
    made->gpu = gpu.shared_from_this();
    made->names.resize(maxScopes);
    if (gpu.timestamps)
    {
        VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = 2 * maxScopes;
        const VkResult result = made->queries.make(gpu, gpu.vk.CreateQueryPool, gpu.host.device, &info, gpu.host.allocationCallbacks);
        if (result != VK_SUCCESS) return gpu.failure("vkCreateQueryPool", result);
    }
    return GpuTimer(std::move(made));
}

void GpuTimer::reset(VkCommandBuffer cmd)
{
    state->used = 0;
    if (state->queries) state->gpu->vk.CmdResetQueryPool(cmd, state->queries.get(), 0, 2 * uint32_t(state->names.size()));
}

void GpuTimer::begin(VkCommandBuffer cmd, const char* name)
{
    if (state->used == state->names.size()) return;
    state->names[state->used] = name;
    // All commands before must be done: the stretch is that of its own passes alone.
    if (state->queries) state->gpu->vk.CmdWriteTimestamp2(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, state->queries.get(), 2 * state->used);
}

void GpuTimer::end(VkCommandBuffer cmd)
{
    if (state->used == state->names.size()) return;
    if (state->queries)
        state->gpu->vk.CmdWriteTimestamp2(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, state->queries.get(), 2 * state->used + 1);
    ++state->used;
}

std::vector<GpuTimer::Scope> GpuTimer::read() const
{
    std::vector<Scope> scopes;
    if (!state->queries || state->used == 0) return scopes;
    const Gpu& gpu = *state->gpu;
    std::vector<uint64_t> ticks(2 * state->used);
    const VkResult result =
        gpu.vk.GetQueryPoolResults(gpu.host.device, state->queries.get(), 0, uint32_t(ticks.size()), ticks.size() * sizeof(uint64_t),
                                   ticks.data(), sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
    if (result != VK_SUCCESS) return scopes;
    for (uint32_t i = 0; i < state->used; ++i)
        scopes.push_back({state->names[i], double(ticks[2 * i + 1] - ticks[2 * i]) * double(gpu.properties.limits.timestampPeriod) * 1e-6});
    return scopes;
}

} // namespace sconce
