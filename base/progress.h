#pragma once

#include <functional>
#include <string_view>

namespace sconce
{

/// Long work calls this with the stage's name and the share of it that is done, in [0,1]. Return false to cancel: the work then ends
/// with ErrorCode::cancelled and leaves nothing half-written. Called from one thread at a time. An empty function is allowed.
using Progress = std::function<bool(std::string_view stage, double done)>;

/// Reports, and says whether to go on.
inline bool report(const Progress& progress, std::string_view stage, double done)
{
    return !progress || progress(stage, done);
}

} // namespace sconce
