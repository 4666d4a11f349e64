// `sconce view` by its scripts, in a window that nobody sees: Xvfb, and Mesa's software device, which draws into it.
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <set>

#include <gtest/gtest.h>

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/reference/image_io.h"
#include "tests/support/png_file.h"
#include "tests/support/run_command.h"

using namespace sconce;
using namespace sconce::testing_support;

namespace
{

/// A display of the test's own; empty where there is no Xvfb.
class Display
{
public:
    Display()
    {
        int ends[2];
        if (pipe(ends) != 0) return;
        const pid_t parent = getpid();
        server = fork();
        if (server == 0)
        {
            if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != parent) _exit(125);
            const std::string fd = std::to_string(ends[1]);
            close(ends[0]);
            if (!freopen("/dev/null", "w", stderr)) _exit(126);
            execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", "1280x1024x24", "-nolisten", "tcp",
                   static_cast<char*>(nullptr));
            _exit(127);
        }
        close(ends[1]);
        char byte = 0;
        while (read(ends[0], &byte, 1) == 1 && byte != '\n') name += byte; // ends at once where there is no Xvfb
        close(ends[0]);
        if (!name.empty()) name.insert(0, ":");
    }
    ~Display()
    {
        if (server <= 0) return;
        kill(server, SIGTERM);
        waitpid(server, nullptr, 0);
    }
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;
    std::string name;

private:
    pid_t server = 0;
};

/// Without a window: neither display nor anything that a desktop has set.
CommandResult viewUnseen(const std::vector<std::string>& arguments)
{
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    return sconceCommand(arguments);
}

bool built()
{
    return viewUnseen({"view", "cornell"}).err.find("This build has no viewer") == std::string::npos;
}

/// A small field of a scene with reflections, baked once for all tests of the process.
class Viewer : public testing::Test
{
protected:
    static void SetUpTestSuite()
    {
        if (!built()) return;
        shown = new Display();
        if (shown->name.empty()) return;
        files = new TestFolder();
        ASSERT_EQ(sconceCommand({"place", kScene, "-o", *files / "p.json", "--count", "2"}).exit, 0);
        ASSERT_EQ(sconceCommand({"bake", kScene, "--probes", *files / "p.json", "-o", field(), "--resolution", "64", "--surface-texels",
                                 "26", "--lamp-texels", "0", "--bounces", "1", "--effects", "all", "--live-links", "8"})
                      .exit,
                  0);
    }
    static void TearDownTestSuite()
    {
        delete files;
        delete shown;
        files = nullptr;
        shown = nullptr;
    }
    void SetUp() override
    {
        if (!shown) GTEST_SKIP() << "this build has no viewer; install libglfw3-dev and libimgui-dev";
        if (shown->name.empty()) GTEST_SKIP() << "there is no Xvfb; install xvfb";
        setenv("DISPLAY", shown->name.c_str(), 1);
        unsetenv("WAYLAND_DISPLAY");
    }
    static std::string field() { return *files / "f.sconce"; }

    /// Plays a script. {} in it stands for the test's folder.
    CommandResult view(std::string script, std::vector<std::string> options = {})
    {
        for (size_t at = 0; (at = script.find("{}")) != std::string::npos;) script.replace(at, 2, folder.path.string());
        writeText(folder / "script.txt", script);
        options.insert(options.begin(), {"view", kScene, "--field", field(), "--size", kSize, "--script", folder / "script.txt"});
        return sconceCommand(options);
    }
    void render(const std::string& name, std::vector<std::string> options = {})
    {
        options.insert(options.begin(), {"render", kScene, "--field", field(), "--size", kSize, "-o", folder / (name + ".exr"), "--png",
                                         folder / (name + ".png")});
        const CommandResult result = sconceCommand(options);
        ASSERT_EQ(result.exit, 0) << result.err;
    }
    /// All bytes of two files.
    void expectSame(const std::string& a, const std::string& b)
    {
        const std::string bytes = readText(folder / a);
        EXPECT_FALSE(bytes.empty()) << a;
        EXPECT_TRUE(bytes == readText(folder / b)) << a << " and " << b << " differ";
    }
    void expectDifferent(const std::string& a, const std::string& b)
    {
        EXPECT_FALSE(readText(folder / a) == readText(folder / b)) << a << " and " << b << " are the same";
    }

    static constexpr const char* kScene = "cornell-glossy";
    static constexpr const char* kSize = "160x120";
    static inline Display* shown = nullptr;
    static inline TestFolder* files = nullptr;
    const TestFolder folder;
};

} // namespace

