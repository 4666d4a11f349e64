// The coverage that a placement reports, measured again without a line of placement's code: Embree called directly, another random number
// generator, and free space found by walking through it from a camera instead of by a distance field.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include <embree3/rtcore.h>
#include <gtest/gtest.h>

#include "placement/place.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_gltf.h"
#include "tests/support/files.h"

namespace sconce
{
namespace
{

/// Triangles in Embree; texels below the alpha cutoff and clear materials are passed through one hit at a time.
class Caster
{
public:
    explicit Caster(const Scene& traced) : scene(traced), device(rtcNewDevice(nullptr)), embree(rtcNewScene(device))
    {
        rtcSetSceneFlags(embree, RTC_SCENE_FLAG_ROBUST);
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, scene.positions.size()));
        auto* corners = static_cast<uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, scene.triangles.size()));
        for (const vec3& position : scene.positions)
            for (int axis = 0; axis < 3; ++axis) *vertices++ = position[axis];
        for (const uvec3& triangle : scene.triangles)
            for (int corner = 0; corner < 3; ++corner) *corners++ = triangle[corner];
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(embree, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(embree);
    }
    Caster(const Caster&) = delete;
    Caster& operator=(const Caster&) = delete;
    ~Caster()
    {
        rtcReleaseScene(embree);
        rtcReleaseDevice(device);
    }

    struct Hit
    {
        double t = 0.0;
        glm::dvec3 normal{0.0}; // toward where the ray came from
    };

    /// Nearest hit on the way from `from`, at most `farthest` along the unit direction; false when there is none.
    bool cast(glm::dvec3 from, glm::dvec3 direction, double farthest, Hit& hit) const
    {
        double start = 0.0;
        for (int layer = 0; layer < 200; ++layer)
        {
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            RTCRayHit query{};
            query.ray.org_x = float(from.x), query.ray.org_y = float(from.y), query.ray.org_z = float(from.z);
            query.ray.dir_x = float(direction.x), query.ray.dir_y = float(direction.y), query.ray.dir_z = float(direction.z);
            query.ray.tnear = float(start), query.ray.tfar = float(farthest), query.ray.mask = ~0u;
            query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(embree, &context, &query);
            if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
            if (isThere(query.hit))
            {
                hit.t = double(query.ray.tfar);
                hit.normal = glm::normalize(glm::dvec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z));
                if (glm::dot(hit.normal, direction) > 0.0) hit.normal = -hit.normal;
                return true;
            }
            start = double(std::nextafter(query.ray.tfar, 1e30f)) * (1.0 + 1e-6);
        }
        return false;
    }

private:
    bool isThere(const RTCHit& hit) const
    {
        const uvec3 corners = scene.triangles[hit.primID];
        const uint32_t material = scene.triangleMaterial[hit.primID];
        if (scene.materials[material].alphaCutoff <= 0.0f) return true;
        const vec2 uv = (1.0f - hit.u - hit.v) * scene.uvs[corners.x] + hit.u * scene.uvs[corners.y] + hit.v * scene.uvs[corners.z];
        return evaluateMaterial(scene, material, uv).baseColor.a >= scene.materials[material].alphaCutoff;
    }

    const Scene& scene;
    RTCDevice device;
    RTCScene embree;
};

struct Share
{
    double seen = 0.0;
    double error = 0.0; // standard error of both measurements together
};

