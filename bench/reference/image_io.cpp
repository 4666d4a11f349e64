#include "bench/reference/image_io.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <png.h>

#include <fmt/format.h>

#include "base/numbers.h"
#include "base/safe_file.h"
#include "bench/reference/exr_guard.h"

namespace sconce
{
namespace
{

constexpr const char* kColours[3] = {"R", "G", "B"};

std::string channelName(const Layer& layer, uint32_t channel)
{
    const std::string suffix = layer.channels == 1 ? "Y" : kColours[channel];
    return layer.name == "beauty" ? suffix : fmt::format("{}.{}", layer.name, suffix);
}

Error fileFailure(const std::filesystem::path& file, const std::string& doing, const std::string& why)
{
    return Error{ErrorCode::fileError,
                 fmt::format("could not {} '{}': {}; check the path, the rights and the free space", doing, file.string(), why)};
}

/// Nothing where OpenEXR may be given the file.
Status guardExr(const std::filesystem::path& file)
{
    std::error_code fault;
    const uintmax_t size = std::filesystem::file_size(file, fault);
    std::ifstream stream(file, std::ios::binary);
    if (fault || !stream) return fileFailure(file, "read", fault ? fault.message() : "it can't be opened");
    std::vector<char> start(std::min<uintmax_t>(size, ExrLimits::headerBytes));
    if (!stream.read(start.data(), std::streamsize(start.size()))) return fileFailure(file, "read", "its first bytes can't be read");
    const std::string problem = exrProblem(std::as_bytes(std::span(start)), size);
    if (problem.empty()) return success();
    return Error{ErrorCode::badInput, fmt::format("Picture '{}' is not read: {}.", file.string(), problem)};
}

/// OpenEXR writes here; what it wrote then becomes a file at once or not at all.
class Memory : public Imf::OStream
{
public:
    Memory() : Imf::OStream("memory") {}
    void write(const char bytes[], int count) override
    {
        text.resize(std::max(text.size(), at + size_t(count)));
        std::copy_n(bytes, count, text.begin() + ptrdiff_t(at));
        at += size_t(count);
    }
    uint64_t tellp() override { return at; }
    void seekp(uint64_t place) override { at = place; }

