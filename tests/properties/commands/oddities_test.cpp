// Every odd glTF file in the corpus gives a report or a sentence, never a crash and never a hang.
#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/run_command.h"

using namespace sconce::testing_support;
namespace fs = std::filesystem;

TEST(CommandOnOddities, EveryFileGivesAReportOrASentence)
{
    const fs::path corpus = scenesFolder() / "gltf_oddities";
    if (!fs::is_directory(corpus)) GTEST_SKIP() << "no folder gltf_oddities in " << scenesFolder();
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(corpus))
        if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") files.push_back(entry.path());
    std::ranges::sort(files);
    ASSERT_GT(files.size(), 100u);

    std::atomic<size_t> next{0};
    std::mutex lock;
    size_t loaded = 0, refused = 0;
    const auto work = [&]
    {
        for (size_t i = next++; i < files.size(); i = next++)
        {
            const CommandResult result = sconceCommand({"check", files[i].string(), "--json"}, {.processorSeconds = 30.0});
            const bool report = result.exit == 0 && !nlohmann::json::parse(result.out, nullptr, false).is_discarded();
            const bool sentence =
                (result.exit == 3 || result.exit == 5) && result.err.find("sconce: ") != std::string::npos && result.err.ends_with(".\n");
            const std::lock_guard guard(lock);
            loaded += report;
            refused += sentence;
            EXPECT_TRUE(report || sentence) << files[i] << ": exit " << result.exit << ", signal " << result.signal
                                            << (result.timedOut ? ", timed out" : "") << "\n"
                                            << result.err;
        }
    };
    std::vector<std::jthread> pool;
    for (unsigned t = 0; t < std::max(2u, std::thread::hardware_concurrency()); ++t) pool.emplace_back(work);
    pool.clear();
    RecordProperty("loaded", int(loaded));
    RecordProperty("refused", int(refused));
    EXPECT_GT(loaded, files.size() / 2);
}
