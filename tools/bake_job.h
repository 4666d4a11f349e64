#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/bake/bake.h"
#include "runtime/bake/bake_journal.h"
#include "tools/common.h"

namespace sconce::tools
{

/// How a bake is kept on its way, and shared out: --resume, --no-journal, and of a shard --shard and --after.
struct JobOptions
{
    bool resume = false, none = false;
    std::string shard;
    std::vector<std::string> after; // part files

    void add(CLI::App* command); // all but what is of a shard
    void addShard(CLI::App* command);
    /// None where the whole is baked. Errors: badArgument.
    Result<std::optional<BakeShard>> wanted() const;
};

/// Reads part files, in any order: all shards of the maps, each once, and of what is gathered all or none; of one bake, by this build.
/// Errors: badInput, with the file or shard; fileError.
Result<std::vector<JournalFile>> readParts(std::span<const std::string> files);

/// The command that a part was baked by: its arguments. Errors: badInput.
Result<std::vector<std::string>> commandOf(const JournalFile& part);

/// The journal of an output file, and parts that others baked.
class BakeJob final : public BakeJournal
{
public:
    struct Desc
    {
        std::filesystem::path output;
        uint64_t content = 0; // as JournalHead::content
        uint32_t probes = 0;
        std::optional<BakeShard> shard;
        std::vector<std::string> command; // a shard's
    };
    /// Notes on stderr what was found. Errors: as JournalFile::open(); badInput: the parts are of another bake.
    static Result<BakeJob> open(const JobOptions& options, const Desc& desc, std::vector<JournalFile> parts, const Context& context);

    std::optional<std::vector<std::byte>> find(const BakePart& part) const override;
    Status keep(const BakePart& part, Pieces pieces) override { return own.keep(part, pieces); }

    /// A failure, with the word that the same command goes on where anything is kept.
    Error withRemedy(Error error) const;
    size_t resumed() const { return before; } // parts of this bake that were there when it began
    uint64_t bytes() const { return own.bytes(); }
    Status commitAs(const std::filesystem::path& target) { return own.commitAs(target); }
    Status remove() { return own.remove(); }

private:
    size_t finished() const; // parts of the bake in the own journal
    BakeJob(JournalFile journal, std::vector<JournalFile> parts) : own(std::move(journal)), others(std::move(parts)), before(finished()) {}
    JournalFile own;
    std::vector<JournalFile> others;
    size_t before;
};

} // namespace sconce::tools
