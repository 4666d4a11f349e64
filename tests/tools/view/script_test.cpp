#include "tools/view/script.h"

#include <gtest/gtest.h>

#include "tests/support/files.h"

using namespace sconce;
using namespace sconce::tools;

TEST(ViewerScript, EveryCommandIsUnderstood)
{
    const auto steps = parseScript("# a script\n"
                                   "camera 1,2,3 -1,+0.5,1e2   # eye, target\n"
                                   "\n"
                                   "set raysBelow 0.5\r\n"
                                   "effect mirror off\n"
                                   "effects auto,-sun\n"
                                   "view depth\n"
                                   "compare split 64\n"
                                   "compare off\n"
                                   "sun 0,-1,0\n"
                                   "sun 0,-2,0.5 3,2,1\n"
                                   "dim lamp 0.5\n"
                                   "panel on\n"
                                   "frame 16\n"
                                   "shot a.exr\n"
                                   "screen b.png\n"
                                   "quit",
                                   "s");
    ASSERT_TRUE(steps) << steps.error().message;
    ASSERT_EQ(steps->size(), 15u);
    const auto& all = *steps;
    EXPECT_EQ(all[0].command, ScriptCommand::camera);
    EXPECT_EQ(all[0].line, 2u);
    EXPECT_EQ(all[0].eye, vec3(1, 2, 3));
    EXPECT_EQ(all[0].target, vec3(-1, 0.5f, 100));
    EXPECT_EQ(all[1].line, 4u);
    EXPECT_EQ(all[1].words, (std::vector<std::string>{"raysBelow", "0.5"}));
    EXPECT_FALSE(all[2].on);
    EXPECT_EQ(all[5].command, ScriptCommand::compare);
    EXPECT_EQ(all[5].count, 64u);
    EXPECT_EQ(all[6].count, 1u);
    EXPECT_FALSE(all[7].on); // the sun keeps its light
    EXPECT_TRUE(all[8].on);
    EXPECT_EQ(all[8].target, vec3(3, 2, 1));
    EXPECT_TRUE(all[10].on);
    EXPECT_EQ(all[11].count, 16u);
    EXPECT_EQ(all[14].command, ScriptCommand::quit);
}

TEST(ViewerScript, FaultsNameTheLineAndWhatIsRight)
{
    const std::pair<const char*, const char*> faults[] = {
        {"fly 1", "there is no command 'fly'; there are camera, set,"},
        {"camera 1,2,3", "camera has 1 words after it; write camera X,Y,Z X,Y,Z"},
        {"camera 1,2 0,0,0", "'1,2' is not three numbers"},
        {"camera 1,2,3,4 0,0,0", "'1,2,3,4' is not three numbers"},
        {"camera 1,2,nan 0,0,0", "'1,2,nan' is not three numbers"},
        {"camera 1,2,3 1,2,3", "the same point"},
        {"effect mirror maybe", "'maybe' is neither on nor off"},
        {"frame 0", "'0' is not a whole number from 1 to"},
        {"frame -3", "'-3' is not a whole number"},
        {"frame 999999999999", "is not a whole number"},
        {"compare split many", "'many' is not a whole number"},
        {"shot picture.jpg", "'picture.jpg' doesn't end as its kind of picture does; write shot FILE.exr or shot FILE.png"},
        {"screen a.exr", "'a.exr' doesn't end"},
        {"sun 0,0,0", "the sun has no direction"},
        {"sun 0,-1,0 1,-1,1", "light is negative"},
        {"quit now", "quit has 1 words"},
    };
    for (const auto& [line, part] : faults)
    {
        const auto steps = parseScript(std::string("panel off\n\n") + line + "\nquit\n", "some.txt");
        ASSERT_FALSE(steps) << line;
        EXPECT_EQ(steps.error().code, ErrorCode::badInput);
        EXPECT_NE(steps.error().message.find("The script 'some.txt', line 3: "), std::string::npos) << steps.error().message;
        EXPECT_NE(steps.error().message.find(part), std::string::npos) << steps.error().message;
        EXPECT_TRUE(steps.error().message.ends_with(".")) << steps.error().message;
    }
}

TEST(ViewerScript, AFileThatIsNotThereIsASentence)
{
    const auto steps = readScript("/nowhere/script.txt");
    ASSERT_FALSE(steps);
    EXPECT_EQ(steps.error().code, ErrorCode::fileError);
    EXPECT_NE(steps.error().message.find("/nowhere/script.txt"), std::string::npos);
    const testing_support::TestFolder folder;
    testing_support::writeText(folder / "s.txt", "frame 2\n");
    const auto read = readScript(folder / "s.txt");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->size(), 1u);
}

// Whatever the bytes, there are steps or a sentence.
TEST(ViewerScript, AnyBytesGiveStepsOrASentence)
{
    uint32_t random = 1;
    for (int round = 0; round < 2000; ++round)
    {
        std::string text = round % 2 == 0 ? "camera 0,0,0 1,1,1\nframe 5\nset a b\nsun 1,1,1 1,1,1\n" : "";
        for (int i = 0; i < 24; ++i)
        {
            random = random * 1664525u + 1013904223u;
            const char byte = char(random >> 24);
            if (text.empty() || random % 3 == 0)
                text += byte;
            else
                text[(random >> 8) % text.size()] = byte;
        }
        const auto steps = parseScript(text, "bytes");
        EXPECT_TRUE(steps || !steps.error().message.empty());
    }
}
