#include "bench/sweep/sweep.h"

#include <algorithm>
#include <cassert>
#include <map>

#include <fmt/format.h>

#include "bench/race/traced_method.h"
#include "bench/sweep/results.h"

namespace sconce
{
namespace
{

constexpr size_t kMostInGroup = 16;
constexpr uint32_t kPathsTimed = 64;                       // of the path tracer, over its turns
constexpr const char* kTimes[] = {"trace_ms", "frame_ms"}; // the frame's scale is the one that is told

struct Timing
{
    std::vector<double> frame, trace; // milliseconds
    std::map<std::string, std::vector<double>> passes;
    std::vector<std::string> order; // of the passes in a frame

    void add(const SceneBench::Passes& frameOf)
    {
        double sum = 0.0, traced = 0.0;
        bool hasTrace = false;
        for (const auto& [name, milliseconds] : frameOf)
        {
            sum += milliseconds;
            if (name.find("glossy trace") != std::string::npos) traced += milliseconds, hasTrace = true;
            if (!passes.contains(name)) order.push_back(name);
            passes[name].push_back(milliseconds);
        }
        frame.push_back(sum);
        if (hasTrace) trace.push_back(traced);
    }
};

Json timesJson(const std::vector<double>& milliseconds)
{
    const Times times = timesOf(milliseconds);
    return {{"median", times.median}, {"p5", times.p5}, {"p95", times.p95}, {"frames", milliseconds.size()}};
}

/// How many frames apart the path tracer's are timed: as many paths in all, at least one frame.
uint32_t strideOf(const PlannedPoint& point, uint32_t frames)
{
    if (!point.settings.pathTraced()) return 1;
    return frames / std::clamp(kPathsTimed / point.settings.paths, 1u, frames);
}

/// A point's share of the bench's work, in about seconds: what the time left is reckoned with.
double weightOf(const PlannedPoint& point, const BenchSettings& settings)
{
    const double megapixels = double(settings.width) * settings.height * 1e-6;
    const PointSettings& s = point.settings;
    if (s.pathTraced()) return megapixels * (s.paths + kPathsTimed) * 0.5;
    const double bake = double(SceneBench::bytesOf(s)) * 1e-7 * (1 + s.bounces);
    return 1.0 + bake + settings.frames * megapixels * (2.0 + s.frame.glossyRays);
}

class SceneSweep
{
public:
    SceneSweep(SceneBench& sceneBench, std::span<const PlannedPoint> points,
               const std::function<Status(const std::vector<Json>&)>& publishTo, const std::function<void(const std::string&)>& sayTo,
               const Progress& progressTo)
        : bench(sceneBench), plan(points), publisher(publishTo), say(sayTo), progress(progressTo), records(points.size())
    {
        for (size_t i = 0; i < plan.size(); ++i) records[i] = bench.kept(plan[i]);
    }

    Status run()
    {
        const double referenceWeight = 1e-6 * bench.settings().width * bench.settings().height * bench.settings().referencePaths;
        std::vector<size_t> pending;
        whole = referenceWeight;
        for (size_t i = 0; i < plan.size(); ++i)
            if (!records[i] || lacksTimes(i))
            {
                pending.push_back(i);
                whole += weightOf(plan[i], bench.settings());
            }
        if (auto status = bench.makeReference(plan.front().settings.frame.roughness, within(referenceWeight)); !status) return status;
        done = referenceWeight;
        if (auto status = publish(); !status || pending.empty()) return status;
        if (auto status = bench.prepare(); !status) return status;
        if (pending.front() != 0) say(fmt::format("{} of {} points were measured before.", plan.size() - pending.size(), plan.size()));
        for (size_t at = 0; at < pending.size();)
        {
            std::vector<size_t> group;
            uint64_t bytes = SceneBench::bytesOf(plan.front().settings);
            for (; at < pending.size() && group.size() < kMostInGroup; ++at)
            {
                const uint64_t more = SceneBench::bytesOf(plan[pending[at]].settings);
                if (!group.empty() && bytes + more > bench.settings().groupBytes) break;
                bytes += more;
                group.push_back(pending[at]);
            }
            const auto ran = runGroup(group);
            if (!ran) return ran.error();
            at -= group.size() - *ran;
        }
        return success();
    }

private:
    bool lacksTimes(size_t i) const { return bench.settings().times && (!records[i] || !records[i]->contains("frame_ms")); }

