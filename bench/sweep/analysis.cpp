#include "bench/sweep/analysis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include <fmt/format.h>

namespace sconce
{
namespace
{

constexpr std::string_view kErrors[] = {"glossy.relmse", "beauty.relmse", "beauty.flip", "diffuse.relmse", "wrong_rays"};
constexpr std::string_view kCosts[] = {"frame_ms", "trace_ms", "reads", "bytes", "probes"};
constexpr std::string_view kJudged[] = {"glossy.relmse", "beauty.relmse", "diffuse.relmse", "wrong_rays"}; // of the tables of equal things
constexpr std::string_view kPriced[] = {"glossy.relmse", "wrong_rays"};
constexpr double kChange = 0.02;   // an error that changes by less is the same
constexpr double kBroken = 2.0;    // times our default's wrong rays or glossy error: where a knob breaks
constexpr double kFewWrong = 0.02; // share of rays: less is no break, whatever the ratio

using Points = std::vector<const Json*>;

std::string_view nameOfKey(std::string_view key)
{
    static const std::map<std::string_view, std::string_view> names{{"glossy.relmse", "the glossy term's relMSE"},
                                                                    {"beauty.relmse", "the picture's relMSE"},
                                                                    {"beauty.flip", "the picture's FLIP"},
                                                                    {"diffuse.relmse", "the diffuse term's relMSE"},
                                                                    {"wrong_rays", "the share of wrong rays"}};
    return names.at(key);
}

std::string methodName(std::string_view method)
{
    static const std::map<std::string_view, std::string_view> names{{"ours", "Sconce"},
                                                                    {"b0", "B0"},
                                                                    {"b0plus", "B0+"},
                                                                    {"b0plus-octree", "B0+ with Sconce's probes and lists"},
                                                                    {"wang", "W'"},
                                                                    {"ddgi", "DDGI"},
                                                                    {"ddgi-placed", "DDGI on Sconce's probes"},
                                                                    {"sh-grid", "a grid of spherical harmonics"},
                                                                    {kPathTracer, "the path tracer"},
                                                                    {kFilteredPaths, "the path tracer with our filters"},
                                                                    {"ours-grid", "Sconce's tracer on the uniform grid"}};
    const auto found = names.find(method);
    return std::string(found == names.end() ? method : found->second);
}

bool isPathTraced(std::string_view method)
{
    return method == kPathTracer || method == kFilteredPaths;
}

std::string idOf(const Json& point)
{
    return point["id"].get<std::string>();
}

std::string figure(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

std::string times(double ratio)
{
    return fmt::format("{} times", figure(ratio));
}

std::string percent(double share)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.2f %%", 100.0 * share);
    return text;
}

std::string errorText(std::string_view key, double value)
{
    return fmt::format("{} {}", nameOfKey(key), key == "wrong_rays" ? percent(value) : figure(value));
}

bool isOurs(const Json& point)
{
    return point["method"] == "ours";
}

/// Whether it varies the frame alone (rays a pixel, filters): what any tracer's frame may have, and so no merit of one.
bool variesTheFrame(const Json& point)
{
    const SweptKnob* knob = findKnob(point["knob"].get<std::string>());
    return point["knob"] == "level" || (knob && knob->stage == Stage::frame);
}

bool usable(const Json& point)
{
    return !point.contains("wrong") || !point["wrong"].is_string();
}

Json ratio(const Json& a, const Json& b, std::string_view key)
{
    const auto x = figureOf(a, key), y = figureOf(b, key);
    if (!x || !y || !(*y > 0.0)) return nullptr;
    return *x / *y;
}

Json ratiosOf(const Json& a, const Json& b, std::string_view errorKey)
{
    return {{"time", ratio(a, b, "frame_ms")}, {"trace", ratio(a, b, "trace_ms")}, {"reads", ratio(a, b, "reads")},
            {"error", ratio(a, b, errorKey)},  {"memory", ratio(a, b, "bytes")},   {"wrong_rays", ratio(a, b, "wrong_rays")},
            {"probes", ratio(a, b, "probes")}};
}

/// "0.4 times the frame time, 0.5 times the memory": what is known of the ratios, but for one.
std::string ratioText(const Json& ratios, std::string_view but = "")
{
    const std::pair<const char*, const char*> parts[] = {
        {"time", "the frame time"}, {"trace", "the trace time"},      {"reads", "the reads"},  {"error", "the error"},
        {"memory", "the memory"},   {"wrong_rays", "the wrong rays"}, {"probes", "the probes"}};
    std::string text;
    for (const auto& [key, words] : parts)
        if (key != but && ratios[key].is_number()) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", times(ratios[key]), words);
    return text;
}

/// The cheapest of those whose error isn't larger; null where none is.
const Json* cheapestAsGood(const Points& points, std::string_view errorKey, double error, std::string_view costKey)
{
    const Json* best = nullptr;
    for (const Json* point : points)
    {
        const auto e = figureOf(*point, errorKey), cost = figureOf(*point, costKey);
        if (e && cost && *e <= error && (!best || *cost < *figureOf(*best, costKey))) best = point;
    }
    return best;
}

/// That with the least error of those that cost no more (everything, with infinity); null where none does.
const Json* bestWithin(const Points& points, std::string_view errorKey, std::string_view costKey, double most)
{
    const Json* best = nullptr;
    for (const Json* point : points)
    {
        const auto e = figureOf(*point, errorKey), cost = figureOf(*point, costKey);
        if (e && cost && *cost <= most && (!best || *e < *figureOf(*best, errorKey))) best = point;
    }
    return best;
}

class Tables
{
public:
    Tables(Points oursOf, const Json* oursDefault) : ours(std::move(oursOf)), mine(oursDefault) {}

