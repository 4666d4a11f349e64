// A journal gives back what was kept, and of a damaged one the good records alone.
#include "runtime/bake/bake_journal.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/files.h"

namespace sconce
{
namespace
{

using testing_support::readText;
using testing_support::TestFolder;
using testing_support::writeText;

constexpr JournalHead kHead{.build = 1, .content = 2, .probes = 3};

std::vector<std::byte> bytes(std::string_view text)
{
    const auto all = std::as_bytes(std::span(text));
    return {all.begin(), all.end()};
}

BakePart part(uint32_t index, BakeStage stage = BakeStage::maps)
{
    return {7, stage, index};
}

void keep(JournalFile& journal, const BakePart& what, std::string_view text)
{
    const std::span<const std::byte> all = std::as_bytes(std::span(text));
    const std::span<const std::byte> pieces[] = {all.first(text.size() / 2), all.subspan(text.size() / 2)};
    const Status kept = journal.keep(what, pieces);
    ASSERT_TRUE(kept) << kept.error().message;
}

JournalFile opened(const std::filesystem::path& file, const JournalHead& head = kHead)
{
    auto journal = JournalFile::open(file, head);
    if (!journal) throw std::runtime_error(journal.error().message);
    return std::move(*journal);
}

constexpr std::string_view kTexts[] = {"the first", "", "the third, which is longer", "4"};

/// A journal of four records; its bytes.
std::string writeJournal(const std::filesystem::path& file)
{
    JournalFile journal = opened(file);
    for (uint32_t i = 0; i < 4; ++i) keep(journal, part(i), kTexts[i]);
    return readText(file);
}

TEST(BakeJournal, GivesBackWhatWasKeptAndNothingElse)
{
    const TestFolder folder;
    writeJournal(folder / "j");
    JournalFile journal = opened(folder / "j");
    EXPECT_EQ(journal.note(), "");
    EXPECT_EQ(journal.records(), 4u);
    for (uint32_t i = 0; i < 4; ++i) EXPECT_EQ(journal.find(part(i)), bytes(kTexts[i])) << i;
    EXPECT_FALSE(journal.find(part(4)));
    EXPECT_FALSE(journal.find(part(0, BakeStage::gather)));
    EXPECT_FALSE(journal.find({8, BakeStage::maps, 0})) << "of another bake";
    keep(journal, part(1), "anew");
    EXPECT_EQ(journal.find(part(1)), bytes("anew"));
    ASSERT_TRUE(journal.remove());
    EXPECT_FALSE(std::filesystem::exists(folder / "j"));
}

TEST(BakeJournal, LiesHiddenBesideTheOutput)
{
    EXPECT_EQ(JournalFile::besides("a/b.sconce"), std::filesystem::path("a/.b.sconce.journal"));
    EXPECT_EQ(JournalFile::besides("b.sconce"), std::filesystem::path(".b.sconce.journal"));
}

TEST(BakeJournal, OfEachTruncationTheWholeRecordsHold)
{
    const TestFolder folder;
    const std::string whole = writeJournal(folder / "whole");
    for (size_t length = 0; length < whole.size(); ++length)
    {
        writeText(folder / "j", whole.substr(0, length));
        size_t good = 0;
        {
            JournalFile journal = opened(folder / "j");
            good = journal.records();
            size_t end = 64;
            for (uint32_t i = 0; i < 4; ++i)
            {
                end += 40 + kTexts[i].size();
                EXPECT_EQ(journal.find(part(i)).has_value(), length >= end) << length;
            }
            keep(journal, part(9), "after it");
        }
        JournalFile again = opened(folder / "j");
        EXPECT_EQ(again.note(), "") << "the damage was cut off";
        EXPECT_EQ(again.records(), good + 1) << length;
        EXPECT_EQ(again.find(part(9)), bytes("after it"));
    }
}

TEST(BakeJournal, NoFlippedBitIsTakenForContent)
{
    const TestFolder folder;
    const std::string whole = writeJournal(folder / "whole");
    for (size_t at = 0; at < whole.size(); ++at)
    {
        std::string flipped = whole;
        flipped[at] = char(flipped[at] ^ (1 << at % 8));
        writeText(folder / "j", flipped);
        JournalFile journal = opened(folder / "j");
        const bool pid = at >= 56 && at < 64; // which is no content
        EXPECT_EQ(journal.records() == 4, pid) << at;
        EXPECT_EQ(journal.note().empty(), pid) << at;
        for (const BakePart& kept : journal.parts()) EXPECT_EQ(journal.find(kept), bytes(kTexts[kept.index])) << at;
    }
}

TEST(BakeJournal, OneOfAnotherBakeIsNotUsedAndResumeLeavesItAlone)
{
    const TestFolder folder;
    const std::string whole = writeJournal(folder / "j");
    JournalHead others[6] = {kHead, kHead, kHead, kHead, kHead, kHead};
    others[0].build = 9, others[1].content = 9, others[2].probes = 9, others[3].shards = 2, others[4].shard = 1;
    others[5].stage = BakeStage::gather;
    for (const JournalHead& other : others)
    {
        const auto demanded = JournalFile::open(folder / "j", other, true);
        ASSERT_FALSE(demanded);
        EXPECT_EQ(demanded.error().code, ErrorCode::badInput);
        EXPECT_NE(demanded.error().message.find("leave --resume out"), std::string::npos) << demanded.error().message;
        EXPECT_EQ(readText(folder / "j"), whole);
    }
    for (const JournalHead& other : others)
    {
        writeText(folder / "j", whole);
        JournalFile journal = opened(folder / "j", other);
        EXPECT_EQ(journal.records(), 0u);
        EXPECT_NE(journal.note().find("begins anew"), std::string::npos) << journal.note();
    }
    const auto missing = JournalFile::open(folder / "none", kHead, true);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::badInput);
    EXPECT_FALSE(std::filesystem::exists(folder / "none"));
    writeText(folder / "j", whole);
    EXPECT_TRUE(JournalFile::open(folder / "j", kHead, true));
}

TEST(BakeJournal, TheSecondWriterIsToldWhoTheFirstIs)
{
    const TestFolder folder;
    {
        const JournalFile first = opened(folder / "j");
        const auto second = JournalFile::open(folder / "j", kHead);
        ASSERT_FALSE(second);
        EXPECT_EQ(second.error().code, ErrorCode::fileError);
        EXPECT_NE(second.error().message.find("process " + std::to_string(getpid())), std::string::npos) << second.error().message;
    }
    EXPECT_TRUE(JournalFile::open(folder / "j", kHead)) << "a lock ends with its owner";
}

TEST(BakeJournal, WhereItCannotBeWrittenIsSaid)
{
    const TestFolder folder;
    const auto nowhere = JournalFile::open(folder / "none/j", kHead);
    ASSERT_FALSE(nowhere);
    EXPECT_EQ(nowhere.error().code, ErrorCode::fileError);
    EXPECT_NE(nowhere.error().message.find("none/j"), std::string::npos);
}

/// A file that may grow no further stands for a full disk: the write comes back short, then fails.
TEST(BakeJournal, AFullDiskLosesTheRecordThatDidNotFitAlone)
{
    const TestFolder folder;
    const pid_t child = fork();
    if (child == 0)
    {
        signal(SIGXFSZ, SIG_IGN);
        JournalFile journal = opened(folder / "j");
        const std::string large(40000, 'x');
        const std::span<const std::byte> pieces[] = {std::as_bytes(std::span(large))};
        const rlimit limit{100000, 100000};
        if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(9);
        if (!journal.keep(part(0), pieces) || !journal.keep(part(1), pieces)) _exit(1);
        const Status third = journal.keep(part(2), pieces);
        if (third || third.error().code != ErrorCode::fileError) _exit(2);
        if (journal.records() != 2 || std::filesystem::file_size(folder / "j") != journal.bytes()) _exit(3);
        _exit(0);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
    JournalFile after = opened(folder / "j");
    EXPECT_EQ(after.records(), 2u);
    EXPECT_EQ(after.note(), "");
}

TEST(BakeJournal, AKilledWriterLosesNothingOfWhatItKept)
{
    const TestFolder folder;
    std::mt19937 random(1);
    uint32_t before = 0;
    for (int round = 0; round < 40; ++round)
    {
        int ends[2];
        ASSERT_EQ(pipe(ends), 0);
        const pid_t child = fork();
        if (child == 0)
        {
            JournalFile journal = opened(folder / "j");
            for (auto i = uint32_t(journal.records());; ++i)
            {
                keep(journal, part(i), std::string(3000, char('a' + i % 26)));
                if (write(ends[1], &i, sizeof i) != sizeof i) _exit(1);
            }
        }
        close(ends[1]);
        // Some records are kept however busy the machine is; the kill comes at any moment of the next.
        uint32_t kept = before;
        for (uint32_t i = 0, least = 1 + random() % 3; least > 0 && read(ends[0], &i, sizeof i) == ssize_t(sizeof i); --least) kept = i + 1;
        usleep(useconds_t(random() % 3000));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        for (uint32_t i = 0; read(ends[0], &i, sizeof i) == ssize_t(sizeof i);) kept = i + 1;
        close(ends[0]);
        const JournalFile journal = opened(folder / "j");
        ASSERT_GE(journal.records(), kept);
        ASSERT_LE(journal.records(), kept + 1);
        for (uint32_t i = 0; i < journal.records(); ++i) ASSERT_EQ(journal.find(part(i)), bytes(std::string(3000, char('a' + i % 26))));
        before = uint32_t(journal.records());
    }
    EXPECT_GE(before, 40u);
}

TEST(BakeJournal, APartFileIsWholeOrRefused)
{
    const TestFolder folder;
    JournalHead head = kHead;
    head.shard = 1, head.shards = 3;
    {
        JournalFile journal = opened(folder / "j", head);
        for (uint32_t i = 0; i < 4; ++i) keep(journal, part(i), kTexts[i]);
        const Status done = journal.commitAs(folder / "part");
        ASSERT_TRUE(done) << done.error().message;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "j"));
    const auto read = JournalFile::read(folder / "part");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->head(), head);
    EXPECT_EQ(read->find(part(2)), bytes(kTexts[2]));
    const std::string whole = readText(folder / "part");
    for (size_t length = 0; length < whole.size(); ++length)
    {
        writeText(folder / "cut", whole.substr(0, length));
        const auto cut = JournalFile::read(folder / "cut");
        ASSERT_FALSE(cut) << length;
        EXPECT_EQ(cut.error().code, ErrorCode::badInput);
        EXPECT_NE(cut.error().message.find("cut'"), std::string::npos);
    }
    const auto missing = JournalFile::read(folder / "none");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::fileError);
}

} // namespace
} // namespace sconce
