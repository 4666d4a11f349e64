#include "scene/camera_check.h"

#include <cmath>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

/// The fault of a camera that is sound but for what `spoil` does to it.
template <class Spoil> std::string faultAfter(Spoil&& spoil)
{
    Camera camera;
    camera.name = "door";
    spoil(camera);
    return cameraFault(camera);
}

void expectNamed(const std::string& fault, const std::string& part)
{
    EXPECT_NE(fault.find("'door'"), std::string::npos) << fault;
    EXPECT_NE(fault.find(part), std::string::npos) << fault;
}

TEST(CameraCheck, SoundOnesHaveNoFault)
{
    EXPECT_EQ(cameraFault(Camera()), "");
    EXPECT_EQ(faultAfter([](Camera& c) { c.verticalFov = 3.09f; }), "");
    EXPECT_EQ(faultAfter([](Camera& c) { c.verticalFov = 1e-3f; }), "");
    EXPECT_EQ(faultAfter([](Camera& c) { c.eye = vec3(-1e6f); }), "");
    EXPECT_EQ(faultAfter([](Camera& c) { c.up = vec3(0.0f, 1.0f, -0.9f); }), ""); // not orthogonal, but a plane
}

TEST(CameraCheck, FieldOfViewIsBelowAHalfTurn)
{
    for (const float fov : {0.0f, -1.0f, 3.1f, 3.2f, INFINITY, std::nanf("")})
        expectNamed(faultAfter([&](Camera& c) { c.verticalFov = fov; }), "field of view");
}

TEST(CameraCheck, EyeIsAPlace)
{
    for (const float x : {INFINITY, -INFINITY, std::nanf("")}) expectNamed(faultAfter([&](Camera& c) { c.eye.y = x; }), "eye");
}

TEST(CameraCheck, ForwardAndUpSpanAPlane)
{
    expectNamed(faultAfter([](Camera& c) { c.up = c.forward; }), "parallel");
    expectNamed(faultAfter([](Camera& c) { c.up = -2.0f * c.forward; }), "parallel");
    expectNamed(faultAfter([](Camera& c) { c.forward = vec3(0.0f); }), "no length");
    expectNamed(faultAfter([](Camera& c) { c.up = vec3(0.0f); }), "no length");
    expectNamed(faultAfter([](Camera& c) { c.forward.x = std::nanf(""); }), "not finite");
    expectNamed(faultAfter([](Camera& c) { c.up.z = INFINITY; }), "not finite");
}

TEST(CameraCheck, WithoutANameIsTheCamera)
{
    Camera camera;
    camera.verticalFov = 0.0f;
    EXPECT_EQ(cameraFault(camera).find("The camera has"), 0u) << cameraFault(camera);
}

} // namespace
} // namespace sconce
