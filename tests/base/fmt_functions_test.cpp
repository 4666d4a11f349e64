// fmt's functions as our library has them: numbers against the standard library's.
#include <bit>
#include <charconv>
#include <cmath>
#include <locale>
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/random.h"

namespace sconce
{
namespace
{

template <class Number> void expectReadBack(Number number)
{
    const std::string text = fmt::format("{}", number);
    Number read = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
    EXPECT_TRUE(error == std::errc() && end == text.data() + text.size()) << text;
    EXPECT_EQ(read, number) << text;
    char shortest[64];
    const auto scientific = std::to_chars(shortest, shortest + sizeof shortest, number, std::chars_format::scientific);
    const auto digits = [](std::string_view of)
    {
        std::string found;
        for (const char c : of.substr(0, of.find('e')))
            if (c >= '0' && c <= '9') found += c;
        found.erase(0, found.find_first_not_of('0'));
        return found.erase(found.find_last_not_of('0') + 1);
    };
    EXPECT_EQ(digits(text), digits({shortest, size_t(scientific.ptr - shortest)})) << "the fewest digits that read back the same";
}

TEST(FmtFunctions, NumbersHaveTheFewestDigitsThatReadBackTheSame)
{
    Random random(3, 0, 0);
    for (int i = 0; i < 20000; ++i)
    {
        const uint32_t high = random.below(0xffffffffu), low = random.below(0xffffffffu);
        if (const float number = std::bit_cast<float>(high); std::isfinite(number)) expectReadBack(number);
        if (const double number = std::bit_cast<double>(uint64_t(high) << 32 | low); std::isfinite(number)) expectReadBack(number);
    }
}

TEST(FmtFunctions, LocalesSeparateAndMisuseThrows)
{
    struct Grouped : std::numpunct<char>
    {
        char do_thousands_sep() const override { return '.'; }
        char do_decimal_point() const override { return ','; }
        std::string do_grouping() const override { return "\3"; }
    };
    const std::locale grouped(std::locale::classic(), new Grouped);
    EXPECT_EQ(fmt::format(grouped, "{:L}", 1234567), "1.234.567");
    EXPECT_EQ(fmt::format(grouped, "{:L}", 1234.5), "1.234,5");
    EXPECT_EQ(fmt::format("{:L}", 1234567), "1234567");
    EXPECT_THROW(std::ignore = fmt::format(fmt::runtime("{:d}"), 1.5), fmt::format_error);
}

} // namespace
} // namespace sconce
