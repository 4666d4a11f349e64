// In place of viewer.cpp where GLFW or Dear ImGui was not found.
#include "tools/view/viewer.h"

namespace sconce::tools
{

bool hasViewer()
{
    return false;
}

Status runViewer(ViewDesc, const Context&)
{
    return Error{ErrorCode::missingFeature,
                 "This build has no viewer; install libglfw3-dev and libimgui-dev, then configure and build again."};
}

} // namespace sconce::tools
