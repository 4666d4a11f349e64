// fmt's functions, compiled once for all of Sconce instead of in every file that formats a sentence (a third to a
// half of the compiler's time), and within our own library, so that hosts of the installed one need no fmt.
#include <locale>

#include <fmt/format-inl.h>

static_assert(FMT_VERSION >= 90000 && FMT_VERSION < 100000, "base/CMakeLists.txt takes fmt's headers alone where their version is another");

namespace fmt::detail
{
// What format.h declares to be made elsewhere.
template locale_ref::locale_ref(const std::locale&);
template auto locale_ref::get<std::locale>() const -> std::locale;
template auto thousands_sep_impl<char>(locale_ref) -> thousands_sep_result<char>;
template auto thousands_sep_impl<wchar_t>(locale_ref) -> thousands_sep_result<wchar_t>;
template auto decimal_point_impl<char>(locale_ref) -> char;
template auto decimal_point_impl<wchar_t>(locale_ref) -> wchar_t;
template auto dragonbox::to_decimal(float) noexcept -> dragonbox::decimal_fp<float>;
template auto dragonbox::to_decimal(double) noexcept -> dragonbox::decimal_fp<double>;
} // namespace fmt::detail