    void compareWith(const std::string& opponent, const Points& theirs, const Json& their)
    {
        if (mine && figureOf(their, "probes")) equalProbes(opponent, their);
        for (const std::string_view key : kJudged)
        {
            if (!figureOf(their, key)) continue;
            const std::string_view time = key == "wrong_rays" ? "trace_ms" : "frame_ms"; // other passes answer no rays
            equalError(opponent, their, key, time);
            const Json* most = bestWithin(theirs, key, time, std::numeric_limits<double>::infinity());
            if (most && most != &their) equalError(opponent, *most, key, time);
            equalCost(opponent, their, key, "time", time);
            if (!figureOf(their, "bytes")) continue; // the path tracer
            equalError(opponent, their, key, "bytes");
            equalCost(opponent, their, key, "memory", "bytes");
        }
    }

    Json rows = Json::array();

private:
    void add(const char* what, std::string_view key, const std::string& opponent, const Json* a, const Json& b, Json ratios,
             std::string sentence, std::string_view costKey = "")
    {
        rows.push_back({{"what", what},
                        {"error_key", std::string(key)},
                        {"cost_key", costKey.empty() ? Json(nullptr) : Json(std::string(costKey))},
                        {"method", opponent},
                        {"ours", a ? Json(idOf(*a)) : Json(nullptr)},
                        {"theirs", idOf(b)},
                        {"ratio", std::move(ratios)},
                        {"sentence", std::move(sentence)}});
    }

    void equalProbes(const std::string& opponent, const Json& their)
    {
        const char* key = figureOf(their, "glossy.relmse") ? "glossy.relmse" : "diffuse.relmse"; // volumes have diffuse light alone
        const Json ratios = ratiosOf(*mine, their, key);
        const Json exactly = ratio(*mine, their, "wrong_rays_02");
        add("probes", key, opponent, mine, their, ratios,
            fmt::format("With {} probes against {} of {}, Sconce takes {}{}.", figure(*figureOf(*mine, "probes")),
                        figure(*figureOf(their, "probes")), methodName(opponent), ratioText(ratios),
                        exactly.is_number() ? fmt::format("; judged within 0.2 % of the diagonal, {} the wrong rays", times(exactly))
                                            : std::string()));
    }

