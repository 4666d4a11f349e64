#pragma once

#include <string_view>

namespace sconce
{

/// What stands in a program before the commit that it was built from, and how many characters that has: who tells programs apart by what
/// they do (runtime/scene/content_key.h) leaves them out.
inline constexpr std::string_view kCommitMark = "sconce was built from:";
inline constexpr size_t kCommitLength = 16;

} // namespace sconce
