#include "runtime/bake/bake_journal.h"

#include <bit>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace sconce
{
namespace
{

static_assert(std::endian::native == std::endian::little, "the journal is little-endian and is copied as it is");

constexpr char kMagic[8] = {'\x89', 'S', 'C', 'J', 'R', 'N', '1', '\n'}; // with the version of the format
constexpr uint32_t kMark = 0x44524353;                                   // SCRD
constexpr size_t kPieceBytes = size_t(1) << 20;                          // that are checked at once

struct StoredHead
{
    char magic[8];
    uint64_t build, content;
    uint32_t probes, shard, shards, stage;
    uint64_t none;
    uint64_t checksum; // of the bytes before it
    uint64_t pid;      // of who writes it; not what it holds, so not in the checksum
};
static_assert(sizeof(StoredHead) == 64);

struct StoredRecord
{
    uint32_t mark, stage, index, none;
    uint64_t bake, bytes;
    uint64_t checksum; // of the bytes before it and the content
};
static_assert(sizeof(StoredRecord) == 40);
constexpr size_t kCheckedOfRecord = offsetof(StoredRecord, checksum);

uint64_t checksumOf(const StoredHead& head)
{
    return XXH3_64bits(&head, offsetof(StoredHead, checksum));
}

StoredHead stored(const JournalHead& head)
{
    StoredHead out{{}, head.build, head.content, head.probes, head.shard, head.shards, uint32_t(head.stage), 0, 0, uint64_t(getpid())};
    std::memcpy(out.magic, kMagic, sizeof kMagic);
    out.checksum = checksumOf(out);
    return out;
}

/// What came of reading: of a disk that fails nothing is known, of fewer bytes that there are no more.
enum class Read
{
    all,
    fewer,
    failed // errno says why
};

/// All of the bytes, through short reads and interruptions.
Read readAll(int file, uint64_t offset, std::span<std::byte> into)
{
    size_t done = 0;
    while (done < into.size())
    {
        const ssize_t count = pread(file, into.data() + done, into.size() - done, off_t(offset + done));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return count == 0 ? Read::fewer : Read::failed;
        done += size_t(count);
    }
    return Read::all;
}

bool writeAll(int file, uint64_t offset, std::span<const std::byte> bytes)
{
    size_t done = 0;
    while (done < bytes.size())
    {
        const ssize_t count = pwrite(file, bytes.data() + done, bytes.size() - done, off_t(offset + done));
        if (count < 0 && errno == EINTR) continue;
        if (count == 0) errno = ENOSPC; // no room, and no word of it
        if (count <= 0) return false;
        done += size_t(count);
    }
    return true;
}

uint64_t sizeOf(int file)
{
    struct stat state = {};
    return fstat(file, &state) == 0 ? uint64_t(state.st_size) : 0;
}

/// The head of a file; none: it is no journal's, or that isn't known.
std::optional<JournalHead> headOf(int file, Read& how)
{
    StoredHead head{};
    how = readAll(file, 0, std::as_writable_bytes(std::span(&head, 1)));
    if (how != Read::all) return std::nullopt;
    if (std::memcmp(head.magic, kMagic, sizeof kMagic) != 0 || head.checksum != checksumOf(head)) return std::nullopt;
    return JournalHead{head.build, head.content, head.probes, head.shard, head.shards, BakeStage(head.stage)};
}

/// Why a journal is none of a bake's.
std::string_view differenceOf(const JournalHead& there, const JournalHead& wanted)
{
    if (there.build != wanted.build) return "was written by another build of this program";
    if (there.shard != wanted.shard || there.shards != wanted.shards || there.stage != wanted.stage) return "is of another shard";
    return "is of another scene, other probes or settings, or another device";
}

/// Whether the file that is open still is the one of that name: its last owner may have removed it meanwhile.
bool isStillNamed(int file, const std::filesystem::path& name)
{
    struct stat open = {}, named = {};
    return fstat(file, &open) == 0 && stat(name.c_str(), &named) == 0 && open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

} // namespace

BakeJournal::~BakeJournal() = default;

std::filesystem::path JournalFile::besides(const std::filesystem::path& output)
{
    return output.parent_path() / fmt::format(".{}.journal", output.filename().string());
}

JournalFile::JournalFile(JournalFile&& other) noexcept
    : name(std::move(other.name)), own(other.own), descriptor(std::exchange(other.descriptor, -1)), writable(other.writable),
      end(other.end), places(std::move(other.places)), found(std::move(other.found))
{
}

JournalFile::~JournalFile()
{
    if (descriptor >= 0) close(descriptor); // which lets go of the lock
}

Status JournalFile::failure(std::string_view what) const
{
    const int reason = errno;
    return Error{ErrorCode::fileError,
                 fmt::format("{} the journal '{}' failed: {}; free some space, choose another folder, or bake without a journal", what,
                             name.string(), std::strerror(reason))};
}

/// Opens the file and takes it for this process alone.
Status JournalFile::lock()
{
    while (true)
    {
        descriptor = ::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (descriptor < 0) return failure("Opening");
        if (flock(descriptor, LOCK_EX | LOCK_NB) != 0)
        {
            if (errno != EWOULDBLOCK) return failure("Locking");
            StoredHead head{};
            const bool known = readAll(descriptor, 0, std::as_writable_bytes(std::span(&head, 1))) == Read::all;
            return Error{ErrorCode::fileError,
                         fmt::format("Another bake ({}) is writing to the same output, and has its journal '{}'; wait for its end, or "
                                     "choose another output",
                                     known ? fmt::format("process {}", head.pid) : "a process that has just begun", name.string())};
        }
        if (isStillNamed(descriptor, name)) return success();
        close(std::exchange(descriptor, -1));
    }
}

/// An empty journal.
Status JournalFile::begin()
{
    const StoredHead head = stored(own);
    if (ftruncate(descriptor, 0) != 0 || !writeAll(descriptor, 0, std::as_bytes(std::span(&head, 1)))) return failure("Writing");
    end = sizeof head;
    return success();
}

Result<JournalFile> JournalFile::open(const std::filesystem::path& file, const JournalHead& head, bool demanded)
{
    JournalFile journal;
    journal.name = file;
    journal.own = head;
    journal.writable = true;
    std::error_code ignored;
    if (demanded && !std::filesystem::exists(file, ignored))
        return Error{ErrorCode::badInput,
                     fmt::format("There is no journal '{}' to resume from; leave --resume out to begin anew", file.string())};
    if (auto status = journal.lock(); !status) return status.error();
    const uint64_t size = sizeOf(journal.descriptor);
    Read how = Read::all;
    const std::optional<JournalHead> there = headOf(journal.descriptor, how);
    // It may be a good one: what can't be read now is not to be overwritten.
    if (how == Read::failed) return journal.failure("Reading").error();
    if (there != head)
    {
        const std::string_view why = there ? differenceOf(*there, head) : "has no head that could be read";
        if (demanded)
            return Error{ErrorCode::badInput, fmt::format("The journal '{}' {}; leave --resume out to begin anew", file.string(), why)};
        if (size > 0) journal.found = fmt::format("the journal '{}' {}; the bake begins anew", file.string(), why);
        if (auto status = journal.begin(); !status) return status.error();
        return journal;
    }
    const auto damage = journal.scan();
    if (!damage) return damage.error();
    if (!damage->empty())
        journal.found =
            fmt::format("the journal '{}' {} after its record {}; the bake goes on from there", file.string(), *damage, journal.records());
    const StoredHead mine = stored(head);
    if (ftruncate(journal.descriptor, off_t(journal.end)) != 0 || !writeAll(journal.descriptor, 0, std::as_bytes(std::span(&mine, 1))))
        return journal.failure("Writing").error();
    return journal;
}

Result<JournalFile> JournalFile::read(const std::filesystem::path& file)
{
    JournalFile journal;
    journal.name = file;
    journal.descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (journal.descriptor < 0)
    {
        const int reason = errno;
        return Error{ErrorCode::fileError,
                     fmt::format("Cannot read '{}': {}; check that it is there and may be read", file.string(), std::strerror(reason))};
    }
    Read how = Read::all;
    const std::optional<JournalHead> head = headOf(journal.descriptor, how);
    if (how == Read::failed) return journal.failure("Reading").error();
    if (!head)
        return Error{
            ErrorCode::badInput,
            fmt::format("'{}' is no part of a bake, or its head is damaged; give what `sconce bake --shard` wrote", file.string())};
    journal.own = *head;
    const auto scanned = journal.scan();
    if (!scanned) return scanned.error();
    std::string damage = *scanned;
    if (damage.empty() && !journal.holds({0, BakeStage::end, 0})) damage = "is cut off";
    if (!damage.empty())
        return Error{ErrorCode::badInput,
                     fmt::format("The part '{}' {} after its record {}; bake that shard again", file.string(), damage, journal.records())};
    return journal;
}

Result<std::optional<std::pair<BakePart, JournalFile::Place>>> JournalFile::recordAt(uint64_t offset, uint64_t size) const
{
    using Found = std::optional<std::pair<BakePart, Place>>;
    StoredRecord record{};
    if (size - offset < sizeof record) return Found();
    Read how = readAll(descriptor, offset, std::as_writable_bytes(std::span(&record, 1)));
    if (how == Read::failed) return failure("Reading").error();
    if (how == Read::fewer) return Found();
    const uint64_t content = offset + sizeof record;
    if (record.mark != kMark || record.bytes > size - content) return Found();
    XXH3_state_t hash;
    XXH3_64bits_reset(&hash);
    XXH3_64bits_update(&hash, &record, kCheckedOfRecord);
    std::vector<std::byte> piece(std::min<uint64_t>(record.bytes, kPieceBytes));
    for (uint64_t done = 0; done < record.bytes; done += piece.size())
    {
        piece.resize(std::min<uint64_t>(record.bytes - done, kPieceBytes));
        how = readAll(descriptor, content + done, piece);
        if (how == Read::failed) return failure("Reading").error();
        if (how == Read::fewer) return Found();
        XXH3_64bits_update(&hash, piece.data(), piece.size());
    }
    if (XXH3_64bits_digest(&hash) != record.checksum) return Found();
    return Found({BakePart{record.bake, BakeStage(record.stage), record.index}, Place{content, record.bytes, record.checksum}});
}

Result<std::string> JournalFile::scan()
{
    const uint64_t size = sizeOf(descriptor);
    end = sizeof(StoredHead);
    while (end < size)
    {
        const auto read = recordAt(end, size);
        if (!read) return read.error();
        const auto& record = *read;
        if (!record) return std::string("is cut off or damaged");
        places[record->first] = record->second;
        end = record->second.offset + record->second.bytes;
    }
    return std::string();
}

std::vector<BakePart> JournalFile::parts() const
{
    std::vector<BakePart> all;
    for (const auto& [part, place] : places) all.push_back(part);
    return all;
}

std::optional<std::vector<std::byte>> JournalFile::find(const BakePart& part) const
{
    const auto place = places.find(part);
    if (place == places.end()) return std::nullopt;
    std::vector<std::byte> bytes(place->second.bytes);
    if (readAll(descriptor, place->second.offset, bytes) != Read::all) return std::nullopt; // what isn't found is baked again
    // Once more: it may have been long ago that it was read.
    const StoredRecord record{kMark, uint32_t(part.stage), part.index, 0, part.bake, bytes.size(), 0};
    XXH3_state_t hash;
    XXH3_64bits_reset(&hash);
    XXH3_64bits_update(&hash, &record, kCheckedOfRecord);
    XXH3_64bits_update(&hash, bytes.data(), bytes.size());
    if (XXH3_64bits_digest(&hash) != place->second.checksum) return std::nullopt;
    return bytes;
}

Status JournalFile::keep(const BakePart& part, Pieces pieces)
{
    StoredRecord record{kMark, uint32_t(part.stage), part.index, 0, part.bake, 0, 0};
    for (const auto piece : pieces) record.bytes += piece.size();
    XXH3_state_t hash;
    XXH3_64bits_reset(&hash);
    XXH3_64bits_update(&hash, &record, kCheckedOfRecord);
    for (const auto piece : pieces) XXH3_64bits_update(&hash, piece.data(), piece.size());
    record.checksum = XXH3_64bits_digest(&hash);
    const uint64_t content = end + sizeof record;
    uint64_t at = content;
    bool done = writable;
    for (const auto piece : pieces)
    {
        done = done && writeAll(descriptor, at, piece);
        at += piece.size();
    }
    // Last, so that what is cut off has no mark.
    if (!done || !writeAll(descriptor, end, std::as_bytes(std::span(&record, 1))))
    {
        Status failed = failure("Writing");
        if (ftruncate(descriptor, off_t(end)) != 0) return failed; // the checksums find it
        return failed;
    }
    places[part] = {content, record.bytes, record.checksum};
    end = at;
    return success();
}

Status JournalFile::commitAs(const std::filesystem::path& target)
{
    if (auto status = keep({0, BakeStage::end, 0}, {}); !status) return status;
    if (fsync(descriptor) != 0) return failure("Flushing");
    if (rename(name.c_str(), target.c_str()) != 0) return failure("Renaming");
    const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
    // As SafeFile does: the new name survives a power cut only once the folder is on disk too.
    if (const int opened = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); opened >= 0)
    {
        (void)fsync(opened);
        close(opened);
    }
    name = target;
    return success();
}

Status JournalFile::remove()
{
    if (unlink(name.c_str()) != 0) return failure("Removing");
    return success();
}

} // namespace sconce
