#include "base/knobs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/files.h"

namespace sconce
{
namespace
{

TEST(Knobs, EveryOneOfTheHeaderIsARowOfItsOwn)
{
    const std::string header = testing_support::readText(SCONCE_SOURCES "/base/knobs.h");
    size_t defined = 0;
    for (size_t at = 0; (at = header.find("inline constexpr Knob<", at)) != std::string::npos; ++at) ++defined;
    EXPECT_EQ(knobRows().size(), defined);
    std::set<std::string> names;
    for (const KnobRow& row : knobRows())
    {
        EXPECT_FALSE(row.option.empty() && row.member.empty()) << row.name << " can't be set anywhere";
        EXPECT_TRUE(names.insert(std::string(row.option) + " " + std::string(row.member)).second) << row.option << " " << row.member;
        EXPECT_FALSE(row.byDefault.empty() || row.range.empty() || row.what.empty()) << row.name;
        EXPECT_TRUE(!row.readme || !row.buys.empty()) << row.name;
    }
}

// What the README's table names, a host finds in what it includes.
TEST(Knobs, MembersOfTheReadmesTableAreTheHosts)
{
    std::string included;
    for (const char* file : {"/runtime/sconce.h", "/runtime/frame/effect_plan.h", "/runtime/field/quality.h", "/shaders/shared/frame.h",
                             "/shaders/shared/light_field.h"})
        included += testing_support::readText(std::string(SCONCE_SOURCES) + file);
    int named = 0;
    for (const KnobRow& row : knobRows())
    {
        if (!row.readme || row.member.empty()) continue;
        ++named;
        std::string path(row.member.substr(0, row.member.find(',')));
        if (path.starts_with("Quality::trace.")) path.replace(0, std::string_view("Quality::trace.").size(), "TraceQuality::");
        size_t begin = 0, end = std::string::npos;
        for (size_t colons; (colons = path.find("::")) != std::string::npos; path.erase(0, colons + 2))
        {
            const std::string owner = path.substr(0, colons) + "\n";
            begin = std::min(included.find("struct " + owner, begin), included.find("class " + owner, begin));
            ASSERT_LT(begin, end) << row.member;
            if (end == std::string::npos) end = included.find("\n};", begin);
        }
        const std::string inside = included.substr(begin, end - begin);
        const bool declared = std::ranges::any_of(std::array{" =", ";", ",", "("},
                                                  [&](const char* then) { return inside.find(" " + path + then) != std::string::npos; });
        EXPECT_TRUE(declared) << row.member;
    }
    EXPECT_GT(named, 12);
}

TEST(Knobs, AValueOutOfRangeIsASentence)
{
    EXPECT_EQ(faultOf(knobs::bounces, 64), "");
    EXPECT_EQ(faultOf(knobs::bounces, 65), "bounces is 65; give 0 to 64 bounces");
    EXPECT_EQ(faultOf(knobs::glossyRays, 65), "glossyRays is 65; give 1 to 64 rays a pixel");
    EXPECT_EQ(faultOf(knobs::traceEvery, 3), "traceEvery is 3; give 1, 2, 4, 8, 16 pixels");
    EXPECT_EQ(faultOf(knobs::placement, "anywhere"), "placement is anywhere; give optimised, skeleton, balls, grid");
    EXPECT_NE(faultOf(knobs::coverage, NAN).find("coverage is nan"), std::string::npos);
    EXPECT_NE(faultOf(knobs::light, INFINITY), "");
    EXPECT_EQ(firstFault({"", "a", "b"}), "a");
    EXPECT_EQ(firstFault({}), "");
}

// 0 stands for what is derived: structs begin with it, and nobody types it.
TEST(Knobs, ADerivedDefaultIsAllowedOutsideOfTheRange)
{
    EXPECT_TRUE(knobs::count.allows(0));
    EXPECT_FALSE(knobs::count.inRange(0));
    EXPECT_TRUE(knobs::octreeVoxels.allows(0));
    EXPECT_FALSE(knobs::octreeVoxels.allows(4));
}

// Words that name another knob's number go with it.
TEST(Knobs, NumbersInWordsAreThoseOfTheirKnobs)
{
    const auto expectPart = [](std::string_view words, const std::string& part)
    { EXPECT_NE(words.find(part), std::string_view::npos) << part << ": " << words; };
    expectPart(knobs::count.inWords, "for a grid " + knobText(knobs::kGridCount));
    expectPart(knobs::areaShadows.buys, "by " + knobText(knobs::emitterSamples.value) + " and " + knobText(knobs::skySamples.value));
    expectPart(knobs::areaShadows.buys, knobText(knobs::tracedLightSamples.value) + " of either");
    expectPart(knobs::areaSamples.inWords, knobText(knobs::areaSamples.value) + " for each of --samples, " +
                                               knobText(knobs::kTracedAreaSamples) + " with --area-shadows field");
    expectPart(knobs::octreeVoxels.inWords, "to " + knobText(knobs::octreeVoxels.most));
}

TEST(Knobs, AreSpelledAsPeopleDo)
{
    EXPECT_EQ(defaultText(knobs::coverage), "0.995");
    EXPECT_EQ(rangeText(knobs::epsilon), "0 to 0.01 diagonals");
    EXPECT_EQ(rangeText(knobs::placeSeed), "0 to 2^64-1");
    EXPECT_EQ(rangeText(knobs::frameSeed), "0 to 2^32-1");
    EXPECT_EQ(rangeText(knobs::light), "0 or more");
    EXPECT_EQ(rangeText(knobs::exposure), "1e-6 to 1e6");
    EXPECT_EQ(rangeText(knobs::goalTime), "above 0 milliseconds");
    EXPECT_EQ(rangeText(knobs::temporal), "on, off");
    EXPECT_EQ(rangeText(knobs::resolution), "64 to 2048 texels, multiple of 32, or of 16 with octahedral maps");
}

} // namespace
} // namespace sconce
