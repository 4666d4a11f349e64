#pragma once

#include <memory>

#include <gtest/gtest.h>

#include "runtime/gpu.h"

namespace sconce::testing_support
{

/// One validated device for all tests of a program; a test that ends with more messages than it began with fails.
class DeviceTest : public testing::Test
{
protected:
    void SetUp() override
    {
        ASSERT_TRUE(device().ok()) << device().error().message;
        before = device()->validationMessages().size();
    }
    void TearDown() override
    {
        if (device().ok()) EXPECT_EQ(device()->validationMessages().size(), before) << "the validation layer has something to say";
    }
    static Gpu& gpu()
    {
        static std::unique_ptr<Gpu> made = []
        {
            auto result = Gpu::create(device()->host());
            return result ? std::move(*result) : nullptr;
        }();
        return *made;
    }

private:
    static Result<OwnDevice>& device()
    {
        static Result<OwnDevice> made = OwnDevice::create({.device = "", .validation = true, .memoryBudget = 0});
        return made;
    }
    size_t before = 0;
};

} // namespace sconce::testing_support
