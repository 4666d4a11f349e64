#include "tools/bake_job.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "base/listed.h"
#include "runtime/scene/content_key.h"

namespace sconce::tools
{
namespace
{

constexpr BakePart kCommand{0, BakeStage::command, 0};

Result<uint64_t> thisBuild()
{
    const auto key = keyOfThisBuild();
    if (!key) return key.error();
    return std::stoull(*key, nullptr, 16);
}

std::string_view nameOf(BakeStage stage)
{
    return stage == BakeStage::gather ? "what is gathered" : "the maps";
}

Error badPart(std::string sentence)
{
    return {ErrorCode::badInput, std::move(sentence)};
}

/// What one part can't be merged for beside the first.
std::string strangerFault(const JournalFile& part, const JournalFile& first, uint64_t build)
{
    const JournalHead& head = part.head();
    if (head.shards == 0 || head.shard >= head.shards)
        return fmt::format("'{}' is a whole bake's journal, not a part; give what `sconce bake --shard` wrote", part.path().string());
    if (head.build != build)
        return fmt::format("The part '{}' was baked by another build of this program; bake all parts and merge them by the same one",
                           part.path().string());
    if (head.content != first.head().content || head.probes != first.head().probes)
        return fmt::format("The part '{}' is of another scene, other probes or settings, or another device than '{}'; bake it again by the "
                           "command of the others",
                           part.path().string(), first.path().string());
    return {};
}

/// Whether the parts of a stage are all of its shards, each once.
std::string stageFault(std::span<const JournalFile> parts, BakeStage stage)
{
    std::map<uint32_t, const JournalFile*> shards;
    uint32_t count = 0;
    for (const JournalFile& part : parts)
    {
        const JournalHead& head = part.head();
        if (head.stage != stage) continue;
        if (count != 0 && head.shards != count)
            return fmt::format("The part '{}' is one of {} shards of {}, others are of {}; give the parts of one division",
                               part.path().string(), head.shards, nameOf(stage), count);
        count = head.shards;
        const auto [there, fresh] = shards.emplace(head.shard, &part);
        if (!fresh)
            return fmt::format("'{}' and '{}' are both shard {}/{} of {}; give one of them", there->second->path().string(),
                               part.path().string(), head.shard, count, nameOf(stage));
    }
    if (count == 0) return stage == BakeStage::maps ? "No part is of the maps; give the parts of all their shards" : "";
    std::vector<std::string> missing;
    for (uint32_t i = 0; i < count; ++i)
        if (!shards.contains(i)) missing.push_back(fmt::format("{}/{}", i, count));
    if (missing.empty()) return {};
    constexpr size_t kMostNamed = 8;
    const size_t named = std::min(missing.size(), kMostNamed);
    return fmt::format("Of {} {} of {} shards {} missing: {}{}; give all parts", nameOf(stage), missing.size(), count,
                       missing.size() == 1 ? "is" : "are", listed(std::span(missing).first(named)),
                       named < missing.size() ? " and more" : "");
}

} // namespace

void JobOptions::add(CLI::App* command)
{
    CLI::Option* demanded = command->add_flag(
        "--resume", resume,
        described("Fail unless there is a journal of the same bake to go on from; one that is there is gone on from in any case",
                  words("off")));
    command
        ->add_flag("--no-journal", none,
                   described("Keep nothing beside the output of what is finished: a bake that is stopped begins anew, and nobody is "
                             "refused who writes to the same output meanwhile",
                             words("off")))
        ->excludes(demanded);
}

void JobOptions::addShard(CLI::App* command)
{
    CLI::Option* part =
        command
            ->add_option(
                "--shard", shard,
                described("Bake every n-th probe's maps alone, from the i-th on, into a part file; `sconce merge` makes a field of "
                          "all parts, that of one bake to the byte",
                          words("all probes"), fmt::format("from i = 0, n to {}", kMostShards)))
            ->type_name("i/n")
            ->excludes("--no-journal");
    command
        ->add_option(
            "--after", after,
            described("Part files of all shards of the maps: this shard then gathers surface light, the next stage", words("none")))
        ->type_name("PART")
        ->needs(part);
}

Result<std::optional<BakeShard>> JobOptions::wanted() const
{
    if (shard.empty()) return std::optional<BakeShard>();
    BakeShard wanted{0, 0, after.empty() ? BakeStage::maps : BakeStage::gather};
    const auto number = [](const std::string& text, uint32_t& value) { return !text.empty() && CLI::detail::lexical_cast(text, value); };
    const std::vector<std::string> parts = split(shard, '/');
    if (parts.size() != 2 || !number(parts[0], wanted.index) || !number(parts[1], wanted.count))
        return Error{ErrorCode::badArgument, fmt::format("--shard: '{}' is no shard; give i/n, as 0/4", shard)};
    if (wanted.count == 0 || wanted.count > kMostShards)
        return Error{ErrorCode::badArgument,
                     fmt::format("--shard: there are {} shards in '{}'; give 1 to {}", wanted.count, shard, kMostShards)};
    if (wanted.index >= wanted.count)
        return Error{ErrorCode::badArgument,
                     fmt::format("--shard: there is no shard {} of {}; count from 0 to {}", wanted.index, wanted.count, wanted.count - 1)};
    return std::optional(wanted);
}

Result<std::vector<JournalFile>> readParts(std::span<const std::string> files)
{
    const auto build = thisBuild();
    if (!build) return build.error();
    std::vector<JournalFile> parts;
    for (const std::string& file : files)
    {
        auto part = JournalFile::read(file);
        if (!part) return part.error();
        parts.push_back(std::move(*part));
        if (std::string fault = strangerFault(parts.back(), parts.front(), *build); !fault.empty()) return badPart(std::move(fault));
    }
    for (const BakeStage stage : {BakeStage::maps, BakeStage::gather})
        if (std::string fault = stageFault(parts, stage); !fault.empty()) return badPart(std::move(fault));
    return parts;
}

Result<std::vector<std::string>> commandOf(const JournalFile& part)
{
    const auto stored = part.find(kCommand);
    if (!stored) return badPart(fmt::format("The part '{}' doesn't say how it was baked; bake it again", part.path().string()));
    std::vector<std::string> arguments(1);
    for (const std::byte letter : *stored)
        if (letter == std::byte(0))
            arguments.emplace_back();
        else
            arguments.back() += char(letter);
    arguments.pop_back(); // each ends with a 0
    return arguments;
}

Result<BakeJob> BakeJob::open(const JobOptions& options, const Desc& desc, std::vector<JournalFile> parts, const Context& context)
{
    const auto build = thisBuild();
    if (!build) return build.error();
    JournalHead head{.build = *build, .content = desc.content, .probes = desc.probes};
    for (const JournalFile& part : parts)
        if (part.head().content != head.content || part.head().probes != head.probes)
            return badPart(
                fmt::format("The part '{}' is of another scene, other probes or settings, or another device than this bake; bake "
                            "it again",
                            part.path().string()));
    if (desc.shard) head.shard = desc.shard->index, head.shards = desc.shard->count, head.stage = desc.shard->stage;
    auto journal = JournalFile::open(JournalFile::besides(desc.output), head, options.resume);
    if (!journal) return journal.error();
    BakeJob job(std::move(*journal), std::move(parts));
    if (!job.own.note().empty()) note(context, "note: " + job.own.note());
    if (job.before > 0)
        note(context, fmt::format("note: goes on from the journal '{}', which has {} finished parts", job.own.path().string(), job.before));
    if (!desc.shard || job.own.holds(kCommand)) return job;
    std::string text;
    for (const std::string& argument : desc.command) text += argument + '\0';
    const std::span<const std::byte> pieces[] = {std::as_bytes(std::span(text))};
    if (auto status = job.own.keep(kCommand, pieces); !status) return status.error();
    return job;
}

std::optional<std::vector<std::byte>> BakeJob::find(const BakePart& part) const
{
    if (auto found = own.find(part)) return found;
    for (const JournalFile& other : others)
        if (auto found = other.find(part)) return found;
    return std::nullopt;
}

size_t BakeJob::finished() const
{
    return own.records() - (own.holds(kCommand) ? 1 : 0);
}

Error BakeJob::withRemedy(Error error) const
{
    if (finished() > 0) error.message += "; what is finished is kept, and the same command goes on from there";
    return error;
}

} // namespace sconce::tools
