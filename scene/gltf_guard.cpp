#include "scene/gltf_guard.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/gltf_layout.h"

namespace sconce
{

namespace fs = std::filesystem;

namespace
{

using Json = nlohmann::json;
using Bytes = std::vector<uint8_t>;

Error bad(const std::string& sentence)
{
    return {ErrorCode::badInput, sentence};
}
Error unreadable(const std::string& sentence)
{
    return {ErrorCode::fileError, sentence};
}

Result<Bytes> decodeBase64(std::string_view text, const std::string& what)
{
    static const std::array<int8_t, 256> value = []
    {
        std::array<int8_t, 256> table{};
        table.fill(-1);
        const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        for (size_t i = 0; i < digits.size(); ++i) table[uint8_t(digits[i])] = int8_t(i);
        table[uint8_t('-')] = 62, table[uint8_t('_')] = 63; // the URL-safe spelling
        return table;
    }();
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    Bytes out;
    out.reserve(text.size() / 4 * 3 + 3);
    uint32_t bits = 0;
    int held = 0;
    for (const char c : text)
    {
        const int8_t digit = value[uint8_t(c)];
        if (digit < 0) return bad(fmt::format("{} has a data URI that is not base64; export the file again.", what));
        bits = bits << 6 | uint32_t(digit);
        if ((held += 6) >= 8) out.push_back(uint8_t(bits >> (held -= 8)));
    }
    return out;
}

Result<Bytes> decodeDataUri(std::string_view uri, const std::string& what)
{
    const size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
        return bad(fmt::format("{} has a data URI without ';base64,'; export the file again.", what));
    const std::string_view text = uri.substr(comma + 1);
    if (text.find('%') == std::string_view::npos) return decodeBase64(text, what);
    const auto plain = percentDecode(text); // '+' and '/' may come as %2B and %2F
    if (!plain) return plain.error();
    return decodeBase64(*plain, what);
}

uint32_t littleEndian(std::span<const uint8_t> bytes, size_t at)
{
    return uint32_t(bytes[at]) | uint32_t(bytes[at + 1]) << 8 | uint32_t(bytes[at + 2]) << 16 | uint32_t(bytes[at + 3]) << 24;
}

struct Container
{
    std::string json;
    std::optional<Bytes> binary;
};

Result<Container> splitGlb(const Bytes& bytes, const std::string& name)
{
    constexpr uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942; // "JSON", "BIN\0"
    if (bytes.size() < 20) return bad(fmt::format("{} has {} bytes, too few for a GLB; copy or export it again.", name, bytes.size()));
    const uint64_t version = littleEndian(bytes, 4), length = littleEndian(bytes, 8);
    if (version != 2) return bad(fmt::format("{} is GLB version {}; convert it to glTF 2.0.", name, version));
    if (length > bytes.size())
        return bad(fmt::format("{} says it has {} bytes but has {}; copy or export it again.", name, length, bytes.size()));
    Container container;
    for (uint64_t at = 12; at + 8 <= length;)
    {
        const uint64_t size = littleEndian(bytes, at), type = littleEndian(bytes, at + 4);
        if (size > length - at - 8)
            return bad(fmt::format("{} has a chunk at byte {} that runs past the end; copy or export it again.", name, at));
        const auto begin = bytes.begin() + int64_t(at + 8);
        if (at == 12 && type != kJson) return bad(fmt::format("{} doesn't begin with a JSON chunk; export it again.", name));
        if (at == 12 && size > GltfLimits::jsonBytes) return bad(fmt::format("{} has {} bytes of JSON; the limit is 256 MiB.", name, size));
        // All chunks but the JSON and the first binary one are skipped, as glTF 2.0 section 4.4.3 asks of unknown types.
        if (at == 12)
            container.json.assign(begin, begin + int64_t(size));
        else if (type == kBinary && !container.binary)
            container.binary = Bytes(begin, begin + int64_t(size));
        at += 8 + (size + 3) / 4 * 4;
    }
    return container;
}

// What this importer does to the letter. A file that requires more would look wrong, so it is refused by the extension's name.
Status checkRequired(const Json& gltf, const std::string& name)
{
    static constexpr std::string_view known[] = {"KHR_mesh_quantization", "KHR_materials_emissive_strength", "KHR_texture_transform",
                                                 "KHR_lights_punctual",   "EXT_mesh_gpu_instancing",         "EXT_texture_webp"};
    if (!gltf.contains("extensionsRequired")) return success();
    if (!gltf["extensionsRequired"].is_array())
        return bad(fmt::format("{} has 'extensionsRequired' that is no array; export it again.", name));
    for (const Json& entry : gltf["extensionsRequired"])
    {
        const std::string extension = entry.is_string() ? entry.get<std::string>() : entry.dump().substr(0, 40);
        if (std::find(std::begin(known), std::end(known), extension) != std::end(known)) continue;
        const bool compressed = extension.ends_with("_compression");
        return bad(fmt::format("{} requires the extension {}, which isn't supported; export it {}", name, extension,
                               compressed ? "without mesh compression." : "without that extension."));
    }
    return success();
}

// tinygltf takes the top-level lists for arrays of objects; so does everything here.
Status checkShape(const Json& gltf, const std::string& name)
{
    if (!gltf.is_object()) return bad(fmt::format("{} holds JSON that is no object; it is no glTF file.", name));
    if (!gltf.contains("asset") || !gltf["asset"].is_object() || !gltf["asset"].contains("version") ||
        !gltf["asset"]["version"].is_string())
        return bad(fmt::format("{} has no asset version; it is no glTF 2.0 file.", name));
    if (const std::string version = gltf["asset"]["version"]; !version.starts_with("2."))
        return bad(fmt::format("{} is glTF version '{}'; convert it to 2.0.", name, version.substr(0, 20)));
    for (const char* list : {"buffers", "bufferViews", "accessors", "images", "textures", "samplers", "materials", "meshes", "nodes",
                             "scenes", "cameras", "skins", "animations"})
    {
        if (!gltf.contains(list)) continue;
        if (!gltf[list].is_array()) return bad(fmt::format("{} has '{}' that is no array; export it again.", name, list));
        for (const Json& entry : gltf[list])
            if (!entry.is_object()) return bad(fmt::format("{} has an entry of '{}' that is no object; export it again.", name, list));
    }
    return success();
}

// Draco may come beside plain data, which is then used; without it the accessors have no buffer view and would read as zeros.
Status checkCompressedMeshes(const Json& gltf, const std::string& name)
{
    if (!gltf.contains("meshes")) return success();
    const auto plain = [&](const Json& accessor)
    {
        return accessor.is_number_unsigned() && gltf.contains("accessors") && accessor.get<size_t>() < gltf["accessors"].size() &&
               (gltf["accessors"][accessor.get<size_t>()].contains("bufferView") ||
                gltf["accessors"][accessor.get<size_t>()].contains("sparse"));
    };
    for (const Json& mesh : gltf["meshes"])
        for (const Json& primitive : mesh.value("primitives", Json::array()))
        {
            if (!primitive.is_object() || !primitive.value("extensions", Json::object()).contains("KHR_draco_mesh_compression")) continue;
            const Json attributes = primitive.value("attributes", Json::object());
            if (!plain(attributes.value("POSITION", Json())) || (primitive.contains("indices") && !plain(primitive["indices"])))
                return bad(name +
                           " holds a mesh only as KHR_draco_mesh_compression, which isn't supported; export it without mesh compression.");
        }
    return success();
}

bool isFallback(const Json& buffer)
{
    if (!buffer.contains("extensions") || !buffer["extensions"].is_object()) return false;
    const Json& extensions = buffer["extensions"];
    return extensions.contains("EXT_meshopt_compression") || extensions.contains("KHR_meshopt_compression");
}

Status readBuffers(const Json& gltf, std::optional<Bytes> binary, GuardedGltf& out)
{
    if (!gltf.contains("buffers")) return success();
    uint64_t total = 0;
    for (size_t i = 0; i < gltf["buffers"].size(); ++i)
    {
        const Json& buffer = gltf["buffers"][i];
        const std::string what = fmt::format("Buffer {}", i);
        if (!buffer.contains("byteLength") || !buffer["byteLength"].is_number_unsigned())
            return bad(fmt::format("{} has no byteLength that is a whole number; export the file again.", what));
        const uint64_t length = buffer["byteLength"];
        Bytes bytes;
        if (buffer.contains("uri"))
        {
            if (!buffer["uri"].is_string()) return bad(fmt::format("{} has a URI that is no string; export the file again.", what));
            auto read = out.folder.read(buffer["uri"].get_ref<const std::string&>(), what);
            if (!read) return read.error();
            bytes = std::move(*read);
        }
        else if (isFallback(buffer))
        {
            out.buffers.emplace_back(); // data only exists compressed; checkLayout refuses accessors that read it
            continue;
        }
        else if (i == 0 && binary)
            bytes = std::move(*binary);
        else if (length > 0)
            return bad(fmt::format("{} has neither a URI nor a binary chunk; export the file again.", what));
        if (bytes.size() < length)
            return bad(fmt::format("{} has {} bytes but should have {}; the file is incomplete, copy or export it again.", what,
                                   bytes.size(), length));
        bytes.resize(length); // GLB chunks are padded
        if ((total += length) > GltfLimits::totalBytes) return bad("The buffers hold more than 6 GiB; split the scene.");
        out.buffers.push_back(std::move(bytes));
    }
    return success();
}

Status listImages(const Json& gltf, GuardedGltf& out)
{
    if (!gltf.contains("images")) return success();
    const size_t views = gltf.contains("bufferViews") ? gltf["bufferViews"].size() : 0;
    for (size_t i = 0; i < gltf["images"].size(); ++i)
    {
        const Json& entry = gltf["images"][i];
        GltfImage image;
        image.name = fmt::format("image {}", i);
        if (entry.contains("uri") && entry["uri"].is_string())
        {
            image.uri = entry["uri"];
            if (!image.uri.starts_with("data:")) image.name = image.uri.substr(0, 200);
        }
        else if (entry.contains("bufferView") && entry["bufferView"].is_number_unsigned() && entry["bufferView"].get<uint64_t>() < views)
            image.bufferView = int(entry["bufferView"].get<uint64_t>());
        else
            return bad(fmt::format("Image {} has neither a URI nor a buffer view of this file; export the file again.", i));
        if (entry.contains("name") && entry["name"].is_string()) image.name = entry["name"].get<std::string>().substr(0, 200);
        out.images.push_back(std::move(image));
    }
    return success();
}

} // namespace

Result<Bytes> readRegularFile(const fs::path& file, const std::string& what)
{
    std::error_code problem;
    const fs::file_status status = fs::status(file, problem);
    if (!fs::exists(status)) return unreadable(fmt::format("{} can't be read: {} doesn't exist; check the path.", what, file.string()));
    if (!fs::is_regular_file(status))
        return unreadable(fmt::format("{} can't be read: {} is no regular file; name a file.", what, file.string()));
    const uint64_t size = fs::file_size(file, problem);
    if (problem) return unreadable(fmt::format("{} can't be read: {}: {}.", what, file.string(), problem.message()));
    if (size > GltfLimits::fileBytes)
        return bad(fmt::format("{} is {} of {} bytes; the limit is 2 GiB, split it.", what, file.string(), size));
    Bytes bytes(size);
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size)) && size > 0)
        return unreadable(fmt::format("{} can't be read: {} refused ({}); check its permissions.", what, file.string(),
                                      errno != 0 ? std::strerror(errno) : "it has become shorter"));
    return bytes;
}

