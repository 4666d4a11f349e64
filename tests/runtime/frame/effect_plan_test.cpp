// Which effects a plan has: what the scene calls for, what the host asks for, and what it gives up.
#include <gtest/gtest.h>

#include "runtime/frame/effect_plan.h"
#include "scene/builtin_scenes.h"

namespace sconce
{
namespace
{

EffectPlan planOf(const char* scene, const char* wanted)
{
    const auto plan = planEffects(checkScene(*makeBuiltinScene(scene)), wanted);
    EXPECT_TRUE(plan) << plan.error().message;
    return plan ? *plan : EffectPlan{};
}

TEST(EffectPlan, AutoIsWhatTheSceneCallsFor)
{
    const EffectPlan diffuse = planOf("cornell", "auto");
    EXPECT_TRUE(diffuse.on("diffuse") && diffuse.on("rough") && diffuse.on("emitters"));
    EXPECT_FALSE(diffuse.on("glossy") || diffuse.on("mirror") || diffuse.on("denoise") || diffuse.on("sun") || diffuse.on("sky"));
    EXPECT_FALSE(diffuse.needsRadiance());
    EXPECT_TRUE(diffuse.indirect().tiles);
    const EffectPlan town = planOf("town", "auto");
    EXPECT_TRUE(town.on("sun") && town.on("sky") && town.on("glossy") && town.on("mirror") && town.on("denoise"));
    EXPECT_TRUE(town.needsRadiance());
    for (const PlannedEffect& effect : town.effects)
    {
        EXPECT_EQ(effect.on, effect.called) << effect.name;
        EXPECT_FALSE(effect.why.empty() || effect.cost.empty()) << effect.name;
    }
}

TEST(EffectPlan, AllIsEverythingOverTheWholePicture)
{
    const EffectPlan plan = planOf("cornell", "all");
    for (const PlannedEffect& effect : plan.effects) EXPECT_TRUE(effect.on) << effect.name;
    EXPECT_FALSE(plan.indirect().tiles);
}

TEST(EffectPlan, AListIsTakenAsItIsAndAMinusTakesAway)
{
    const EffectPlan list = planOf("town", "diffuse,mirror");
    for (const PlannedEffect& effect : list.effects)
        EXPECT_EQ(effect.on, effect.ofScene ? effect.called : effect.name == "diffuse" || effect.name == "mirror") << effect.name;
    const EffectPlan less = planOf("town", "auto,-mirror");
    EXPECT_TRUE(less.called("mirror"));
    EXPECT_FALSE(less.on("mirror"));
    EXPECT_TRUE(less.on("glossy"));
    EXPECT_FALSE(less.effects[7].givenUp.empty()) << less.effects[7].name;
    for (const PlannedEffect& effect : planOf("town", "none").effects) EXPECT_EQ(effect.on, effect.ofScene && effect.called);
    const EffectPlan noSun = planOf("town", "diffuse,sky");
    EXPECT_TRUE(noSun.on("sky") && noSun.on("thin-two-sided") == noSun.called("thin-two-sided"));
    EXPECT_FALSE(noSun.on("sun") || noSun.on("emitters")) << "of the lights only what is named";
}

TEST(EffectPlan, AnUnknownNameIsRefusedWithTheKnownOnes)
{
    const auto plan = planEffects(checkScene(*makeBuiltinScene("cornell")), "glossy,sparkle");
    ASSERT_FALSE(plan);
    EXPECT_NE(plan.error().message.find("'sparkle'"), std::string::npos);
    EXPECT_NE(plan.error().message.find("thin-two-sided"), std::string::npos);
}

TEST(EffectPlan, TheRoughnessThatRaysEndAtDecidesWhatIsCalledFor)
{
    const Scene scene = *makeBuiltinScene("cornell-glossy"); // roughness 0.1 to 0.3
    EXPECT_TRUE(planEffects(checkScene(scene, 0.4f))->on("glossy"));
    EXPECT_FALSE(planEffects(checkScene(scene, 0.0f))->on("glossy")) << "all from prefiltered radiance";
    EXPECT_TRUE(planEffects(checkScene(scene, 0.0f))->on("rough"));
}

} // namespace
} // namespace sconce
