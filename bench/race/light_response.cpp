// How light follows a lamp that is switched: a field with live links beside what an irradiance volume's blending leaves of it (DDGI).
//   sconce_light_response FIELD [--share S...] [--frames N] [--hysteresis H]
// All of the field's lights that may move are off, and settled; then they are on. Prints, frame by frame, the mean of the light that
// bounces, of its settled mean, and its error, root mean square, of its settled root mean square: over all texels of surface light, each by
// the area that it shows.
#include <algorithm>
#include <cmath>
#include <iostream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/race/blended_light.h"
#include "bench/race/tracer_race.h"
#include "runtime/field/light_field.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/live_light.h"
#include "runtime/field/tracer_cpu.h"
#include "runtime/vulkan/host_vulkan.h"

namespace sconce
{
namespace
{

using Text = twin::LightFieldTwin<float>;

struct Options
{
    std::string field;
    std::vector<double> shares{1.0, 1.0 / 16.0}; // of the probes, that are lit a frame
    uint32_t frames = 300;
    double hysteresis = BlendSettings().hysteresis;
};

/// One way's light, frame by frame, against where it ends.
struct Way
{
    std::string name;
    std::vector<double> mean, error;
};

/// Square metres, but for a factor, that each texel shows.
std::vector<double> areasOf(const FieldData& field)
{
    const uint32_t side = field.info.surfaceSize;
    std::vector<double> areas(field.live.texels.size());
    Text text(field, {});
    for (uint32_t i = 0; i < areas.size(); ++i)
    {
        if ((field.live.texels[i].normal & gpu::kSurfaceKnown) == 0) continue;
        const uint32_t probe = i / (6 * side * side), face = i / (side * side) % 6, y = i / side % side, x = i % side;
        const auto surface = text.surfacePointAt(probe, int(face), int(x), int(y));
        const vec3 axis = Text::faceDirection(int(face), vec3(0.0f, 0.0f, 1.0f));
        const float cosine = -glm::dot(surface.at, surface.normal);
        if (surface.width > 0.0f && cosine > 0.0f) areas[i] = double(surface.width * surface.width * glm::dot(surface.at, axis) / cosine);
    }
    return areas;
}

void judge(Way& way, const std::vector<double>& areas, std::span<const vec3> light, std::span<const vec3> settled)
{
    double mean = 0.0, all = 0.0, off = 0.0, squares = 0.0;
    for (size_t i = 0; i < areas.size(); ++i)
    {
        mean += areas[i] * double(Text::luminance(light[i])), all += areas[i] * double(Text::luminance(settled[i]));
        const vec3 d = light[i] - settled[i];
        off += areas[i] * double(glm::dot(d, d)), squares += areas[i] * double(glm::dot(settled[i], settled[i]));
    }
    way.mean.push_back(mean / all);
    way.error.push_back(std::sqrt(off / squares));
}

/// Frames until a share of all light is there for good.
std::string framesTo(const Way& way, double share)
{
    size_t frames = way.mean.size();
    while (frames > 0 && way.mean[frames - 1] >= share) --frames;
    return frames == way.mean.size() ? fmt::format("more than {}", frames) : fmt::format("{}", frames + 1);
}

class Response
{
public:
    Response(Gpu& device, const FieldData& field) : gpu(device), data(field), areas(areasOf(field)) {}