Result<std::string> percentDecode(std::string_view uri)
{
    const auto digit = [](char c) {
        return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
    };
    std::string out;
    out.reserve(uri.size());
    for (size_t i = 0; i < uri.size(); ++i)
    {
        if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0)
        {
            out += char(digit(uri[i + 1]) * 16 + digit(uri[i + 2]));
            i += 2;
        }
        else
            out += uri[i];
        if (out.back() == '\0') return bad("A URI holds a NUL character; export the file again.");
    }
    return out;
}

Result<Bytes> SceneFolder::read(std::string_view uri, const std::string& what) const
{
    if (uri.starts_with("data:")) return decodeDataUri(uri, what);
    const auto decoded = percentDecode(uri);
    if (!decoded) return decoded.error();
    const std::string shown = fmt::format("{} names '{}', ", what, uri.substr(0, 200));
    const std::string remedy = "; only files in the scene's own folder are read, copy it there.";
    if (decoded->empty()) return bad(fmt::format("{}which is empty; export the file again.", shown));
    if (decoded->front() == '/' || decoded->find('\\') != std::string::npos || decoded->find(':') != std::string::npos)
        return bad(fmt::format("{}an absolute path, a backslash or another scheme{}", shown, remedy));
    const fs::path relative(*decoded);
    // As written first, then as resolved: '..' is refused though it might lead back, a link by where it ends.
    for (const fs::path& part : relative)
        if (part == "..") return bad(fmt::format("{}which leads out of the folder{}", shown, remedy));
    std::error_code problem;
    const fs::path base = fs::canonical(root, problem);
    if (problem) return unreadable(fmt::format("{} can't be read: the folder {} is not there.", what, root.string()));
    const fs::path target = fs::canonical(base / relative, problem); // resolves symbolic links
    if (problem) return unreadable(fmt::format("{}which can't be found; copy it next to the scene.", shown));
    if (std::mismatch(base.begin(), base.end(), target.begin(), target.end()).first != base.end())
        return bad(fmt::format("{}a link that leads out of the folder{}", shown, remedy));
    return readRegularFile(target, what);
}

