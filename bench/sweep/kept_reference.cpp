#include "bench/sweep/kept_reference.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <fstream>

#include <fmt/format.h>

#include "base/parsed_json.h"
#include "base/safe_file.h"
#include "bench/reference/path_tracer.h"
#include "bench/sweep/keys.h"

namespace sconce
{
namespace
{

using Json = nlohmann::ordered_json;

/// What the path tracer answers along some paths: another one's pictures are not gone on with.
std::string answersOf(const RayScene& rays, const ReferenceSettings& settings)
{
    constexpr uint32_t kPaths = 256;
    const PathTracer tracer(rays, settings.roughness, settings.pathBounces());
    std::string bits;
    for (uint32_t i = 0; i < kPaths; ++i)
    {
        Random random(settings.seed, kPaths, i);
        const vec3 towards = glm::normalize(glm::normalize(settings.camera.forward) + 0.5f * random.direction());
        const PathLight light = tracer.trace(settings.camera.eye, towards, random);
        for (const vec3& part : {light.direct, light.diffuse, light.glossy})
            for (int axis = 0; axis < 3; ++axis) bits += fmt::format("{:x},", std::bit_cast<uint32_t>(part[axis]));
    }
    return keyOf(Json(bits));
}

std::string pictureKey(const RayScene& rays, const std::string& scene, const ReferenceSettings& s)
{
    const auto numbers = [](vec3 v) { return Json{v.x, v.y, v.z}; };
    Json all = {{"scene", scene},
                {"answers", answersOf(rays, s)},
                {"size", {s.width, s.height}},
                {"camera", {numbers(s.camera.eye), numbers(s.camera.forward), numbers(s.camera.up), s.camera.verticalFov}},
                {"paths", {s.samples, s.bounces, s.seed}},
                {"layers", {s.guides, s.pixelCentre, s.parts}}};
    if (s.roughness) all["roughness"] = *s.roughness;
    if (s.straight) all["straight"] = true;
    return keyOf(all);
}

std::filesystem::path pictureOf(const std::filesystem::path& folder, const std::string& key, uint64_t paths)
{
    return folder / fmt::format("{}-{}.exr", key, paths);
}

/// Nothing where there is none, or not a whole one: then it is traced again.
KeptReference readKept(const std::filesystem::path& folder, const std::string& key)
{
    const std::filesystem::path file = folder / (key + ".json");
    std::ifstream stream(file, std::ios::binary);
    const auto parsed = parsedJson<Json>(stream, file);
    if (!parsed) return {};
    const Json& json = *parsed;
    if (!json.is_object() || !json.value("paths", Json()).is_number_unsigned() || !json.value("relmse", Json()).is_array() ||
        json["relmse"].size() != 3 || !json.value("non_finite_paths", Json()).is_number_unsigned() ||
        !json.value("seconds", Json()).is_number() ||
        !std::ranges::all_of(json["relmse"], [](const Json& value) { return value.is_number(); }))
        return {};
    KeptReference kept;
    auto images = readExr(pictureOf(folder, key, json["paths"].get<uint64_t>()));
    if (!images) return {};
    kept.paths = json["paths"].get<uint64_t>();
    kept.seconds = json["seconds"].get<double>();
    kept.reference.images = std::move(*images);
    kept.reference.estimatedRelMse = json["relmse"][0].get<double>();
    kept.reference.estimatedRelMseDiffuse = json["relmse"][1].get<double>();
    kept.reference.estimatedRelMseGlossy = json["relmse"][2].get<double>();
    kept.reference.nonFinitePaths = json["non_finite_paths"].get<uint64_t>();
    return kept;
}

/// The picture first, under a name of its own, so that what the text names is always whole; then the one before may go.
Status writeKept(const std::filesystem::path& folder, const std::string& key, const KeptReference& kept, uint64_t before)
{
    const Reference& r = kept.reference;
    if (auto status = writeExr(r.images, pictureOf(folder, key, kept.paths)); !status) return status;
    const Json json = {{"paths", kept.paths},
                       {"relmse", {r.estimatedRelMse, r.estimatedRelMseDiffuse, r.estimatedRelMseGlossy}},
                       {"non_finite_paths", r.nonFinitePaths},
                       {"seconds", kept.seconds}};
    if (auto status = writeText(folder / (key + ".json"), json.dump()); !status) return status;
    std::error_code ignored; // a picture too many does no harm
    if (before > 0) std::filesystem::remove(pictureOf(folder, key, before), ignored);
    return success();
}

} // namespace

Result<KeptReference> keptReference(const RayScene& rays, const std::string& scene, const ReferenceSettings& first,
                                    const KeepReference& keep, const Progress& progress)
{
    if (first.samples < 2 || (first.parts && first.samples % 4 != 0))
        return Error{ErrorCode::badArgument,
                     fmt::format("A batch of {} paths a pixel doesn't tell its noise; give a multiple of 4.", first.samples)};
    std::error_code failed;
    std::filesystem::create_directories(keep.folder, failed);
    if (failed)
        return Error{ErrorCode::fileError,
                     fmt::format("Cannot make the folder '{}' of references: {}; give another.", keep.folder.string(), failed.message())};
    const std::string key = pictureKey(rays, scene, first);
    KeptReference kept = readKept(keep.folder, key);
    const auto noise = [&] { return std::max(kept.reference.estimatedRelMseDiffuse, kept.reference.estimatedRelMseGlossy); };
    while (kept.paths == 0 || (keep.until > 0.0 && !(noise() <= keep.until) && kept.paths < keep.mostPaths))
    {
        ReferenceSettings batch = first;
        batch.firstPath = kept.paths;
        // Whole times the first batch, so that the parts stay parts of four.
        const uint64_t most = (keep.mostPaths - std::min<uint64_t>(kept.paths, keep.mostPaths) + first.samples - 1) / first.samples;
        batch.samples = uint32_t(std::max<uint64_t>(std::min(kept.paths / first.samples, most), 1) * first.samples);
        const auto begin = std::chrono::steady_clock::now();
        auto traced = renderReference(rays, batch, progress);
        if (!traced) return traced.error();
        kept.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        const uint64_t before = kept.paths;
        kept.reference = before == 0 ? std::move(*traced) : joined(kept.reference, before, *traced, batch.samples);
        kept.paths = before + batch.samples;
        if (auto status = writeKept(keep.folder, key, kept, before); !status) return status.error();
    }
    return kept;
}

} // namespace sconce
