#include "runtime/vulkan/rays_a_lane.h"

#include <cstdlib>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

class RaysALane : public testing::Test
{
protected:
    static constexpr const char* kVariable = "SCONCE_RAYS_A_LANE";

    void SetUp() override { unsetenv(kVariable); }
    void TearDown() override { unsetenv(kVariable); }

    static uint32_t given(VkPhysicalDeviceType kind, bool ballots)
    {
        const auto rays = raysALane(kind, ballots);
        return rays ? *rays : 0;
    }

    static std::string refusal(const char* asked, bool ballots)
    {
        setenv(kVariable, asked, 1);
        const auto rays = raysALane(VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, ballots);
        return rays ? "taken" : rays.error().message;
    }
};

TEST_F(RaysALane, ProcessorsAndDevicesWithoutBallotsHaveOne)
{
    EXPECT_EQ(given(VK_PHYSICAL_DEVICE_TYPE_CPU, true), 1u);
    EXPECT_EQ(given(VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, false), 1u);
    EXPECT_GT(given(VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, true), 1u);
    EXPECT_GT(given(VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU, true), 1u);
}

TEST_F(RaysALane, TheEnvironmentSaysOtherwise)
{
    setenv(kVariable, "16", 1);
    EXPECT_EQ(given(VK_PHYSICAL_DEVICE_TYPE_CPU, true), 16u);
    setenv(kVariable, "1", 1);
    EXPECT_EQ(given(VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, true), 1u);
    EXPECT_EQ(given(VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, false), 1u);
}

TEST_F(RaysALane, RefusesOtherNumbers)
{
    for (const char* asked : {"0", "3", "32", "-1", "eight", "8 ", "", "99999999999"})
        EXPECT_EQ(refusal(asked, true), "SCONCE_RAYS_A_LANE is '" + std::string(asked) + "'; give 1, 2, 4, 8 or 16");
    EXPECT_EQ(refusal("8", false), "SCONCE_RAYS_A_LANE is 8, and the device has no subgroup ballots in compute passes; give 1");
}

} // namespace
} // namespace sconce