    /// Progress of a stage that is `weight` of the whole; the whole's is what is shown, and it never falls: the parts of a stage each begin
    /// at nothing.
    Progress within(double weight)
    {
        return [this, weight](std::string_view, double share)
        {
            shown = std::max(shown, std::min((done + weight * share) / whole, 1.0));
            return report(progress, fmt::format("bench {}", bench.name()), shown);
        };
    }

    Status publish() const
    {
        std::vector<Json> measured;
        for (const std::optional<Json>& record : records)
            if (record) measured.push_back(*record);
        return publisher(measured);
    }

    /// @return  how many of the group were measured: fewer than all where the device had no memory for one more beside the others, which
    ///          then begins the next group
    Result<size_t> runGroup(std::vector<size_t> group)
    {
        std::vector<std::pair<size_t, SceneBench::Live>> lives;
        // The plan's first point is timed in every group, also where it has been measured: machines and their load differ from group to
        // group, and scaledPoints() takes the groups' times to one scale by it.
        const bool yardstickApart = group.front() != 0 && std::ranges::any_of(group, [&](size_t i) { return lacksTimes(i); });
        if (yardstickApart)
        {
            auto yardstick = bench.enliven(plan.front(), within(0.0));
            if (!yardstick) return yardstick.error();
            lives.emplace_back(0, std::move(*yardstick));
        }
        for (size_t k = 0; k < group.size(); ++k)
        {
            const size_t i = group[k];
            // The other half of the weight is that of timing the group.
            const double weight = 0.5 * weightOf(plan[i], bench.settings());
            auto live = bench.enliven(plan[i], within(weight));
            Result<Json> measured = live ? (records[i] ? Result<Json>(*records[i]) : bench.measure(*live, within(0.0))) : live.error();
            if (!measured && measured.error().code == ErrorCode::outOfMemory && lives.size() > (yardstickApart ? 1 : 0))
            {
                group.resize(k);
                break;
            }
            done += weight;
            if (!measured)
            {
                if (measured.error().code == ErrorCode::cancelled || i == 0) return measured.error();
                records[i] = Json{{"id", plan[i].id},
                                  {"method", plan[i].settings.method},
                                  {"knob", plan[i].knob},
                                  {"value", plan[i].value},
                                  {"settings", settingsJson(plan[i].settings)},
                                  {"wrong", fmt::format("Not measured: {}", measured.error().message)}};
                say(fmt::format("{}: not measured: {}", plan[i].id, measured.error().message));
                if (auto status = publish(); !status) return status.error(); // not kept: tried again in a later run
                continue;
            }
            const bool fresh = !records[i];
            records[i] = std::move(*measured);
            if (fresh)
            {
                if (auto status = bench.keep(plan[i], *records[i]); !status) return status.error();
                if (auto status = publish(); !status) return status.error();
                say(describePoint(*records[i]));
            }
            lives.emplace_back(i, std::move(*live));
        }
        if (bench.settings().times && !lives.empty())
            if (auto status = timeGroup(lives, group); !status) return status.error();
        return group.size();
    }

