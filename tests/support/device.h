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
        expectNoMessages();
    }
    /// Since the last time that it was asked.
    void expectNoMessages()
    {
        const std::vector<std::string> messages = own->validationMessages();
        for (; told < messages.size(); ++told) ADD_FAILURE() << messages[told];
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
    size_t told = 0; // messages
};

/// One device for all tests of a process that need none of their own: its passes are compiled once, which takes longer than most tests.
/// What the layer has to say fails the test in which it said it.
class SharedDevice
{
public:
    ~SharedDevice()
    {
        if (environment->device) environment->device->expectNoMessages();
    }
    const HostVulkan& host() const { return one().host(); }
    Gpu& gpu() const { return one().gpu(); }

private:
    /// Goes with the tests' end, so that what is said then fails the program.
    struct Environment : testing::Environment
    {
        void TearDown() override { device.reset(); }
        std::unique_ptr<ValidatedDevice> device;
    };
    static ValidatedDevice& one()
    {
        if (!environment->device) environment->device = std::make_unique<ValidatedDevice>();
        return *environment->device;
    }
    static inline Environment* const environment = [] // which GoogleTest owns
    {
        auto made = new Environment;
        testing::AddGlobalTestEnvironment(made);
        return made;
    }();
};

/// The fixture of tests that share nothing but the way to a device.
class DeviceTest : public testing::Test
{
protected:
    virtual Gpu& gpu() { return shared.gpu(); }

private:
    SharedDevice shared;
};

} // namespace sconce::testing_support