    Status run(const Options& options)
    {
        // Settled first, which all ways end at.
        if (auto status = switchedOn(0, 0, nullptr); !status) return status;
        for (const double share : options.shares)
        {
            const auto probes = uint32_t(std::max(1.0, std::ceil(share * double(data.info.probeCount))));
            Way& way = ways.emplace_back();
            way.name = fmt::format("ours, {} of {} probes a frame", probes, data.info.probeCount);
            if (auto status = switchedOn(probes, options.frames, &way); !status) return status;
        }
        for (const BlendSettings& blend :
             {BlendSettings{options.hysteresis, 1.0}, {options.hysteresis, 5.0}, {options.hysteresis, 5.0, true}})
        {
            Way& way = ways.emplace_back();
            way.name = fmt::format("blended, hysteresis {}, gamma {}{}", options.hysteresis, blend.gamma,
                                   blend.detects ? ", changes detected" : "");
            BlendedLight light(data, direct, blend);
            for (uint32_t frame = 0; frame < options.frames; ++frame)
            {
                light.frame();
                judge(way, areas, light.bounced(), settled);
            }
        }
        print(options.frames);
        return success();
    }

private:
    /// From the dark. @param way  null: until light is settled, which is kept
    Status switchedOn(uint32_t probes, uint32_t frames, Way* way)
    {
        auto field = makeLightField(gpu, data);
        if (!field) return field.error();
        auto live = makeLiveLight(gpu, *field, data);
        if (!live) return live.error();
        const LightState on{data.live.lights, {}};
        const auto record = [&](const RelightBudget& budget)
        { return gpu.submit([&](VkCommandBuffer cmd) { live->record(cmd, budget); }); };
        const auto words = [&](const Buffer& buffer, std::vector<uint32_t>& to)
        {
            to.resize(areas.size());
            return gpu.download(buffer, 0, std::as_writable_bytes(std::span(to)));
        };
        if (way)
        {
            if (auto status = live->set({{}, {}}); !status) return status;
            while (!live->settled())
                if (auto status = record({}); !status) return status.error();
        }
        if (auto status = live->set(on); !status) return status;
        std::vector<uint32_t> packed;
        std::vector<vec3> light(areas.size());
        for (uint32_t frame = 0; way ? frame < frames : !live->settled(); ++frame)
        {
            if (auto status = record({.probes = probes}); !status) return status.error();
            if (!way) continue;
            if (auto status = words(live->state().bounced, packed); !status) return status;
            std::ranges::transform(packed, light.begin(), [](uint32_t word) { return vec3(Text::unpackSharedExponent(word)); });
            judge(*way, areas, light, settled);
        }
        if (way) return success();
        if (auto status = words(live->state().direct, direct); !status) return status;
        if (auto status = words(live->state().bounced, packed); !status) return status;
        settled.resize(areas.size());
        std::ranges::transform(packed, settled.begin(), [](uint32_t word) { return vec3(Text::unpackSharedExponent(word)); });
        return success();
    }

    void print(uint32_t frames) const
    {
        std::cout << "frame";
        for (const Way& way : ways) std::cout << fmt::format(";{}: mean;error", way.name);
        for (uint32_t frame = 0; frame < frames; ++frame)
        {
            std::cout << "\n" << frame + 1;
            for (const Way& way : ways) std::cout << fmt::format(";{:.4f};{:.4f}", way.mean[frame], way.error[frame]);
        }
        std::cout << "\n";
        for (const Way& way : ways)
            std::cout << fmt::format("{}: 50 % after {}, 95 % after {}, 99 % after {} frames; mean error on the way to 95 % {:.3f}\n",
                                     way.name, framesTo(way, 0.5), framesTo(way, 0.95), framesTo(way, 0.99), errorOnTheWay(way));
    }

    /// Mean of a way's error over the frames before 95 % of its light is there.
    static double errorOnTheWay(const Way& way)
    {
        double sum = 0.0;
        size_t frames = 0;
        for (; frames < way.mean.size() && way.mean[frames] < 0.95; ++frames) sum += way.error[frames];
        return frames > 0 ? sum / double(frames) : 0.0;
    }

    Gpu& gpu;
    const FieldData& data;
    std::vector<double> areas;
    std::vector<uint32_t> direct;
    std::vector<vec3> settled;
    std::vector<Way> ways;
};

Status run(const Options& options)
{
    auto field = loadField(options.field);
    if (!field) return field.error();
    if (field->live.links == 0 || field->live.lights.empty())
        return Error{ErrorCode::badInput,
                     fmt::format("Light field '{}' has no lights that move; bake a scene with a sun, points or spots with --live-links.",
                                 options.field)};
    auto device = OwnDevice::create();
    if (!device) return device.error();
    auto gpu = Gpu::create(device->host());
    if (!gpu) return gpu.error();
    return Response(**gpu, *field).run(options);
}

} // namespace
} // namespace sconce

int main(int argc, char** argv)
{
    CLI::App app{"How light follows lamps that are switched on, beside an irradiance volume's blending"};
    sconce::Options options;
    app.add_option("FIELD", options.field, ".sconce file of sconce bake --live-links, whose lights are switched")->required();
    app.add_option("--share", options.shares, "of the probes that are lit a frame, one or more (default: 1 and 1/16; range: above 0 to 1)")
        ->check(CLI::Range(1e-6, 1.0));
    app.add_option("--frames", options.frames, "that are drawn (default: 300; range: 1 to 100000)")->check(CLI::Range(1u, 100000u));
    app.add_option("--hysteresis", options.hysteresis, "of the blending (default: 0.97; range: 0 to 0.999)")->check(CLI::Range(0.0, 0.999));
    CLI11_PARSE(app, argc, argv);
    return sconce::exitCodeOf(sconce::run(options));
}
