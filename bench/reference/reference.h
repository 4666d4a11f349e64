#pragma once

#include <cstdint>
#include <optional>

#include "base/knobs.h"
#include "base/progress.h"
#include "base/result.h"
#include "bench/reference/image_io.h"
#include "bench/reference/path_tracer.h"
#include "bench/reference/ray_scene.h"
#include "scene/scene.h"

namespace sconce
{

/// Ranges and prices: base/knobs.h.
struct ReferenceSettings
{
    uint32_t width = knobs::width.value;         // pixels
    uint32_t height = knobs::height.value;       // pixels
    uint32_t samples = knobs::paths.value;       // paths a pixel; noise falls with the square root
    uint32_t bounces = knobs::pathBounces.value; // times baked light is re-injected: a path scatters at most bounces + 2 times
    bool straight = false;                       // of indirect light that of emitters and sky alone, straight from there: one scattering
    uint64_t firstPath = 0;                      // of each pixel: others are another picture's, see joined()
    uint64_t seed = knobs::pathSeed.value;       // same seed, same bytes, whatever the number of threads
    std::optional<float> roughness;              // [0,1]; set: the roughness of every surface
    bool guides = true;                          // depth, normal, albedo and roughness, too: one more ray a pixel; false: left out
    bool pixelCentre =
        knobs::pixelCentre
            .value; // true: every path starts at the pixel's centre, as a rasteriser's, textures alone by a box filter; false: all
    bool parts = knobs::parts.value; // layers kParts of beauty and the indirect terms: what some of the paths bring
    Camera camera;

    uint32_t pathBounces() const { return straight ? kStraight : bounces; } // as PathTracer takes them
};

struct Reference
{
    /// beauty = direct + diffuse_indirect + glossy_indirect; depth (metres along the view axis, 0: sky), normal (shading, on the
    /// viewer's side), albedo (base colour), roughness, these four always of the surface at the pixel's centre.
    /// direct: emission seen by the camera, light of the lights without area at the first hit, sky where nothing is hit.
    /// indirect: all other light that arrives at the first hit, reflected there by the diffuse or the specular lobe.
    ImageSet images;
    /// Of the mean against the limit of many samples; NaN with one sample.
    double estimatedRelMse = 0.0;                                     // of beauty
    double estimatedRelMseDiffuse = 0.0, estimatedRelMseGlossy = 0.0; // of the indirect terms
    uint64_t nonFinitePaths = 0;                                      // left out of the picture; anything but 0 is a fault to report
};

/// Path traces the scene: next-event estimation to lights and emitters, multiple importance sampling with the reflection model of
/// shaders/shared/brdf.h, threads by TBB. Errors: badArgument (names the field), badInput, outOfMemory, cancelled.
Result<Reference> renderReference(const Scene& scene, const ReferenceSettings& settings, const Progress& progress = {});
/// The same without building the scene's hierarchy anew; the scene must be a valid one.
Result<Reference> renderReference(const RayScene& rays, const ReferenceSettings& settings, const Progress& progress = {});

/// The light of one pixel.
struct PixelLight
{
    vec3 direct{0.0f}, diffuse{0.0f}, glossy{0.0f}; // as the layers of Reference::images
    vec3 unsureDiffuse{0.0f}, unsureGlossy{0.0f};   // standard errors of these means
};
/// What the picture with these settings has at a pixel, to the bit, without the rest of it.
/// @param settings  but for guides and parts, which it has none of
/// Errors: badArgument (also a pixel outside of the picture).
Result<PixelLight> pixelReference(const RayScene& rays, ReferenceSettings settings, glm::uvec2 pixel);

/// What one picture of all paths would be, but for rounding. Of two with the same settings but for `samples` and `firstPath`, both
/// multiples of 4 where they have parts.
/// @param pathsA, pathsB  a pixel
Reference joined(const Reference& a, uint64_t pathsA, const Reference& b, uint64_t pathsB);

} // namespace sconce
