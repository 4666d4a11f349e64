#include "runtime/vulkan/rays_a_lane.h"

#include <cstdlib>
#include <string>

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
    uint32_t rays = 1;
    while (rays <= kMostRaysALane && std::to_string(rays) != asked) rays *= 2;
    if (rays > kMostRaysALane)
        return Error{ErrorCode::badArgument, fmt::format("SCONCE_RAYS_A_LANE is '{}'; give 1, 2, 4, 8 or {}", asked, kMostRaysALane)};
    if (rays > 1 && !ballots)
        return Error{ErrorCode::missingFeature,
                     fmt::format("SCONCE_RAYS_A_LANE is {}, and the device has no subgroup ballots in compute passes; give 1", rays)};
    return rays;
}

} // namespace sconce