TEST(ViewerWithoutADisplay, IsASentence)
{
    const CommandResult result = viewUnseen({"view", "cornell"});
    EXPECT_EQ(result.exit, 4) << result.err;
    EXPECT_TRUE(result.err.find("install libglfw3-dev and libimgui-dev") != std::string::npos ||
                result.err.find("No window can be opened") != std::string::npos)
        << result.err;
    EXPECT_TRUE(result.err.ends_with(".\n")) << result.err;
    EXPECT_TRUE(result.out.empty()) << result.out;
}

// All layers to the bit, and the tone map's picture; what the window shows is a rounding of the tone map away from it.
TEST_F(Viewer, ShotsAreThePicturesOfRender)
{
    const CommandResult result = view("panel off\nshot {}/a.exr\nshot {}/a.png\nscreen {}/screen.png\nquit\n");
    ASSERT_EQ(result.exit, 0) << result.err;
    render("b");
    expectSame("a.exr", "b.exr");
    expectSame("a.png", "b.png");
    const PngFile window = readPng(folder / "screen.png"), picture = readPng(folder / "b.png");
    ASSERT_EQ(window.width, picture.width);
    ASSERT_EQ(window.height, picture.height);
    int worst = 0;
    for (size_t i = 0; i < picture.rgb.size(); ++i) worst = std::max(worst, std::abs(int(window.rgb[i]) - int(picture.rgb[i])));
    EXPECT_LE(worst, 1);
}

TEST_F(Viewer, CameraKnobsAndEffectsAreRenders)
{
    const CommandResult result = view("camera 0.2,1,2.2 0,0.8,0\n"
                                      "set fov 1\n");
    EXPECT_EQ(result.exit, 2) << result.err; // a camera's, none of the panel's
    EXPECT_NE(result.err.find("line 2: there is no knob 'fov'"), std::string::npos) << result.err;

    const CommandResult played = view("camera 0.2,1,2.2 0,0.8,0\n"
                                      "set raysBelow 0.9\nset glossyRays 2\nset exposure 1.5\nshot {}/a.exr\nshot {}/a.png\n"
                                      "effect diffuse off\nshot {}/c.exr\n"
                                      "effect diffuse on\nset temporal on\nframe 4\nshot {}/e.exr\n"
                                      "set temporal off\nset ranked 1\nset maxHandoffs 0\nshot {}/g.exr\nquit\n",
                                      {"--eye", "0,1,2", "--target", "0,1,0", "--fov", "50"});
    ASSERT_EQ(played.exit, 0) << played.err;
    const std::vector<std::string> same = {"--eye",        "0.2,1,2.2", "--target",  "0,0.8,0", "--fov",      "50",
                                           "--rays-below", "0.9",       "--samples", "2",       "--exposure", "1.5"};
    const auto with = [&](std::vector<std::string> more)
    {
        more.insert(more.end(), same.begin(), same.end());
        return more;
    };
    render("b", same);
    expectSame("a.exr", "b.exr");
    expectSame("a.png", "b.png");
    render("d", with({"--effects", "auto,-diffuse"}));
    expectSame("c.exr", "d.exr");
    expectDifferent("c.exr", "a.exr");
    render("f", with({"--temporal", "--frames", "4"}));
    expectSame("e.exr", "f.exr");
    expectDifferent("e.exr", "a.exr");
    expectDifferent("g.exr", "a.exr"); // the tracer's knobs, too
}

TEST_F(Viewer, TheSunMovesAsRendersDoes)
{
    const CommandResult played = view("sun -0.2,-1,0.1 4,3,2\nshot {}/a.exr\nquit\n", {"--sun", "0.1,-1,0.3,2,2,2"});
    ASSERT_EQ(played.exit, 0) << played.err;
    render("b", {"--sun", "-0.2,-1,0.1,4,3,2"});
    expectSame("a.exr", "b.exr");
}

