#include "bench/sweep/keys.h"

#include <set>

#include <gtest/gtest.h>

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