/// Share of the points hit by random rays from free space that some probe sees at a cosine above 0.05. Free points: hit and run (Smith
/// 1984), that is to a uniform point of the free chord through the present one, in a random direction; its steps are as likely back as
/// forth, so it visits all of a connected space evenly. The walk stays in the given box.
Share walkAndLook(const Scene& scene, const std::vector<PlacedProbe>& probes, glm::dvec3 start, const Bounds& box, int points)
{
    const Caster caster(scene);
    std::mt19937_64 random(20);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const auto direction = [&] { return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))); };
    const double margin = 1e-4 * double(box.diagonal());
    glm::dvec3 at = start;
    int looked = 0, seen = 0;
    for (int step = -2000; looked < points && step < 40 * points; ++step)
    {
        const glm::dvec3 along = direction();
        double ends[2]; // of the chord, ahead and behind
        for (int side = 0; side < 2; ++side)
        {
            const glm::dvec3 way = side == 0 ? along : -along;
            double exit = 1e30;
            for (int axis = 0; axis < 3; ++axis)
                if (way[axis] != 0.0)
                    exit = std::min(exit, (double(way[axis] > 0.0 ? box.high[axis] : box.low[axis]) - at[axis]) / way[axis]);
            Caster::Hit hit;
            // A fixed way before the surface, not along the ray: flat rays would end too near for single precision, and slip through.
            double end = exit;
            if (caster.cast(at, way, exit, hit)) end = hit.t - margin / std::max(std::abs(glm::dot(hit.normal, way)), 1e-6);
            ends[side] = std::max(0.0, end);
        }
        at += along * (-ends[1] + uniform(random) * (ends[0] + ends[1]));
        Caster::Hit hit;
        const glm::dvec3 view = direction();
        if (step < 0 || !caster.cast(at, view, 1e30, hit)) continue;
        const glm::dvec3 point = at + hit.t * view;
        ++looked;
        for (const PlacedProbe& probe : probes)
        {
            const glm::dvec3 toProbe = glm::dvec3(probe.position) - point;
            const double distance = glm::length(toProbe);
            if (glm::dot(toProbe, hit.normal) <= 0.05 * distance) continue;
            Caster::Hit blocker;
            const glm::dvec3 lifted = point + margin * hit.normal;
            if (caster.cast(lifted, glm::normalize(glm::dvec3(probe.position) - lifted), glm::distance(glm::dvec3(probe.position), lifted),
                            blocker))
                continue;
            ++seen;
            break;
        }
    }
    const double share = double(seen) / double(looked);
    return {share, std::sqrt(share * (1.0 - share) * (1.0 / double(looked) + 1.0 / 60000.0))};
}

/// @param top  metres: the walk stays below. Above the roofs the placement leaves out what is not enclosed, by a rule of its own
void compare(const Scene& scene, uint32_t count, size_t camera, float top)
{
    PlaceSettings settings;
    settings.count = count;
    settings.refine = Refine::none;
    settings.voxels = 2u << 20;
    settings.candidates = 600;
    settings.surfels = 4000;
    PlaceReport report;
    const auto set = placeProbes(scene, settings, report);
    ASSERT_TRUE(set) << set.error().message;
    Bounds box = report.reachable;
    box.high.y = std::min(box.high.y, top);
    const Share share = walkAndLook(scene, set->probes, glm::dvec3(scene.cameras.at(camera).eye), box, 40000);
    std::printf("placement reports %.3f %%, the walk finds %.3f %% +- %.3f %%\n", 100.0 * double(report.coverageRays), 100.0 * share.seen,
                100.0 * share.error);
    // Neighbouring steps of the walk see alike, so its error is larger than that of as many independent points: up to twice.
    EXPECT_NEAR(share.seen, double(report.coverageRays), 6.0 * share.error + 5e-4);
    EXPECT_LT(report.coverageRays, 0.999f) << "too few gaps to compare by";
}

TEST(IndependentCoverage, AgreesInTheCornellBox)
{
    const auto scene = makeBuiltinScene("cornell");
    ASSERT_TRUE(scene) << scene.error().message;
    compare(*scene, 2, 1, 2.0f);
}

TEST(IndependentCoverage, AgreesInSponza)
{
    const std::filesystem::path file = testing_support::scenesFolder() / "sponza" / "Sponza.gltf";
    if (!std::filesystem::exists(file.parent_path())) GTEST_SKIP() << "the scene sponza is not in " << file.parent_path();
    const auto scene = loadGltf(file);
    ASSERT_TRUE(scene) << scene.error().message;
    compare(*scene, 24, 0, 20.5f);
}

} // namespace
} // namespace sconce
