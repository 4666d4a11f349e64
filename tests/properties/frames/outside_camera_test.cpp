// A camera may stand outside of the scene's box: what it sees of the scene is lit as for any other.
#include <gtest/gtest.h>

#include "bench/reference/metrics.h"
#include "bench/reference/reference.h"
#include "placement/place.h"
#include "scene/builtin_scenes.h"
#include "tests/properties/frames/frame_test.h"

namespace sconce
{
namespace
{

using OutsideCamera = testing_support::FrameTest;

TEST_F(OutsideCamera, SeesOpenGroundInTheLightOfTheTruth)
{
    Scene scene = *makeBuiltinScene("plain");
    Camera& camera = scene.cameras.front();
    camera.eye = {140.0f, 60.0f, 140.0f};
    camera.forward = glm::normalize(-camera.eye);
    camera.up = glm::normalize(vec3(0.0f, 1.0f, 0.0f) - camera.forward.y * camera.forward);
    ASSERT_GT(camera.eye.x, scene.bounds().high.x);
    ASSERT_GT(camera.eye.y, scene.bounds().high.y);
    PlaceSettings place;
    place.count = 24;
    place.voxels = 1u << 20;
    place.candidates = 800;
    place.surfels = place.refineSurfels = 8000;
    place.open.ground = 2.0f;
    place.inside = {{0.0f, 2.5f, 0.0f}};
    PlaceReport report;
    const auto probes = placeProbes(scene, place, report);
    ASSERT_TRUE(probes) << probes.error().message;
    std::vector<vec3> positions;
    for (const PlacedProbe& probe : probes->probes) positions.push_back(probe.position);
    const auto field = bakeField(scene, positions, 128, 2, 52);
    ASSERT_TRUE(field) << field.error().message;
    const auto frame = drawWith(*field, scene, settingsOf(96));
    ASSERT_TRUE(frame) << frame.error().message;

    ReferenceSettings reference;
    reference.width = reference.height = 96;
    reference.samples = 128;
    reference.bounces = 2;
    reference.pixelCentre = reference.parts = true;
    reference.camera = camera;
    const auto truth = renderReference(scene, reference);
    ASSERT_TRUE(truth) << truth.error().message;
    ImageSet ours{frame->width, frame->height, {}};
    const float* first = &frame->diffuseIndirect[0].x;
    ours.add("diffuse_indirect", 3).pixels.assign(first, first + 3 * frame->diffuseIndirect.size());
    CompareSettings compare;
    compare.layer = "diffuse_indirect";
    const auto compared = compareImages(ours, truth->images, compare);
    ASSERT_TRUE(compared) << compared.error().message;
    RecordProperty("mean, relMSE", std::to_string(*compared->mean) + " " + std::to_string(*compared->relMse));
    EXPECT_NEAR(*compared->mean, 1.0, 0.01);
    EXPECT_LT(*compared->relMse, 0.001);
    const size_t seen = size_t(std::ranges::count_if(frame->depth, [](float depth) { return depth > 0.0f; }));
    EXPECT_GT(seen, frame->depth.size() / 10);
}

} // namespace
} // namespace sconce