    Status timeGroup(std::vector<std::pair<size_t, SceneBench::Live>>& lives, const std::vector<size_t>& group)
    {
        const BenchSettings& settings = bench.settings();
        double weight = 0.0;
        for (const size_t i : group) weight += 0.5 * weightOf(plan[i], settings);
        const uint32_t turns = settings.warmUp + settings.frames;
        std::vector<Timing> timings(lives.size());
        for (uint32_t turn = 0; turn < turns; ++turn)
        {
            if (!within(weight)("", double(turn) / turns)) return Error{ErrorCode::cancelled, "Interrupted; what was measured is kept."};
            // Drawn anew each turn: neither a drifting machine nor what the point before leaves in the caches favours one.
            for (const uint32_t which : shuffledOrder(lives.size(), settings.seed + turn))
            {
                const PlannedPoint& point = plan[lives[which].first];
                const bool warm = turn < settings.warmUp;
                if (point.settings.pathTraced() && (warm || (turn - settings.warmUp) % strideOf(point, settings.frames) != 0)) continue;
                auto passes = bench.timeFrame(lives[which].second, turn);
                if (!passes) return passes.error();
                if (!warm) timings[which].add(*passes);
            }
        }
        done += weight;
        if (timings.front().trace.empty()) return success(); // a device without timestamps: no times
        const double frameYardstick = timesOf(timings.front().frame).median, traceYardstick = timesOf(timings.front().trace).median;
        for (size_t k = 0; k < lives.size(); ++k)
        {
            const size_t i = lives[k].first;
            if (!lacksTimes(i)) continue;
            Json& record = *records[i];
            record["frame_ms"] = timesJson(timings[k].frame);
            if (!timings[k].trace.empty()) record["trace_ms"] = timesJson(timings[k].trace);
            record["passes_ms"] = Json::object();
            for (const std::string& pass : timings[k].order) record["passes_ms"][pass] = timesOf(timings[k].passes[pass]).median;
            record["yardstick_ms"] = {{"frame_ms", frameYardstick}, {"trace_ms", traceYardstick}};
            if (auto status = bench.keep(plan[i], record); !status) return status;
        }
        return publish();
    }

    SceneBench& bench;
    std::span<const PlannedPoint> plan;
    const std::function<Status(const std::vector<Json>&)>& publisher;
    const std::function<void(const std::string&)>& say;
    const Progress& progress;
    std::vector<std::optional<Json>> records;
    double done = 0.0, whole = 1.0; // about seconds
    double shown = 0.0;             // share of the whole
};

} // namespace

Status sweepScene(SceneBench& bench, std::span<const PlannedPoint> plan, const std::function<Status(const std::vector<Json>&)>& publish,
                  const std::function<void(const std::string&)>& say, const Progress& progress)
{
    assert(!plan.empty());
    return SceneSweep(bench, plan, publish, say, progress).run();
}

std::vector<Json> scaledPoints(std::vector<Json> points)
{
    for (const char* time : kTimes)
    {
        std::vector<double> yardsticks;
        for (const Json& point : points)
            if (point.contains("yardstick_ms")) yardsticks.push_back(point["yardstick_ms"][time]);
        if (yardsticks.empty()) continue;
        const double common = timesOf(yardsticks).median;
        for (Json& point : points)
        {
            if (!point.contains("yardstick_ms")) continue;
            const double factor = common / point["yardstick_ms"][time].get<double>();
            point["time_scale"] = factor;
            if (point.contains(time))
                for (const char* part : {"median", "p5", "p95"}) point[time][part] = point[time][part].get<double>() * factor;
            if (time == std::string("frame_ms"))
                for (auto& [pass, milliseconds] : point["passes_ms"].items()) milliseconds = milliseconds.get<double>() * factor;
        }
    }
    for (Json& point : points) point.erase("yardstick_ms");
    return points;
}

std::string describePoint(const Json& point)
{
    const auto figure = [&](std::string_view name) { return figureOf(point, name).value_or(std::numeric_limits<double>::quiet_NaN()); };
    std::string line = fmt::format("{}:", point["id"].get<std::string>());
    if (point.contains("rays"))
        line += fmt::format(" rays right {:.2f} % within 1 %, {:.2f} % within 0.2 %, unresolved {:.2f} %, {:.1f} reads;",
                            100.0 - 100.0 * figure("wrong_rays"), 100.0 - 100.0 * figure("wrong_rays_02"), 100.0 * figure("unresolved"),
                            figure("reads"));
    line += fmt::format(" relMSE of beauty {:.4f}, diffuse {:.4f}", figure("beauty.relmse"), figure("diffuse.relmse"));
    if (figureOf(point, "glossy.relmse")) line += fmt::format(", glossy {:.4f}", figure("glossy.relmse"));
    if (point.contains("bytes")) line += fmt::format("; {:.1f} MB", figure("bytes") / 1e6);
    return line;
}

} // namespace sconce
