// What the command line names beside a scene: lights, a sun's path, shapes, a viewer's script.
#include "tests/fuzzers/input.h"
#include "tools/live_light_options.h"
#include "tools/moving_shape_options.h"
#include "tools/view/script.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    using namespace sconce;
    const auto file = testing_support::inputFile(bytes, size);
    std::vector<Light> lights;
    tools::LiveLightOptions options;
    options.file = file.string();
    (void)options.apply(lights);
    (void)tools::sunPath(file, 5);
    (void)tools::MovingShapeOptions{file.string()}.read();
    (void)tools::readScript(file);
    return 0;
}
