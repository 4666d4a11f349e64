// The command as its users meet it: exit codes, sentences, help, JSON, files.
#include <cmath>
#include <fstream>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/reference/image_io.h"
#include "tests/support/run_command.h"

using namespace sconce::testing_support;
using nlohmann::json;

namespace
{

const std::vector<std::string> kCommands = {"scenes", "doctor",  "check", "place",     "bake",    "info",  "verify", "render", "relight",
                                            "merge",  "capture", "trace", "reference", "compare", "bench", "tune",   "knobs",  "view"};

/// stdout as JSON; a failure prints everything there was.
json jsonOf(const CommandResult& result)
{
    const json document = json::parse(result.out, nullptr, false);
    EXPECT_FALSE(document.is_discarded()) << "exit " << result.exit << "\n" << result.out << "\n" << result.err;
    return document;
}

/// A sentence for people: one line that begins as the command's do and ends as a sentence does.
void expectSentence(const CommandResult& result, int exit, const std::string& part)
{
    EXPECT_EQ(result.exit, exit) << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    EXPECT_TRUE(result.err.ends_with(".\n")) << result.err;
    EXPECT_TRUE(result.out.empty()) << result.out;
}

/// Of six probes that `place` chose in cornell the first, as its file has them; placed once.
void writeProbes(const std::filesystem::path& to, size_t count)
{
    static const json placed = []
    {
        const TestFolder folder;
        EXPECT_EQ(sconceCommand({"place", "cornell", "-o", folder / "p.json", "--count", "6", "-q"}).exit, 0);
        return json::parse(readText(folder / "p.json"));
    }();
    json some = placed;
    auto& probes = some.at("probes");
    probes.erase(probes.begin() + std::ptrdiff_t(count), probes.end());
    writeText(to, some.dump());
}

std::vector<std::vector<std::string>> csvRows(const std::string& text)
{
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
    {
        rows.emplace_back();
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    }
    return rows;
}

} // namespace

TEST(Command, HelpOfEveryOptionStatesItsDefault)
{
    const CommandResult overview = sconceCommand({"--help"});
    EXPECT_EQ(overview.exit, 0);
    for (const std::string& command : kCommands)
    {
        EXPECT_NE(overview.out.find("\n  " + command + " "), std::string::npos) << command;
        const CommandResult help = sconceCommand({command, "--help"});
        EXPECT_EQ(help.exit, 0) << command;
        std::istringstream lines(help.out);
        std::string option;
        const auto check = [&]
        {
            if (option.empty() || option.starts_with("  -h,--help")) return;
            EXPECT_TRUE(option.find("default") != std::string::npos || option.find("required") != std::string::npos ||
                        option.find("needed with") != std::string::npos)
                << command << ": " << option;
        };
        for (std::string line; std::getline(lines, line);)
        {
            if (line.starts_with("  -"))
            {
                check();
                option.clear();
            }
            if (line.starts_with("  -") || !option.empty()) option += line;
        }
        check();
    }
    const std::string version = sconceCommand({"--version"}).out; // with its commit, or that it has none
    EXPECT_TRUE(std::regex_match(version, std::regex(R"(\d+\.\d+\.\d+ \(([0-9a-f]{12,14}\+?|unknown)\)\n)"))) << version;
}

/// What --help says of "COMMAND --OPTION", in one line; empty: there is no such option.
std::string helpOf(const std::string& commandAndOption)
{
    const size_t space = commandAndOption.find(' ');
    std::istringstream lines(sconceCommand({commandAndOption.substr(0, space), "--help"}).out);
    std::string entry;
    bool found = false;
    for (std::string line; std::getline(lines, line);)
    {
        std::istringstream words(line);
        std::string word;
        if (line.starts_with("  -"))
        {
            if (found) break;
            words >> word;
            found = ("," + word + ",").find("," + commandAndOption.substr(space + 1) + ",") != std::string::npos;
        }
        while (found && words >> word) entry += (entry.empty() ? "" : " ") + word;
    }
    return entry;
}

TEST(Command, KnobsAreWhatHelpSays)
{
    for (const json& row : jsonOf(sconceCommand({"knobs", "--json"})))
    {
        const std::string option = row.at("option"), range = row.at("range");
        if (option.empty() || option.ends_with("--size")) continue; // --size is two knobs, WxH
        const std::string help = helpOf(option);
        EXPECT_NE(help.find("(default: " + row.at("default").get<std::string>()), std::string::npos) << option << ": " << help;
        if (range == "on, off") continue; // a flag is either
        std::string choices = range;
        for (size_t at = 0; (at = choices.find(", ", at)) != std::string::npos;) choices.replace(at, 2, "|");
        EXPECT_TRUE(help.find("; range: " + range + ")") != std::string::npos || help.find(choices) != std::string::npos)
            << option << ", " << range << ": " << help;
    }
}

// A help text that says a number of its own is one that nobody remembers when the number changes.
TEST(Command, NoHelpTextTypesADefaultOrARange)
{
    const std::filesystem::path helper = "knob_options.cpp"; // the one place that writes the words
    for (const auto& file : std::filesystem::directory_iterator(SCONCE_SOURCES "/tools"))
    {
        if (file.path().extension() != ".cpp" || file.path().filename() == helper) continue;
        const std::string text = readText(file.path());
        for (const char* word : {"(default", "range: 0", "range: 1", "range: >", "CLI::Range", "CLI::PositiveNumber"})
            EXPECT_EQ(text.find(word), std::string::npos) << file.path() << ": " << word;
    }
}

TEST(Command, ReadmeHasTheTableOfKnobs)
{
    const std::string readme = readText(SCONCE_SOURCES "/README.md"), begin = "<!-- knobs -->\n", end = "<!-- /knobs -->";
    const size_t first = readme.find(begin), last = readme.find(end);
    ASSERT_TRUE(first != std::string::npos && last != std::string::npos);
    EXPECT_EQ(readme.substr(first + begin.size(), last - first - begin.size()), sconceCommand({"knobs", "--markdown"}).out)
        << "put what `sconce knobs --markdown` prints between the two marks";
}

// What 65 rays would be is what 64 are: tests/shaders/sample_pair_test.cpp.
TEST(Command, MoreRaysThanThereAreDifferentOnesAreRefused)
{
    const CommandResult result = sconceCommand({"render", "cornell", "--field", "f.sconce", "-o", "x.exr", "--samples", "65"});
    EXPECT_EQ(result.exit, 2);
    EXPECT_NE(result.err.find("--samples: it can't be '65'; give 1 to 64 rays a pixel."), std::string::npos) << result.err;
    const TestFolder folder;
    writeText(folder / "settings.json", R"({"quality": 1, "settings": {"rays": 65}})");
    expectSentence(sconceCommand({"render", "cornell", "--field", "f.sconce", "-o", "x.exr", "--quality", folder / "settings.json"}), 3,
                   "'rays' can't be 65; give 1 to 64 rays a pixel");
}

