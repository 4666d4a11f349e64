#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bench/sweep/probe_sets.h"
#include "runtime/bake/bake.h"
#include "runtime/vulkan/gpu.h"

namespace sconce
{

/// A JSON file that the bench wrote; none where it isn't there, or is damaged: what it told is measured again.
std::optional<Json> readJson(const std::filesystem::path& file);

/// A scene's probes and light fields on the bench: each made once, and kept in a folder by a hash of everything that it depends on, so that
/// methods and later runs share it.
class KeptFields
{
public:
    struct Desc
    {
        Gpu& gpu;
        const Scene& scene;
        std::filesystem::path folder;
        std::string device, build; // keyOfThisBuild()
    };
    explicit KeptFields(Desc desc);

    /// What a method makes of a grid, for placeFor().
    using Judge = std::function<Result<double>(const ProbeGrid&, const PointSettings&)>;
    /// Before the first grid is asked for.
    /// @param by  what a volume's judge depends on besides its settings: part of its grid's key
    void judgeGrids(Judge judgeOf, std::string by) { judge = std::move(judgeOf), judgedBy = std::move(by); }

    std::filesystem::path cached(const char* kind, const std::string& key, const char* extension) const;
    const std::string& sceneKey() const { return scene; }

    std::optional<BenchProbes> keptProbes(const PointSettings& settings) const;
    /// Errors: as placeFor(); badInput (no probe), fileError.
    Result<BenchProbes> probesFor(const PointSettings& settings, const Progress& progress);
    /// The light field that a method reads. An opponent's maps are lit by what exact rays find at the surfaces that the same probes see, as
    /// ours are.
    /// @param cost  gets probe_set, place_s, coverage, bake_s, bake_peak_mb and field
    /// Errors: as probesFor() and bakeLightField().
    Result<FieldData> fieldFor(const PointSettings& settings, Json& cost, const Progress& progress);

private:
    std::string probesKey(const PointSettings& settings) const;
    std::string fieldKey(const std::string& probes, const BakeSettings& bake, bool fieldGather, const std::string& litBy) const;
    Result<FieldData> baked(const BenchProbes& probes, BakeSettings bake, bool fieldGather, const std::string& litBy, Json& cost,
                            const Progress& progress);

    Desc desc;
    std::string scene; // its key
    Judge judge;
    std::string judgedBy;
};

} // namespace sconce
