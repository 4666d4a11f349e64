#include "tools/view/live_knobs.h"

#include <set>

#include <gtest/gtest.h>

using namespace sconce;
using namespace sconce::tools;

namespace
{

const LiveKnob& knob(std::string_view name)
{
    for (const LiveKnob& known : liveKnobs())
        if (known.row.name == name) return known;
    ADD_FAILURE() << name;
    return liveKnobs().front();
}

} // namespace

// Every knob of a frame and of the tracer that `sconce knobs` lists can be set while it is drawn.
TEST(LiveKnobs, AreAllOfTheFrameAndTheTracer)
{
    std::set<std::string_view> live;
    for (const LiveKnob& known : liveKnobs()) EXPECT_TRUE(live.insert(known.row.name).second) << known.row.name;
    const std::set<std::string_view> fixed = {"IndirectLight::Desc::width", "IndirectLight::Desc::height"}; // the window's
    for (const KnobRow& row : knobRows())
    {
        const bool ofFrame = row.member.starts_with("FrameView::") || row.member.starts_with("IndirectEffects::") ||
                             row.member.starts_with("IndirectLight::Desc::") || row.member.starts_with("Quality::") ||
                             row.name == "areaSamples" || row.name == "roughness"; // of the command's own light and materials
        EXPECT_TRUE(!ofFrame || fixed.contains(row.member) || live.contains(row.name)) << row.member;
    }
}

TEST(LiveKnobs, BeginAtTheDefaultsOfTheLibrary)
{
    const ViewKnobs fresh;
    EXPECT_EQ(knob("exposure").get(fresh), "default");
    EXPECT_EQ(knob("diffuse").get(fresh), "default");
    EXPECT_EQ(knob("areaSamples").get(fresh), "default");
    EXPECT_EQ(knob("roughness").get(fresh), "default");
    EXPECT_EQ(knob("denoise").get(fresh), "on");
    EXPECT_EQ(knob("temporal").get(fresh), "off");
    EXPECT_EQ(knob("screenTrace").get(fresh), "off");
    EXPECT_EQ(knob("raysBelow").get(fresh), knobText(knobs::raysBelow.value));
    EXPECT_EQ(knob("ranked").get(fresh), knobText(knobs::ranked.value));
}

TEST(LiveKnobs, WhatIsSetIsReadAndChangesNothingElse)
{
    const std::pair<const char*, const char*> values[] = {
        {"exposure", "2.5"},       {"glossyRays", "4"},    {"diffuse", "traced"},  {"areaShadows", "field"},
        {"areaSamples", "32"},     {"surfaceProbes", "1"}, {"traceEvery", "8"},    {"raysBelow", "0.7"},
        {"roughness", "0"},        {"denoise", "off"},     {"temporal", "on"},     {"screenTrace", "on"},
        {"normalOffset", "0.001"}, {"seed", "4000000000"}, {"ranked", "2"},        {"opinion", "0.01"},
        {"maxHandoffs", "0"},      {"startLevel", "6"},    {"coarsestLevel", "2"}, {"tolerance", "0.5"},
        {"epsilon", "0.001"},      {"farBounds", "1"},     {"order", "3"}};
    EXPECT_EQ(std::size(values), liveKnobs().size());
    for (const auto& [name, value] : values)
    {
        ViewKnobs set;
        EXPECT_EQ(setKnob(set, name, value), "") << name;
        for (const LiveKnob& other : liveKnobs())
            EXPECT_EQ(other.get(set), other.row.name == name ? value : other.get(ViewKnobs())) << name << ", " << other.row.name;
        EXPECT_EQ(setKnob(set, name, "default"), "") << name;
        EXPECT_EQ(knob(name).get(set), knob(name).get(ViewKnobs())) << name;
    }
}

TEST(LiveKnobs, AWrongValueIsNamedAndChangesNothing)
{
    const std::pair<const char*, const char*> faults[] = {
        {"glossyRays", "0"}, {"glossyRays", "65"}, {"glossyRays", "2.5"}, {"raysBelow", "nan"}, {"raysBelow", "-1"},
        {"raysBelow", ""},   {"traceEvery", "3"},  {"diffuse", "magic"},  {"temporal", "yes"},  {"denoise", "1"},
        {"exposure", "0"},   {"roughness", "1.5"}, {"startLevel", "5"},   {"epsilon", "1e400"}, {"ranked", "4x"}};
    for (const auto& [name, value] : faults)
    {
        ViewKnobs set;
        const std::string fault = setKnob(set, name, value);
        EXPECT_NE(fault.find(std::string(name) + " is '" + value + "'; give "), std::string::npos) << name << ": " << fault;
        EXPECT_EQ(knob(name).get(set), knob(name).get(ViewKnobs())) << name;
    }
    ViewKnobs set;
    EXPECT_NE(setKnob(set, "colour", "1").find("there is no knob 'colour' to set; there are exposure, glossyRays"), std::string::npos);
}

TEST(LiveKnobs, AnEffectIsSwitchedOffAndOnAgain)
{
    EffectPlan plan;
    const auto add = [&](const char* name, bool called, bool on) -> PlannedEffect&
    {
        PlannedEffect& effect = plan.effects.emplace_back();
        effect.name = name;
        effect.called = called;
        effect.on = on;
        return effect;
    };
    add("diffuse", true, true);
    add("mirror", false, false).why = "No surface is a mirror.";
    add("glossy", true, false);
    add("sun", true, true).ofScene = true;
    const auto off = effectsWith(plan, "sun", false);
    ASSERT_TRUE(off);
    EXPECT_EQ(*off, "auto,-glossy,-sun");
    const auto on = effectsWith(plan, "glossy", true);
    ASSERT_TRUE(on);
    EXPECT_EQ(*on, "auto");
    const auto uncalled = effectsWith(plan, "mirror", true);
    ASSERT_FALSE(uncalled);
    EXPECT_NE(uncalled.error().message.find("No surface is a mirror."), std::string::npos);
    const auto unknown = effectsWith(plan, "fog", false);
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message.find("There is no effect 'fog'; there are diffuse, mirror, glossy, sun."), std::string::npos);
}
