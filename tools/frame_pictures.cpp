#include "tools/frame_pictures.h"

#include <algorithm>
#include <string_view>

namespace sconce::tools
{

namespace
{

void addColours(ImageSet& images, const char* name, const std::vector<vec3>& pixels)
{
    if (pixels.empty()) return;
    Layer& layer = images.add(name, 3);
    for (size_t i = 0; i < pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) layer.pixels[3 * i + size_t(c)] = pixels[i][c];
}

void addNumbers(ImageSet& images, const char* name, const std::vector<float>& pixels)
{
    if (!pixels.empty()) images.add(name, 1).pixels = pixels;
}

} // namespace

const std::vector<std::string>& frameLayers()
{
    static const std::vector<std::string> layers = {"beauty", "direct",   "diffuse_indirect", "glossy_indirect",
                                                    "depth",  "normal",   "albedo",           "roughness",
                                                    "probe",  "handoffs", "fetches",          "unknown"};
    return layers;
}

bool wantsLayersOfLight(const std::string& aov)
{
    constexpr std::string_view kept[] = {"indirect", "probe", "handoffs", "fetches", "unknown"};
    return aov.empty() || std::ranges::any_of(kept, [&](std::string_view layer) { return aov.find(layer) != std::string::npos; });
}

ImageSet imagesOf(const RenderedFrame& frame)
{
    ImageSet images;
    images.width = frame.width;
    images.height = frame.height;
    addColours(images, "beauty", frame.beauty);
    addColours(images, "direct", frame.direct);
    addColours(images, "diffuse_indirect", frame.diffuseIndirect);
    addColours(images, "glossy_indirect", frame.glossyIndirect);
    addNumbers(images, "depth", frame.depth);
    addColours(images, "normal", frame.normal);
    addColours(images, "albedo", frame.albedo);
    addNumbers(images, "roughness", frame.roughness);
    const char* const names[] = {"probe", "handoffs", "fetches", "unknown"};
    for (int part = 0; part < 4 && !frame.counts.empty(); ++part)
    {
        Layer& layer = images.add(names[part], 1);
        for (size_t i = 0; i < frame.counts.size(); ++i)
            layer.pixels[i] = part == 0 && frame.counts[i].x == gpu::kNoProbe ? -1.0f : float(frame.counts[i][part]);
    }
    return images;
}

} // namespace sconce::tools
