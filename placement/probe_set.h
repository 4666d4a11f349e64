#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scene/probe_grid.h"
#include "scene/result.h"

namespace sconce
{

struct PlacedProbe
{
    glm::vec3 position; // world, metres
    std::string why;    // a few words: grid cell, skeleton cluster, ...
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

} // namespace sconce
