#pragma once

#include <string>

#include "scene/scene.h"

namespace sconce
{

/// What keeps a picture from being drawn with a camera, a sentence; empty when nothing does.
std::string cameraFault(const Camera& camera);

} // namespace sconce
