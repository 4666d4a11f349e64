#include "runtime/scene/content_key.h"

#include <cstdio>
#include <filesystem>

#include <gtest/gtest.h>

#include "base/commit_mark.h"
#include "scene/builtin_scenes.h"
#include "tests/support/files.h"

namespace sconce
{
namespace
{

// The program that runs this test is such a build: its key is that of its file but for the commit.
TEST(ContentKey, TheKeyOfABuildIsThatOfItsProgramWithoutItsCommit)
{
    const auto build = keyOfThisBuild();
    ASSERT_TRUE(build) << build.error().message;
    const std::string program = testing_support::readText(std::filesystem::read_symlink("/proc/self/exe"));
    char key[17];
    std::snprintf(key, sizeof key, "%016llx", static_cast<unsigned long long>(keyWithoutCommit(program)));
    EXPECT_EQ(*build, key);

    const std::string mark(kCommitMark), rest(1000, 'x');
    const uint64_t one = keyWithoutCommit(rest + mark + "0123456789ab    " + rest);
    EXPECT_EQ(keyWithoutCommit(rest + mark + "ba9876543210+   " + rest), one) << "another commit";
    EXPECT_NE(keyWithoutCommit(rest + mark + "0123456789ab    y" + rest.substr(1)), one) << "another program";
    EXPECT_NE(keyWithoutCommit(rest.substr(1) + "y" + mark + "0123456789ab    " + rest), one);
    EXPECT_NO_FATAL_FAILURE(keyWithoutCommit(mark + "01")) << "cut off behind the mark";
}

TEST(ContentKey, WhatLightDependsOnCountsInASceneAndItsNameDoesNot)
{
    const auto scene = makeBuiltinScene("cornell");
    ASSERT_TRUE(scene);
    Scene renamed = *scene, moved = *scene, painted = *scene, lit = *scene;
    renamed.name = "another";
    moved.positions[0].x += 1e-6f;
    painted.materials[0].roughness += 1e-6f;
    lit.sky.x += 1e-6f;
    Scene oneSided = *scene, doubled = *scene;
    oneSided.twoSided = !oneSided.twoSided;
    doubled.materials[0].doubleSided = !doubled.materials[0].doubleSided;
    const std::string key = keyOf(*scene);
    EXPECT_EQ(keyOf(renamed), key);
    EXPECT_NE(keyOf(moved), key);
    EXPECT_NE(keyOf(painted), key);
    EXPECT_NE(keyOf(lit), key);
    EXPECT_NE(keyOf(oneSided), key);
    EXPECT_NE(keyOf(doubled), key);
    Scene glass = *scene, bumped = *scene, flatter = *scene;
    glass.materials[0].blended = true;
    bumped.materials[0].normalTexture.image = 0;
    flatter.materials[0].normalStrength = 0.5f;
    Scene sign = *scene;
    sign.materials[0].retroreflective = true;
    for (const Scene* other : {&glass, &bumped, &flatter, &sign}) EXPECT_NE(keyOf(*other), key);
}

// XXH3_64bits("") and its like of the algorithm's published test vectors: nothing added, and the same bytes in one piece or many.
TEST(ContentKey, AHashIsThatOfAllBytesHoweverTheyWereCut)
{
    EXPECT_EQ(keyText(ContentHash().value()), "2d06800538d394c2");
    const std::string text(1000, 'x');
    ContentHash whole, pieces;
    whole.addBytes(std::as_bytes(std::span(text)));
    for (const char& letter : text) pieces.add(letter);
    EXPECT_EQ(whole.value(), pieces.value());
    ContentHash one, other; // "ab" + "c" isn't "a" + "bc"
    one.addText("ab"), one.addText("c");
    other.addText("a"), other.addText("bc");
    EXPECT_NE(one.value(), other.value());
}

} // namespace
} // namespace sconce
