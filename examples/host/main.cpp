// A small Vulkan renderer of its own, without a window: it draws a glTF scene with its sun, takes indirect light from Sconce (sconce_gi.*,
// and nothing else of it), and writes the picture.
#include <charconv>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

#include "exr.h"
#include "gbuffer.h"
#include "gltf_mesh.h"
#include "lighting.h"
#include "sconce_bake.h"
#include "sconce_gi.h"
#include "sun_shadow.h"

namespace
{

constexpr const char* kUsage = R"(usage: host SCENE.gltf|SCENE.glb FIELD.sconce -o PICTURE.exr [options]
  --camera N      camera of the scene, from 0 (default: 0)
  --size WxH      pixels (default: 640x360)
  --frames N      frames that are drawn, 1 to 1000; more than one are filtered over time (default: 1)
  --probe X,Y,Z   a place to see the scene from, once for each: FIELD is baked first, by what this host draws there
  --left-handed   a world with z turned round and a camera that looks along +z; the picture is the same
  --validation    with the validation layer, and Sconce's look at its inputs; what they find is a failure
)";

struct Options
{
    std::string scene, field, output;
    uint32_t camera = 0, width = 640, height = 360, frames = 1;
    std::vector<glm::vec3> probes;
    Convention convention;
    bool validation = false;
};

glm::vec3 placeOf(const std::string& text)
{
    glm::vec3 place;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%f,%f,%f%c", &place.x, &place.y, &place.z, &rest) != 3)
        throw std::invalid_argument("--probe is '" + text + "'; write a place in metres, as 1,1.5,-2");
    return place;
}

/// @param limit  the largest that is allowed
uint32_t numberOf(const std::string& text, const char* option, uint32_t least, uint32_t limit)
{
    uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < least || value > limit)
        throw std::invalid_argument(std::string(option) + " is '" + text + "'; give a number from " + std::to_string(least) + " to " +
                                    std::to_string(limit));
    return value;
}

Options parse(int argc, char** argv)
{
    Options options;
    std::vector<std::string> files;
    for (int i = 1; i < argc; ++i)
    {
        const std::string word = argv[i];
        const auto value = [&]() -> std::string
        {
            if (i + 1 >= argc) throw std::invalid_argument(word + " needs a value\n" + kUsage);
            return argv[++i];
        };
        if (word == "-o")
            options.output = value();
        else if (word == "--camera")
            options.camera = numberOf(value(), "--camera", 0, 1'000'000);
        else if (word == "--frames")
            options.frames = numberOf(value(), "--frames", 1, 1000);
        else if (word == "--probe")
            options.probes.push_back(placeOf(value()));
        else if (word == "--left-handed")
            options.convention.leftHanded = true;
        else if (word == "--validation")
            options.validation = true;
        else if (word == "--size")
        {
            const std::string size = value();
            const size_t cross = size.find('x');
            if (cross == std::string::npos) throw std::invalid_argument("--size is '" + size + "'; write it as 640x360");
            options.width = numberOf(size.substr(0, cross), "--size", 1, 16384);
            options.height = numberOf(size.substr(cross + 1), "--size", 1, 16384);
        }
        else if (word.starts_with("-"))
            throw std::invalid_argument("there is no option '" + word + "'\n" + kUsage);
        else
            files.push_back(word);
    }
    if (files.size() != 2 || options.output.empty()) throw std::invalid_argument(std::string("two files and -o are needed\n") + kUsage);
    options.scene = files[0];
    options.field = files[1];
    return options;
}

std::vector<glm::vec4> readBack(const Vulkan& vulkan, const Image& image)
{
    std::vector<glm::vec4> pixels(size_t(image.size.width) * image.size.height);
    const Buffer buffer = vulkan.makeBuffer(pixels.size() * sizeof(glm::vec4), vk::BufferUsageFlagBits::eTransferDst, true);
    vulkan.run(
        [&](vk::CommandBuffer cmd)
        {
            const vk::BufferImageCopy copy{.imageSubresource = {image.aspect(), 0, 0, 1},
                                           .imageExtent = {image.size.width, image.size.height, 1}};
            cmd.copyImageToBuffer(*image.image, vk::ImageLayout::eTransferSrcOptimal, *buffer.buffer, copy);
            const vk::MemoryBarrier2 toHost{.srcStageMask = vk::PipelineStageFlagBits2::eAllTransfer,
                                            .srcAccessMask = vk::AccessFlagBits2::eTransferWrite,
                                            .dstStageMask = vk::PipelineStageFlagBits2::eHost,
                                            .dstAccessMask = vk::AccessFlagBits2::eHostRead};
            cmd.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &toHost});
        });
    std::memcpy(pixels.data(), buffer.mapped, pixels.size() * sizeof(glm::vec4));
    return pixels;
}