    void equalError(const std::string& opponent, const Json& their, std::string_view key, std::string_view costKey)
    {
        const double error = *figureOf(their, key);
        if (!figureOf(their, costKey)) return;
        const std::string as = fmt::format("For {}, as {} has ({}), ", errorText(key, error), methodName(opponent), idOf(their));
        if (const Json* best = cheapestAsGood(ours, key, error, costKey))
        {
            const Json ratios = ratiosOf(*best, their, key);
            add("error", key, opponent, best, their, ratios,
                fmt::format("{}Sconce ({}) takes {}.", as, idOf(*best), ratioText(ratios, "error")), costKey);
            return;
        }
        const Json* nearest = bestWithin(ours, key, costKey, std::numeric_limits<double>::infinity());
        if (!nearest) return;
        const Json ratios = ratiosOf(*nearest, their, key);
        add("error", key, opponent, nullptr, their, ratios,
            fmt::format("{}no setting of Sconce is good enough: the best ({}) has {} the error, with {}.", as, idOf(*nearest),
                        times(ratios["error"]), ratioText(ratios, "error")),
            costKey);
    }

    void equalCost(const std::string& opponent, const Json& their, std::string_view key, const char* what, std::string_view costKey)
    {
        const auto cost = figureOf(their, costKey);
        if (!cost) return;
        const std::string as = fmt::format("In no more {} than {} takes ({}), ", what, methodName(opponent), idOf(their));
        if (const Json* best = bestWithin(ours, key, costKey, *cost))
        {
            const Json ratios = ratiosOf(*best, their, key);
            add(what, key, opponent, best, their, ratios,
                fmt::format("{}Sconce ({}) has {}: {}.", as, idOf(*best), errorText(key, *figureOf(*best, key)), ratioText(ratios)),
                costKey);
        }
        else
            add(what, key, opponent, nullptr, their, Json::object(), fmt::format("{}Sconce has no setting.", as), costKey);
    }

