#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scene/result.h"

namespace sconce
{

struct PlacedProbe
{
    glm::vec3 position; // world, metres
    std::string why;    // a few words: grid cell, skeleton cluster, ...
};

/// Present when the probes are a full uniform grid: index = x + count.x * (y + count.y * z), position = origin + step * (x,y,z).
struct ProbeGrid
{
    glm::ivec3 count{0};
    glm::vec3 origin{0.0f};
    glm::vec3 step{0.0f};
};

struct ProbeSet
{
    std::vector<PlacedProbe> probes;
    std::optional<ProbeGrid> grid;
    std::string method; // sdf | grid | ...
    std::string scene;
    uint64_t seed = 0;
};

/// probes.json: {"probes":[{"position":[x,y,z],"why":"..."}], "method":..., "scene":..., "seed":..., "grid":{"count","origin","step"}}; only
/// "probes" with its positions is required when reading. Written to a temporary name and renamed.
Status saveProbes(const ProbeSet& set, const std::filesystem::path& file);
Result<ProbeSet> loadProbes(const std::filesystem::path& file);

} // namespace sconce
