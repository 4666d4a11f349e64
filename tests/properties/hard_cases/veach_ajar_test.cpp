// A dark room behind a door that stands ajar: all its light comes from the next room through the gap. Too much of it would be a leak
// through walls or door, too little a gap that the probes miss.
#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "bench/reference/reference.h"
#include "placement/place.h"
#include "scene/scene_gltf.h"
#include "tests/properties/frames/frame_test.h"
#include "tests/properties/hard_cases/hard_case.h"
#include "tests/properties/hard_cases/hard_frames.h"
#include "tests/support/files.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr uint32_t kWidth = 64, kHeight = 36, kBlock = 4; // pixels; a block's side
constexpr uint32_t kBounces = 3;

/// Means of all channels over blocks of a picture: the truth's noise is averaged away.
std::vector<double> blocksOf(const float* rgb)
{
    std::vector<double> blocks(size_t(kWidth / kBlock) * (kHeight / kBlock));
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x)
            for (int c = 0; c < 3; ++c)
                blocks[size_t(y / kBlock) * (kWidth / kBlock) + x / kBlock] += double(rgb[3 * (size_t(y) * kWidth + x) + c]);
    for (double& block : blocks) block /= 3.0 * kBlock * kBlock;
    return blocks;
}

class VeachAjar : public FrameTest
{
};

TEST_F(VeachAjar, TheDarkRoomHasTheLightOfTheTruth)
{
    const auto file = testing_support::scenesFolder() / "veach_ajar" / "veach_ajar.glb";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "the scene veach_ajar is missing; set SCONCE_SCENES";
    const auto scene = loadGltf(file);
    ASSERT_TRUE(scene) << scene.error().message;
    PlaceSettings place; // else the product's
    place.count = 24;
    PlaceReport placed;
    const auto probes = placeProbes(*scene, place, placed);
    ASSERT_TRUE(probes) << probes.error().message;
    std::vector<vec3> positions;
    for (const PlacedProbe& probe : probes->probes) positions.push_back(probe.position);
    const auto field = bakeByTriangles(*scene, positions, bakeOf(128, kBounces, kFewTexels, knobs::surfaceRays.value));
    ASSERT_TRUE(field) << field.error().message;

    RenderSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.glossyRays = 16;
    settings.areaSamples = 64;
    const auto frame = drawWith(*field, *scene, settings);
    ASSERT_TRUE(frame) << frame.error().message;
    ReferenceSettings reference;
    reference.width = kWidth;
    reference.height = kHeight;
    reference.samples = 768;
    reference.bounces = kBounces;
    reference.pixelCentre = true;
    reference.camera = scene->cameras.at(0); // in the dark room, at its wall, the door and the lit strip behind the gap
    reference.guides = false;
    const auto traced = renderReference(*scene, reference);
    ASSERT_TRUE(traced) << traced.error().message;
    const auto ours = blocksOf(&frame->diffuseIndirect[0].x), truth = blocksOf(traced->images.find("diffuse_indirect")->pixels.data());

    auto sorted = truth;
    std::erase_if(sorted, [](double light) { return light <= 0.0; }); // metal
    std::ranges::sort(sorted);
    const double middle = sorted[sorted.size() / 2];
    double all = 0.0, allTruth = 0.0, dark = 0.0, darkTruth = 0.0;
    size_t brighter = 0, blocks = 0;
    for (size_t i = 0; i < ours.size(); ++i)
    {
        all += ours[i], allTruth += truth[i];
        if (truth[i] <= 0.0 || truth[i] > middle) continue;
        dark += ours[i], darkTruth += truth[i];
        ++blocks;
        brighter += ours[i] > 2.0 * truth[i] && ours[i] - truth[i] > 0.1 * middle;
    }
    // Asked: 0.1. Found: 0.001 short of the truth, 0.024 beyond it in the darker half, and no such block.
    expectAtMost("veach_ajar: indirect light, ours beyond the truth, relative", frame->beauty.size(), all / allTruth - 1.0, 0.03);
    expectAtMost("veach_ajar: indirect light, ours short of the truth, relative", frame->beauty.size(), 1.0 - all / allTruth, 0.03);
    expectAtMost("veach_ajar, darker half: indirect light, ours beyond the truth, relative", blocks * kBlock * kBlock,
                 dark / darkTruth - 1.0, 0.06);
    expectAtMost("veach_ajar, darker half: indirect light, ours short of the truth, relative", blocks * kBlock * kBlock,
                 1.0 - dark / darkTruth, 0.06);
    expectAtMost("veach_ajar, darker half: share of blocks of over twice the truth's light", blocks, double(brighter) / double(blocks),
                 0.016); // one
}

} // namespace
} // namespace sconce
