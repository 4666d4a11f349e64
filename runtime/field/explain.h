#pragma once

#include <string>
#include <vector>

#include "runtime/field/field_data.h"

namespace sconce
{

/// What came of asking one probe for the diffuse light of a surface point (shaders/shared/surface_light.h).
enum class Verdict : uint8_t
{
    lights,  // its texels there are of this surface
    spare,   // they are, but two others see more of it
    grazes,  // it sees the surface from behind, or at too small an angle
    hidden,  // it sees another surface before it
    noTexel, // it sees the place, and its texels there are of other surfaces
};

struct AskedProbe
{
    uint32_t probe = 0;
    Verdict verdict = Verdict::grazes;
    float distance = 0.0f; // metres, from the point
    float cosine = 0.0f;   // of the angle at the point between normal and probe
    float share = 0.0f;    // of the point's light that is its; 0 unless it lights
    float texel = 0.0f;    // metres, the least width of its texels of this surface; 0: it has none
    float seen = 0.0f;     // metres from the probe, along the way to the point, to the surface that hides it; 0 unless hidden
    glm::vec3 light{0.0f}; // what it alone says: mean of the radiance that arrives, weighted by the cosine; 0 unless it lights or is spare
    std::string sentence() const;
};

/// The diffuse light of a point and where it is from, as a frame finds it (surfaceLightAt()).
struct ExplainedSurface
{
    std::vector<AskedProbe> asked;  // of the leaf, in its order, each once
    int from = 0;                   // SurfaceLight::probes
    glm::vec3 light{0.0f};          // mean of the radiance that arrives, weighted by the cosine
    std::vector<AskedProbe> others; // of all other probes those that would light the point, those that see most of it first
    std::string sentence() const;   // what the light is from
};

/// Of a field with surface light. Runs on the host with the shaders' own text, in float as the device does.
/// @param point   world, metres
/// @param normal  for shading, unit
/// @param facing  of the surface itself, unit, on the side that is looked at
/// Cost: about 30 reads a probe of the field.
ExplainedSurface explainSurface(const FieldData& field, glm::vec3 point, glm::vec3 normal, glm::vec3 facing);

/// How a ray's way through one probe's map ended.
enum class StretchEnd : uint8_t
{
    met,    // what the probe sees there
    hidden, // the ray goes on behind a surface that the probe sees
    left,   // the field
    unsure, // the probe can't tell what comes there
};

/// A ray's way through one probe's map.
struct RayStretch
{
    uint32_t probe = 0;
    float from = 0.0f, to = 0.0f; // metres along the ray
    bool opinion = false;         // asked about a hit that another probe sees coarsely
    StretchEnd end = StretchEnd::unsure;
    float seen = 0.0f; // metres from the probe to the surface that hides the ray's next point from it; 0 unless hidden
    std::string sentence() const;
};

struct ExplainedRay
{
    std::vector<RayStretch> way;
    gpu::RayHit hit{}; // as queryRay() gives it
};

/// A ray through a field of cube faces, turn by turn, on the host as above. Directions are unit.
ExplainedRay explainRay(const FieldData& field, const gpu::Ray& ray);

/// Probes that see a point of a surface, nearest first: none of them is told by octree or rank. Cost: 1 read a probe.
std::vector<uint32_t> probesThatSee(const FieldData& field, glm::vec3 point, glm::vec3 facing);

} // namespace sconce
