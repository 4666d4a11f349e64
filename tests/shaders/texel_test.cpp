// Words of the distance maps, against closed forms.
#include <cmath>

#include <gtest/gtest.h>

#include "runtime/field/field_space.h"
#include "runtime/field/tracer_cpu.h"

namespace sconce
{
namespace
{

struct Text
{
    FieldData field;
    twin::LightFieldTwin<float> f{field, {}};
};

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

} // namespace
} // namespace sconce