    std::string text;

private:
    size_t at = 0;
};

} // namespace

const Layer* ImageSet::find(std::string_view name) const
{
    for (const Layer& layer : layers)
        if (layer.name == name) return &layer;
    return nullptr;
}

Layer& ImageSet::add(std::string name, uint32_t channels)
{
    layers.push_back({std::move(name), channels, std::vector<float>(pixelCount() * channels)});
    return layers.back();
}

Status writeExr(const ImageSet& images, const std::filesystem::path& file)
{
    if (images.width == 0 || images.height == 0 || images.layers.empty())
        return Error{ErrorCode::badArgument, fmt::format("nothing to write to '{}': the picture is {}x{} with {} layers; render it first",
                                                         file.string(), images.width, images.height, images.layers.size())};
    Memory memory;
    try
    {
        Imf::Header header(static_cast<int>(images.width), static_cast<int>(images.height));
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer buffer;
        for (const Layer& layer : images.layers)
        {
            if ((layer.channels != 1 && layer.channels != 3) || layer.pixels.size() != images.pixelCount() * layer.channels)
                return Error{ErrorCode::badArgument,
                             fmt::format("layer '{}' has {} floats; it needs width x height x 1 or 3", layer.name, layer.pixels.size())};
            for (uint32_t channel = 0; channel < layer.channels; ++channel)
            {
                const std::string name = channelName(layer, channel);
                header.channels().insert(name, Imf::Channel(Imf::FLOAT));
                char* base = reinterpret_cast<char*>(const_cast<float*>(layer.pixels.data() + channel)); // OpenEXR only reads it
                const size_t step = sizeof(float) * layer.channels;
                buffer.insert(name, Imf::Slice(Imf::FLOAT, base, step, step * images.width));
            }
        }
        Imf::OutputFile output(memory, header);
        output.setFrameBuffer(buffer);
        output.writePixels(static_cast<int>(images.height));
    }
    catch (const std::exception& failure)
    {
        return fileFailure(file, "write", failure.what());
    }
    return writeText(file, memory.text);
}

Result<ImageSet> readExr(const std::filesystem::path& file)
{
    if (const Status sound = guardExr(file); !sound) return sound.error();
    try
    {
        Imf::InputFile input(file.c_str());
        const Imath::Box2i window = input.header().dataWindow();
        ImageSet images;
        images.width = static_cast<uint32_t>(window.max.x - window.min.x + 1);
        images.height = static_cast<uint32_t>(window.max.y - window.min.y + 1);

        // Channels come one by one; R, G and B of one prefix are a layer of three.
        std::map<std::string, std::vector<std::string>> groups; // layer prefix -> its channels' last names
        for (auto c = input.header().channels().begin(); c != input.header().channels().end(); ++c)
        {
            const std::string name = c.name();
            const size_t dot = name.rfind('.');
            groups[dot == std::string::npos ? "" : name.substr(0, dot)].push_back(dot == std::string::npos ? name : name.substr(dot + 1));
        }
        Imf::FrameBuffer buffer;
        const auto attach = [&](Layer& layer, const std::string& channel, uint32_t index)
        {
            const size_t step = sizeof(float) * layer.channels;
            // OpenEXR addresses pixels by data window coordinates.
            char* base = reinterpret_cast<char*>(layer.pixels.data() + index) -
                         (static_cast<ptrdiff_t>(window.min.y) * images.width + window.min.x) * static_cast<ptrdiff_t>(step);
            buffer.insert(channel, Imf::Slice(Imf::FLOAT, base, step, step * images.width));
        };
        for (const auto& [prefix, channels] : groups)
        {
            const std::string start = prefix.empty() ? "" : prefix + ".";
            const std::string layerName = prefix.empty() ? "beauty" : prefix;
            const auto has = [&](const char* wanted) { return std::find(channels.begin(), channels.end(), wanted) != channels.end(); };
            const bool colours = has("R") && has("G") && has("B");
            if (colours)
            {
                Layer& layer = images.add(layerName, 3);
                for (uint32_t i = 0; i < 3; ++i) attach(layer, start + kColours[i], i);
            }
            for (const std::string& channel : channels)
            {
                const bool isColour = channel == "R" || channel == "G" || channel == "B";
                if ((colours && isColour) || channel == "A") continue;
                attach(images.add(channel == "Y" && !colours ? layerName : start + channel, 1), start + channel, 0);
            }
        }
        input.setFrameBuffer(buffer);
        input.readPixels(window.min.y, window.max.y);
        return images;
    }
    catch (const std::exception& failure)
    {
        return Error{ErrorCode::badInput, fmt::format("Picture '{}' is not read: {}; write it again.", file.string(), failure.what())};
    }
}

Status writePng(std::span<const float> linearRgb, uint32_t width, uint32_t height, const std::filesystem::path& file)
{
    if (width == 0 || height == 0 || linearRgb.size() != size_t(width) * height * 3)
        return Error{ErrorCode::badArgument, fmt::format("PNG '{}' has {} floats for {}x{} pixels; it needs three a pixel", file.string(),
                                                         linearRgb.size(), width, height)};
    std::vector<uint8_t> bytes(linearRgb.size());
    std::transform(linearRgb.begin(), linearRgb.end(), bytes.begin(),
                   [](float v) { return static_cast<uint8_t>(std::lround(255.0f * srgbFromLinear(v))); });
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string text(size, '\0');
    if (!png_image_write_to_memory(&image, text.data(), &size, 0, bytes.data(), 0, nullptr))
        return fileFailure(file, "write", image.message);
    text.resize(size);
    return writeText(file, text);
}

namespace
{
// (a x^2 + b x) / (d x^2 + e x + f), x scaled by 0.6.
constexpr float kAcesA = 2.51f * 0.36f;
constexpr float kAcesB = 0.03f * 0.6f;
constexpr float kAcesD = 2.43f * 0.36f;
constexpr float kAcesE = 0.59f * 0.6f;
constexpr float kAcesF = 0.14f;
} // namespace

float toneMapAces(float value)
{
    if (!(value > 0.0f)) return 0.0f;
    if (value > 1e6f) return 1.0f;
    return std::min(1.0f, (kAcesA * value * value + kAcesB * value) / (kAcesD * value * value + kAcesE * value + kAcesF));
}

float inverseToneMapAces(float mapped)
{
    const float a = kAcesA - mapped * kAcesD;
    const float b = kAcesB - mapped * kAcesE;
    const float c = -mapped * kAcesF;
    return (-b + std::sqrt(b * b - 4.0f * a * c)) / (2.0f * a); // a > 0 for mapped < 1.03: one positive root
}

std::vector<float> toneMap(std::span<const float> linearRgb, float exposure)
{
    std::vector<float> mapped(linearRgb.size());
    std::transform(linearRgb.begin(), linearRgb.end(), mapped.begin(), [exposure](float v) { return toneMapAces(exposure * v); });
    return mapped;
}

float autoExposure(std::span<const float> linearRgb)
{
    double sum = 0.0;
    size_t count = 0;
    for (size_t i = 0; i + 2 < linearRgb.size(); i += 3)
    {
        const float y = luminance({linearRgb[i], linearRgb[i + 1], linearRgb[i + 2]});
        if (!(y > 1e-6f) || !std::isfinite(y)) continue;
        sum += std::log(y);
        ++count;
    }
    return count == 0 ? 1.0f : static_cast<float>(0.18 / std::exp(sum / static_cast<double>(count)));
}

float srgbFromLinear(float value)
{
    if (!(value > 0.0f)) return 0.0f;
    if (value >= 1.0f) return 1.0f;
    return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

} // namespace sconce
