#include "bench/sweep/guard.h"

#include <gtest/gtest.h>

#include "tests/support/files.h"

namespace sconce
{
namespace
{

Json point(double reads, double right, double bytes, double glossy)
{
    return {{"id", "ours/default"},
            {"rays", {{"reads_mean", reads}, {"right_1", right}, {"unresolved", 0.0}}},
            {"bytes", {{"total", bytes}}},
            {"error", {{"glossy", {{"relmse", glossy}}}, {"beauty", {{"relmse", 0.1}}}, {"diffuse", {{"relmse", 0.1}}}}},
            {"wrong", nullptr}};
}

std::vector<std::string> worseThan(const Json& now)
{
    const Json scene = guardedScene("room", "room.glb", Json::object(), {point(20.0, 0.98, 1000.0, 0.05)});
    return worsened(emptyGuard(), scene, {now});
}

TEST(Guard, EqualAndBetterPointsPass)
{
    EXPECT_TRUE(worseThan(point(20.0, 0.98, 1000.0, 0.05)).empty());
    EXPECT_TRUE(worseThan(point(10.0, 1.0, 10.0, 0.001)).empty());
    EXPECT_TRUE(worseThan(point(20.5, 0.9785, 1005.0, 0.054)).empty()); // within the margins
}

TEST(Guard, AWorseFigureIsNamedWithBothValues)
{
    const auto reads = worseThan(point(21.0, 0.98, 1000.0, 0.05));
    ASSERT_EQ(reads.size(), 1u);
    EXPECT_EQ(reads[0], "room, ours/default: reads is 21, worse than the baseline's 20 by more than its margin (at most 20.6).");
    for (const auto& [now, figure] : {std::pair{point(20.0, 0.97, 1000.0, 0.05), "wrong_rays"},
                                      {point(20.0, 0.98, 1020.0, 0.05), "bytes"},
                                      {point(20.0, 0.98, 1000.0, 0.06), "glossy.relmse"}})
    {
        const auto sentences = worseThan(now);
        ASSERT_EQ(sentences.size(), 1u) << figure;
        EXPECT_NE(sentences[0].find(std::string(": ") + figure + " is "), std::string::npos) << sentences[0];
    }
}

TEST(Guard, WhatIsMissingOrWrongIsWorse)
{
    Json other = point(20.0, 0.98, 1000.0, 0.05);
    other["id"] = "ours/another";
    EXPECT_EQ(worseThan(other), std::vector<std::string>{"room, ours/default: not measured; the baseline has it."});
    Json noReads = point(20.0, 0.98, 1000.0, 0.05);
    noReads["rays"].erase("reads_mean");
    EXPECT_EQ(worseThan(noReads), std::vector<std::string>{"room, ours/default: reads was not measured; the baseline has 20."});
    Json black = point(20.0, 0.98, 1000.0, 0.05);
    black["wrong"] = "black.";
    EXPECT_EQ(worseThan(black), std::vector<std::string>{"room, ours/default: black."});
    const Json wrongBefore = guardedScene("room", "room.glb", Json::object(), {black});
    EXPECT_TRUE(worsened(emptyGuard(), wrongBefore, {black}).empty()); // an opponent is no worse by being as wrong as it was
    Json infinite = point(20.0, 0.98, 1000.0, 0.05);
    infinite["error"]["glossy"]["relmse"] = nullptr; // how a picture that is not finite comes out
    EXPECT_EQ(worseThan(infinite).size(), 1u);
}

TEST(Guard, AnotherFileIsASentence)
{
    EXPECT_NE(readGuard("nowhere.json").error().message.find("nowhere.json"), std::string::npos);
    const testing_support::TestFolder folder;
    for (const char* text : {"{", "[]", "{\"guard\": \"one\"}", "{\"guard\": 1, \"margins\": [], \"scenes\": [5]}",
                             "{\"guard\": 1, \"margins\": [{\"figure\": \"reads\"}], \"scenes\": []}",
                             "{\"guard\": 1, \"margins\": [], \"scenes\": [{\"name\": \"a\", \"source\": \"a\", \"options\": {}}]}"})
    {
        testing_support::writeText(folder / "a.json", text);
        const auto refused = readGuard(folder / "a.json");
        ASSERT_FALSE(refused.ok()) << text;
        EXPECT_NE(refused.error().message.find("no baseline of version 1"), std::string::npos) << refused.error().message;
    }
}

} // namespace
} // namespace sconce
