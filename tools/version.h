#pragma once

#include <string>

namespace sconce::tools
{

extern const char kMarkedCommit[]; // kCommitMark, then the commit (cmake/SconceCommit.cmake)

/// "0.1.0 (1a2b3c4d5e6f)", with a + behind the commit where files were changed; "(unknown)" where it was not built from a repository.
std::string versionText();

} // namespace sconce::tools
