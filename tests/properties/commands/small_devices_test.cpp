// On devices that have no more than a profile lets them have, all works, by the same bytes.
#include <array>
#include <cstdlib>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "runtime/vulkan/gpu.h"
#include "tests/support/environment.h"
#include "tests/support/run_command.h"

namespace sconce
{
namespace
{

using namespace testing_support;
using Arguments = std::vector<std::string>;

/// For as long as it lives, devices are those of a profile of tests/support/small_device.cpp.
class SmallDevice
{
public:
    explicit SmallDevice(const std::string& profile)
        : folders("XDG_DATA_DIRS", usual() + ":" SCONCE_SMALL_DEVICE_FOLDER),
          layers("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation:VK_LAYER_SCONCE_small_device"), name("SCONCE_SMALL_DEVICE", profile)
    {
    }

private:
    static std::string usual()
    {
        const char* there = std::getenv("XDG_DATA_DIRS");
        return there && *there ? there : "/usr/local/share:/usr/share"; // XDG Base Directory Specification
    }
    Variable folders, layers, name;
};

/// What `doctor` says of the first device.
nlohmann::json doctored()
{
    return nlohmann::json::parse(sconceCommand({"doctor", "--json"}).out).at("devices").at(0);
}

/// Of each command that asks the device, the bytes of what it writes: fields in both forms, lit and relit, pictures by all effects and by
/// what moves, streamed and of no geometry, and answers to rays.
/// @param all  else those alone whose work hangs on kinds of memory and of devices
std::map<std::string, std::string> filesOf(const TestFolder& folder, bool all)
{
    writeText(folder / "probes.json", R"({"probes":[{"position":[0,1.5,0.5],"why":"a"},{"position":[-0.8,0.5,0.6],"why":"b"},
        {"position":[0.8,0.5,-0.4],"why":"c"},{"position":[-0.75,1,-0.8],"why":"d"}]})");
    writeText(folder / "shapes.json", R"({"shapes": [{"kind": "capsule", "centre": [0.3, 0.5, 0.5], "half": [0.15, 0.35, 0.15]}]})");
    writeText(folder / "lights.json", R"({"lights": [{"type": "point", "position": [0, 1.2, 0.3], "intensity": [1, 0.8, 0.6]}]})");
    std::string rays = "ox,oy,oz,dx,dy,dz\n";
    for (int i = 0; i < 64; ++i) rays += fmt::format("0,1,0.2,{},{},{}\n", i % 8 - 3.5, i / 8 - 3.5, i % 3 - 1.3);
    writeText(folder / "rays.csv", rays);
    const Arguments bake{"bake",
                         "cornell-glossy",
                         "--probes",
                         folder / "probes.json",
                         "--resolution",
                         "128",
                         "--surface-texels",
                         "26",
                         "--surface-rays",
                         "8",
                         "--bounces",
                         "2",
                         "-q"};
    const Arguments render{"render", "cornell-glossy", "--size", "64x36", "-q"};
    struct Step
    {
        const Arguments& common;
        Arguments more;
        std::string output;
        bool always = false;
    };
    const Arguments none;
    std::map<std::string, std::string> files;
    for (const Step& step :
         {Step{bake, {}, "f.sconce", true},
          {bake, {"--live-links", "8"}, "live.sconce"},
          {bake, {"--compact"}, "compact.sconce"},
          {bake, {"--gather", "field"}, "through.sconce"},
          {none, {"relight", folder / "live.sconce", "--lights", folder / "lights.json", "-q"}, "relit.sconce"},
          {render, {"--field", folder / "f.sconce", "--effects", "all", "--temporal", "--screen-trace", "--frames", "2"}, "all.exr", true},
          {render, {"--field", folder / "live.sconce", "--shapes", folder / "shapes.json"}, "shapes.exr"},
          {render, {"--field", folder / "f.sconce", "--diffuse", "traced", "--trace-every", "4"}, "traced.exr"},
          {render, {"--field", folder / "f.sconce", "--diffuse", "irradiance", "--area-shadows", "field"}, "samples.exr"},
          {render, {"--field", folder / "f.sconce", "--resident", "2", "--frames", "3"}, "streamed.exr", true},
          {render, {"--field", folder / "compact.sconce", "--from-field"}, "primary.exr"},
          {none, {"trace", folder / "f.sconce", "--rays", folder / "rays.csv", "-q"}, "hits.csv", true}})
    {
        if (!all && !step.always) continue;
        Arguments arguments = step.common;
        arguments.insert(arguments.end(), step.more.begin(), step.more.end());
        arguments.insert(arguments.end(), {"-o", folder / step.output});
        const CommandResult result = sconceCommand(arguments);
        EXPECT_EQ(result.exit, 0) << step.output << ": " << result.err;
        files[step.output] = readText(folder / step.output);
        EXPECT_GT(files[step.output].size(), 1000u) << step.output;
    }
    return files;
}

