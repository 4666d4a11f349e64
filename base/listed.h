#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace sconce
{

/// "a, b, c": what a sentence says there is.
/// @param name  element -> what it is called; a member will do
template <class Range, class Name = std::identity>
std::string listed(const Range& range, const Name& name = {}, std::string_view between = ", ")
{
    std::string text;
    for (const auto& element : range) text += fmt::format("{}{}", text.empty() ? std::string_view() : between, std::invoke(name, element));
    return text;
}

} // namespace sconce