TEST(Command, WrongUsageExitsWith2)
{
    const std::vector<std::vector<std::string>> wrong = {
        {},
        {"frobnicate"},
        {"check"},
        {"place", "cornell"},
        {"place", "cornell", "-o", "x.json", "--method", "magic"},
        {"place", "cornell", "-o", "x.json", "--grid", "4x4"},
        {"place", "cornell", "-o", "x.json", "--inside", "1,2"},
        {"place", "cornell", "-o", "x.json", "--count", "-1"},
        {"place", "cornell", "-o", "x.json", "--memory", "0"},
        {"place", "cornell", "-o", "x.json", "--memory", "1e9", "--count", "3"},
        {"check", "cornell", "--sun", "0,0,0"},
        {"check", "cornell", "--sky", "1,nan,1"},
        {"check", "cornell", "--sky=-1,0,0"},
        {"bake", "cornell", "--probes", "p.json", "-o", "x.sconce", "--resolution", "32"},
        {"reference", "cornell", "-o", "x.exr", "--size", "0x10"},
        {"reference", "cornell", "-o", "x.exr", "--aov", "nonsense"},
        {"reference", "cornell", "-o", "x.exr", "--eye", "0,1,0"},
        {"reference", "cornell", "-o", "x.exr", "--camera", "nowhere"},
        {"compare", "a.exr", "b.exr", "--metric", "beauty"},
        {"compare", "a.exr", "b.exr", "--fail-above", "flip"},
        {"trace", "f.sconce", "--rays", "r.csv", "-o", "h.csv", "--tracer", "magic"},
    };
    for (const std::vector<std::string>& arguments : wrong)
    {
        const CommandResult result = sconceCommand(arguments);
        std::string line;
        for (const std::string& argument : arguments) line += " " + argument;
        EXPECT_EQ(result.exit, 2) << "sconce" << line << "\n" << result.err;
        EXPECT_FALSE(result.err.empty()) << line;
        EXPECT_TRUE(result.out.empty()) << line << "\n" << result.out;
    }
}

TEST(Command, BadInputExitsWith3AndNamesIt)
{
    const TestFolder folder;
    expectSentence(sconceCommand({"check", "nowhere"}), 3, "nowhere");
    writeText(folder / "broken.gltf", "{ not json");
    expectSentence(sconceCommand({"check", folder / "broken.gltf"}), 3, "broken.gltf");
    writeText(folder / "broken.sconce", "rubbish");
    expectSentence(sconceCommand({"info", folder / "broken.sconce"}), 3, "broken.sconce");
    EXPECT_EQ(sconceCommand({"verify", folder / "broken.sconce"}).exit, 3);
    writeText(folder / "broken.json", "[1, 2");
    expectSentence(sconceCommand({"bake", "cornell", "--probes", folder / "broken.json", "-o", folder / "x.sconce", "-q"}), 3,
                   "broken.json");
}

TEST(Command, EmptySceneExitsWith3AndASentence)
{
    const TestFolder folder;
    const std::string scene = folder / "empty.gltf", probes = folder / "probes.json";
    std::ofstream(scene) << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[]}]})";
    std::ofstream(probes) << R"({"probes":[{"position":[0,0,0],"why":"pinned"}]})";
    const std::vector<std::string> lines[] = {{"check", scene},
                                              {"place", scene, "-o", folder / "placed.json"},
                                              {"bake", scene, "--probes", probes, "-o", folder / "field.sconce"}};
    for (const auto& line : lines)
    {
        const CommandResult result = sconceCommand(line);
        EXPECT_EQ(result.exit, 3) << line[0];
        EXPECT_NE(result.err.find("triangles"), std::string::npos) << line[0] << ": " << result.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "field.sconce"));
}

TEST(Command, FilesThatCannotBeReadOrWrittenExitWith5)
{
    const TestFolder folder;
    expectSentence(sconceCommand({"info", folder / "none.sconce"}), 5, "none.sconce");
    expectSentence(sconceCommand({"verify", folder / "none.sconce"}), 5, "none.sconce");
    expectSentence(sconceCommand({"bake", "cornell", "--probes", folder / "none.json", "-o", folder / "x.sconce", "-q"}), 5, "none.json");
    expectSentence(sconceCommand({"compare", folder / "none.exr", folder / "none.exr"}), 5, "none.exr");
    // Before the work of hours, not after it.
    for (const char* output : {"-o", "--png"})
    {
        std::vector<std::string> line{"reference", "cornell", "--size", "1920x1080",           "--spp",
                                      "65536",     "-q",      output,   folder / "no_folder/a"};
        if (std::string(output) == "--png") line.insert(line.end(), {"-o", folder / "a.exr"});
        expectSentence(sconceCommand(line), 5, "no_folder");
    }
    expectSentence(sconceCommand({"place", "cornell", "--count", "2000", "-o", folder / "no_folder/p.json", "-q"}), 5, "no_folder");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path));
}

TEST(Command, ScenesListsTheBuiltInOnes)
{
    const json list = jsonOf(sconceCommand({"scenes", "--json"}));
    std::vector<std::string> names;
    for (const json& scene : list) names.push_back(scene.at("name"));
    EXPECT_EQ(names, (std::vector<std::string>{"cornell", "cornell-glossy", "temple", "hall", "town", "plain"}));
    const std::string text = sconceCommand({"scenes"}).out;
    for (const std::string& name : names) EXPECT_NE(text.find(name), std::string::npos);
}

TEST(Command, CheckTellsWhatIsInAScene)
{
    const json report = jsonOf(sconceCommand({"check", "cornell", "--json"}));
    EXPECT_GT(report.at("triangles").get<int>(), 30);
    EXPECT_FALSE(report.at("effects").empty());
    for (const json& effect : report.at("effects"))
    {
        EXPECT_TRUE(effect.at("called").is_boolean());
        EXPECT_FALSE(effect.at("why").get<std::string>().empty());
        EXPECT_FALSE(effect.at("cost").get<std::string>().empty());
    }
    const json sunny = jsonOf(sconceCommand({"check", "cornell", "--json", "--sun=-1,-2,0,3,3,3", "--sky", "1,1,1"}));
    for (const json& effect : sunny.at("effects"))
    {
        const bool given = effect.at("name") == "sun" || effect.at("name") == "sky";
        EXPECT_TRUE(!given || effect.at("called").get<bool>()) << effect;
    }
    EXPECT_FALSE(sconceCommand({"check", "cornell"}).out.empty());
}

TEST(Command, DoctorListsDevices)
{
    const CommandResult result = sconceCommand({"doctor", "--json"});
    const json report = jsonOf(result);
    bool usable = false;
    for (const json& device : report.at("devices"))
    {
        usable = usable || device.at("usable").get<bool>();
        EXPECT_EQ(device.at("back_ends").empty(), !device.at("usable").get<bool>());
        for (const json& form : device.at("back_ends"))
            if (form.at("of") == "lists of rays" && device.at("kind") == "software")
            {
                EXPECT_EQ(form.at("taken"), "a ray a lane");
            }
    }
    EXPECT_EQ(result.exit, usable ? 0 : 4);
    const std::string said = sconceCommand({"doctor"}).out;
    for (const char* form : {"words of maps: texel buffers (", "lists of rays: "}) EXPECT_EQ(said.find(form) != std::string::npos, usable);
}

