#pragma once

#include <vector>

#include "base/result.h"
#include "scene/scene.h"

namespace sconce
{

/// The rays of a camera through its picture.
struct Pinhole
{
    vec3 eye, forward, right, up; // right and up scaled to the half picture

    Pinhole(const Camera& camera, uint32_t width, uint32_t height);
    /// Unit, through a point of a picture of that size; pixels from the top left corner.
    vec3 direction(float x, float y, uint32_t width, uint32_t height) const;
};

/// How a camera's picture is taken.
struct View
{
    uint32_t width = 640, height = 360; // of one eye's picture, pixels
    uint32_t samples = 1;               // rays a pixel: the first through its centre, more spread over it, alike in every pixel
    float eyesApart = 0.0f; // metres; 0: one eye. Else two parallel ones, the camera's eye between them, the left one's picture first
    vec2 lens{0.0f};        // k1, k2: the picture is drawn for a lens that shows what is r from the middle, in half heights, at the
                            // tangent (1 + k1 r^2 + k2 r^4) r of what it would be at without (Brown 1966; a headset's: k1 about 0.2)
};

struct ViewRay
{
    vec3 origin;    // metres
    vec3 direction; // unit
};

/// The rays of a view, both eyes' beside each other.
class ViewRays
{
public:
    /// Errors: badArgument (a lens that folds the picture over itself, eyes that are not 0 to 10 m apart, no pixels or samples).
    static Result<ViewRays> create(const Camera& camera, const View& view);

    uint32_t width() const { return view.width * (view.eyesApart > 0.0f ? 2u : 1u); } // of both eyes' pictures
    uint32_t height() const { return view.height; }
    uint32_t samples() const { return view.samples; }
    vec3 forward() const { return pinhole.forward; } // unit
    /// @param x, y, sample  below width(), height() and View::samples
    ViewRay ray(uint32_t x, uint32_t y, uint32_t sample) const;

    static constexpr uint32_t kTile = 8; // pixels a side
    /// The pixels of rows from `first` to before `last`, tile by tile: rays that lie beside each other in a trace then look the same way.
    std::vector<glm::uvec2> pixelsInTiles(uint32_t first, uint32_t last) const;

private:
    ViewRays(const Camera& camera, const View& seen) : view(seen), pinhole(camera, seen.width, seen.height) {}

    View view;
    Pinhole pinhole;
};

} // namespace sconce
