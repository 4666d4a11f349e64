#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/field/field_data.h"
#include "tools/common.h"
#include "tools/frame_setup.h"
#include "tools/view/script.h"

namespace sconce::tools
{

/// What `sconce view` was asked to show.
struct ViewDesc
{
    Scene scene;
    Camera camera;
    std::optional<FieldData> field; // none: probes are placed and a field is baked, with every default
    std::string fieldName;
    std::vector<LightGroupDesc> groups;
    FrameChoice frame;
    std::optional<float> exposure;
    std::string device;
    uint32_t width = 0, height = 0; // of the window, pixels
    std::vector<ScriptStep> script;
    std::string scriptName;
};

/// Whether this build has the viewer.
bool hasViewer();

/// Opens the window and returns once it is closed, or the script has said quit. A build without the viewer says what it lacks.
/// Errors: of the device, the script's lines and the files that it writes; cancelled after SIGINT.
Status runViewer(ViewDesc desc, const Context& context);

} // namespace sconce::tools
