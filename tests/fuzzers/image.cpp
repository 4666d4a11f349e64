// PNG, JPEG and WebP of a scene's textures.
#include "scene/image_decode.h"
#include "tests/fuzzers/input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    (void)sconce::decodeImage({bytes, size}, "image");
    return 0;
}
