#pragma once

#include <filesystem>
#include <istream>

#include <fmt/format.h>

#include "base/result.h"

namespace sconce
{

/// The JSON in a stream, discarded where it is none. Errors: fileError, where the file can't be read to its end.
/// @tparam Json  nlohmann's
template <class Json> Result<Json> parsedJson(std::istream& stream, const std::filesystem::path& file)
{
    try
    {
        return Json::parse(stream, nullptr, /*allow_exceptions=*/false);
    }
    catch (const std::ios_base::failure& failed) // the parser asks the stream's buffer, which throws where a disk fails
    {
        return Error{ErrorCode::fileError, fmt::format("File '{}' can't be read to its end: {}", file.string(), failed.code().message())};
    }
}

} // namespace sconce
