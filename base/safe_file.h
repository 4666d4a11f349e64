#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "base/result.h"

namespace sconce
{

/// A file that appears under its name whole or not at all: written beside it under a temporary name, synced, renamed, the folder synced.
/// Unless commit() succeeded, the destructor removes the temporary file and what stood under the name before stays as it was.
class SafeFile
{
public:
    static Result<SafeFile> create(const std::filesystem::path& target);
    SafeFile(SafeFile&& other) noexcept;
    SafeFile& operator=(SafeFile&&) = delete;
    ~SafeFile();

    Status append(std::span<const std::byte> bytes);
    Status overwrite(uint64_t offset, std::span<const std::byte> bytes); // within what was appended
    Status commit();

private:
    SafeFile() = default;
    Status failure(std::string_view what) const;

    std::filesystem::path target, temporary;
    int descriptor = -1;
};

/// Whether a file could be written now, as SafeFile::create() says: asked before the work. Nothing is left.
Status writable(const std::filesystem::path& target);

/// The whole of a small text under a name, crash-safe as above.
Status writeText(const std::filesystem::path& target, std::string_view text);

} // namespace sconce
