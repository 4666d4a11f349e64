#pragma once

#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

#include "runtime/vulkan/gpu.h"

namespace sconce::testing_support
{

/// A device under the validation layer (core and synchronization) that fails its test when the layer has anything to say.
class ValidatedDevice
{
public:
    explicit ValidatedDevice(uint64_t memoryBudget = 0)
    {
        OwnDevice::Desc desc;
        desc.validation = true;
        desc.memoryBudget = memoryBudget;
        auto made = OwnDevice::create(desc);
        if (!made) throw std::runtime_error(made.error().message);
        own = std::make_unique<OwnDevice>(std::move(*made));
    }
    ~ValidatedDevice()
    {
        lent.reset();
        for (const std::string& message : own->validationMessages()) ADD_FAILURE() << message;
    }
    const HostVulkan& host() const { return own->host(); }
    Gpu& gpu()
    {
        if (lent) return *lent;
        auto made = Gpu::create(host());
        if (!made) throw std::runtime_error(made.error().message);
        lent = std::move(*made);
        return *lent;
    }

private:
    std::unique_ptr<OwnDevice> own;
    std::shared_ptr<Gpu> lent;
};

/// The fixture of tests that share nothing but the way to a device.
class DeviceTest : public testing::Test
{
protected:
    Gpu& gpu() { return validated.gpu(); }

private:
    ValidatedDevice validated;
};

} // namespace sconce::testing_support
