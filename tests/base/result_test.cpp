#include "base/result.h"

#include <memory>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

TEST(Result, HoldsAValueOrAnError)
{
    const Result<int> value = 7;
    EXPECT_TRUE(value.ok());
    EXPECT_TRUE(bool(value));
    EXPECT_EQ(*value, 7);
    const Result<int> error = Error{ErrorCode::fileError, "The file is gone."};
    EXPECT_FALSE(error.ok());
    EXPECT_FALSE(bool(error));
    EXPECT_EQ(error.error().code, ErrorCode::fileError);
    EXPECT_EQ(error.error().message, "The file is gone.");
}

// A value of the Error's own kind, or one that an Error could be made of, is still a value.
TEST(Result, TellsAValueFromAnErrorByItsTypeAlone)
{
    const Result<std::string> text = std::string("The file is gone.");
    ASSERT_TRUE(text.ok());
    EXPECT_EQ(*text, "The file is gone.");
    const Result<ErrorCode> code = ErrorCode::cancelled;
    ASSERT_TRUE(code.ok());
    EXPECT_EQ(*code, ErrorCode::cancelled);
}

TEST(Result, MovesWhatCannotBeCopied)
{
    Result<std::unique_ptr<int>> made = std::make_unique<int>(3);
    ASSERT_TRUE(made.ok());
    **made = 4;
    const std::unique_ptr<int> taken = std::move(*made);
    EXPECT_EQ(*taken, 4);
}

TEST(Result, OfNothingIsAStatus)
{
    EXPECT_TRUE(success().ok());
    const Status refused = Error{ErrorCode::cancelled, ""};
    EXPECT_EQ(refused.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace sconce
