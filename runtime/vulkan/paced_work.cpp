#include "runtime/vulkan/paced_work.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <utility>

namespace sconce
{
namespace
{

constexpr double kAimedAt = 0.7;    // of the limit: units of a pass differ, and so do probes
constexpr uint32_t kFirstPart = 32; // of a pass that is new, one part in so many goes first
constexpr double kShortest = 1e-9;  // seconds that a unit takes, for whoever divides by it
constexpr double kForgets = 0.5;    // what is left of an estimate that was too long: the first part may have waited for a compiler

} // namespace

double PacedWork::steadySeconds()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void PacedWork::add(std::string_view name, uint32_t units, Record record)
{
    assert(units > 0);
    passes.push_back({name, units, std::move(record)});
}

void PacedWork::choose(Part& from)
{
    chosen.clear();
    double left = kAimedAt * limit;
    while (from.pass < passes.size())
    {
        const Pass& pass = passes[from.pass];
        const uint32_t rest = pass.units - from.first;
        const auto found = known.find(pass.name);
        const bool isNew = found == known.end();
        if (isNew && !chosen.empty()) return;
        uint32_t count = isNew ? std::max(pass.units / kFirstPart, 1u) : uint32_t(std::clamp(left / found->second, 0.0, double(rest)));
        if (count == 0 && !chosen.empty()) return;
        count = std::clamp(count, 1u, rest);
        chosen.push_back({from.pass, from.first, count});
        from = count < rest ? Part{from.pass, from.first + count, 0} : Part{from.pass + 1, 0, 0};
        if (isNew || count < rest) return;
        left -= count * found->second;
    }
}

void PacedWork::learn(double seconds)
{
    double expected = 0.0;
    for (const Part& part : chosen)
    {
        const auto [each, isNew] = known.try_emplace(passes[part.pass].name, std::max(seconds / part.count, kShortest));
        expected += each->second * part.count;
    }
    // What took longer than thought takes that long from now on; what took less may have been the easy part of it.
    const double ratio = std::max(seconds / expected, kForgets);
    const auto wasIn = [&](std::string_view name)
    { return std::ranges::any_of(chosen, [&](const Part& part) { return passes[part.pass].name == name; }); };
    for (auto& [name, each] : known)
        if (wasIn(name)) each = std::max(each * ratio, kShortest);
}

Status PacedWork::run(const std::function<bool(double)>& goesOn)
{
    Part from{0, 0, 0};
    Status status = success();
    uint64_t all = 0, done = 0; // units
    for (const Pass& pass : passes) all += pass.units;
    while (status && from.pass < passes.size())
    {
        if (goesOn && !goesOn(double(done) / double(all)))
        {
            status = Error{ErrorCode::cancelled, "cancelled between two submissions"};
            break;
        }
        choose(from);
        for (const Part& part : chosen) done += part.count;
        const double begun = now();
        status = gpu.submit(
            [&](VkCommandBuffer cmd)
            {
                for (const Part& part : chosen) passes[part.pass].record(cmd, part.first, part.count);
            });
        learn(now() - begun);
    }
    passes.clear();
    return status;
}

void dispatchRows(const Gpu& gpu, VkCommandBuffer cmd, glm::uvec3 groups, uint32_t first, uint32_t count)
{
    const uint32_t end = first + count;
    while (first < end)
    {
        const uint32_t layer = first / groups.y, row = first % groups.y;
        const uint32_t layers = row == 0 ? (end - first) / groups.y : 0; // whole ones
        const uint32_t rows = layers > 0 ? groups.y : std::min(groups.y - row, end - first);
        gpu.vk.CmdDispatchBase(cmd, 0, row, layer, groups.x, rows, std::max(layers, 1u));
        first += rows * std::max(layers, 1u);
    }
}

} // namespace sconce
