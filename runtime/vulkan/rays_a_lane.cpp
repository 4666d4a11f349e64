#include "runtime/vulkan/rays_a_lane.h"

#include <bit>
#include <charconv>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

namespace sconce
{
namespace
{

constexpr uint32_t kOnGpus = 4; // 2 to 16 were measured

} // namespace

Result<uint32_t> raysALane(VkPhysicalDeviceType kind, bool ballots)
{
    const char* asked = std::getenv("SCONCE_RAYS_A_LANE");
    if (!asked) return ballots && kind != VK_PHYSICAL_DEVICE_TYPE_CPU ? kOnGpus : 1;
    const std::string_view text(asked);
    uint32_t rays = 0;
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), rays);
    if (failed != std::errc() || end != text.data() + text.size() || rays > kMostRaysALane || !std::has_single_bit(rays))
        return Error{ErrorCode::badArgument, fmt::format("SCONCE_RAYS_A_LANE is '{}'; give 1, 2, 4, 8 or {}", text, kMostRaysALane)};
    if (rays > 1 && !ballots)
        return Error{ErrorCode::missingFeature,
                     fmt::format("SCONCE_RAYS_A_LANE is {}, and the device has no subgroup ballots in compute passes; give 1", rays)};
    return rays;
}

} // namespace sconce
