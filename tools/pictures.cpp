#include "tools/pictures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/listed.h"
#include "base/safe_file.h"

namespace sconce::tools
{

namespace
{

std::string joined(const std::vector<std::string>& names)
{
    return listed(names, {}, ","); // as --aov takes them
}

} // namespace

void PictureOptions::add(CLI::App* command, const std::vector<std::string>& layers)
{
    command->add_option("-o,--output", output, "EXR to write, 32-bit float, linear radiance (required)")->required()->type_name("FILE");
    command
        ->add_option("--aov", aov,
                     described(fmt::format("Layers to write, separated by commas, of {}", joined(layers)), words("all that are at hand")))
        ->type_name("LIST");
    command->add_option("--png", png, described("Also writes the beauty layer as it looks: exposure, ACES tone map, sRGB", words("none")))
        ->type_name("FILE");
    addKnob(command, "--exposure", exposure, knobs::exposure, "FACTOR");
}

std::string PictureOptions::problem(const std::vector<std::string>& layers) const
{
    if (aov.empty()) return {};
    for (const std::string& name : split(aov, ','))
        if (std::ranges::find(layers, name) == layers.end())
            return fmt::format("--aov: there is no layer '{}' here; there are {}.", name, joined(layers));
    return {};
}

Status PictureOptions::writable() const
{
    for (const std::string& name : {output, png})
        if (!name.empty())
            if (Status fine = sconce::writable(name); !fine) return fine;
    return success();
}

Status PictureOptions::write(ImageSet images, Json& json) const
{
    json["width"] = images.width;
    json["height"] = images.height;
    std::vector<float> shown;
    if (const Layer* beauty = images.find("beauty"))
    {
        const float used = exposure.value_or(autoExposure(beauty->pixels));
        json["exposure"] = used;
        if (!png.empty()) shown = toneMap(beauty->pixels, used);
    }
    if (!aov.empty())
    {
        const std::vector<std::string> wanted = split(aov, ',');
        std::erase_if(images.layers, [&](const Layer& layer) { return std::ranges::find(wanted, layer.name) == wanted.end(); });
    }
    json["layers"] = Json::array();
    for (const Layer& layer : images.layers) json["layers"].push_back(layer.name);
    // The EXR first: a picture to look at can be made of it again.
    if (Status status = writeExr(images, output); !status || shown.empty()) return status;
    return writePng(shown, images.width, images.height, png);
}

} // namespace sconce::tools
