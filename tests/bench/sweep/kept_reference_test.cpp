#include "bench/sweep/kept_reference.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "bench/sweep/keys.h"
#include "scene/builtin_scenes.h"
#include "tests/support/files.h"

namespace sconce
{
namespace
{

using testing_support::TestFolder;

class KeptReference : public testing::Test
{
protected:
    KeptReference() : scene(*makeBuiltinScene("cornell")), rays(std::move(*RayScene::create(scene))), key(keyOf(scene))
    {
        settings.width = 16, settings.height = 9;
        settings.samples = 8;
        settings.parts = settings.pixelCentre = true;
        settings.camera = scene.cameras.at(0);
    }
    Result<Reference> kept(double until, uint64_t& paths, const Progress& progress = {}) const
    {
        auto found = keptReference(rays, key, settings, {folder / "references", until}, progress);
        if (!found) return found.error();
        paths = found->paths;
        return std::move(found->reference);
    }
    size_t files() const
    {
        size_t count = 0;
        for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator(folder / "references")) ++count;
        return count;
    }
    TestFolder folder;
    Scene scene;
    RayScene rays;
    std::string key;
    ReferenceSettings settings;
};

const Progress kRefuses = [](std::string_view, double) { return false; };

TEST_F(KeptReference, TwoPicturesJoinedAreOneOfAllTheirPaths)
{
    ReferenceSettings more = settings, rest = settings;
    more.samples = 24;
    rest.samples = 16, rest.firstPath = 8;
    const auto whole = renderReference(rays, more), first = renderReference(rays, settings), second = renderReference(rays, rest);
    ASSERT_TRUE(whole && first && second);
    const Reference all = joined(*first, 8, *second, 16);
    ASSERT_EQ(all.images.layers.size(), whole->images.layers.size());
    for (size_t l = 0; l < all.images.layers.size(); ++l)
    {
        const Layer &a = all.images.layers[l], &b = whole->images.layers[l];
        if (a.name == "normal") continue; // of the first: none is better
        for (size_t i = 0; i < a.pixels.size(); ++i) ASSERT_NEAR(a.pixels[i], b.pixels[i], 2e-5f + 2e-5f * std::abs(b.pixels[i])) << a.name;
    }
}

TEST_F(KeptReference, AddsPathsUntilItsNoiseIsSmallEnough)
{
    uint64_t paths = 0;
    const auto once = kept(0.0, paths);
    ASSERT_TRUE(once);
    EXPECT_EQ(paths, 8u);
    const double before = once->estimatedRelMseDiffuse, until = before / 6.0;
    const auto more = kept(until, paths);
    ASSERT_TRUE(more);
    EXPECT_GE(paths, 32u);
    EXPECT_LE(paths, 128u);
    EXPECT_LE(more->estimatedRelMseDiffuse, until);
    EXPECT_EQ(files(), 2u) << "a picture and what it is of";
    // Asked again it is there: nobody has to wait.
    uint64_t again = 0;
    const auto same = kept(until, again, kRefuses);
    ASSERT_TRUE(same) << same.error().message;
    EXPECT_EQ(again, paths);
    EXPECT_EQ(same->images.find("beauty")->pixels, more->images.find("beauty")->pixels);
    settings.seed += 1;
    EXPECT_FALSE(kept(until, again, kRefuses)) << "other paths are another picture";
}

TEST_F(KeptReference, GoesOnWhereItWasInterrupted)
{
    uint64_t paths = 0;
    int batches = 0; // of 8, 8 and 16 paths
    const auto stopped = kept(1e-6, paths,
                              [&, last = 1.0](std::string_view, double done) mutable
                              {
                                  if (std::exchange(last, done) > 0.9 && done < 0.5) ++batches;
                                  return batches < 3;
                              });
    ASSERT_FALSE(stopped.ok());
    EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
    uint64_t before = 0;
    ASSERT_TRUE(kept(1.0, before, kRefuses)) << "two batches are kept";
    EXPECT_EQ(before, 16u);
    // What isn't whole is traced again, not believed.
    for (const auto& file : std::filesystem::directory_iterator(folder / "references"))
        if (file.path().extension() == ".exr") std::filesystem::resize_file(file.path(), 100);
    EXPECT_FALSE(kept(1.0, before, kRefuses).ok());
    ASSERT_TRUE(kept(0.0, before));
    EXPECT_EQ(before, 8u);
    settings.samples = 6;
    EXPECT_EQ(kept(0.0, before).error().code, ErrorCode::badArgument);
    settings.samples = 1, settings.parts = false;
    EXPECT_EQ(kept(0.0, before).error().code, ErrorCode::badArgument) << "its noise isn't known";
}

} // namespace
} // namespace sconce
