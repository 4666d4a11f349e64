// A scene from its file to its checked triangles. Files beside it are never there.
#include "scene/scene_check.h"
#include "scene/scene_gltf.h"
#include "tests/fuzzers/input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    using namespace sconce;
    if (const auto scene = loadGltf(testing_support::inputFile(bytes, size)); scene) checkScene(*scene);
    return 0;
}
