#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "base/result.h"
#include "scene/probe_grid.h"

namespace sconce
{

struct PlacedProbe
{
    glm::vec3 position; // world, metres
    std::string why;    // a few words: grid cell, skeleton cluster, ...
};

/// A position that the user decides.
struct Pin
{
    enum class Kind : uint8_t
    {
        keep,  // a probe stays here, one of those asked for
        add,   // a probe stays here, beside those asked for
        forbid // no probe within the radius
    };
    Kind kind = Kind::keep;
    glm::vec3 position{0.0f}; // world, metres
    float radius = 0.0f;      // metres, forbid only
};

struct ProbeSet
{
    std::vector<PlacedProbe> probes;
    std::optional<ProbeGrid> grid; // present when the probes are a full uniform grid
    std::string method;            // sdf | grid | ...
    std::string scene;
    uint64_t seed = 0;
};

/// probes.json: {"probes":[{"position":[x,y,z],"why":"..."}], "method":..., "scene":..., "seed":..., "grid":{"count","origin","step"}};
/// only "probes" with its positions is required when reading. Written to a temporary name and renamed.
Status saveProbes(const ProbeSet& set, const std::filesystem::path& file);
Result<ProbeSet> loadProbes(const std::filesystem::path& file);

/// The pins of a file in the form of probes.json whose probes say "pin": "keep" (which a probe that says nothing is, so that a probes.json
/// pins all its probes), "add", or "forbid" with a "radius" in metres.
Result<std::vector<Pin>> loadPins(const std::filesystem::path& file);

} // namespace sconce
