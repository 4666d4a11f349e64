#pragma once

#include "bench/reference/image_io.h"
#include "runtime/field/field_data.h"
#include "runtime/scene/scene_renderer.h"
#include "scene/scene.h"

namespace sconce
{

/// A path tracer's picture as a light field that knows nothing else: its frames show what the paths found, through our filters.
/// @param paths  layers diffuse_indirect and glossy_indirect, of the size of the frames
FieldData tracedPicture(const Scene& scene, const ImageSet& paths);

/// Makes frames show a light field of tracedPicture(): every term from its pixels, filtered by our filters, which reach as far as they do
/// over so many rays.
/// @param paths  a pixel, of the picture
void showPaths(RenderSettings& frame, uint32_t paths);

} // namespace sconce