Status checkJsonDepth(std::string_view json)
{
    int depth = 0;
    bool text = false;
    for (size_t i = 0; i < json.size(); ++i)
    {
        const char c = json[i];
        if (text)
        {
            if (c == '\\')
                ++i;
            else if (c == '"')
                text = false;
        }
        else if (c == '"')
            text = true;
        else if (c == '{' || c == '[')
        {
            // Counted by hand: the parsers recurse, and would overflow the stack before they could refuse.
            if (++depth > GltfLimits::jsonDepth)
                return bad(fmt::format("The JSON is nested deeper than {} levels at byte {}; remove the extras or export the file again.",
                                       GltfLimits::jsonDepth, i));
        }
        else if (c == '}' || c == ']')
            --depth;
    }
    return success();
}

Result<GuardedGltf> openGltf(const fs::path& file)
{
    const std::string name = fmt::format("'{}'", file.filename().string());
    auto bytes = readRegularFile(file, "The scene");
    if (!bytes) return bytes.error();
    Container container;
    if (bytes->size() >= 4 && std::memcmp(bytes->data(), "glTF", 4) == 0)
    {
        auto split = splitGlb(*bytes, name);
        if (!split) return split.error();
        container = std::move(*split);
    }
    else
    {
        if (bytes->size() > GltfLimits::jsonBytes)
            return bad(fmt::format("{} has {} bytes of JSON; the limit is 256 MiB.", name, bytes->size()));
        container.json.assign(bytes->begin(), bytes->end());
    }
    *bytes = Bytes(); // buffers of GB size need not be there twice
    if (Status status = checkJsonDepth(container.json); !status)
        return Error{status.error().code, fmt::format("{}: {}", name, status.error().message)};

    GuardedGltf out;
    out.folder = SceneFolder(file.has_parent_path() ? file.parent_path() : fs::path("."));
    try
    {
        Json gltf = Json::parse(container.json);
        container.json = std::string();
        // What the file claims to be is checked before any byte that it names is read.
        if (Status status = checkShape(gltf, name); !status) return status.error();
        if (Status status = checkRequired(gltf, name); !status) return status.error();
        if (Status status = checkCompressedMeshes(gltf, name); !status) return status.error();
        if (Status status = readBuffers(gltf, std::move(container.binary), out); !status) return status.error();
        std::vector<uint64_t> sizes;
        for (const Bytes& buffer : out.buffers) sizes.push_back(buffer.size());
        if (Status status = checkLayout(gltf, sizes); !status)
            return Error{status.error().code, fmt::format("{}: {}", name, status.error().message)};
        if (Status status = listImages(gltf, out); !status)
            return Error{status.error().code, fmt::format("{}: {}", name, status.error().message)};
        // The parser sees JSON that names no data: what it could be led to open has been read, and checked, here.
        gltf.erase("buffers");
        gltf.erase("images");
        out.json = gltf.dump(-1, ' ', false, Json::error_handler_t::replace);
    }
    catch (const Json::exception& problem) // the parser's and the accessors' own; with its place in the text
    {
        return bad(
            fmt::format("{} holds JSON that can't be understood ({}); export it again.", name, std::string(problem.what()).substr(0, 160)));
    }
    return out;
}

} // namespace sconce
