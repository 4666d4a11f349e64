#include "base/safe_file.h"

#include <csignal>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "tests/support/files.h"

namespace sconce
{
namespace
{

using testing_support::readText;
using testing_support::TestFolder;

size_t filesIn(const TestFolder& folder)
{
    size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path)) ++count;
    return count;
}

TEST(SafeFile, IsThereWholeAfterCommitAndNotBefore)
{
    const TestFolder folder;
    const std::string name = folder / "a.txt";
    ASSERT_TRUE(writeText(name, "old"));
    {
        auto file = SafeFile::create(name);
        ASSERT_TRUE(file);
        const std::string text = "new";
        ASSERT_TRUE(file->append(std::as_bytes(std::span(text))));
        EXPECT_EQ(readText(name), "old");
    } // never committed
    EXPECT_EQ(readText(name), "old");
    EXPECT_EQ(filesIn(folder), 1u) << "a temporary file was left";
    ASSERT_TRUE(writeText(name, std::string(100000, 'x')));
    EXPECT_EQ(readText(name), std::string(100000, 'x'));
    EXPECT_EQ(filesIn(folder), 1u);
}

TEST(SafeFile, HasTheModeThatTheMaskGives)
{
    const TestFolder folder;
    const mode_t mask = umask(027);
    const Status written = writeText(folder / "a.txt", "text");
    umask(mask);
    ASSERT_TRUE(written);
    struct stat state = {};
    ASSERT_EQ(stat((folder / "a.txt").c_str(), &state), 0);
    EXPECT_EQ(state.st_mode & 0777u, 0640u);
}

TEST(SafeFile, SaysWhereItCannotWrite)
{
    const TestFolder folder;
    const Status nowhere = writeText(folder / "none/a.txt", "text");
    ASSERT_FALSE(nowhere);
    EXPECT_EQ(nowhere.error().code, ErrorCode::fileError);
    EXPECT_NE(nowhere.error().message.find("none"), std::string::npos) << nowhere.error().message;
    const Status aFolder = writeText(folder.path, "text");
    ASSERT_FALSE(aFolder);
    EXPECT_NE(aFolder.error().message.find("folder"), std::string::npos) << aFolder.error().message;
}

// A file is put in the place of what had its name: of a pipe's, and of /dev/null, which all programs share.
TEST(SafeFile, LeavesDevicesAndPipesAlone)
{
    const TestFolder folder;
    const std::string pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0666), 0);
    std::filesystem::create_symlink(pipe, folder / "link");
    for (const char* name : {"pipe", "link"})
    {
        const Status refused = writeText(folder / name, "text");
        ASSERT_FALSE(refused) << name;
        EXPECT_EQ(refused.error().code, ErrorCode::fileError);
        EXPECT_NE(refused.error().message.find("pipe"), std::string::npos) << refused.error().message;
        EXPECT_TRUE(std::filesystem::is_fifo(folder / name)) << name;
    }
}

TEST(SafeFile, ReplacesALinkAndNotWhatItPointsTo)
{
    const TestFolder folder;
    ASSERT_TRUE(writeText(folder / "target", "kept"));
    std::filesystem::create_symlink(folder / "target", folder / "link");
    ASSERT_TRUE(writeText(folder / "link", "text"));
    EXPECT_EQ(readText(folder / "link"), "text");
    EXPECT_EQ(readText(folder / "target"), "kept");
}

// A file that may grow no further stands for a full disk: writes come back short, then fail.
TEST(SafeFile, AFullDiskLeavesWhatWasThereAndNothingElse)
{
    const TestFolder folder;
    ASSERT_TRUE(writeText(folder / "a.txt", "old"));
    const pid_t child = fork();
    if (child == 0)
    {
        signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{1000, 1000};
        if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(9);
        if (!writeText(folder / "a.txt", "newer")) _exit(1);
        const Status full = writeText(folder / "a.txt", std::string(5000, 'x'));
        if (full || full.error().code != ErrorCode::fileError) _exit(2);
        _exit(full.error().message.find("what stood there before is unchanged") == std::string::npos ? 3 : 0);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
    EXPECT_EQ(readText(folder / "a.txt"), "newer");
    EXPECT_EQ(filesIn(folder), 1u) << "a temporary file was left";
}

} // namespace
} // namespace sconce
