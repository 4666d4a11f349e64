#include "bench/opponents/traced_picture.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "bench/opponents/irradiance_volume.h"
#include "shaders/opponents/path_picture.h"

#include "spirv/show_paths_comp.h"

namespace sconce
{

FieldData tracedPicture(const Scene& scene, const ImageSet& paths)
{
    const Layer *diffuse = paths.find("diffuse_indirect"), *glossy = paths.find("glossy_indirect");
    assert(diffuse && glossy);
    FieldData field = bareGrid(scene, {.count = glm::ivec3(1), .origin = scene.bounds().centre(), .step = vec3(1.0f)});
    field.radiance.resize(paths.pixelCount() * gpu::kPathWords);
    for (size_t i = 0; i < paths.pixelCount(); ++i)
        for (size_t c = 0; c < 3; ++c)
        {
            field.radiance[i * gpu::kPathWords + c] = std::bit_cast<uint32_t>(diffuse->pixels[3 * i + c]);
            field.radiance[i * gpu::kPathWords + 3 + c] = std::bit_cast<uint32_t>(glossy->pixels[3 * i + c]);
        }
    return field;
}

void showPaths(RenderSettings& frame, uint32_t paths)
{
    frame.lightShaders.glossy = show_paths_comp;
    frame.effects.tracedDiffuse = frame.effects.diffuse = frame.effects.glossy = frame.effects.mirror = true;
    frame.effects.rough = false;
    frame.raysBelow = knobs::raysBelow.most; // no reflection is read from probes
    frame.glossyRays = std::min(paths, knobs::glossyRays.most);
}

} // namespace sconce
