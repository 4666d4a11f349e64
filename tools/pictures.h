#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/reference/image_io.h"
#include "tools/common.h"

namespace sconce::tools
{

/// What the commands that make pictures share: -o, --aov, --png, --exposure.
struct PictureOptions
{
    std::string output, png, aov;
    std::optional<float> exposure;

    /// @param layers what --aov may name, comma-separated in the help
    void add(CLI::App* command, const std::vector<std::string>& layers);
    /// Empty when every name of --aov is one of `layers`, else the sentence. Asked before the work.
    std::string problem(const std::vector<std::string>& layers) const;
    /// Whether the files can be written: before the work, too. Errors: fileError.
    Status writable() const;
    /// Keeps the layers that --aov names, writes the EXR and the PNG, and adds size, layers and exposure to the results.
    Status write(ImageSet images, Json& json) const;
};

} // namespace sconce::tools
