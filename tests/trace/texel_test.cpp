// Words of the distance maps, charts and packed colours, against closed forms.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "runtime/field_space.h"
#include "runtime/tracer_cpu.h"

namespace sconce
{
namespace
{

using glm::vec2;
using glm::vec3;

struct Text
{
    FieldData field;
    twin::LightFieldTwin<float> f{field, {}};
    twin::LightFieldTwin<double> d{field, {}};
};

vec3 randomDirection(std::mt19937& random)
{
    std::normal_distribution<float> normal;
    return glm::normalize(vec3(normal(random), normal(random), normal(random)));
}

TEST(Chart, FaceCoordinatesInvert)
{
    Text text;
    std::mt19937 random(1);
    for (int i = 0; i < 10000; ++i)
    {
        const vec3 p = randomDirection(random);
        for (int face = 0; face < 6; ++face) EXPECT_EQ(text.f.faceDirection(face, text.f.faceCoordinates(face, p)), p);
        const vec3 on = text.f.faceCoordinates(text.f.dominantFace(p), p);
        EXPECT_GE(on.z, std::max(std::abs(on.x), std::abs(on.y)));
    }
}

TEST(Chart, OctahedralMapInvertsAlsoOnEdgesAndCorners)
{
    Text text;
    std::mt19937 random(2);
    auto check = [&](vec3 d)
    {
        const vec2 uv = text.f.octahedralFromDirection(d);
        EXPECT_GE(uv.x, 0.0f);
        EXPECT_LE(uv.y, 1.0f);
        EXPECT_NEAR(glm::distance(text.f.directionFromOctahedral(uv), glm::normalize(d)), 0.0f, 2e-6f) << d.x << " " << d.y << " " << d.z;
    };
    for (int i = 0; i < 10000; ++i) check(randomDirection(random));
    for (float x : {-1.0f, -0.0f, 0.0f, 1.0f})
        for (float y : {-1.0f, 0.0f, 1.0f})
            for (float z : {-1.0f, -0.0f, 0.0f, 1.0f})
                if (x != 0.0f || y != 0.0f || z != 0.0f) check(vec3(x, y, z));
}

TEST(Texel, GradientRoundsToNearestStep)
{
    Text text;
    for (float g = -0.14f; g <= 0.14f; g += 0.001f)
    {
        const float read = text.f.unpackGradient(text.f.packGradient(g));
        const float step = 2.0f * std::sqrt(std::abs(g) * 0.15f) / 127.0f + 0.15f / (127.0f * 127.0f); // of the squared scale, at g
        EXPECT_NEAR(read, g, step);
    }
    EXPECT_FLOAT_EQ(text.f.unpackGradient(text.f.packGradient(0.9f)), 0.15f) << "saturates";
    EXPECT_EQ(text.f.unpackGradient(text.f.packGradient(0.0f)), 0.0f);
}

TEST(Texel, BoundsHoldEveryPointOfThePlane)
{
    Text text;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> logQ(-4.0f, 4.0f), gradient(-0.2f, 0.2f), offset(-0.5f, 0.5f);
    for (int i = 0; i < 20000; ++i)
    {
        const uint32_t word = text.f.packTexel(std::exp2(logQ(random)), gradient(random), gradient(random));
        const uint32_t bounds = text.f.texelBounds(word);
        const double q = text.d.halfToReal(word), high = text.d.halfToReal(bounds), low = text.d.halfToReal(bounds >> 16);
        for (int k = 0; k < 4; ++k)
        {
            const double plane =
                q * (1.0 + text.d.unpackGradient(word >> 16) * offset(random) + text.d.unpackGradient(word >> 24) * offset(random));
            EXPECT_LE(plane, high);
            EXPECT_GE(plane, low);
        }
    }
}

TEST(Texel, ChainHoldsEveryTexelBelow)
{
    Text text;
    const uint32_t size = 64;
    std::vector<uint32_t> words(distanceWordsPerProbe(gpu::kChartCube, size) / 6);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> q(0.0f, 8.0f), gradient(-0.1f, 0.1f);
    for (uint32_t i = 0; i < size * size; ++i)
        words[i] = i % 17 == 0 ? 0u : text.f.packTexel(q(random), gradient(random), gradient(random));
    buildChain(words.data(), size, coarsestLevel(size));
    uint32_t offset = size * size;
    for (uint32_t level = 2; level <= coarsestLevel(size); level += 2)
    {
        const uint32_t width = size >> level;
        for (uint32_t i = 0; i < size * size; ++i)
        {
            const uint32_t parent = words[offset + ((i / size) >> level) * width + ((i % size) >> level)];
            const uint32_t own = text.f.texelBounds(words[i]);
            EXPECT_GE(parent & 0xffffu, own & 0xffffu);
            EXPECT_LE(parent >> 16, own >> 16);
        }
        offset += width * width;
    }
    EXPECT_EQ(offset, words.size());
}

TEST(Colour, RadianceRoundTripsWithinItsMantissa)
{
    Text text;
    std::mt19937 random(6);
    std::uniform_real_distribution<float> exponent(-10.0f, 15.0f);
    for (int i = 0; i < 10000; ++i)
    {
        const vec3 c(std::exp2(exponent(random)), std::exp2(exponent(random)), std::exp2(exponent(random)));
        const vec3 r = text.f.unpackRadiance(text.f.packRadiance(c));
        EXPECT_NEAR(r.x, c.x, c.x / 120.0f);
        EXPECT_NEAR(r.y, c.y, c.y / 120.0f);
        EXPECT_NEAR(r.z, c.z, c.z / 60.0f);
    }
    EXPECT_EQ(text.f.unpackRadiance(text.f.packRadiance(vec3(0.0f))), vec3(0.0f));
    const vec3 extreme = text.f.unpackRadiance(text.f.packRadiance(vec3(1e9f, std::nanf(""), -3.0f)));
    EXPECT_GT(extreme.x, 60000.0f);
    EXPECT_TRUE(std::isfinite(extreme.x));
    EXPECT_EQ(extreme.y, 0.0f);
    EXPECT_EQ(extreme.z, 0.0f);
}

} // namespace
} // namespace sconce
