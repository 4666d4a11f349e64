#include "bench/sweep/keys.h"

#include <cstdio>
#include <set>

#include <gtest/gtest.h>

#include "base/commit_mark.h"
#include "bench/sweep/settings.h"
#include "scene/builtin_scenes.h"
#include "tests/support/files.h"

namespace sconce
{
namespace
{

using testing_support::TestFolder;
using testing_support::writeText;

// XXH3_64bits("") of the algorithm's published test vectors (Collet, xxHash specification): seed 0, no input.
TEST(Keys, AnEmptyFileHasThePublishedHashOfNothing)
{
    const TestFolder folder;
    writeText(folder / "empty", "");
    const auto key = keyOfFile(folder / "empty");
    ASSERT_TRUE(key);
    EXPECT_EQ(*key, "2d06800538d394c2");
}

TEST(Keys, AnyByteOfAFileCounts)
{
    const TestFolder folder;
    std::string text(3000000, 'x'); // more than is read at once
    std::set<std::string> keys;
    for (const size_t place : {size_t(0), size_t(1048575), size_t(1048576), text.size() - 1})
    {
        std::string changed = text;
        changed[place] = 'y';
        writeText(folder / "a", changed);
        keys.insert(*keyOfFile(folder / "a"));
    }
    writeText(folder / "a", text);
    keys.insert(*keyOfFile(folder / "a"));
    EXPECT_EQ(keys.size(), 5u);
    const auto missing = keyOfFile(folder / "none");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::fileError);
}

// The program that runs this test is such a build: its key is that of its file but for the commit.
TEST(Keys, TheKeyOfABuildIsThatOfItsProgramWithoutItsCommit)
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

TEST(Keys, WhatLightDependsOnCountsInASceneAndItsNameDoesNot)
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
    for (const Scene* other : {&glass, &bumped, &flatter}) EXPECT_NE(keyOf(*other), key);
}

TEST(Keys, TellScenesAndSettingsApart)
{
    Scene scene = *makeBuiltinScene("cornell");
    const std::string key = keyOf(scene);
    EXPECT_EQ(key, keyOf(*makeBuiltinScene("cornell")));
    scene.lights.push_back({});
    EXPECT_NE(key, keyOf(scene));
    scene = *makeBuiltinScene("cornell");
    scene.materials.back().roughness += 0.01f;
    EXPECT_NE(key, keyOf(scene));
    scene = *makeBuiltinScene("cornell");
    scene.name = "another name";
    EXPECT_EQ(key, keyOf(scene));
    EXPECT_NE(keyOf(Json{{"rays", 1}}), keyOf(Json{{"rays", 2}}));
}

} // namespace
} // namespace sconce
