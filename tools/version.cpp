#include "tools/version.h"

#include <string_view>

#include <fmt/format.h>

#include "base/commit_mark.h"

namespace sconce::tools
{

std::string versionText()
{
    std::string_view commit = std::string_view(kMarkedCommit).substr(kCommitMark.size());
    commit = commit.substr(0, commit.find(' '));
    return fmt::format("{} ({})", SCONCE_VERSION, commit);
}

} // namespace sconce::tools
