#pragma once

#include "scene/scene.h"

namespace sconce
{

/// Streets and furnished rooms, the large mixed scene; reached through makeBuiltinScene("town").
Scene makeTown();

} // namespace sconce
