#include "scene/gltf_layout.h"

#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace sconce
{

namespace
{

using Json = nlohmann::json;

constexpr uint64_t kMaxNumber = 1ull << 40; // of any offset, length or count; products of two 4-byte factors of it stay below 2^63

Error bad(const std::string& sentence)
{
    return {ErrorCode::badInput, sentence};
}

// A non-negative integer of an object; `missing` where it isn't given.
Result<uint64_t> number(const Json& object, const char* key, const std::string& owner, const uint64_t* missing)
{
    const auto it = object.find(key);
    if (it == object.end())
    {
        if (missing) return *missing;
        return bad(fmt::format("{} has no {}; the file is damaged, export it again.", owner, key));
    }
    if (!it->is_number_unsigned() || it->get<uint64_t>() > kMaxNumber)
        return bad(fmt::format("{} has {} {}; it must be an integer from 0 to {}, export the file again.", owner, key,
                               it->dump().substr(0, 40), kMaxNumber));
    return it->get<uint64_t>();
}

uint32_t typeComponents(const Json& accessor)
{
    const auto it = accessor.find("type");
    if (it == accessor.end() || !it->is_string()) return 0;
    const std::string& type = it->get_ref<const std::string&>();
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4" || type == "MAT2") return 4;
    if (type == "MAT3") return 9;
    return type == "MAT4" ? 16 : 0;
}

struct View
{
    uint64_t bytes = 0, stride = 0;
};

class LayoutCheck
{
public:
    explicit LayoutCheck(const Json& document) : gltf(document) {}

    Status views(const std::vector<uint64_t>& bufferBytes)
    {
        const Json empty = Json::array();
        const Json& list = gltf.contains("bufferViews") ? gltf["bufferViews"] : empty;
        for (size_t i = 0; i < list.size(); ++i)
        {
            const std::string owner = fmt::format("Buffer view {}", i);
            const uint64_t zero = 0;
            const auto buffer = number(list[i], "buffer", owner, nullptr), offset = number(list[i], "byteOffset", owner, &zero);
            const auto length = number(list[i], "byteLength", owner, nullptr), stride = number(list[i], "byteStride", owner, &zero);
            for (const auto* value : {&buffer, &offset, &length, &stride})
                if (!*value) return value->error();
            if (*buffer >= bufferBytes.size())
                return bad(fmt::format("{} uses buffer {} of {}; export the file again.", owner, *buffer, bufferBytes.size()));
            // glTF 2.0's own limits; a stride of 0 is 'not given', and elements are then tightly packed.
            if (*stride > 252 || *stride % 4 != 0)
                return bad(fmt::format("{} has byteStride {}; it must be a multiple of 4 up to 252.", owner, *stride));
            // A compression fallback without data passes here: only an accessor that reads it is a fault.
            const bool compressed = list[i].contains("extensions") && (list[i]["extensions"].contains("EXT_meshopt_compression") ||
                                                                       list[i]["extensions"].contains("KHR_meshopt_compression"));
            const uint64_t available = bufferBytes[*buffer];
            if (*offset + *length > available && !(compressed && available == 0))
                return bad(fmt::format("{} ends at byte {} of a buffer of {} bytes; the file is damaged, export it again.", owner,
                                       *offset + *length, available));
            seen.push_back({compressed && available == 0 ? kNoData : *length, *stride});
        }
        return success();
    }

    Status accessors() const
    {
        if (!gltf.contains("accessors")) return success();
        const Json& list = gltf["accessors"];
        for (size_t i = 0; i < list.size(); ++i)
            if (Status status = accessor(list[i], fmt::format("Accessor {}", i)); !status) return status;
        return success();
    }

private:
    static constexpr uint64_t kNoData = ~0ull;

    // Do `count` elements of `size` bytes fit into the view from `offset` on? Alignment isn't asked for: they are read byte by byte.
    Status fits(uint64_t view, uint64_t offset, uint64_t count, uint64_t size, bool strided, const std::string& owner) const
    {
        if (view >= seen.size()) return bad(fmt::format("{} uses buffer view {} of {}; export the file again.", owner, view, seen.size()));
        if (seen[view].bytes == kNoData)
            return bad(fmt::format("{} holds compressed data (meshopt) without an uncompressed fallback, which isn't supported; "
                                   "export the file without mesh compression.",
                                   owner));
        const uint64_t stride = strided && seen[view].stride != 0 ? seen[view].stride : size;
        if (stride < size)
            return bad(fmt::format("{} has elements of {} bytes, more than the stride of {} of its buffer view; export the file again.",
                                   owner, size, stride));
        const uint64_t end = count == 0 ? offset : offset + (count - 1) * stride + size; // below 2^40 * 252 + ..., no overflow
        if (end > seen[view].bytes)
            return bad(fmt::format("{} ends at byte {} of a buffer view of {} bytes; the file is damaged, export it again.", owner, end,
                                   seen[view].bytes));
        return success();
    }

    Status accessor(const Json& entry, const std::string& owner) const
    {
        const uint64_t zero = 0;
        const auto type = number(entry, "componentType", owner, nullptr), count = number(entry, "count", owner, nullptr);
        const auto offset = number(entry, "byteOffset", owner, &zero);
        for (const auto* value : {&type, &count, &offset})
            if (!*value) return value->error();
        const uint64_t component = componentBytes(*type), components = typeComponents(entry);
        if (component == 0)
            return bad(fmt::format("{} has component type {}, which glTF 2.0 doesn't have; export the file again.", owner, *type));
        if (components == 0) return bad(fmt::format("{} has an unknown type; glTF 2.0 has SCALAR, VEC2 to VEC4 and MAT2 to MAT4.", owner));
        if (*count > 0xffffffffull) return bad(fmt::format("{} has {} elements; the limit is 2^32 - 1, split the mesh.", owner, *count));
        if (entry.contains("bufferView"))
        {
            const auto view = number(entry, "bufferView", owner, nullptr);
            if (!view) return view.error();
            if (Status status = fits(*view, *offset, *count, component * components, true, owner); !status) return status;
        }
        return entry.contains("sparse") ? sparse(entry["sparse"], *count, component * components, fmt::format("{} (sparse)", owner))
                                        : success();
    }

    Status sparse(const Json& entry, uint64_t elements, uint64_t size, const std::string& owner) const
    {
        if (!entry.is_object() || !entry.contains("indices") || !entry.contains("values") || !entry["indices"].is_object() ||
            !entry["values"].is_object())
            return bad(fmt::format("{} lacks indices or values; the file is damaged, export it again.", owner));
        const uint64_t zero = 0;
        const Json &indices = entry["indices"], &values = entry["values"];
        const auto count = number(entry, "count", owner, nullptr), type = number(indices, "componentType", owner, nullptr);
        const auto indexView = number(indices, "bufferView", owner, nullptr), indexOffset = number(indices, "byteOffset", owner, &zero);
        const auto valueView = number(values, "bufferView", owner, nullptr), valueOffset = number(values, "byteOffset", owner, &zero);
        for (const auto* value : {&count, &type, &indexView, &indexOffset, &valueView, &valueOffset})
            if (!*value) return value->error();
        if (*count > elements) return bad(fmt::format("{} replaces {} of {} elements; export the file again.", owner, *count, elements));
        if (*type != 5121 && *type != 5123 && *type != 5125)
            return bad(fmt::format("{} has indices of component type {}; they must be unsigned.", owner, *type));
        const uint64_t indexBytes = componentBytes(*type);
        if (Status status = fits(*indexView, *indexOffset, *count, indexBytes, false, owner); !status) return status;
        return fits(*valueView, *valueOffset, *count, size, false, owner);
    }

    const Json& gltf;
    std::vector<View> seen;
};

} // namespace

uint32_t componentBytes(uint64_t componentType)
{
    switch (componentType)
    {
    case 5120: // byte
    case 5121: // unsigned byte
        return 1;
    case 5122: // short
    case 5123: // unsigned short
        return 2;
    case 5125: // unsigned int
    case 5126: // float
        return 4;
    default:
        return 0;
    }
}

Status checkLayout(const Json& gltf, const std::vector<uint64_t>& bufferBytes)
{
    LayoutCheck check(gltf);
    if (Status status = check.views(bufferBytes); !status) return status;
    return check.accessors();
}

} // namespace sconce
