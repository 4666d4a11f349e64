// sconce_report_pages FOLDER: writes the pages that page_test.mjs looks at, FOLDER/NAME/report/index.html.
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include "bench/report/report_page.h"
#include "tests/bench/report/made_up_results.h"

using namespace sconce;
using namespace sconce::testing_support;
using Json = nlohmann::ordered_json;

namespace
{

/// Names that are long, that look like markup, and that hold every kind of quote.
Json nastyNames(Json results)
{
    const std::string nasty = "</script><script>window.broken = 1</script><!-- \"it's\" & <img src=x onerror=broken()> \xE2\x80\xA8 " +
                              std::string(300, 'W') + " a very long name of a scene that no head of a page has room for";
    Json& scene = results["scenes"][0];
    scene["name"] = nasty;
    scene["source"] = nasty;
    results["answers"][0] = nasty;
    results["commands"][0] = nasty;
    const std::string key = nasty.substr(0, 60);
    for (Json& point : scene["points"])
    {
        if (point["method"].get<std::string>() == "wang") point["method"] = nasty;
        point["settings"][key] = nasty;
    }
    scene["analysis"]["breaks"][0]["sentence"] = nasty;
    return results;
}

/// Everything that can be missing, is, somewhere.
Json missingParts(Json results)
{
    Json& points = results["scenes"][0]["points"];
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    points[1] = {{"id", "bare"}, {"method", "ours"}, {"knob", "probes"}, {"value", "1"}};
    points[2]["error"]["glossy"]["relmse"] = nan; // JSON has neither: both are written as null
    points[3]["frame_ms"]["median"] = infinity;
    points[4]["error"] = nullptr;
    points[5]["bytes"] = nullptr;
    points[6]["frame_ms"]["median"] = 0.0;
    points[0]["images"].erase("glossy");
    results["scenes"][0]["reference"]["images"].erase("diffuse");
    results["scenes"][0]["probe_sets"].erase("grid-54");
    results["scenes"][0].erase("plan");
    results["scenes"][1] = {{"name", "nothing but a name"}};
    results.erase("device");
    results.erase("answers");
    return results;
}

/// A pixel that is not a number, one beyond the halves, and one whose value is known: all in the first row, channel by channel 1, 2, 3 ...
Json knownPixels(const std::filesystem::path& folder, Json results)
{
    constexpr int width = 8, height = 4;
    std::vector<uint16_t> bits(3 * width * height, glm::packHalf1x16(0.5f));
    for (int i = 0; i < 6; ++i) bits[size_t(i)] = glm::packHalf1x16(float(i + 1));
    bits[6] = 0x7e00; // not a number
    bits[9] = 0x7c00; // infinite
    writeHalves(folder / "images/known.half", width, height, bits);
    Json& scene = results["scenes"][0];
    scene["width"] = width;
    scene["height"] = height;
    scene["points"][0]["images"] = {{"beauty", "images/known.half"}};
    scene["reference"]["images"] = {{"beauty", "images/known.half"}};
    return results;
}

/// Ours is the worst in everything, and half as bright as the reference and its opponents.
Json losing(const std::filesystem::path& folder, Json results)
{
    constexpr int width = 8, height = 4;
    for (const auto& [name, value] : {std::pair("half", 0.5f), std::pair("whole", 1.0f)})
        writeHalves(folder / fmt::format("images/{}.half", name), width, height,
                    std::vector<uint16_t>(3 * width * height, glm::packHalf1x16(value)));
    const Json right = {{"beauty", "images/whole.half"}};
    Json& scene = results["scenes"][0];
    scene["width"] = width;
    scene["height"] = height;
    for (Json& point : scene["points"])
        if (point.contains("images")) point["images"] = right;
    scene["reference"]["images"] = right;
    Json& ours = scene["points"][0];
    ours["images"]["beauty"] = "images/half.half";
    ours["rays"]["right_1"] = 0.9;
    ours["rays"]["right_02"] = 0.85;
    ours["error"]["beauty"]["flip"] = 0.5;
    ours["error"]["diffuse"]["flip"] = 0.9;
    ours["error"]["diffuse"]["mean"] = 0.5;
    ours["frame_ms"]["median"] = 1000.0;
    ours["bytes"]["total"] = 9e8;
    return results;
}

bool write(const std::filesystem::path& folder, const Json& results)
{
    const Status done = writeReportPage(results, folder);
    if (!done) std::fprintf(stderr, "%s\n", done.error().message.c_str());
    return done.ok();
}

} // namespace

int main(int count, char** arguments)
{
    if (count != 2)
    {
        std::fputs("usage: sconce_report_pages FOLDER\n", stderr);
        return 2;
    }
    const std::filesystem::path folder = arguments[1];
    const auto madeUp = [&](const char* name, const MadeUp& what) { return madeUpResults(folder / name, what); };
    Json nothing = madeUpResults(folder / "empty", {.scenes = 0});
    Json wrongSchema = nothing;
    wrongSchema["schema"] = 1;
    bool done = write(folder / "typical", madeUp("typical", {}));
    done = write(folder / "one", madeUp("one", {.scenes = 1, .points = 1, .width = 0, .height = 0})) && done;
    done = write(folder / "many", madeUp("many", {.scenes = 1, .points = 500})) && done;
    done = write(folder / "names", nastyNames(madeUp("names", {}))) && done;
    done = write(folder / "missing", missingParts(madeUp("missing", {}))) && done;
    done = write(folder / "known", knownPixels(folder / "known", madeUp("known", {.scenes = 1, .points = 1}))) && done;
    done = write(folder / "losing", losing(folder / "losing", madeUp("losing", {.scenes = 1}))) && done;
    done = write(folder / "empty", nothing) && done;
    done = write(folder / "schema", wrongSchema) && done;
    return done ? 0 : 1;
}