    Points ours;
    const Json* mine;
};

Json pricesOf(const Points& ours, const Json& base)
{
    Json prices = Json::array();
    for (const Json* point : ours)
    {
        if (point == &base) continue;
        for (const std::string_view key : kPriced)
        {
            const Json ratios = ratiosOf(*point, base, key);
            if (!ratios["error"].is_number()) continue;
            const double error = ratios["error"];
            const Json time = ratios["time"].is_number() ? ratios["time"] : ratios["reads"];
            const std::optional<double> halving = halvingCost(error, time.is_number() ? time.get<double>() : 0.0);
            const std::optional<double> memory = halvingCost(error, ratios["memory"].is_number() ? ratios["memory"].get<double>() : 0.0);
            std::string sentence = fmt::format("{} {}: {} {}", (*point)["knob"].get<std::string>(), (*point)["value"].get<std::string>(),
                                               times(error), nameOfKey(key));
            if (const std::string rest = ratioText(ratios, "error"); !rest.empty()) sentence += fmt::format(", {}", rest);
            if (halving) sentence += fmt::format("; at this rate, halving the error costs {} the time", times(*halving));
            if (halving && memory) sentence += fmt::format(" and {} the memory", times(*memory));
            prices.push_back({{"knob", (*point)["knob"]},
                              {"error_key", std::string(key)},
                              {"from", idOf(base)},
                              {"to", idOf(*point)},
                              {"error_ratio", error},
                              {"time_ratio", ratios["time"]},
                              {"trace_ratio", ratios["trace"]},
                              {"reads_ratio", ratios["reads"]},
                              {"memory_ratio", ratios["memory"]},
                              {"halving_costs_time", halving ? Json(*halving) : Json(nullptr)},
                              {"halving_costs_memory", memory ? Json(*memory) : Json(nullptr)},
                              {"sentence", fmt::format("{}.", sentence)}});
        }
    }
    return prices;
}

/// "1.2 % of the rays wrongly (1.9 % judged within 0.2 % of the diagonal)".
std::string wrongText(const Json& point)
{
    const auto exactly = figureOf(point, "wrong_rays_02");
    return fmt::format("{} of the rays wrongly{}", percent(*figureOf(point, "wrong_rays")),
                       exactly ? fmt::format(" ({} judged within 0.2 % of the diagonal)", percent(*exactly)) : std::string());
}

/// What a method fails by most, in words.
std::string mostFailing(const Json& rays)
{
    const std::pair<const char*, const char*> kinds[] = {{"unresolved", "no probe that is asked sees their way"},
                                                         {"false", "they stop in front of what they should hit"},
                                                         {"leak", "they pass through what they should hit"}};
    const auto* most = &kinds[0];
    for (const auto& kind : kinds)
        if (rays[kind.first].get<double>() > rays[most->first].get<double>()) most = &kind;
    return fmt::format("most of them ({} of all) because {}", percent(rays[most->first]), most->second);
}

Json breaksOf(const std::vector<Json>& points, const Json* base)
{
    Json breaks = Json::array();
    for (const Json& point : points)
    {
        const std::string method = point["method"].get<std::string>();
        const std::string where =
            methodName(method) + (point["knob"] == "default"
                                      ? std::string()
                                      : fmt::format(" with {} {}", point["knob"].get<std::string>(), point["value"].get<std::string>()));
        if (!usable(point))
        {
            breaks.push_back(
                {{"method", method}, {"id", point["id"]}, {"sentence", fmt::format("{}: {}", where, point["wrong"].get<std::string>())}});
            continue;
        }
        const auto wrong = figureOf(point, "wrong_rays"), glossy = figureOf(point, "glossy.relmse");
        if (!wrong) continue;
        if (point["knob"] == "default")
        {
            breaks.push_back({{"method", method},
                              {"id", point["id"]},
                              {"sentence", fmt::format("{} answers {}, {}.", where, wrongText(point), mostFailing(point["rays"]))}});
            continue;
        }
        if (!base || method != "ours") continue;
        const auto baseWrong = figureOf(*base, "wrong_rays"), baseGlossy = figureOf(*base, "glossy.relmse");
        if (*wrong > kFewWrong && baseWrong && *wrong > kBroken * *baseWrong)
            breaks.push_back({{"method", method},
                              {"id", point["id"]},
                              {"sentence", fmt::format("{} answers {} instead of {}, {}.", where, wrongText(point), percent(*baseWrong),
                                                       mostFailing(point["rays"]))}});
        else if (glossy && baseGlossy && *glossy > kBroken * *baseGlossy)
            breaks.push_back({{"method", method},
                              {"id", point["id"]},
                              {"sentence", fmt::format("{} has {} the glossy term's error.", where, times(*glossy / *baseGlossy))}});
    }
    return breaks;
}

} // namespace

std::optional<double> halvingCost(double errorRatio, double timeRatio)
{
    constexpr double least = 1.2; // a step that changes the error by less, taken as often as it needs to halve it, gave factors of 1e7
    if (!(errorRatio > 0.0 && timeRatio > 0.0) || std::abs(std::log(errorRatio)) < std::log(least)) return {};
    return std::pow(timeRatio, std::log(0.5) / std::log(errorRatio));
}

std::vector<std::string> paretoFront(std::span<const Json* const> points, std::string_view errorKey, std::string_view costKey)
{
    struct Candidate
    {
        double cost, error;
        const Json* point;
    };
    std::vector<Candidate> candidates;
    for (const Json* point : points)
        if (const auto error = figureOf(*point, errorKey), cost = figureOf(*point, costKey); error && cost)
            candidates.push_back({*cost, *error, point});
    // From the cheapest on: a point is on the front when its error is less than that of all cheaper ones.
    std::ranges::stable_sort(candidates, [](const Candidate& a, const Candidate& b)
                             { return std::pair(a.cost, a.error) < std::pair(b.cost, b.error); });
    std::vector<std::string> front;
    double best = std::numeric_limits<double>::infinity();
    for (const Candidate& each : candidates)
        if (each.error < best)
        {
            best = each.error;
            front.push_back(idOf(*each.point));
        }
    return front;
}

Json analyseScene(const std::vector<Json>& points)
{
    Points all, ours, oursTraced; // oursTraced: those that vary placement, bake or trace
    std::map<std::string, Points> opponents;
    const Json* base = nullptr;
    for (const Json& point : points)
    {
        if (!usable(point)) continue;
        all.push_back(&point);
        if (isOurs(point))
        {
            ours.push_back(&point);
            if (!variesTheFrame(point)) oursTraced.push_back(&point);
            if (point["knob"] == "default") base = &point;
        }
        else
            opponents[point["method"].get<std::string>()].push_back(&point);
    }
    Json analysis = {{"fronts", Json::object()}, {"equal", Json::array()}, {"prices", Json::array()}, {"breaks", breaksOf(points, base)}};
    for (const std::string_view error : kErrors)
        for (const std::string_view cost : kCosts) analysis["fronts"][fmt::format("{}|{}", error, cost)] = paretoFront(all, error, cost);
    // Tracers are compared by what placement, bake and trace bring, path tracers by whole frames: filters are no merit of a tracer, but
    // are one of the frame.
    Tables tables(oursTraced, base), pathTables(ours, base);
    for (auto& [opponent, theirs] : opponents)
    {
        if (isPathTraced(opponent))
        {
            for (const Json* point : theirs) pathTables.compareWith(opponent, {}, *point);
            continue;
        }
        std::erase_if(theirs, [](const Json* point) { return variesTheFrame(*point); });
        for (const Json* point : theirs)
            if ((*point)["knob"] == "default") tables.compareWith(opponent, theirs, *point);
    }
    for (Json& row : pathTables.rows) tables.rows.push_back(std::move(row));
    analysis["equal"] = std::move(tables.rows);
    if (base) analysis["prices"] = pricesOf(ours, *base);
    return analysis;
}

std::vector<std::string> answersOf(const Json& results)
{
    struct Question
    {
        const char *what, *key, *cost, *ratio, *begin;
    };
    const Question questions[] = {
        {"error", "glossy.relmse", "frame_ms", "time", "For the glossy error of the opponent, Sconce's frame takes"},
        {"error", "wrong_rays", "trace_ms", "trace", "For as few wrong rays as the opponent, Sconce's trace takes"},
        {"probes", "glossy.relmse", nullptr, "wrong_rays", "With as many probes, Sconce answers wrongly"},
        {"probes", "glossy.relmse", nullptr, "error", "With as many probes, Sconce's glossy error is"},
        {"probes", "diffuse.relmse", nullptr, "error", "With as many probes as a volume of irradiance, Sconce's diffuse error is"},
        {"error", "glossy.relmse", "bytes", "memory", "For the glossy error of the opponent, Sconce's light field takes"},
        {"time", "glossy.relmse", "frame_ms", "error", "In the opponent's frame time, Sconce's glossy error is"},
        {"memory", "glossy.relmse", "bytes", "error", "In the opponent's memory, Sconce's glossy error is"}};
    std::vector<std::string> answers;
    for (const Question& question : questions)
    {
        std::string reached, missed; // scenes
        for (const Json& scene : results["scenes"])
        {
            if (!scene.contains("analysis")) continue;
            const Json* worst = nullptr; // against the opponent that is hardest to beat
            bool unreached = false;
            for (const Json& row : scene["analysis"]["equal"])
            {
                const std::string method = row["method"];
                if (row["what"] != question.what || row["error_key"] != question.key || isPathTraced(method) ||
                    (question.cost && row["cost_key"] != question.cost) || !row["theirs"].get<std::string>().ends_with("/default"))
                    continue;
                // A scene where nothing of ours is good enough counts as such, however well others went.
                if (row["ours"].is_null())
                {
                    if (!unreached) worst = &row;
                    unreached = true;
                }
                else if (!unreached && row["ratio"][question.ratio].is_number() &&
                         (!worst || row["ratio"][question.ratio].get<double>() > (*worst)["ratio"][question.ratio].get<double>()))
                    worst = &row;
            }
            if (!worst) continue;
            const std::string where =
                fmt::format("{} (against {})", scene["name"].get<std::string>(), methodName((*worst)["method"].get<std::string>()));
            if (unreached)
                missed += fmt::format("{}{}", missed.empty() ? " in " : ", in ", where);
            else
                reached += fmt::format("{}{} as much in {}", reached.empty() ? " " : "; ", times((*worst)["ratio"][question.ratio]), where);
        }
        const std::string begin = question.begin;
        if (!reached.empty())
            answers.push_back(
                fmt::format("{}{}{}", begin, reached, missed.empty() ? "." : fmt::format("; no setting of ours does it{}.", missed)));
        else if (!missed.empty())
            answers.push_back(fmt::format("{}: no setting of ours does it{}.", begin.substr(0, begin.find(", Sconce")), missed));
    }
    return answers;
}

} // namespace sconce
