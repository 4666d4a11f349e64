#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace sconce::testing_support
{

/// A variable of the environment for as long as this lives.
class Variable
{
public:
    Variable(const char* called, const std::string& value) : name(called)
    {
        if (const char* there = std::getenv(name)) before = there;
        setenv(name, value.c_str(), 1);
    }
    ~Variable() { before ? setenv(name, before->c_str(), 1) : unsetenv(name); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

private:
    const char* name;
    std::optional<std::string> before;
};

} // namespace sconce::testing_support