/// Everything of Sconce is made and gone in here.
void draw(const Vulkan& vulkan, Allocators& lent, const Options& options)
{
    const DrawnScene scene(vulkan, loadGltf(options.scene, options.convention.axes()));
    for (const std::string& warning : scene.model().warnings) std::fprintf(stderr, "host: %s\n", warning.c_str());
    if (!options.probes.empty()) bakeField(vulkan, lent, scene, options.convention, options.probes, options.field);
    const auto& cameras = scene.model().cameras;
    if (options.camera >= cameras.size())
        throw std::runtime_error("--camera is " + std::to_string(options.camera) + ", and '" + options.scene + "' has " +
                                 std::to_string(cameras.size()) + "; add one or choose another");
    const Camera& camera = cameras[options.camera];
    const Sun sun = scene.model().sun.value_or(Sun{}); // without one: black

    const vk::Extent2D size{options.width, options.height};
    const GBuffer gbuffer(vulkan, scene, size);
    const SunShadow shadow(vulkan, scene, sun);
    Lighting lighting(vulkan, size);
    SconceGi gi(vulkan, lent, options.field, size, options.frames > 1);
    if (!gi.hasAllDiffuse())
        std::fprintf(stderr, "host: '%s' holds no surface light, and this host draws no light straight from lamps and sky: it is missing\n",
                     options.field.c_str());
    gi.setGBuffer({*gbuffer.depth.view, *gbuffer.normalRoughness.view, *gbuffer.baseColorMetallic.view});
    lighting.setInputs(gbuffer, shadow, {gi.terms(lighting.nothing()), gi.made(), gi.raysBelow, gi.sky()});
    for (uint32_t frame = 0; frame < options.frames; ++frame)
        vulkan.run(
            [&](vk::CommandBuffer cmd)
            {
                gbuffer.record(cmd, camera, options.convention);
                shadow.record(cmd);
                gi.record(cmd, camera, options.convention, 1 + frame);
                lighting.record(cmd, camera, options.convention, sun, shadow);
            });

    const std::vector<std::string> faults = options.validation ? gi.faults() : std::vector<std::string>();
    for (const std::string& fault : faults) std::fprintf(stderr, "host: %s\n", fault.c_str());
    if (!faults.empty()) throw std::runtime_error("Sconce's inputs are wrong");

    const char* names[] = {"direct", "diffuse_indirect", "glossy_indirect", ""};
    std::vector<ExrLayer> layers;
    for (size_t i = 0; i < lighting.pictures.size(); ++i) layers.push_back({names[i], readBack(vulkan, lighting.pictures[i])});
    writeExr(options.output, options.width, options.height, layers);
    std::printf("%ux%u pixels, %u frames\nSconce holds %llu bytes of device memory, lent %llu in %zu blocks\n", options.width,
                options.height, options.frames, static_cast<unsigned long long>(gi.bytes()),
                static_cast<unsigned long long>(lent.device.bytes()), lent.device.blocks());
}

int run(const Options& options)
{
    const Vulkan vulkan(SconceGi::missing, SconceGi::addFeatures, options.validation);
    Allocators lent(*vulkan.device);
    draw(vulkan, lent, options);
    std::printf("afterwards %llu bytes of device memory and %lld blocks of main memory, of %llu and %lld\n",
                static_cast<unsigned long long>(lent.device.bytes()), static_cast<long long>(lent.main.blocks()),
                static_cast<unsigned long long>(lent.device.mostBytes()), static_cast<long long>(lent.main.calls()));
    if (lent.device.blocks() > 0 || lent.main.blocks() > 0) throw std::runtime_error("what was lent has not all come back");
    if (vulkan.validationMessages() > 0) throw std::runtime_error("the validation layer has found faults");
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    try
    {
        return run(parse(argc, argv));
    }
    catch (const std::invalid_argument& misuse)
    {
        std::fprintf(stderr, "host: %s\n", misuse.what());
        return 2;
    }
    catch (const vk::SystemError& failure)
    {
        std::fprintf(stderr, "host: the device refused: %s; ask for a smaller picture, or see what --validation says\n", failure.what());
        return 1;
    }
    catch (const std::exception& failure)
    {
        std::fprintf(stderr, "host: %s\n", failure.what());
        return 1;
    }
}
