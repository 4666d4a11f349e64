#include "bench/sweep/keys.h"

#include <fstream>
#include <span>

#include <fmt/format.h>

namespace sconce
{

std::string keyOf(const nlohmann::ordered_json& json)
{
    const std::string text = json.dump();
    ContentHash hash;
    hash.addBytes(std::as_bytes(std::span(text)));
    return keyText(hash.value());
}

Result<std::string> keyOfFile(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    ContentHash hash;
    std::vector<char> piece(size_t(1) << 20);
    while (stream)
    {
        stream.read(piece.data(), std::streamsize(piece.size()));
        hash.addBytes(std::as_bytes(std::span<const char>(piece).first(size_t(stream.gcount()))));
    }
    if (!stream.eof())
        return Error{ErrorCode::fileError, fmt::format("Cannot read '{}'; check that it is there and may be read.", file.string())};
    return keyText(hash.value());
}

} // namespace sconce
