#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "scene/scene.h"

namespace sconce::tools
{

/// What a line of a viewer's script does.
enum class ScriptCommand
{
    camera,  // camera X,Y,Z X,Y,Z      eye and target, metres; histories forget what was
    set,     // set KNOB VALUE          a knob of the panel, or exposure; `default` takes it back
    effect,  // effect NAME on|off      as `sconce check` names them
    effects, // effects auto|all|none|LIST
    view,    // view NAME               what the window shows, as --aov
    compare, // compare off|split|difference [PATHS]   waits for so many paths a pixel, 1 without
    sun,     // sun X,Y,Z [R,G,B]       the way its light travels, and its irradiance
    dim,     // dim GROUP W|R,G,B
    panel,   // panel on|off
    frame,   // frame N                 draws N frames
    shot,    // shot FILE               .exr: all layers, .png: as it looks; of the last frame
    screen,  // screen FILE             .png of the window as it is, panel included
    quit     // quit
};

struct ScriptStep
{
    ScriptCommand command = ScriptCommand::quit;
    size_t line = 0;                // from 1 on
    std::vector<std::string> words; // after the command
    vec3 eye{0.0f}, target{0.0f};   // camera; sun: direction and irradiance
    uint32_t count = 0;             // of frames or paths
    bool on = false;
};

inline constexpr uint32_t kMostScriptFrames = 100'000;

/// One command a line; a # begins a comment, empty lines mean nothing.
/// @param name  of the file, for sentences
/// Errors: badInput: file, line, what is wrong, and what is right.
Result<std::vector<ScriptStep>> parseScript(std::string_view text, const std::string& name);
/// Errors: as above, and fileError.
Result<std::vector<ScriptStep>> readScript(const std::filesystem::path& file);

/// Three finite numbers, X,Y,Z; false where it is none.
bool parseVec3(std::string_view text, vec3& value);
/// One finite number.
bool parseNumber(std::string_view text, float& value);

} // namespace sconce::tools
