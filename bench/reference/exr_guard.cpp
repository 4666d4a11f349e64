#include "bench/reference/exr_guard.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace sconce
{
namespace
{

constexpr uint32_t kMagic = 20000630, kVersion = 2, kLongNames = 0x400;
constexpr size_t kMostName = 255;
constexpr uint8_t kPiz = 4; // compressions are numbered: none, RLE, ZIPS, ZIP, PIZ, then those that lose something
constexpr const char* kWriteAgain = "write it as one part of scan lines, packed by ZIP, from the program that made it";

/// Takes values off the front; none where too few bytes are left.
struct Bytes
{
    std::span<const std::byte> left;

    template <class T> std::optional<T> take()
    {
        if (left.size() < sizeof(T)) return {};
        T value;
        std::memcpy(&value, left.data(), sizeof(T));
        left = left.subspan(sizeof(T));
        return value;
    }
    std::optional<std::span<const std::byte>> take(size_t count)
    {
        if (left.size() < count) return {};
        const auto taken = left.first(count);
        left = left.subspan(count);
        return taken;
    }
    /// Up to a zero, which goes, too.
    std::optional<std::string_view> takeName()
    {
        const auto zero = std::ranges::find(left, std::byte(0));
        const auto length = size_t(zero - left.begin());
        if (zero == left.end() || length > kMostName) return {};
        const std::string_view name(reinterpret_cast<const char*>(left.data()), length);
        left = left.subspan(length + 1);
        return name;
    }
};

struct Box
{
    int32_t left, top, right, bottom;
};

struct Header
{
    std::optional<Box> window;
    std::optional<uint8_t> compression;
    std::optional<uint64_t> channels;
};

/// None where a list of channels isn't one: name, then pixel type, linearity, sampling in x and y; an empty name ends it.
std::optional<uint64_t> countChannels(Bytes list)
{
    struct Rest
    {
        int32_t type;
        uint32_t linear;
        int32_t sampling[2];
    };
    for (uint64_t count = 0;; ++count)
    {
        const auto name = list.takeName();
        if (!name) return {};
        if (name->empty()) return list.left.empty() ? std::optional(count) : std::nullopt;
        const auto rest = list.take<Rest>();
        if (!rest || rest->type < 0 || rest->type > 2 || rest->sampling[0] != 1 || rest->sampling[1] != 1) return {};
    }
}

struct Kind
{
    std::string_view type;
    uint32_t bytes;
};
// OpenEXR reads a value by its type, not by the size that is written before it: where they differ it goes on in the midst of the next.
constexpr Kind kKinds[] = {{"box2f", 16},      {"box2i", 16},   {"chromaticities", 32},
                           {"compression", 1}, {"double", 8},   {"envmap", 1},
                           {"float", 4},       {"int", 4},      {"keycode", 28},
                           {"lineOrder", 1},   {"m33f", 36},    {"m44f", 64},
                           {"rational", 8},    {"timecode", 8}, {"v2f", 8},
                           {"v2i", 8},         {"v3f", 12},     {"v3i", 12}};

/// Whether a value is of a kind whose size is known, and of that size.
bool isWhole(std::string_view type, Bytes value)
{
    if (type == "chlist") return countChannels(value).has_value();
    if (type == "string") return true;
    const auto* const kind = std::ranges::find(kKinds, type, &Kind::type);
    return kind != std::end(kKinds) && kind->bytes == value.left.size();
}

/// Reads what is looked at of a header; what is wrong with it otherwise.
std::string readHeader(Bytes& from, Header& header)
{
    constexpr const char* kCut = "its header is cut short or damaged; write it again";
    for (;;)
    {
        const auto name = from.takeName();
        if (!name) return kCut;
        if (name->empty()) return {};
        const auto type = from.takeName();
        const auto size = from.take<uint32_t>();
        if (!type || !size) return kCut;
        const auto value = from.take(*size);
        if (!value) return kCut;
        Bytes bytes{*value};
        if (!isWhole(*type, bytes))
            return fmt::format("its attribute '{}' is damaged or of a kind that isn't read; {}", *name, kWriteAgain);
        if (*name == "dataWindow" && *type == "box2i") header.window = bytes.take<Box>();
        if (*name == "compression" && *type == "compression") header.compression = bytes.take<uint8_t>();
        if (*name == "channels" && *type == "chlist") header.channels = countChannels(bytes);
    }
}

} // namespace

std::string exrProblem(std::span<const std::byte> start, uint64_t fileBytes)
{
    Bytes bytes{start};
    const auto magic = bytes.take<uint32_t>(), version = bytes.take<uint32_t>();
    if (!magic || !version || *magic != kMagic) return "it is no OpenEXR picture";
    if ((*version & 0xff) != kVersion || (*version >> 8 << 8 & ~kLongNames) != 0)
        return fmt::format("it is tiled, deep or of several parts; {}", kWriteAgain);
    Header header;
    if (const std::string problem = readHeader(bytes, header); !problem.empty()) return problem;
    if (!header.window || !header.compression || !header.channels)
        return fmt::format("its header lacks its size, its compression or channels of full resolution; {}", kWriteAgain);
    if (*header.compression > kPiz)
        return fmt::format("its compression, number {}, is one that loses something; {}", *header.compression, kWriteAgain);
    const Box& box = *header.window;
    const int64_t width = int64_t(box.right) - box.left + 1, height = int64_t(box.bottom) - box.top + 1;
    if (width < 1 || height < 1 || width > ExrLimits::side || height > ExrLimits::side)
        return fmt::format("it has {}x{} pixels; 1x1 to {}x{} are read", width, height, ExrLimits::side, ExrLimits::side);
    // The window may lie anywhere; what addresses its pixels counts from the origin.
    if (std::max({std::abs(int64_t(box.left)), std::abs(int64_t(box.top)), std::abs(int64_t(box.right)), std::abs(int64_t(box.bottom))}) >
        2 * ExrLimits::side)
        return fmt::format("its pixels begin at {},{}; at most {} from the origin are read", box.left, box.top, 2 * ExrLimits::side);
    const uint64_t wanted = uint64_t(width) * uint64_t(height) * *header.channels * sizeof(float);
    if (*header.channels == 0 || wanted > ExrLimits::pixelBytes || wanted / ExrLimits::mostExpansion > fileBytes)
        return fmt::format("its {}x{} pixels of {} channels don't fit its {} bytes; write it again", width, height, *header.channels,
                           fileBytes);
    return {};
}

} // namespace sconce