TEST(Command, DoctorListsADeviceThatCannotBeHad)
{
    setenv("SCONCE_RAYS_A_LANE", "3", 1);
    const CommandResult result = sconceCommand({"doctor"});
    unsetenv("SCONCE_RAYS_A_LANE");
    EXPECT_NE(result.out.find("any pass: none (SCONCE_RAYS_A_LANE is '3'; give 1, 2, 4, 8 or 16)"), std::string::npos) << result.out;
}

TEST(Command, PlaceHonoursPinsAndMemory)
{
    const TestFolder folder;
    writeText(folder / "pins.json", R"({"probes":[{"position":[0.75,1.5,0.5]},{"position":[-0.5,1.5,0.25],"pin":"add"}]})");
    const auto place = [&](std::vector<std::string> more)
    {
        std::vector<std::string> arguments = {"place", "cornell", "-o", folder / "p.json", "--json", "--pin", folder / "pins.json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return sconceCommand(arguments);
    };
    EXPECT_EQ(jsonOf(place({"--count", "3"})).at("probes"), 4);
    std::ifstream in(folder / "p.json");
    const json written = json::parse(in);
    size_t found = 0;
    for (const json& probe : written.at("probes"))
        found += probe.at("position") == json({0.75, 1.5, 0.5}) || probe.at("position") == json({-0.5, 1.5, 0.25});
    EXPECT_EQ(found, 2u);

    // What a probe takes is what a bake of one says it takes.
    ASSERT_EQ(sconceCommand({"place", "cornell", "-o", folder / "one.json", "--grid", "1x1x1", "-q"}).exit, 0);
    const auto bytesOf = [&](const char* form)
    {
        const json bytes = jsonOf(sconceCommand({"bake", "cornell", "--probes", folder / "one.json", "-o", folder / "one.sconce",
                                                 "--resolution", "64", "--bounces", "0", "--effects", "all", "--json", form}))
                               .at("bytes");
        return bytes.at("total").get<uint64_t>() - bytes.at("index").get<uint64_t>();
    };
    const uint64_t compact = bytesOf("--compact"), maps = bytesOf("--quiet");
    EXPECT_LT(compact, maps);
    EXPECT_EQ(jsonOf(place({"--resolution", "64", "--memory", std::to_string(maps * 4 + maps / 2)})).at("probes"), 4);
    EXPECT_EQ(jsonOf(place({"--resolution", "64", "--compact", "--memory", std::to_string(compact * 4 + compact / 2)})).at("probes"), 4);
    expectSentence(place({"--resolution", "64", "--memory", std::to_string(maps / 2)}), 2, "--memory");
    expectSentence(place({"--resolution", "64", "--memory", std::to_string(maps + maps / 2)}), 2, "--pin");
    writeText(folder / "pins.json", R"({"probes":[{"position":[0.25,"a",0.25]}]})");
    expectSentence(place({"--count", "3"}), 3, "pins.json");
}

TEST(Command, PlaceTakesTheSpaceThatCounts)
{
    const TestFolder folder;
    const auto place = [&](const std::string& space) {
        return sconceCommand({"place", "cornell", "-o", folder / "p.json", "--count", "2", "--json", "-q", "--space=" + space});
    };
    const json box = jsonOf(place("-0.9,0.1,-0.9,0.9,0.9,0.9"));
    EXPECT_EQ(box.at("space"), "-0.9,0.1,-0.9,0.9,0.9,0.9");
    constexpr double kLow[] = {-0.9, 0.1, -0.9}, kHigh[] = {0.9, 0.9, 0.9};
    for (const json& probe : json::parse(readText(folder / "p.json")).at("probes"))
        for (size_t axis = 0; axis < 3; ++axis)
        {
            EXPECT_GE(probe.at("position")[axis], kLow[axis]);
            EXPECT_LE(probe.at("position")[axis], kHigh[axis]);
        }
    const json rooms = jsonOf(place("enclosed"));
    EXPECT_EQ(rooms.at("space"), "enclosed");
    EXPECT_LT(rooms.at("surface_left_out").get<double>(), box.at("surface_left_out").get<double>());
    for (const std::string wrong : {"sideways", "ground:", "ground:x", "ground:-1", "walk:0:mesh.glb", "walk:2", "1,2,3"})
        EXPECT_EQ(place(wrong).exit, 2) << wrong;
    EXPECT_NE(place("sideways").err.find("--space: it can't be 'sideways'; give auto, enclosed, ground:METRES"), std::string::npos);
    EXPECT_EQ(place("walk:2:" + (folder / "none.glb")).exit, 5);
}

// The whole way once, small: place, bake, info, verify, trace, damage.
TEST(Command, PipelineFromSceneToHits)
{
    const TestFolder folder;
    const json placed = jsonOf(sconceCommand({"place", "cornell", "-o", folder / "p.json", "--count", "6", "--json"}));
    EXPECT_EQ(placed.at("probes"), 6);
    EXPECT_GT(placed.at("seconds").get<double>(), 0.0);
    EXPECT_GT(placed.at("peak_rss_mb").get<double>(), 1.0);
    const json probes = json::parse(readText(folder / "p.json"));
    ASSERT_EQ(probes.at("probes").size(), 6u);
    EXPECT_EQ(probes.at("probes")[0].at("position").size(), 3u);

    const CommandResult bake = sconceCommand(
        {"bake", "cornell", "--probes", folder / "p.json", "-o", folder / "f.sconce", "--resolution", "128", "--bounces", "1", "--json"});
    ASSERT_EQ(bake.exit, 0) << bake.err;
    EXPECT_GT(jsonOf(bake).at("peak_rss_mb").get<double>(), 1.0);

    const json info = jsonOf(sconceCommand({"info", folder / "f.sconce", "--json"}));
    EXPECT_EQ(info.at("probes"), 6);
    EXPECT_EQ(info.at("resolution"), 128);
    EXPECT_EQ(info.at("face_size"), 64);
    EXPECT_EQ(info.at("bounces"), 1);
    EXPECT_TRUE(info.at("effects").is_array());
    const json& bytes = info.at("bytes");
    EXPECT_EQ(bytes.at("total").get<size_t>(), bytes.at("distance").get<size_t>() + bytes.at("normals").get<size_t>() +
                                                   bytes.at("radiance").get<size_t>() + bytes.at("irradiance").get<size_t>() +
                                                   bytes.at("index").get<size_t>());
    EXPECT_EQ(bytes.at("radiance"), bytes.at("prefiltered_radiance")) << "no ray is traced in cornell: its surfaces are rough";
    EXPECT_GT(bytes.at("radiance").get<size_t>(), 0u);
    for (const char* key : {"leaves", "nodes", "depth"}) EXPECT_GT(info.at("octree").at(key).get<int>(), 0) << key;

    EXPECT_EQ(jsonOf(sconceCommand({"verify", folder / "f.sconce", "--json"})).at("ok"), true);
    std::string damaged = readText(folder / "f.sconce");
    damaged[damaged.size() / 2] ^= 4;
    writeText(folder / "bad.sconce", damaged);
    const CommandResult verify = sconceCommand({"verify", folder / "bad.sconce", "--json"});
    EXPECT_EQ(verify.exit, 3);
    EXPECT_EQ(jsonOf(verify).at("ok"), false);

    // From a probe straight down: the floor. And rays that are none.
    const json& position = probes.at("probes")[0].at("position");
    std::ostringstream rays;
    rays << "ox,oy,oz,dx,dy,dz\n" << position[0] << "," << position[1] << "," << position[2] << ",1e-401,-3,0\n"; // no double is so small
    const size_t odd = 7;
    rays << "0,1,0,nan,0,0\n0,1,0,0,0,0\n0,1,0,inf,0,0\nnan,0,0,0,1,0\n1e39,1e-60,0,1,0,0\n1e400,0,0,1,0,0\n0,1,0,1e38,-1e38,1e-38\n";
    writeText(folder / "rays.csv", rays.str());
    const CommandResult trace =
        sconceCommand({"trace", folder / "f.sconce", "--rays", folder / "rays.csv", "-o", folder / "hits.csv", "--json", "--cpu"});
    ASSERT_EQ(trace.exit, 0) << trace.err;
    const auto rows = csvRows(readText(folder / "hits.csv"));
    ASSERT_EQ(rows.size(), 2 + odd);
    EXPECT_EQ(readText(folder / "hits.csv").substr(0, readText(folder / "hits.csv").find('\n')),
              "status,t,x,y,z,nx,ny,nz,r,g,b,probe,handoffs,distance_fetches,index_fetches");
    for (size_t i = 1; i < rows.size(); ++i)
    {
        ASSERT_EQ(rows[i].size(), 15u);
        for (size_t c = 1; c < 15; ++c) EXPECT_TRUE(std::isfinite(std::stod(rows[i][c]))) << i << ": " << rows[i][c];
    }
    EXPECT_EQ(rows[1][0], "hit");
    EXPECT_NEAR(std::stod(rows[1][2]), position[0].get<double>(), 1e-3);
    EXPECT_NEAR(std::stod(rows[1][1]), position[1].get<double>() - std::stod(rows[1][3]),
                1e-3); // t is metres though the direction is not unit
    EXPECT_EQ(rows[2][0], "miss");

    writeText(folder / "rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,0,1,0,0\n0,0,zero,1,0,0\n");
    expectSentence(sconceCommand({"trace", folder / "f.sconce", "--rays", folder / "rays.csv", "-o", folder / "hits2.csv", "-q"}), 3,
                   "Line 3");
    writeText(folder / "rays.csv", "ox,oy,oz,dx,dy,dz,nx,ny,nz\n0,1,0,0,-1,0,0,-2,0\n0,1,0,0,-1,0,0,0,0\n0,1,0,0,-1,0,nan,inf,0\n");
    ASSERT_EQ(sconceCommand({"trace", folder / "f.sconce", "--rays", folder / "rays.csv", "-o", folder / "n.csv", "--cpu", "-q"}).exit, 0);
    const auto withNormals = csvRows(readText(folder / "n.csv"));
    ASSERT_EQ(withNormals.size(), 4u);
    for (size_t i = 1; i < 4; ++i) EXPECT_EQ(withNormals[i][0], "hit");
    writeText(folder / "rays.csv", "ox,oy,oz,dx,dy,dz,nx,ny,nz\n0,0,0,1,0,0\n");
    expectSentence(sconceCommand({"trace", folder / "f.sconce", "--rays", folder / "rays.csv", "-o", folder / "hits2.csv", "-q"}), 3,
                   "nine");
    writeText(folder / "rays.csv", "x,y,z\n");
    expectSentence(sconceCommand({"trace", folder / "f.sconce", "--rays", folder / "rays.csv", "-o", folder / "hits2.csv", "-q"}), 3,
                   "header");
    EXPECT_FALSE(std::filesystem::exists(folder / "hits2.csv"));
}

// One probe in a closed room: what it sees, and a pixel whose light and ray are its alone.
TEST(Command, ProbesAndPixelsAreExplained)
{
    const TestFolder folder;
    writeText(folder / "p.json",
              R"({"probes": [{"position": [0, 1, 0.2], "why": "by hand"}, {"position": [0, 1.2, 0.6], "why": "more"}]})");
    ASSERT_EQ(sconceCommand({"bake", "cornell-glossy", "--probes", folder / "p.json", "-o", folder / "f.sconce", "--resolution", "128",
                             "--surface-rays", "16", "-q"})
                  .exit,
              0);
    const json probe = jsonOf(sconceCommand({"probe", folder / "f.sconce", "1", "-o", folder / "pano.exr", "--width", "128", "--json"}));
    EXPECT_EQ(probe.at("why"), "more");
    EXPECT_NEAR(probe.at("position")[1].get<double>(), 1.2, 1e-3);
    EXPECT_GT(probe.at("square_metres").get<double>(), probe.at("square_metres_alone").get<double>());
    EXPECT_GT(probe.at("sky").get<double>(), 0.05) << "the box is open to the front";
    const auto panorama = sconce::readExr(folder / "pano.exr");
    ASSERT_TRUE(panorama) << panorama.error().message;
    for (const char* layer : {"beauty", "depth", "normal", "alone"}) EXPECT_NE(panorama->find(layer), nullptr) << layer;
    EXPECT_EQ(panorama->height, 64u);
    EXPECT_EQ(sconceCommand({"probe", folder / "f.sconce", "1", "-o", folder / "pano.png", "--width", "64", "-q"}).exit, 0);
    expectSentence(sconceCommand({"probe", folder / "f.sconce", "2", "-o", folder / "x.png"}), 2, "no probe 2");
    expectSentence(sconceCommand({"probe", folder / "f.sconce", "1", "-o", folder / "x.jpg"}), 2, "x.jpg");

    const std::vector<std::string> camera = {"--size", "64x36", "--eye", "0,1,0.9", "--target", "0,0.9,-1"};
    const auto with = [&](std::vector<std::string> line)
    {
        line.insert(line.end(), camera.begin(), camera.end());
        return sconceCommand(line);
    };
    ASSERT_EQ(with({"render", "cornell-glossy", "--field", folder / "f.sconce", "-o", folder / "r.exr", "-q"}).exit, 0);
    const auto picture = sconce::readExr(folder / "r.exr");
    ASSERT_TRUE(picture) << picture.error().message;
    const json pixel = jsonOf(with(
        {"explain", folder / "f.sconce", "cornell-glossy", "--pixel", "40,6", "--spp", "64", "--picture", folder / "way.png", "--json"}));
    for (const size_t c : {0, 1, 2})
    {
        EXPECT_EQ(pixel.at("diffuse").at("frame")[c].get<float>(), picture->find("diffuse_indirect")->pixels[3 * (6 * 64 + 40) + c]);
        EXPECT_EQ(pixel.at("glossy").at("frame")[c].get<float>(), picture->find("glossy_indirect")->pixels[3 * (6 * 64 + 40) + c]);
    }
    EXPECT_FALSE(pixel.at("diffuse").at("asked").empty());
    EXPECT_FALSE(pixel.at("glossy").at("way").empty());
    EXPECT_FALSE(pixel.at("advice").empty());
    EXPECT_GT(std::filesystem::file_size(folder / "way.png"), 100u);
    // Of all surfaces as one of another roughness: planned and drawn by it.
    ASSERT_EQ(
        with({"render", "cornell-glossy", "--field", folder / "f.sconce", "--roughness", "0.9", "-o", folder / "rough.exr", "-q"}).exit, 0);
    const auto rough = sconce::readExr(folder / "rough.exr");
    ASSERT_TRUE(rough) << rough.error().message;
    const json blunt =
        jsonOf(with({"explain", folder / "f.sconce", "cornell-glossy", "--pixel", "40,6", "--spp", "4", "--roughness", "0.9", "--json"}));
    EXPECT_FLOAT_EQ(blunt.at("roughness").get<float>(), 0.9f);
    for (const size_t c : {0, 1, 2})
        EXPECT_EQ(blunt.at("glossy").at("frame")[c].get<float>(), rough->find("glossy_indirect")->pixels[3 * (6 * 64 + 40) + c]);
    expectSentence(with({"explain", folder / "f.sconce", "cornell-glossy", "--pixel", "64,0"}), 2, "63,35");
    expectSentence(with({"explain", folder / "f.sconce", "cornell-glossy", "--pixel", "1.5,0"}), 2, "1.5");
    expectSentence(sconceCommand({"explain", folder / "f.sconce", "cornell-glossy", "--pixel", "1,1", "--size", "8x8", "--eye", "0,1,3",
                                  "--target", "0,1,9"}),
                   2, "sky");
}

// The frame as a user gets it; what `auto` leaves out must not change a bit of it.
TEST(Command, RenderWritesTheLayersThatWereAskedFor)
{
    const TestFolder folder;
    writeText(folder / "p.json", R"({"probes":[{"position":[0,1,-0.5]},{"position":[0,1,0.5]}]})");
    const CommandResult bake =
        sconceCommand({"bake", "cornell", "--probes", folder / "p.json", "-o", folder / "f.sconce", "--resolution", "64", "-q"});
    ASSERT_EQ(bake.exit, 0) << bake.err;
    EXPECT_EQ(bake.err, ""); // the validation layer's messages would stand here
    const std::vector<std::string> base = {"render", "cornell", "--field", folder / "f.sconce", "--size", "40x24"};
    const auto render = [&](const std::string& name, std::vector<std::string> more)
    {
        std::vector<std::string> arguments = base;
        arguments.insert(arguments.end(), {"-o", folder / name});
        arguments.insert(arguments.end(), more.begin(), more.end());
        return sconceCommand(arguments);
    };
    const CommandResult all = render("all.exr", {"--effects", "all", "--json", "--png", folder / "all.png", "--frames", "2"});
    ASSERT_EQ(all.exit, 0) << all.err;
    const json report = jsonOf(all);
    EXPECT_EQ(report.at("layers").size(), 12u) << report.at("layers");
    EXPECT_EQ(report.at("width"), 40);
    EXPECT_GT(report.at("peak_rss_mb").get<double>(), 1.0);
    EXPECT_FALSE(report.contains("unknown_share")) << "nothing in it is smooth enough for a traced ray";
    const CommandResult shiny = render("shiny.exr", {"--roughness", "0.15", "--json"});
    EXPECT_GE(jsonOf(shiny).at("unknown_share").get<double>(), 0.0);
    EXPECT_NE(shiny.err.find("--effects all"), std::string::npos) << "the field holds no radiance for rays, and says so";
    EXPECT_EQ(readText(folder / "all.png").substr(1, 3), "PNG");
    const CommandResult quiet = render("auto.exr", {"-q"});
    ASSERT_EQ(quiet.exit, 0);
    EXPECT_EQ(quiet.err, "");
    EXPECT_EQ(jsonOf(sconceCommand({"compare", folder / "auto.exr", folder / "all.exr", "--metric", "mse", "--json"})).at("mse"), 0.0);
    EXPECT_EQ(jsonOf(render("none.exr", {"--effects", "none", "--json", "--aov", "beauty,depth"})).at("layers"), json({"beauty", "depth"}));
    // What a layer needs is made where it is asked for; and frames that only warm up change nothing.
    const json alone = jsonOf(render("alone.exr", {"--json", "--roughness", "0.15", "--aov", "beauty", "--warm-up", "0.05"}));
    const json counted = jsonOf(render("counted.exr", {"--json", "--roughness", "0.15", "--aov", "beauty,fetches"}));
    EXPECT_FALSE(alone.contains("fetches_per_ray"));
    EXPECT_TRUE(counted.contains("fetches_per_ray"));
    EXPECT_LT(alone.at("device_bytes"), counted.at("device_bytes"));
    EXPECT_EQ(jsonOf(sconceCommand({"compare", folder / "alone.exr", folder / "counted.exr", "--metric", "mse", "--json"})).at("mse"), 0.0);

    EXPECT_EQ(render("x.exr", {"--effects", "sparkle"}).exit, 2);
    EXPECT_EQ(render("x.exr", {"--aov", "sparkle"}).exit, 2);
    for (const char* tracer : {"b0", "b0plus", "b0plus-octree"}) // the field has cube faces
        expectSentence(render("x.exr", {"--tracer", tracer, "-q"}), 3, "--chart octahedral");
    EXPECT_EQ(jsonOf(render("wang.exr", {"--tracer", "wang", "--json"})).at("tracer"), "wang");
    EXPECT_EQ(sconceCommand({"render", "cornell", "--field", folder / "none.sconce", "-o", folder / "x.exr"}).exit, 5);
    EXPECT_FALSE(std::filesystem::exists(folder / "x.exr"));
}

TEST(Command, APictureNeedsNoGeometry)
{
    const TestFolder folder;
    writeProbes(folder / "p.json", 6);
    const CommandResult bake =
        sconceCommand({"bake", "cornell", "--probes", folder / "p.json", "--effects", "all", "--resolution", "256", "--surface-texels",
                       "26", "--surface-rays", "16", "--bounces", "2", "-o", folder / "f.sconce", "-q"});
    ASSERT_EQ(bake.exit, 0) << bake.err;
    const auto render = [&](const std::string& name, std::vector<std::string> more)
    {
        more.insert(more.begin(), {"render", "cornell", "--field", folder / "f.sconce", "--size", "64x36", "-o", folder / name, "--json"});
        return sconceCommand(more);
    };
    ASSERT_EQ(render("drawn.exr", {"--eye=0,1,0.9", "--target=0,0.9,-1"}).exit, 0);
    const json seen = jsonOf(render("seen.exr", {"--from-field", "--eye=0,1,0.9", "--target=0,0.9,-1", "--samples", "4"}));
    EXPECT_EQ(seen.at("rays"), 4 * 64 * 36);
    EXPECT_LT(seen.at("unknown_share").get<double>(), 0.02);
    EXPECT_EQ(seen.at("layers").size(), 7u) << seen.at("layers");
    const json same = jsonOf(sconceCommand({"compare", folder / "seen.exr", folder / "drawn.exr", "--same-surface", "--json"}));
    EXPECT_LT(same.at("other_surface_pixels").get<double>(), 0.1 * 64 * 36);
    EXPECT_NEAR(same.at("mean").get<double>(), 1.0, 0.07); // 0.950: rays over the whole pixel, and the lamp in few pixels
    EXPECT_LT(same.at("relmse").get<double>(), 0.02);

    const json eyes = jsonOf(render("eyes.exr", {"--from-field", "--stereo", "0.064", "--lens", "0.22,0.24", "--aov", "beauty,unknown"}));
    EXPECT_EQ(eyes.at("width"), 128);
    EXPECT_EQ(eyes.at("layers"), json({"beauty", "unknown"}));
    EXPECT_EQ(render("x.exr", {"--from-field", "--effects", "all"}).exit, 2);
    EXPECT_EQ(render("x.exr", {"--stereo", "0.064"}).exit, 2);
    expectSentence(render("x.exr", {"--from-field", "--lens=-0.5,0"}), 2, "folds");
    expectSentence(render("x.exr", {"--from-field", "--stereo", "-1"}), 2, "-1 m apart");
    expectSentence(render("x.exr", {"--from-field", "--aov", "direct"}), 2, "direct");
    EXPECT_FALSE(std::filesystem::exists(folder / "x.exr"));
}

TEST(Command, ShapesAreReadOrRefusedWithASentence)
{
    const TestFolder folder;
    const auto reference = [&](const std::string& shapes)
    {
        writeText(folder / "s.json", shapes);
        return sconceCommand(
            {"reference", "cornell", "--shapes", folder / "s.json", "--size", "16x16", "--spp", "1", "-o", folder / "x.exr", "-q"});
    };
    expectSentence(reference("[]"), 3, "no JSON object with an array `shapes`");
    expectSentence(reference(R"({"shapes": [{}]})"), 3, "of shape 0 it has no kind");
    expectSentence(reference(R"({"shapes": [{"kind": "cone"}]})"), 3, "its kind is 'cone'; give sphere, capsule, box");
    expectSentence(reference(R"({"shapes": [{"kind": "box"}, {"kind": "box", "half": [1, 2]}]})"), 3, "of shape 1 its 'half'");
    expectSentence(reference(R"({"shapes": [{"kind": "box", "size": 3}]})"), 3, "its 'size' is unknown");
    expectSentence(reference(R"({"shapes": [{"kind": "sphere", "half": [-1, 0, 0]}]})"), 3, "its radius is not above 0");
    expectSentence(sconceCommand({"reference", "cornell", "--shapes", folder / "none.json", "-o", folder / "x.exr"}), 5,
                   "Cannot read shapes");
    EXPECT_FALSE(std::filesystem::exists(folder / "x.exr"));
    EXPECT_EQ(reference(R"({"shapes": []})").exit, 0);
}

// A ball on the floor: its shadow in light that was looked up, and what telling the light of it changes against the truth.
TEST(Command, WhatMovesIsDrawnAndTold)
{
    const TestFolder folder;
    writeText(folder / "s.json",
              R"({"shapes": [{"kind": "sphere", "centre": [0, 0.35, 0.75], "half": [0.2, 0, 0], "albedo": [0.6, 0.6, 0.6]}]})");
    writeProbes(folder / "p.json", 4);
    ASSERT_EQ(sconceCommand({"bake", "cornell", "--probes", folder / "p.json", "--resolution", "128", "--surface-texels", "26",
                             "--surface-rays", "64", "-o", folder / "f.sconce", "-q"})
                  .exit,
              0);
    const std::vector<std::string> view = {"cornell", "--eye=0,1.2,2.4", "--target=0,0.2,0.5", "--fov", "50", "--size", "64x48"};
    const auto with = [&](const char* command, std::vector<std::string> more)
    {
        more.insert(more.begin(), view.begin(), view.end());
        more.insert(more.begin(), command);
        return sconceCommand(more);
    };
    ASSERT_EQ(with("reference", {"--spp", "256", "-o", folder / "before.exr"}).exit, 0);
    ASSERT_EQ(with("reference", {"--spp", "256", "--shapes", folder / "s.json", "-o", folder / "truth.exr"}).exit, 0);
    const std::vector<std::string> drawn = {"--field", folder / "f.sconce", "--shapes", folder / "s.json", "-o"};
    const auto render = [&](const std::string& name, bool only)
    {
        std::vector<std::string> more = drawn;
        more.push_back(folder / name);
        if (only) more.push_back("--drawn-only");
        return with("render", more);
    };
    ASSERT_EQ(render("told.exr", false).exit, 0);
    ASSERT_EQ(render("untold.exr", true).exit, 0);
    const auto error = [&](const std::string& name)
    {
        return jsonOf(sconceCommand({"compare", folder / name, folder / "truth.exr", "--changed-from", folder / "before.exr", "--layer",
                                     "diffuse_indirect", "--metric", "mse", "--json"}))
            .at("mse")
            .get<double>();
    };
    EXPECT_LT(error("told.exr"), 0.5 * error("untold.exr"));
}

// Light groups from bake to picture: dimmed live, dimmed in the file and path-traced in the dimmed scene are the same light.
TEST(Command, LightGroupsAreDimmedInPicturesFilesAndReferences)
{
    const TestFolder folder;
    const std::vector<std::string> scene = {"cornell", "--sky", "2,2,2"};
    const auto with = [&](const char* command, std::vector<std::string> more)
    {
        std::vector<std::string> arguments{command};
        arguments.insert(arguments.end(), scene.begin(), scene.end());
        arguments.insert(arguments.end(), more.begin(), more.end());
        return sconceCommand(arguments);
    };
    writeProbes(folder / "p.json", 4);
    const std::vector<std::string> bake = {"--probes", folder / "p.json", "-o", folder / "f.sconce", "--resolution", "64", "--json"};
    const auto grouped = [&](std::vector<std::string> groups)
    {
        groups.insert(groups.begin(), bake.begin(), bake.end());
        return with("bake", groups);
    };
    expectSentence(grouped({"--group", "lamp="}), 2, "lamp=");
    expectSentence(grouped({"--group", "moon", "-q"}), 2, "no light 'moon'");
    const json baked = jsonOf(grouped({"--group", "lamp=emitters"}));
    ASSERT_EQ(baked["light_groups"].size(), 2u) << baked;
    EXPECT_EQ(baked["light_groups"][0]["name"], "lamp");
    EXPECT_EQ(baked["light_groups"][1]["name"], "rest");
    EXPECT_EQ(baked["format_version"], 7);
    EXPECT_GT(baked["bytes"]["light_groups"], 0);
    EXPECT_NE(sconceCommand({"info", folder / "f.sconce"}).out.find("lamp=emitters rest"), std::string::npos);

    const json relit = jsonOf(
        sconceCommand({"relight", folder / "f.sconce", "-o", folder / "dim.sconce", "--dim", "lamp=0.5", "--dim", "rest=0,0,2", "--json"}));
    EXPECT_EQ(relit["light_groups"].size(), 0u);
    EXPECT_EQ(relit["format_version"], 6) << "a static field has nothing of groups";
    expectSentence(sconceCommand({"relight", folder / "f.sconce", "-o", folder / "x.sconce", "--dim", "moon=1"}), 2, "lamp, rest");
    expectSentence(sconceCommand({"relight", folder / "f.sconce", "-o", folder / "x.sconce", "--dim", "lamp=bright"}), 2, "lamp=bright");
    expectSentence(sconceCommand({"relight", folder / "f.sconce", "-o", folder / "x.sconce", "--dim", "lamp=-1"}), 2, "'lamp'");
    expectSentence(sconceCommand({"relight", folder / "dim.sconce", "-o", folder / "x.sconce", "--dim", "lamp=1"}), 2, "--group");

    const std::vector<std::string> dims = {"--dim", "lamp=0.5", "--dim", "rest=0,0,2"};
    const auto drawn = [&](const char* command, std::vector<std::string> more, const char* picture)
    {
        more.insert(more.end(), {"--size", "64x36", "-o", folder / picture, "-q"});
        return with(command, more);
    };
    const auto and_ = [&](std::vector<std::string> some) { return some.insert(some.end(), dims.begin(), dims.end()), some; };
    ASSERT_EQ(drawn("render", and_({"--field", folder / "f.sconce"}), "live.exr").exit, 0);
    ASSERT_EQ(drawn("render", {"--field", folder / "dim.sconce"}, "file.exr").exit, 0);
    ASSERT_EQ(drawn("reference", and_({"--group", "lamp=emitters", "--spp", "256", "--pixel-centre", "--bounces", "8"}), "truth.exr").exit,
              0);
    const auto compared = [&](const char* picture, const char* reference) {
        return jsonOf(sconceCommand({"compare", folder / picture, folder / reference, "--layer", "diffuse_indirect", "--json"}));
    };
    EXPECT_EQ(compared("live.exr", "file.exr").at("mse"), 0.0);
    EXPECT_NEAR(compared("live.exr", "truth.exr").at("mean").get<double>(), 1.0, 0.06);
}

TEST(Command, LightsMoveAfterTheBake)
{
    const TestFolder folder;
    writeText(folder / "p.json", R"({"probes":[{"position":[0.0,1.0,0.0]},{"position":[0.3,0.5,0.3]}]})");
    const auto lights = [&](const char* name, const char* text)
    {
        writeText(folder / name, text);
        return std::string(folder / name);
    };
    const std::string one =
        lights("one.json", R"({"lights":[{"type":"point","name":"bulb","position":[-0.4,0.9,0.3],"intensity":[2,2,2]}]})");
    const std::string other = lights("other.json", R"({"lights":[{"type":"point","position":[0.5,1.5,-0.2],"intensity":[0.5,1,3]}]})");
    const json live =
        jsonOf(sconceCommand({"bake", "cornell-glossy", "--probes", folder / "p.json", "--lights", one, "--live-links", "8", "--resolution",
                              "64", "--surface-texels", "26", "--surface-rays", "16", "-o", folder / "f.sconce", "--json"}));
    EXPECT_EQ(live["live_links"], 8);
    EXPECT_EQ(live["live_lights"], json::array({"bulb"}));
    EXPECT_EQ(live["format_version"], 10);
    EXPECT_NE(sconceCommand({"info", folder / "f.sconce"}).out.find("live: 8 links a texel"), std::string::npos);

    // Captured, the same is dark until it is lit, by those lights if told nothing else: to the byte the bake.
    const json captured = jsonOf(
        sconceCommand({"capture", "cornell-glossy", "--probes", folder / "p.json", "--lights", one, "--live-links", "8", "--resolution",
                       "64", "--surface-texels", "26", "--surface-rays", "16", "-o", folder / "dark.sconce", "--json"}));
    EXPECT_EQ(captured["lit"], false);
    EXPECT_NE(sconceCommand({"info", folder / "dark.sconce"}).out.find("captured, not lit"), std::string::npos);
    const json lit = jsonOf(sconceCommand({"relight", folder / "dark.sconce", "-o", folder / "lit.sconce", "--keep", "--json"}));
    EXPECT_EQ(lit["lit"], true);
    EXPECT_EQ(readText(folder / "lit.sconce"), readText(folder / "f.sconce"));
    const auto shown = [&](const char* field, const char* picture)
    {
        return jsonOf(sconceCommand(
            {"render", "cornell-glossy", "--field", folder / field, "--lights", one, "--size", "64x36", "-o", folder / picture, "--json"}));
    };
    EXPECT_TRUE(shown("dark.sconce", "captured.exr").contains("live_light_ms"));
    EXPECT_FALSE(shown("f.sconce", "baked.exr").contains("live_light_ms"));
    const auto apart = [&](const char* layer, const char* figure)
    {
        return jsonOf(sconceCommand({"compare", folder / "captured.exr", folder / "baked.exr", "--layer", layer, "--json"}))
            .at(figure)
            .get<double>();
    };
    EXPECT_EQ(apart("direct", "mse"), 0.0);
    EXPECT_EQ(apart("diffuse_indirect", "mse"), 0.0);
    expectSentence(
        sconceCommand({"capture", "cornell-glossy", "--probes", folder / "p.json", "--live-links", "0", "-o", folder / "x.sconce"}), 2,
        "live links");
    expectSentence(sconceCommand({"bake", "cornell-glossy", "--probes", folder / "p.json", "--live-links", "8", "--compact", "-o",
                                  folder / "x.sconce"}),
                   2, "compact");

    // A pixel is not explained by light that its field doesn't have.
    const auto explained = [&](const char* field, const std::string& by) {
        return sconceCommand(
            {"explain", folder / field, "cornell-glossy", "--lights", by, "--size", "16x9", "--pixel", "8,4", "--spp", "4"});
    };
    expectSentence(explained("dark.sconce", one), 2, "captured, not lit");
    expectSentence(explained("f.sconce", other), 2, "other lights than the scene");
    const CommandResult same = explained("f.sconce", one);
    EXPECT_EQ(same.exit, 0) << same.err;

    // In the file and in the frame it is the same light, and another one than before.
    const json relit = jsonOf(sconceCommand({"relight", folder / "f.sconce", "-o", folder / "other.sconce", "--lights", other, "--json"}));
    EXPECT_EQ(relit["format_version"], 6) << "a static field has nothing of it";
    const auto drawn = [&](const std::string& field, const std::string& by, const char* picture)
    {
        return sconceCommand(
            {"render", "cornell-glossy", "--field", folder / field, "--lights", by, "--size", "64x36", "-o", folder / picture, "--json"});
    };
    const json moved = jsonOf(drawn("f.sconce", other, "moved.exr"));
    EXPECT_TRUE(moved["live_light_ms"].contains("live direct"));
    EXPECT_FALSE(jsonOf(drawn("other.sconce", other, "file.exr")).contains("live_light_ms"));
    EXPECT_FALSE(jsonOf(drawn("f.sconce", one, "before.exr")).contains("live_light_ms")) << "nothing moved";
    const auto compared = [&](const char* picture, const char* reference, const char* layer = "diffuse_indirect") {
        return jsonOf(sconceCommand({"compare", folder / picture, folder / reference, "--layer", layer, "--json"})).at("mse").get<double>();
    };
    EXPECT_EQ(compared("moved.exr", "file.exr"), 0.0);
    EXPECT_GT(compared("moved.exr", "before.exr"), 1e-6);

    // A day: a picture each, numbered.
    writeText(folder / "day.csv", "time,x,y,z,r,g,b\n6,1,-0.1,0,1,0.5,0.2\n12,0.2,-1,-0.9,4,4,4\n20,-1,0.2,0,1,0.5,0.2\n");
    const json day = jsonOf(sconceCommand({"render", "cornell-glossy", "--field", folder / "f.sconce", "--lights", one, "--sun-path",
                                           folder / "day.csv", "--frames", "3", "--size", "32x18", "-o", folder / "day.exr", "--json"}));
    ASSERT_EQ(day["pictures"].size(), 3u);
    for (const char* name : {"day-0000.exr", "day-0001.exr", "day-0002.exr"}) EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
    EXPECT_GT(compared("day-0001.exr", "day-0002.exr"), 1e-6) << "noon and night";
    EXPECT_GT(compared("day-0001.exr", "day-0002.exr", "direct"), 1e-6) << "a sun that the scene didn't have shines directly, too";

    const auto refused = [&](std::vector<std::string> more, int exit, const char* part)
    {
        more.insert(more.begin(), {"render", "cornell-glossy", "--size", "32x18", "-o", folder / "x.exr"});
        expectSentence(sconceCommand(more), exit, part);
    };
    refused({"--field", folder / "other.sconce", "--sun-path", folder / "day.csv"}, 2, "--live-links");
    // A sun that a group dims stays where it is: another beside it would be two.
    ASSERT_EQ(sconceCommand({"bake",
                             "cornell-glossy",
                             "--probes",
                             folder / "p.json",
                             "--sun",
                             "0,-1,0",
                             "--group",
                             "sun",
                             "--live-links",
                             "8",
                             "--resolution",
                             "64",
                             "--surface-texels",
                             "26",
                             "--surface-rays",
                             "16",
                             "--bounces",
                             "0",
                             "-o",
                             folder / "held.sconce",
                             "-q"})
                  .exit,
              0);
    refused({"--field", folder / "held.sconce", "--sun", "0,-1,0", "--sun-path", folder / "day.csv"}, 2, "light group");
    expectSentence(sconceCommand({"relight", folder / "held.sconce", "-o", folder / "x.sconce", "--sun", "1,-1,0"}), 2, "group 'sun'");
    writeText(folder / "bad.csv", "time,x,y,z\n1,0,-1,0\n1,0,-1,1\n");
    refused({"--field", folder / "f.sconce", "--lights", one, "--sun-path", folder / "bad.csv"}, 3, "line 3");
    refused({"--field", folder / "f.sconce", "--lights", lights("bad.json", R"({"lights":[{"type":"moon"}]})")}, 3, "'moon'");
    refused({"--field", folder / "f.sconce", "--lights", lights("bad.json", R"({"lights":[{"type":"point","intensity":[-1,0,0]}]})")}, 3,
            "intensity");
    expectSentence(sconceCommand({"relight", folder / "other.sconce", "-o", folder / "x.sconce", "--sun", "0,-1,0"}), 2, "--live-links");
    expectSentence(sconceCommand({"relight", folder / "f.sconce", "-o", folder / "x.sconce"}), 2, "nothing to change");
    expectSentence(sconceCommand({"bake", "cornell-glossy", "--probes", folder / "p.json", "--live-links", "8", "--gather", "field", "-o",
                                  folder / "x.sconce"}),
                   2, "live links");
}

TEST(Command, ReferenceAndCompareAgree)
{
    const TestFolder folder;
    const CommandResult made = sconceCommand(
        {"reference", "cornell", "-o", folder / "a.exr", "--png", folder / "a.png", "--size", "24x16", "--spp", "4", "--json"});
    ASSERT_EQ(made.exit, 0) << made.err;
    const json reference = jsonOf(made);
    EXPECT_EQ(reference.at("width"), 24);
    EXPECT_EQ(reference.at("layers").size(), 8u);
    EXPECT_GT(reference.at("exposure").get<double>(), 0.0);
    EXPECT_EQ(readText(folder / "a.png").substr(1, 3), "PNG");
    ASSERT_EQ(sconceCommand(
                  {"reference", "cornell", "-o", folder / "b.exr", "--size", "24x16", "--spp", "4", "--seed", "2", "--aov", "beauty", "-q"})
                  .exit,
              0);

    const json same = jsonOf(sconceCommand({"compare", folder / "a.exr", folder / "a.exr", "--json", "--fail-above", "flip=0"}));
    EXPECT_EQ(same.at("mse"), 0.0);
    EXPECT_TRUE(same.at("psnr").is_null()); // infinite
    const CommandResult other = sconceCommand({"compare", folder / "b.exr", folder / "a.exr", "--metric", "mse,flip", "--json", "-o",
                                               folder / "diff.png", "--side-by-side", folder / "beside.png"});
    EXPECT_EQ(other.exit, 0);
    EXPECT_GT(jsonOf(other).at("mse").get<double>(), 0.0);
    EXPECT_FALSE(jsonOf(other).contains("psnr"));
    EXPECT_EQ(readText(folder / "diff.png").substr(1, 3), "PNG");
    const auto widthOf = [](const std::string& png) { return uint8_t(png[18]) * 256 + uint8_t(png[19]); }; // big-endian, under 65,536
    EXPECT_EQ(widthOf(readText(folder / "beside.png")), 3 * widthOf(readText(folder / "diff.png")));
    EXPECT_EQ(sconceCommand({"compare", folder / "b.exr", folder / "a.exr", "--fail-above", "mse=1e-12"}).exit, 1);
    EXPECT_EQ(sconceCommand({"compare", folder / "b.exr", folder / "a.exr", "--fail-above", "psnr=500"}).exit, 1);
    EXPECT_EQ(sconceCommand({"compare", folder / "b.exr", folder / "a.exr", "--fail-above", "flip=1", "--fail-above", "mse=1e9"}).exit, 0);
    EXPECT_EQ(sconceCommand({"compare", folder / "b.exr", folder / "a.exr", "--layer", "normal"}).exit, 3);
}

TEST(Command, InterruptExitsWith130AndWritesNothing)
{
    const TestFolder folder;
    const CommandResult result = sconceCommand({"reference", "cornell", "-o", folder / "a.exr", "--size", "1920x1080", "--spp", "1000"},
                                               {.interruptWhen = "reference: "});
    EXPECT_EQ(result.exit, 130) << result.err;
    EXPECT_FALSE(result.timedOut);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path));
}

TEST(Command, QuietSaysNothingOnStderr)
{
    const TestFolder folder;
    const CommandResult result = sconceCommand({"reference", "cornell", "-o", folder / "a.exr", "--size", "8x8", "--spp", "1", "--quiet"});
    EXPECT_EQ(result.exit, 0);
    EXPECT_EQ(result.err, "");
    const CommandResult loud = sconceCommand({"reference", "cornell", "-o", folder / "a.exr", "--size", "8x8", "--spp", "1"});
    EXPECT_NE(loud.err.find("100 %"), std::string::npos);
    EXPECT_EQ(loud.err.find('\r'), std::string::npos); // no bar where there is no terminal
}