class SmallDevices : public testing::Test
{
protected:
    void SetUp() override
    {
        if (doctored().at("kind") != "software") GTEST_SKIP() << "not a software device, whose one kind of memory can be any";
    }
    /// What the device as it is writes, once a process, and one of the profile.
    static void expectSame(const std::string& profile, bool all)
    {
        static const TestFolder folder; // one for all: files hold its name
        static const std::map<std::string, std::string> usual = filesOf(folder, true);
        const SmallDevice set(profile);
        for (const auto& [name, bytes] : filesOf(folder, all))
            EXPECT_TRUE(bytes == usual.at(name)) << name << " has other bytes on a device of the profile '" << profile << "'";
    }
};

TEST_F(SmallDevices, OfTheLeastThatVulkanLetsThemBeWriteTheSameBytes)
{
    expectSame("least", true);
}

TEST_F(SmallDevices, OfPhonesWriteTheSameBytes)
{
    expectSame("mobile", false);
}

TEST_F(SmallDevices, WithMemoryOfTheirOwnWriteTheSameBytes)
{
    expectSame("desktop", false);
}

TEST_F(SmallDevices, AreWhatTheProgramIsTold)
{
    const SmallDevice set("least");
    const nlohmann::json device = doctored();
    EXPECT_EQ(device.at("kind"), "other");
    EXPECT_EQ(device.at("max_image_size"), 4096);
    EXPECT_EQ(device.at("timestamps"), false);
    const std::string forms = device.at("back_ends").dump();
    EXPECT_NE(forms.find("of up to 65536 texels"), std::string::npos) << forms;
    EXPECT_NE(forms.find("a ray a lane"), std::string::npos) << forms;
}

TEST_F(SmallDevices, ThatHaveFewLayersForShadowMapsTakeWhatFits)
{
    const TestFolder folder;
    writeText(folder / "probes.json", R"({"probes":[{"position":[0,1.5,0.5]}]})");
    ASSERT_EQ(sconceCommand({"bake", "cornell-glossy", "--probes", folder / "probes.json", "--resolution", "64", "--surface-rays", "4",
                             "--bounces", "0", "-q", "-o", folder / "f.sconce"})
                  .exit,
              0);
    const SmallDevice set("least");
    const auto draw = [&](const Arguments& more)
    {
        Arguments all{"render", "cornell-glossy", "--field", folder / "f.sconce", "--size", "32x18", "-q", "-o", folder / "p.exr"};
        all.insert(all.end(), more.begin(), more.end());
        return sconceCommand(all);
    };
    EXPECT_EQ(draw({"--diffuse", "irradiance"}).exit, 0); // samples of emitters, six layers each
    std::string lamps;
    for (int i = 0; i < 43; ++i)
        lamps += fmt::format(R"({}{{"type": "point", "position": [0, {}, 0.3], "intensity": [1, 1, 1]}})", i ? ", " : "", 0.5 + 0.02 * i);
    writeText(folder / "lights.json", fmt::format(R"({{"lights": [{}]}})", lamps));
    const CommandResult result = draw({"--lights", folder / "lights.json"});
    EXPECT_EQ(result.exit, 4);
    EXPECT_NE(result.err.find("The point lights' shadow maps are 258 layers of an image; the device allows 256; light the scene by fewer"),
              std::string::npos)
        << result.err;
}

/// That the validation layer judges by the profile: what the device below could do breaks a limit of the small one.
TEST_F(SmallDevices, HaveTheirLimitsKept)
{
    const SmallDevice set("least");
    auto own = OwnDevice::create({.device = {}, .validation = true, .memoryBudget = 0});
    ASSERT_TRUE(own) << own.error().message;
    const auto gpu = Gpu::create(own->host());
    ASSERT_TRUE(gpu) << gpu.error().message;
    EXPECT_FALSE((*gpu)->timestamps);
    std::array<VkDescriptorSetLayoutBinding, 5> bindings{};
    for (uint32_t i = 0; i < bindings.size(); ++i)
        bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    const auto layout = (*gpu)->setLayout(bindings);
    ASSERT_TRUE(layout);
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = 1;
    info.pSetLayouts = &*layout;
    VkPipelineLayout made = VK_NULL_HANDLE;
    EXPECT_EQ(own->validationMessages().size(), 0u);
    ASSERT_EQ((*gpu)->vk.CreatePipelineLayout(own->host().device, &info, nullptr, &made), VK_SUCCESS);
    (*gpu)->vk.DestroyPipelineLayout(own->host().device, made, nullptr);
    ASSERT_EQ(own->validationMessages().size(), 1u);
    EXPECT_NE(own->validationMessages()[0].find("maxPerStageDescriptorStorageImages limit (4)"), std::string::npos);
}

} // namespace
} // namespace sconce
