#include "bench/reference/emitters.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "scene/mesh_builder.h"

namespace sconce
{
namespace
{

double areaOf(const Scene& scene, uint32_t triangle)
{
    const uvec3 t = scene.triangles[triangle];
    const glm::dvec3 a(scene.positions[t.x]), b(scene.positions[t.y]), c(scene.positions[t.z]);
    return 0.5 * glm::length(glm::cross(b - a, c - a));
}

/// A dim lamp, a small bright one, a wall that doesn't shine, a lamp of no area, and one whose picture is black on its left half.
Scene lamps()
{
    Scene scene;
    Image image{"half", 2, 1, {0, 0, 0, 255, 255, 255, 255, 255}};
    scene.images = {image};
    MeshBuilder mesh(scene);
    const uint32_t dim = mesh.emitter("dim", vec3(1.0f)), bright = mesh.emitter("bright", vec3(8.0f, 4.0f, 0.0f)),
                   wall = mesh.material("wall", vec3(0.5f)), half = mesh.emitter("half", vec3(2.0f));
    scene.materials[half].emissionTexture.image = 0;
    mesh.quad({0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}, dim);
    mesh.triangle({0, 0, 2}, {1, 0, 2}, {0, 1, 2}, bright);
    mesh.quad({-5, -5, 0}, {5, -5, 0}, {5, -5, 9}, {-5, -5, 9}, wall);
    mesh.triangle({0, 0, 3}, {1, 0, 3}, {2, 0, 3}, bright);
    mesh.quad({0, 0, 5}, {1, 0, 5}, {1, 1, 5}, {0, 1, 5}, half);
    return scene;
}

TEST(Emitters, DensityIsThatOfPowerOverArea)
{
    const Scene scene = lamps();
    const Emitters emitters(scene);
    ASSERT_FALSE(emitters.empty());
    double total = 0.0;
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) total += emitters.areaPdf(i) * areaOf(scene, i);
    EXPECT_NEAR(total, 1.0, 1e-6);
    for (uint32_t i = 0; i < scene.triangles.size(); ++i)
    {
        const std::string& name = scene.materials[scene.triangleMaterial[i]].name;
        const bool shines = name != "wall" && areaOf(scene, i) > 0.0;
        EXPECT_EQ(emitters.areaPdf(i) > 0.0f, shines) << name;
        if (name == "bright" && shines)
        {
            EXPECT_NEAR(emitters.areaPdf(i) / emitters.areaPdf(0), 4.0, 1e-5) << "the mean of 8, 4 and 0, against 1";
        }
    }
}

// Cells of equal area in every shining triangle: by chi-square, counts of draws are those of the density (mean k - 1, variance 2 (k - 1)).
TEST(Emitters, DrawsFollowTheirDensity)
{
    constexpr int kDraws = 400000, kSide = 6; // kSide^2 cells a triangle
    const Scene scene = lamps();
    const Emitters emitters(scene);
    std::map<uint32_t, std::vector<int>> counts;
    Random random(5, 1);
    for (int i = 0; i < kDraws; ++i)
    {
        const Emitters::Sample sample = emitters.draw(random);
        ASSERT_EQ(sample.areaPdf, emitters.areaPdf(sample.triangle));
        const uvec3 t = scene.triangles[sample.triangle];
        const glm::dvec3 a(scene.positions[t.x]), ab = glm::dvec3(scene.positions[t.y]) - a, ac = glm::dvec3(scene.positions[t.z]) - a,
                                                  ap = glm::dvec3(sample.position) - a;
        const double bb = glm::dot(ab, ab), bc = glm::dot(ab, ac), cc = glm::dot(ac, ac), pb = glm::dot(ap, ab), pc = glm::dot(ap, ac);
        const double u = (pb * cc - pc * bc) / (bb * cc - bc * bc), v = (pc * bb - pb * bc) / (bb * cc - bc * bc);
        ASSERT_LT(glm::length(a + u * ab + v * ac - glm::dvec3(sample.position)), 1e-5);
        ASSERT_TRUE(u > -1e-5 && v > -1e-5 && u + v < 1.0 + 1e-5);
        const vec2 uv = float(1.0 - u - v) * scene.uvs[t.x] + float(u) * scene.uvs[t.y] + float(v) * scene.uvs[t.z];
        ASSERT_LT(glm::distance(uv, sample.uv), 1e-5f);
        const double x = std::clamp(u, 0.0, 1.0) * kSide, y = std::clamp(v, 0.0, 1.0) * kSide;
        const int column = std::min(int(x), kSide - 1), row = std::min(int(y), kSide - 1 - column);
        const bool upper = x - column + y - row > 1.0 && column + row < kSide - 1; // each square of the grid is two cells
        std::vector<int>& cells = counts[sample.triangle];
        cells.resize(size_t(2 * kSide * kSide));
        ++cells[size_t(2 * (row * kSide + column) + upper)];
    }
    double sum = 0.0;
    int cellsInAll = 0;
    for (const auto& [triangle, cells] : counts)
    {
        const double expected = kDraws * double(emitters.areaPdf(triangle)) * areaOf(scene, triangle) / (kSide * kSide);
        for (int row = 0; row < kSide; ++row)
            for (int column = 0; column + row < kSide; ++column)
                for (int upper = 0; upper < 2 - (column + row == kSide - 1); ++upper, ++cellsInAll)
                    sum += std::pow(cells[size_t(2 * (row * kSide + column) + upper)] - expected, 2.0) / expected;
    }
    ASSERT_EQ(cellsInAll, 5 * kSide * kSide); // two quads and a triangle
    EXPECT_LT(std::abs(sum - (cellsInAll - 1)) / std::sqrt(2.0 * (cellsInAll - 1)), 4.5);
}

// A lamp whose picture is black almost everywhere must still be found where it isn't: no shining point has density 0.
TEST(Emitters, APictureThatLooksBlackStillHasADensity)
{
    Scene scene;
    Image image{"spark", 64, 64, std::vector<uint8_t>(64 * 64 * 4, 0)};
    image.rgba[0] = 255;
    scene.images = {image};
    MeshBuilder mesh(scene);
    const uint32_t spark = mesh.emitter("spark", vec3(5.0f));
    scene.materials[spark].emissionTexture.image = 0;
    mesh.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, spark);
    const Emitters emitters(scene);
    EXPECT_GT(emitters.areaPdf(0), 0.0f);
    EXPECT_GT(emitters.areaPdf(1), 0.0f);
}

TEST(Emitters, DarkSceneHasNone)
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box(vec3(0.0f), vec3(1.0f), mesh.material("grey", vec3(0.5f)));
    const Emitters emitters(scene);
    EXPECT_TRUE(emitters.empty());
    EXPECT_EQ(emitters.areaPdf(0), 0.0f);
}

} // namespace
} // namespace sconce
