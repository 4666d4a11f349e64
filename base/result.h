#pragma once

#include <string>
#include <utility>
#include <variant>

namespace sconce
{

/// What kind of failure an Error is; the command maps each to its exit code (docs: exit codes).
enum class ErrorCode
{
    badArgument,    // the caller's own fault: a field out of range, a contradiction; exit 2
    badInput,       // a file or scene that can't be used; exit 3
    missingFeature, // the device lacks something that is needed; exit 4
    deviceFailure,  // Vulkan reported an error; exit 4
    outOfMemory,    // the budget or the device is exhausted; exit 4
    fileError,      // reading or writing failed; exit 5
    cancelled,      // the progress callback asked to stop; exit 130
};

/// A failure that a person can act on: the sentence names the thing, the value and the remedy.
struct Error
{
    ErrorCode code = ErrorCode::badInput;
    std::string message;
};

/// A value or an Error. Nothing is half-done when it holds an Error.
template <class T> class [[nodiscard]] Result
{
public:
    Result(T value) : state(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state(std::in_place_index<1>, std::move(error)) {}

    bool ok() const { return state.index() == 0; }
    explicit operator bool() const { return ok(); }
    T& operator*() { return std::get<0>(state); }
    const T& operator*() const { return std::get<0>(state); }
    T* operator->() { return &std::get<0>(state); }
    const T* operator->() const { return &std::get<0>(state); }
    const Error& error() const { return std::get<1>(state); }

private:
    std::variant<T, Error> state;
};

struct Nothing
{
};
using Status = Result<Nothing>; // success or an Error
inline Status success()
{
    return Nothing{};
}

} // namespace sconce