TEST_F(Viewer, EveryViewIsAnotherPicture)
{
    const std::vector<std::string> views = {"beauty",    "direct", "diffuse_indirect", "glossy_indirect", "normal", "albedo", "depth",
                                            "roughness", "probe",  "handoffs",         "fetches",         "unknown"};
    std::string script = "panel off\n";
    for (const std::string& name : views) script += "view " + name + "\nscreen {}/" + name + ".png\n";
    const CommandResult result = view(script + "panel on\nscreen {}/panel.png\nview beauty\nview nothing\nquit\n");
    EXPECT_EQ(result.exit, 2) << result.err;
    EXPECT_NE(result.err.find("there is no view 'nothing'; there are beauty, direct"), std::string::npos) << result.err;
    std::set<std::string> pictures;
    for (const std::string& name : views)
    {
        const std::string bytes = readText(folder / (name + ".png"));
        EXPECT_FALSE(bytes.empty()) << name;
        EXPECT_TRUE(pictures.insert(bytes).second) << name;
    }
    EXPECT_TRUE(pictures.insert(readText(folder / "panel.png")).second); // the panel is there
    // Depth at the centre of the picture is the one of render's: 8 bits of middle / (middle + depth).
    const PngFile normal = readPng(folder / "normal.png");
    const size_t centre = 3 * (size_t(normal.height / 2) * normal.width + normal.width / 2);
    render("b");
    const auto layers = readExr(folder / "b.exr");
    ASSERT_TRUE(layers);
    for (size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(float(normal.rgb[centre + c]), 255.0f * (0.5f + 0.5f * layers->find("normal")->pixels[centre + c]), 1.0f) << c;
}

TEST_F(Viewer, TheReferenceStandsBesideIt)
{
    const CommandResult result = view("panel off\nset exposure 1\nshot {}/a.png\ncompare split 4\nscreen {}/split.png\n"
                                      "compare difference 4\nscreen {}/difference.png\ncompare off\nscreen {}/off.png\nquit\n");
    ASSERT_EQ(result.exit, 0) << result.err;
    const PngFile ours = readPng(folder / "a.png"), split = readPng(folder / "split.png");
    const size_t wide = ours.width;
    // Left of the middle it is ours; right of it the reference, which is the same scene: its light is about ours and its noise isn't.
    double left = 0.0, right = 0.0, rightOurs = 0.0, rightTheirs = 0.0;
    for (size_t y = 0; y < ours.height; ++y)
        for (size_t x = 0; x < wide; ++x)
        {
            if (x + 2 > wide / 2 && x < wide / 2 + 2) continue; // the split's line
            for (size_t c = 0; c < 3; ++c)
            {
                const size_t i = 3 * (y * wide + x) + c;
                const double off = std::abs(double(ours.rgb[i]) - double(split.rgb[i]));
                (x < wide / 2 ? left : right) += off;
                EXPECT_TRUE(x >= wide / 2 || off <= 1.0) << x << ", " << y;
                if (x >= wide / 2) rightOurs += ours.rgb[i], rightTheirs += split.rgb[i];
            }
        }
    EXPECT_GT(right, 100.0 * left / 10.0);
    EXPECT_NEAR(rightTheirs / rightOurs, 1.0, 0.1);
    expectDifferent("difference.png", "split.png");
    const PngFile off = readPng(folder / "off.png");
    for (size_t i = 0; i < off.rgb.size(); ++i) EXPECT_LE(std::abs(int(off.rgb[i]) - int(ours.rgb[i])), 1);
}

TEST_F(Viewer, WithoutAFieldOneIsBaked)
{
    CommandLimits longer;
    longer.processorSeconds = 1800.0;
    writeText(folder / "script.txt", "shot " + (folder / "a.exr") + "\nquit\n");
    const CommandResult result = sconceCommand({"view", "cornell", "--size", "64x48", "--script", folder / "script.txt"}, longer);
    ASSERT_EQ(result.exit, 0) << result.err;
    const std::string probes = folder / "p.json", baked = folder / "f.sconce";
    ASSERT_EQ(sconceCommand({"place", "cornell", "-o", probes}).exit, 0);
    ASSERT_EQ(sconceCommand({"bake", "cornell", "--probes", probes, "-o", baked}, longer).exit, 0);
    ASSERT_EQ(sconceCommand({"render", "cornell", "--field", baked, "--size", "64x48", "-o", folder / "b.exr"}).exit, 0);
    expectSame("a.exr", "b.exr");
}

TEST_F(Viewer, AnInterruptClosesTheWindow)
{
    writeText(folder / "script.txt", "frame 1\n"); // and then the window is the user's
    CommandLimits whenItBakes;
    whenItBakes.interruptWhen = "%";
    const CommandResult result = sconceCommand({"view", "cornell", "--size", "64x48", "--script", folder / "script.txt"}, whenItBakes);
    EXPECT_EQ(result.exit, 130) << result.err;
}
