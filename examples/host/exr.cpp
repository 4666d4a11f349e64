#include "exr.h"

#include <stdexcept>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>

void writeExr(const std::filesystem::path& file, uint32_t width, uint32_t height, std::span<const ExrLayer> layers)
{
    try
    {
        Imf::Header header(static_cast<int>(width), static_cast<int>(height));
        Imf::FrameBuffer slices;
        for (const ExrLayer& layer : layers)
            for (int channel = 0; channel < 3; ++channel)
            {
                const std::string name = (layer.name.empty() ? "" : layer.name + ".") + "RGB"[channel];
                header.channels().insert(name, Imf::Channel(Imf::FLOAT));
                // OpenEXR takes a pointer that isn't const, and only reads it.
                auto* first = const_cast<char*>(reinterpret_cast<const char*>(layer.pixels.data())) + sizeof(float) * size_t(channel);
                slices.insert(name, Imf::Slice(Imf::FLOAT, first, sizeof(glm::vec4), sizeof(glm::vec4) * width));
            }
        Imf::OutputFile output(file.c_str(), header);
        output.setFrameBuffer(slices);
        output.writePixels(static_cast<int>(height));
    }
    catch (const std::exception& failure)
    {
        throw std::runtime_error("'" + file.string() + "' can't be written: " + failure.what() + "; check the path and the free space");
    }
}
