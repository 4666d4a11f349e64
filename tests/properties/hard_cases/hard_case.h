#pragma once

#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

namespace sconce::testing_support
{

/// Of 10,000 rays: where the worst that is found is none, or one, another processor's roundings may bring it to three.
inline constexpr double kHardlyAny = 3e-4;

/// One row of the table in docs/limits.md: prints it and fails the test when the worst value is above the bound.
/// @param asked  the bound that was aimed at, where the one asserted is only what is reached so far: the row is marked as short
inline void expectAtMost(const std::string& name, size_t inputs, double worst, double bound, double asked = NAN)
{
    char text[64] = "";
    if (worst > asked) std::snprintf(text, sizeof(text), "; SHORT of %.4g", asked);
    std::printf("| %s | %zu | %.4g | %.4g%s |\n", name.c_str(), inputs, worst, bound, text);
    std::string key = name;
    for (char& c : key)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    testing::Test::RecordProperty(key, std::to_string(worst));
    EXPECT_LE(worst, bound) << name; // false for a value that is not a number
}

} // namespace sconce::testing_support
