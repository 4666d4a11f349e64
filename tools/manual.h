#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace sconce::tools
{

inline constexpr const char* kManualForms[] = {"man", "bash", "zsh"};

/// The manual page of a program and its sub-commands, in the macros of man(7): every option with its description, which states default and
/// range.
std::string manualPage(const CLI::App& app);

/// Completion scripts: names of sub-commands, of each its options, of options that take one of some words those; files else.
std::string bashCompletion(const CLI::App& app);
std::string zshCompletion(const CLI::App& app);

} // namespace sconce::tools
