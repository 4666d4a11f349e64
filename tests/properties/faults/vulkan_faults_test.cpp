// Every Vulkan call that can fail does, one at a time: what was asked for is refused with the right error, nothing is left behind, and what
// is asked for next is done.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <span>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "runtime/bake/bake_journal.h"
#include "runtime/bake/group_bake.h"
#include "runtime/field/light_field.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/live_light.h"
#include "runtime/scene/scene_renderer.h"
#include "scene/mesh_builder.h"
#include "scene/triangle_rays.h"
#include "tests/support/files.h"
#include "tests/support/vulkan_faults.h"

namespace sconce
{
namespace
{

using namespace testing_support;

/// What work gives, as bytes that tell it from anything else; or why it gave nothing.
using Outcome = Result<std::string>;
using Work = std::function<Outcome()>;

/// Which calls of some work fail. Of work that takes long, not all, and in one of the ways that they may: each line that calls, and,
/// whatever was called from where, one of the calls that were made there. A buffer takes three calls; that a pass does without it is tried
/// by one.
enum class Calls
{
    all,
    oneOfEachSite
};
using Tried = std::set<size_t>; // lines and sites

/// The calls that fail, by their numbers. @param tried  what has failed before, and by now
std::vector<size_t> chosen(std::span<const FallibleCall> calls, Calls which, Tried& tried)
{
    std::vector<size_t> numbers;
    std::vector<std::vector<size_t>> sites; // each with its first call of each line
    std::map<size_t, size_t> siteOf;
    for (size_t n = 0; n < calls.size(); ++n)
    {
        if (which == Calls::all) numbers.push_back(n);
        if (which == Calls::all || tried.contains(calls[n].site)) continue;
        const auto [found, fresh] = siteOf.emplace(calls[n].site, sites.size());
        if (fresh) sites.emplace_back();
        auto& of = sites[found->second];
        if (std::ranges::none_of(of, [&](size_t other) { return calls[other].line == calls[n].line; })) of.push_back(n);
    }
    const auto choose = [&](size_t n)
    {
        numbers.push_back(n);
        tried.insert({calls[n].line, calls[n].site});
    };
    for (size_t i = 0; i < sites.size(); ++i) choose(sites[i][i % sites[i].size()]);
    for (size_t n = 0; n < calls.size(); ++n)
        if (which == Calls::oneOfEachSite && !tried.contains(calls[n].line)) choose(n);
    return numbers;
}

template <class T> std::string bytesOf(std::span<const T> values)
{
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}
template <class T> std::string bytesOf(const std::vector<T>& values)
{
    return bytesOf(std::span<const T>(values));
}

/// A closed room with a panel that shines, a bulb and a mirror: it calls for every pass.
Scene mirrorRoom()
{
    Scene scene;
    scene.name = "mirror room";
    MeshBuilder mesh(scene);
    const uint32_t grey = mesh.material("grey", vec3(0.6f)), panel = mesh.material("panel", vec3(0.3f)),
                   mirror = mesh.material("mirror", vec3(0.9f));
    scene.materials[grey].roughness = 0.5f;
    scene.materials[panel].emission = vec3(6.0f, 5.0f, 3.0f);
    scene.materials[mirror].metallic = 1.0f, scene.materials[mirror].roughness = 0.0f;
    mesh.quad({-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, grey);
    mesh.quad({-2, 3, -2}, {2, 3, -2}, {2, 3, 2}, {-2, 3, 2}, grey);
    mesh.quad({-2, 0, -2}, {2, 0, -2}, {2, 3, -2}, {-2, 3, -2}, grey);
    mesh.quad({-2, 0, -2}, {-2, 3, -2}, {-2, 3, 2}, {-2, 0, 2}, mirror);
    mesh.quad({2, 0, -2}, {2, 0, 2}, {2, 3, 2}, {2, 3, -2}, grey);
    mesh.quad({-2, 0, 2}, {-2, 3, 2}, {2, 3, 2}, {2, 0, 2}, grey);
    mesh.quad({-1.9f, 1, -1}, {-1.9f, 2, -1}, {-1.9f, 2, 1}, {-1.9f, 1, 1}, panel);
    Light bulb;
    bulb.name = "bulb";
    bulb.type = LightType::point;
    bulb.position = {0.5f, 2.0f, 0.3f};
    bulb.intensity = vec3(3.0f, 4.0f, 5.0f);
    scene.lights.push_back(bulb);
    Camera camera;
    camera.eye = {1.5f, 1.4f, 0.2f};
    camera.forward = {-1.0f, 0.0f, 0.0f};
    scene.cameras.push_back(camera);
    return scene;
}

const std::vector<vec3> kProbe = {{0.2f, 1.4f, 0.1f}};

/// As an error says what a call returned.
ErrorCode codeOf(VkResult result)
{
    const bool memory =
        result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_MEMORY_MAP_FAILED;
    return memory ? ErrorCode::outOfMemory : ErrorCode::deviceFailure;
}

std::string textOf(const std::map<std::string_view, size_t>& alive)
{
    std::string text;
    for (const auto& [kind, count] : alive) text += fmt::format("{} {} ", count, kind);
    return text;
}

/// What is done without: times, an extra of what they are taken of; and a wait that failed for want of memory, which is made again.
bool isDoneWithout(const FallibleCall& call, VkResult given)
{
    return call.function == "vkGetQueryPoolResults" || (call.function == "vkWaitForFences" && given != VK_ERROR_DEVICE_LOST);
}

/// A journal in memory, that can be told to know of the first stages alone.
class Kept : public BakeJournal
{
public:
    std::optional<std::vector<std::byte>> find(const BakePart& part) const override
    {
        const auto found = parts.find(part);
        return found == parts.end() || part.stage > last ? std::nullopt : std::optional(found->second);
    }
    Status keep(const BakePart& part, Pieces pieces) override
    {
        std::vector<std::byte>& bytes = parts[part];
        bytes.clear();
        for (const auto piece : pieces) bytes.insert(bytes.end(), piece.begin(), piece.end());
        return success();
    }
    BakeStage last = BakeStage::end;

private:
    std::map<BakePart, std::vector<std::byte>> parts;
};

/// The staging buffer stays for the next copy, if work leaves it there: it isn't counted as left behind.
struct NoStaging
{
    Gpu& gpu;
    ~NoStaging() { gpu.releaseStaging(); }
};

class VulkanFaults : public testing::Test
{
protected:
    static void SetUpTestSuite()
    {
        auto own = OwnDevice::create();
        ASSERT_TRUE(own) << own.error().message;
        device = new OwnDevice(std::move(*own));
        folder = new TestFolder;
        scene = new Scene(mirrorRoom());
        rays = new TriangleRays(std::move(*TriangleRays::build(*scene)));
        auto baked = bake(Bake::live);
        ASSERT_TRUE(baked) << baked.error().message;
        field = new FieldData(std::move(*baked));
        ASSERT_TRUE(saveField(*field, file()));
    }
    static void TearDownTestSuite()
    {
        if (device)
            for (const std::string& message : device->validationMessages()) ADD_FAILURE() << message;
        delete std::exchange(field, nullptr);
        delete std::exchange(rays, nullptr);
        delete std::exchange(scene, nullptr);
        delete std::exchange(folder, nullptr);
        delete std::exchange(device, nullptr);
        EXPECT_EQ(textOf(aliveInVulkan()), "");
    }
    enum class Bake
    {
        throughTheField,
        byTriangles,
        live // by triangles, with links by which light moves
    };
    static std::string file() { return *folder / "field.sconce"; }

    static Result<FieldData> bake(Bake how, BakeJournal* journal = nullptr)
    {
        BakeSettings settings;
        settings.resolution = 64;
        settings.bounces = 0;
        settings.surfaceTexels = 26;
        settings.surfaceRays = how == Bake::live ? 8 : 4;
        settings.surfaceRefined = 0.0f;
        settings.octree.voxels = 16;
        settings.submissionMs = knobs::submissionMs.most; // in which all fits: the calls must not hang on how fast it is
        settings.rays = how == Bake::throughTheField ? nullptr : rays;
        settings.liveLinks = how == Bake::live ? 8 : 0;
        settings.journal = journal;
        report = {};
        const auto gpu = Gpu::create(device->host());
        if (!gpu) return gpu.error();
        return how == Bake::live ? bakeLightGroups(**gpu, *scene, kProbe, settings, {}, {}, report)
                                 : bakeLightField(**gpu, *scene, kProbe, settings, {}, report);
    }
    static Outcome bytesOfField(const Result<FieldData>& made)
    {
        if (!made) return made.error();
        return bytesOf(made->distance) + bytesOf(made->radiance) + bytesOf(made->irradiance) + bytesOf(made->prefiltered) +
               bytesOf(made->surfaceLight) + bytesOf(made->live.texels);
    }

    using Recovers = std::function<bool(VkResult)>;

    /// The work with a fault.
    /// @param recovers  whether it may have done without what failed, and have given the same
    static void expectRefused(const Work& work, const FallibleCall& call, const VulkanFault& fault, const std::string& whole,
                              const Recovers& recovers)
    {
        const auto before = aliveInVulkan();
        watchVulkan(fault);
        const Outcome failed = work();
        const VulkanWatch watch = endVulkanWatch();
        EXPECT_NE(watch.given, VK_SUCCESS) << "the call was not made";
        EXPECT_TRUE(watch.wrongs.empty()) << testing::PrintToString(watch.wrongs);
        EXPECT_EQ(textOf(aliveInVulkan()), textOf(before));
        if (failed)
        {
            EXPECT_TRUE(isDoneWithout(call, watch.given) || (recovers && recovers(watch.given))) << "the error was swallowed";
            EXPECT_TRUE(*failed == whole) << "something else was given, without a word";
            return;
        }
        EXPECT_EQ(int(failed.error().code), int(codeOf(watch.given))) << failed.error().message;
        const std::string said = failed.error().message;
        EXPECT_TRUE(said.find(call.function) != std::string::npos || said.find(" of device memory") != std::string::npos) << said;
    }

    /// @param recovers  as expectRefused()
    static void failEach(const Work& work, Calls which, const Recovers& recovers = {})
    {
        Tried tried;
        failEach(work, which, recovers, tried);
    }
    static void failEach(const Work& work, Calls which, const Recovers& recovers, Tried& tried)
    {
        const Outcome first = work(); // which makes what stays for the next
        ASSERT_TRUE(first) << first.error().message;
        watchVulkan();
        const Outcome whole = work();
        const VulkanWatch seen = endVulkanWatch();
        ASSERT_TRUE(whole) << whole.error().message;
        ASSERT_TRUE(seen.wrongs.empty()) << testing::PrintToString(seen.wrongs);
        size_t faults = 0;
        for (const size_t n : chosen(seen.calls, which, tried))
        {
            if (HasFailure()) return;
            const FallibleCall& call = seen.calls[n];
            const size_t ways = which == Calls::all ? call.errors.size() : 1;
            for (size_t way = 0; way < ways; ++way, ++faults)
            {
                const size_t error = which == Calls::all ? way : faults % call.errors.size();
                const VkResult given = call.errors[error];
                SCOPED_TRACE(fmt::format("call {} of {}, {}, returns {}", n, seen.calls.size(), call.function, int(given)));
                expectRefused(work, call, {.call = n, .error = error}, *whole, recovers);
            }
            // The next fault's work comes by where this one's ended; the whole of it is done now and then, on the same device.
            if (faults % 32 != 0) continue;
            const Outcome next = work();
            ASSERT_TRUE(next) << next.error().message;
            EXPECT_TRUE(*next == *whole) << "after a fault of call " << n << ", " << call.function;
        }
        const Outcome last = work();
        ASSERT_TRUE(last) << last.error().message;
        EXPECT_TRUE(*last == *whole) << "after all faults";
        fmt::print("{} calls, {} faults\n", seen.calls.size(), faults);
    }

    /// Each stage of a bake fails where those before it are kept, or each fault would take all that comes before it.
    static void failEachStage(Bake how, Tried& tried)
    {
        Kept kept;
        for (const BakeStage last : {BakeStage::gather, BakeStage::octree, BakeStage::maps, BakeStage::command})
        {
            kept.last = last;
            // All maps at once may be too much for a device: the host then builds the octree.
            const auto byTheHost = [](VkResult given) { return codeOf(given) == ErrorCode::outOfMemory && !report.octreeOnDevice; };
            failEach([&] { return bytesOfField(bake(how, &kept)); }, Calls::oneOfEachSite, byTheHost, tried);
        }
    }

    static OwnDevice* device;
    static TestFolder* folder;
    static Scene* scene;
    static TriangleRays* rays;
    static FieldData* field;
    static BakeReport report; // of the last bake
};
OwnDevice* VulkanFaults::device = nullptr;
TestFolder* VulkanFaults::folder = nullptr;
Scene* VulkanFaults::scene = nullptr;
TriangleRays* VulkanFaults::rays = nullptr;
FieldData* VulkanFaults::field = nullptr;
BakeReport VulkanFaults::report;

std::vector<gpu::Ray> someRays()
{
    std::vector<gpu::Ray> made(16);
    for (size_t i = 0; i < made.size(); ++i)
        made[i] = {kProbe[0], glm::normalize(vec3(std::cos(float(i)), 0.3f * std::sin(3.0f * float(i)), std::sin(float(i)))), vec3(0.0f)};
    return made;
}

// Instance and device of a program that has none of its own; under the validation layer there is one call more.
TEST(VulkanFaultsOfDevices, AreRefused)
{
    for (const bool validation : {false, true})
    {
        OwnDevice::Desc desc;
        desc.validation = validation;
        watchVulkan();
        ASSERT_TRUE(OwnDevice::create(desc));
        ASSERT_TRUE(deviceSummary());
        const VulkanWatch seen = endVulkanWatch();
        EXPECT_GE(seen.calls.size(), validation ? 8u : 7u);
        for (size_t n = 0; n < seen.calls.size(); ++n)
            for (size_t error = 0; error < seen.calls[n].errors.size(); ++error)
            {
                SCOPED_TRACE(fmt::format("call {}, {}, error {}, validation {}", n, seen.calls[n].function, error, validation));
                watchVulkan(VulkanFault{.call = n, .error = error});
                const auto device = OwnDevice::create(desc);
                const auto summary = deviceSummary();
                const VulkanWatch watch = endVulkanWatch();
                ASSERT_NE(bool(device), bool(summary)) << "one of them fails";
                const Error& said = device ? summary.error() : device.error();
                EXPECT_EQ(int(said.code), int(codeOf(watch.given))) << said.message;
                EXPECT_NE(said.message.find(seen.calls[n].function), std::string::npos) << said.message;
                EXPECT_TRUE(watch.wrongs.empty()) << testing::PrintToString(watch.wrongs);
            }
        EXPECT_EQ(textOf(aliveInVulkan()), "");
    }
}

TEST_F(VulkanFaults, OfADeviceOfTheHost)
{
    failEach(
        []() -> Outcome
        {
            auto gpu = Gpu::create(device->host());
            if (!gpu) return gpu.error();
            const std::vector<uint32_t> sent = {1, 2, 3, 4};
            std::vector<uint32_t> back(4);
            auto buffer = (*gpu)->makeBufferWith<uint32_t>(sent, 0, "words");
            if (!buffer) return buffer.error();
            if (auto status = (*gpu)->download(*buffer, 0, std::as_writable_bytes(std::span(back))); !status) return status.error();
            return bytesOf(back);
        },
        Calls::all);
}

TEST_F(VulkanFaults, TimesThatCannotBeReadAreNone)
{
    const auto host = Device::create(device->host());
    ASSERT_TRUE(host);
    auto timer = GpuTimer::create(*host, 1);
    ASSERT_TRUE(timer);
    const auto timed = [&](VkCommandBuffer cmd)
    {
        timer->reset(cmd);
        timer->begin(cmd, "nothing");
        timer->end(cmd);
    };
    ASSERT_TRUE(host->gpu().submit(timed));
    if (timer->read().empty()) GTEST_SKIP() << "this queue has no timestamps";
    watchVulkan(VulkanFault{.function = "vkGetQueryPoolResults"});
    EXPECT_TRUE(timer->read().empty()) << "0 ms, which nobody has measured";
    EXPECT_NE(endVulkanWatch().given, VK_SUCCESS);
    EXPECT_EQ(timer->read().size(), 1u);
}

// One device for all of it: what fails leaves it fit for what comes next.
TEST_F(VulkanFaults, OfLoadingAndTracing)
{
    const auto host = Device::create(device->host());
    ASSERT_TRUE(host);
    failEach(
        [&]() -> Outcome
        {
            const NoStaging after{host->gpu()};
            const auto loaded = LightField::load(*host, file());
            if (!loaded) return loaded.error();
            const auto tracer = RayTracer::create(*host, *loaded);
            if (!tracer) return tracer.error();
            const std::vector<gpu::Ray> asked = someRays();
            std::vector<gpu::RayHit> hits(asked.size());
            double milliseconds = 0.0;
            if (auto status = tracer->trace(asked, hits, &milliseconds); !status) return status.error();
            return bytesOf(hits);
        },
        Calls::all);
}

TEST_F(VulkanFaults, OfFrames)
{
    const auto host = Device::create(device->host());
    ASSERT_TRUE(host);
    const auto loaded = LightField::load(*host, file());
    ASSERT_TRUE(loaded);
    failEach(
        [&]() -> Outcome
        {
            const NoStaging after{host->gpu()};
            LightSettings light;
            light.emitterSamples = 4;
            light.pointShadow = light.emitterShadow = 64;
            auto drawn = DeviceScene::create(host->gpu(), *scene, loaded->info(), {.light = light});
            if (!drawn) return drawn.error();
            RenderSettings settings;
            settings.width = settings.height = 16;
            settings.effects.temporal = settings.effects.screenTrace = true;
            settings.shapes.resize(1);
            auto renderer = SceneRenderer::create(host->gpu(), *drawn, *loaded, settings);
            if (!renderer) return renderer.error();
            auto frame = (*renderer)->render(scene->cameras.front());
            if (!frame) return frame.error();
            return bytesOf(frame->beauty);
        },
        Calls::oneOfEachSite);
}

TEST_F(VulkanFaults, OfALightThatMoves)
{
    const auto host = Device::create(device->host());
    ASSERT_TRUE(host);
    failEach(
        [&]() -> Outcome
        {
            const NoStaging after{host->gpu()};
            FieldData other = *field;
            std::vector<Light> lights = other.live.lights;
            for (Light& light : lights) light.position.x -= 0.5f;
            if (auto status = relightField(host->gpu(), other, lights, std::vector<vec3>(other.groups.size(), vec3(1.0f))); !status)
                return status.error();
            return bytesOfField(other);
        },
        Calls::oneOfEachSite);
}

TEST_F(VulkanFaults, OfBakes)
{
    Tried tried;
    for (const Bake how : {Bake::byTriangles, Bake::throughTheField}) failEachStage(how, tried);
}

// Once lost a device stays lost, whatever it is asked for. What a bake had finished by then is in its journal: on another device it goes
// on.
TEST_F(VulkanFaults, ABakeGoesOnAfterALostDevice)
{
    watchVulkan();
    const Outcome whole = bytesOfField(bake(Bake::byTriangles));
    const VulkanWatch seen = endVulkanWatch();
    ASSERT_TRUE(whole) << whole.error().message;
    const size_t submits = size_t(std::ranges::count(seen.calls, "vkQueueSubmit", &FallibleCall::function));
    size_t kept = 0;
    for (const size_t quarter : {0, 1, 3})
    {
        const std::string journal = *folder / fmt::format("journal{}", quarter);
        const JournalHead head{.build = 1, .probes = uint32_t(kProbe.size())};
        {
            auto made = JournalFile::open(journal, head);
            ASSERT_TRUE(made) << made.error().message;
            watchVulkan(VulkanFault{.call = submits * quarter / 4, .lost = true, .function = "vkQueueSubmit"});
            const auto lost = bake(Bake::byTriangles, &*made);
            const VulkanWatch watch = endVulkanWatch();
            ASSERT_FALSE(lost);
            EXPECT_EQ(int(lost.error().code), int(ErrorCode::deviceFailure)) << lost.error().message;
            EXPECT_TRUE(watch.wrongs.empty()) << testing::PrintToString(watch.wrongs);
            kept = made->records();
        }
        auto there = JournalFile::open(journal, head, true);
        ASSERT_TRUE(there) << there.error().message;
        EXPECT_EQ(there->records(), kept);
        const Outcome again = bytesOfField(bake(Bake::byTriangles, &*there));
        ASSERT_TRUE(again) << again.error().message;
        EXPECT_TRUE(*again == *whole) << quarter;
    }
    EXPECT_GE(kept, 3u) << "maps, octree and what is gathered";
}

} // namespace
} // namespace sconce
