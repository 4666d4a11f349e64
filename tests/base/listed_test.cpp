#include "base/listed.h"

#include <vector>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

struct Named
{
    std::string name;
};

TEST(Listed, SaysAllWithWhatIsBetween)
{
    EXPECT_EQ(listed(std::vector<std::string>{"a", "b", "c"}), "a, b, c");
    EXPECT_EQ(listed(std::vector<Named>{{"x"}, {"y"}}, &Named::name, "|"), "x|y");
    EXPECT_EQ(listed(std::vector<int>{3, 4}, [](int n) { return n * n; }), "9, 16");
    EXPECT_EQ(listed(std::vector<std::string>{}), "");
    EXPECT_EQ(listed(std::vector<std::string>{"alone"}), "alone");
}

} // namespace
} // namespace sconce
