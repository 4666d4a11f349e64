#include "bench/report/report_page.h"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include "tests/bench/report/made_up_results.h"

namespace sconce
{

namespace
{

using Json = nlohmann::ordered_json;
using testing_support::madeUpResults;

struct ReportPage : testing::Test
{
    std::filesystem::path folder = std::filesystem::temp_directory_path() / ("sconce-report-" + std::to_string(getpid()));
    ReportPage() { std::filesystem::create_directories(folder); }
    ~ReportPage() override { std::filesystem::remove_all(folder); }

    std::string page() const
    {
        std::ifstream file(folder / "report" / "index.html", std::ios::binary);
        return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }
};

/// What stands in the element that begins with `start`, up to its </script>.
std::string contentOf(const std::string& page, const std::string& start)
{
    const size_t begin = page.find(start);
    if (begin == std::string::npos) return "";
    const size_t content = page.find('>', begin) + 1;
    return page.substr(content, page.find("</script", content) - content);
}

std::vector<uint8_t> decoded(const std::string& base64)
{
    static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<uint8_t> bytes;
    uint32_t word = 0;
    int bits = 0;
    for (const char c : base64)
    {
        if (c == '=') break;
        word = word << 6 | uint32_t(digits.find(c));
        bits += 6;
        if (bits >= 8) bytes.push_back(uint8_t(word >> (bits -= 8) & 255));
    }
    return bytes;
}

std::vector<uint8_t> bytesOf(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

size_t countOf(const std::string& text, const std::string& what)
{
    size_t count = 0;
    for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size())) ++count;
    return count;
}

} // namespace

TEST_F(ReportPage, HoldsTheResultsAsTheyAre)
{
    const Json results = madeUpResults(folder);
    ASSERT_TRUE(writeReportPage(results, folder).ok());
    EXPECT_EQ(Json::parse(contentOf(page(), "<script type=\"application/json\" id=\"results\"")), results);
    EXPECT_EQ(page().find("<!--sconce:data-->"), std::string::npos);
}

TEST_F(ReportPage, HoldsEveryImageToTheByte)
{
    const Json results = madeUpResults(folder);
    ASSERT_TRUE(writeReportPage(results, folder).ok());
    const std::string text = page();
    EXPECT_EQ(countOf(text, "<script type=\"application/octet-stream\""), 2u * (3 + 3 * 7));
    for (const auto& [layer, file] : results["scenes"][0]["points"][0]["images"].items())
    {
        const std::string name = file.get<std::string>();
        const std::vector<uint8_t> packed =
            decoded(contentOf(text, "<script type=\"application/octet-stream\" data-name=\"" + name + "\""));
        const std::vector<uint8_t> truth = bytesOf(folder / name);
        std::vector<uint8_t> bytes(truth.size() + 1);
        uLongf size = bytes.size();
        ASSERT_EQ(uncompress(bytes.data(), &size, packed.data(), packed.size()), Z_OK) << name;
        bytes.resize(size);
        EXPECT_EQ(bytes, truth) << name;
    }
}

// No text may end its script early or begin another: the page has the template's elements and the data's, whatever the names.
TEST_F(ReportPage, IsSafeAgainstMarkupInText)
{
    Json plain = madeUpResults(folder, {.scenes = 1, .points = 1});
    ASSERT_TRUE(writeReportPage(plain, folder).ok());
    const size_t scripts = countOf(page(), "<script"), comments = countOf(page(), "<!--");
    for (const char* text : {"</script><script>alert(1)</script>", "</SCRIPT >", "<!--<script>", "]]>&quot;\"'"})
    {
        Json results = plain;
        results["scenes"][0]["name"] = text;
        results[text] = text;
        ASSERT_TRUE(writeReportPage(results, folder).ok());
        EXPECT_EQ(countOf(page(), "<script"), scripts) << text;
        EXPECT_EQ(countOf(page(), "<!--"), comments) << text;
        EXPECT_EQ(Json::parse(contentOf(page(), "<script type=\"application/json\"")), results) << text;
    }
}

TEST_F(ReportPage, TextThatIsNotUtf8IsReplaced)
{
    Json results = madeUpResults(folder, {.scenes = 1, .points = 1});
    results["scenes"][0]["name"] = "caf\xE9";
    ASSERT_TRUE(writeReportPage(results, folder).ok());
    EXPECT_EQ(Json::parse(contentOf(page(), "<script type=\"application/json\""))["scenes"][0]["name"], "caf\xEF\xBF\xBD");
}

TEST_F(ReportPage, ResultsWithoutScenesOrOfAnotherShapeAreNoFault)
{
    for (const char* text :
         {"{}", R"({"scenes":null})", R"({"scenes":[null,3,{"points":7,"reference":[]},{"points":[null,{"images":{"beauty":null}}]}]})"})
        EXPECT_TRUE(writeReportPage(Json::parse(text), folder).ok()) << text;
}

TEST_F(ReportPage, NamesTheImageThatIsMissingCutShortOrOutside)
{
    const Json plain = madeUpResults(folder, {.scenes = 1, .points = 1});
    ASSERT_TRUE(writeReportPage(plain, folder).ok());
    const std::string before = page();
    std::ofstream(folder / "images/short.half") << "SCNI";
    std::ofstream(folder / "images/text.half") << "this is a text that is longer than a header";
    testing_support::writeNumbers(folder / "images/less.u32", 4, 4, std::vector<uint32_t>(15, 0));
    for (const char* name :
         {"images/nowhere.half", "images/short.half", "images/text.half", "images/less.u32", "../outside.half", "/etc/hostname", ""})
    {
        Json results = plain;
        results["scenes"][0]["points"][0]["images"]["beauty"] = name;
        const Status done = writeReportPage(results, folder);
        ASSERT_FALSE(done.ok()) << name;
        EXPECT_NE(done.error().message.find(name), std::string::npos) << done.error().message;
        EXPECT_EQ(page(), before) << "the page before it must stay: " << name;
    }
}

TEST_F(ReportPage, IsTheSameToTheByteForTheSameResults)
{
    const Json results = madeUpResults(folder);
    ASSERT_TRUE(writeReportPage(results, folder).ok());
    const std::string first = page();
    ASSERT_TRUE(writeReportPage(results, folder).ok());
    EXPECT_EQ(page(), first);
}

TEST_F(ReportPage, FolderThatCantBeMadeIsAFileError)
{
    std::ofstream(folder / "report") << "a file where the folder should be";
    const Status done = writeReportPage(madeUpResults(folder), folder);
    ASSERT_FALSE(done.ok());
    EXPECT_EQ(done.error().code, ErrorCode::fileError);
}

} // namespace sconce
