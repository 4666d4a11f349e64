#include "base/safe_file.h"

#include <cerrno>
#include <cstring>
#include <random>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

namespace sconce
{

namespace
{

std::filesystem::path folderOf(const std::filesystem::path& file)
{
    return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

/// All of the bytes, through short writes and interruptions.
template <class Write> bool writeAll(std::span<const std::byte> bytes, Write write)
{
    size_t done = 0;
    while (done < bytes.size())
    {
        const ssize_t count = write(bytes.data() + done, bytes.size() - done, done);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        done += size_t(count);
    }
    return true;
}

} // namespace

Result<SafeFile> SafeFile::create(const std::filesystem::path& target)
{
    SafeFile file;
    file.target = target;
    std::error_code ignored;
    if (target.filename().empty() || std::filesystem::is_directory(target, ignored))
        return Error{ErrorCode::fileError, fmt::format("Cannot write '{}': it names a folder; give a file name.", target.string())};
    // Which renaming would replace, /dev/null for everyone.
    if (const auto there = std::filesystem::status(target, ignored);
        std::filesystem::exists(there) && !std::filesystem::is_regular_file(there))
        return Error{ErrorCode::fileError,
                     fmt::format("Cannot write '{}': it is a device or a pipe; give the name of a file.", target.string())};
    const std::string stem = (folderOf(target) / ".").string() + target.filename().string() + ".";
    // Not mkostemp: the process's mask of modes is the kernel's to apply, since asking for it changes it for every other thread.
    std::random_device chance;
    std::string name;
    for (int tries = 0; file.descriptor < 0 && tries < 100; ++tries)
    {
        name = stem + fmt::format("{:08x}", chance());
        file.descriptor = open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file.descriptor < 0 && errno != EEXIST && errno != EINTR) break;
    }
    if (file.descriptor < 0)
    {
        const int reason = errno;
        return Error{ErrorCode::fileError,
                     fmt::format("Cannot write '{}': {} in folder '{}'; choose a folder that exists and can be written.", target.string(),
                                 std::strerror(reason), folderOf(target).string())};
    }
    file.temporary = name;
    return file;
}

SafeFile::SafeFile(SafeFile&& other) noexcept
    : target(std::move(other.target)), temporary(std::exchange(other.temporary, {})), descriptor(std::exchange(other.descriptor, -1))
{
}

SafeFile::~SafeFile()
{
    if (descriptor >= 0) close(descriptor);
    if (!temporary.empty()) unlink(temporary.c_str());
}

Status SafeFile::failure(std::string_view what) const
{
    const int reason = errno;
    return Error{
        ErrorCode::fileError,
        fmt::format("Writing '{}' failed at {}: {}; what stood there before is unchanged. Free some space or choose another folder.",
                    target.string(), what, std::strerror(reason))};
}

Status SafeFile::append(std::span<const std::byte> bytes)
{
    const bool done = writeAll(bytes, [&](const std::byte* data, size_t size, size_t) { return ::write(descriptor, data, size); });
    return done ? success() : failure("its data");
}

Status SafeFile::overwrite(uint64_t offset, std::span<const std::byte> bytes)
{
    const bool done = writeAll(bytes, [&](const std::byte* data, size_t size, size_t at)
                               { return ::pwrite(descriptor, data, size, off_t(offset + at)); });
    return done ? success() : failure("its header");
}

Status SafeFile::commit()
{
    if (fsync(descriptor) != 0) return failure("flushing it to disk");
    const int closing = std::exchange(descriptor, -1);
    if (close(closing) != 0) return failure("closing it");
    if (rename(temporary.c_str(), target.c_str()) != 0) return failure("giving it its name");
    temporary.clear();
    const int folder = open(folderOf(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    // The new name survives a power cut only once the folder is on disk too. Some file systems refuse to sync folders: the file is whole.
    if (folder >= 0)
    {
        (void)fsync(folder);
        close(folder);
    }
    return success();
}

Status writable(const std::filesystem::path& target)
{
    const Result<SafeFile> file = SafeFile::create(target);
    return file ? success() : Status(file.error());
}

Status writeText(const std::filesystem::path& target, std::string_view text)
{
    Result<SafeFile> file = SafeFile::create(target);
    if (!file) return file.error();
    if (Status status = file->append(std::as_bytes(std::span(text.data(), text.size()))); !status) return status;
    return file->commit();
}

} // namespace sconce
