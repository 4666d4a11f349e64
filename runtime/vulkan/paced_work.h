#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "runtime/vulkan/gpu.h"

namespace sconce
{

/// Passes over parts of their work, one after another, in as many submissions as it takes for each to end in time: drivers stop one that
/// seems to hang, a device that also draws stands still meanwhile, and progress and cancellation come between submissions. How much fits is
/// known from how long what has the same name took before; of what is new a small part goes first, alone. What cannot be cut may take
/// longer.
class PacedWork
{
public:
    /// @param seconds  that a submission is to take at most; above 0
    /// @param clock    seconds since whenever
    PacedWork(Gpu& device, double seconds, double (*clock)() = steadySeconds) : gpu(device), limit(seconds), now(clock) {}

    /// Records units first to first + count - 1 of a pass.
    using Record = std::function<void(VkCommandBuffer, uint32_t first, uint32_t count)>;
    /// One more pass after those that are there; `record` is called once a submission, and whatever it refers to must be there until run().
    /// @param name   a literal; one for all passes whose units take alike
    /// @param units  that may be recorded apart, in order; at least 1
    void add(std::string_view name, uint32_t units, Record record);
    /// Does it all, and waits. Errors: those of Gpu::submit(), and cancelled; after them none of the work is left.
    /// @param goesOn  is asked between submissions, with the share of the units that are done; false: cancelled
    Status run(const std::function<bool(double done)>& goesOn = {});

private:
    struct Pass
    {
        std::string_view name;
        uint32_t units;
        Record record;
    };
    struct Part
    {
        size_t pass;
        uint32_t first, count;
    };
    /// What goes into the next submission. @param from  where the work goes on; moved to where it goes on after that
    void choose(Part& from);
    void learn(double seconds);
    static double steadySeconds();

    Gpu& gpu;
    const double limit; // seconds
    double (*const now)();
    std::vector<Pass> passes;
    std::vector<Part> chosen;
    std::map<std::string_view, double> known; // seconds a unit
};

/// A compute pass over groups.x * y * z workgroups as units of a row along x: some of its rows. Its pipeline must have been made with
/// VK_PIPELINE_CREATE_DISPATCH_BASE_BIT, is bound, and is told what to do; gl_NumWorkGroups is of what is dispatched, x apart.
void dispatchRows(const Gpu& gpu, VkCommandBuffer cmd, glm::uvec3 groups, uint32_t first, uint32_t count);

} // namespace sconce
