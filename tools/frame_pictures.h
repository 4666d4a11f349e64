#pragma once

#include <string>
#include <vector>

#include "bench/reference/image_io.h"
#include "runtime/scene/scene_renderer.h"

namespace sconce::tools
{

/// The pictures of a frame, as --aov and the viewer name them.
const std::vector<std::string>& frameLayers();

/// Whether some layer that --aov names, all where it is empty, is kept only where RenderSettings::layers says so.
bool wantsLayersOfLight(const std::string& aov);

/// All of them; a pixel without a probe has -1 in `probe`.
ImageSet imagesOf(const RenderedFrame& frame);

} // namespace sconce::tools
