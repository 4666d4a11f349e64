#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/result.h"
#include "scene/light_groups.h"
#include "scene/scene.h"

namespace sconce::tools
{

/// --sun and --lights: lights of no extent in place of those that a scene, or a field with live links, has.
struct LiveLightOptions
{
    std::optional<vec3> sunDirection, sunIrradiance;
    std::string file;

    void add(CLI::App* command);
    bool any() const { return sunDirection || !file.empty(); }
    /// Errors: fileError, badInput: names the file, and what is wrong.
    Status apply(std::vector<Light>& lights) const;
};

/// A sun at one moment of a day.
struct SunPlace
{
    vec3 direction{0.0f};           // the way its light travels, unit
    std::optional<vec3> irradiance; // on a surface that faces it, W/m^2; none: as it was
};

/// Turns the first directional light, or adds one; below the horizon it gives nothing.
void turnSun(std::vector<Light>& lights, const SunPlace& place);

/// Why a sun can't be turned beside lights that stay; empty where it can.
std::string heldSunFault(std::span<const Light> fixed);

/// A path of the sun: lines of time,x,y,z or time,x,y,z,r,g,b after a header of these names, times ascending.
/// @return  places at even times from the first line's to the last's, linear between lines
/// Errors: fileError, badInput: the line, and what is wrong with it.
Result<std::vector<SunPlace>> sunPath(const std::filesystem::path& file, uint32_t count);

/// Lights of a scene that are in no group by name: what moves in a field with live links. They are taken out of the scene.
/// Errors: as selectLights().
Result<std::vector<Light>> takeLiveLights(Scene& scene, std::vector<LightGroupDesc> groups);

} // namespace sconce::tools
