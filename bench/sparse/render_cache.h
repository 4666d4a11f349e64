#pragma once

#include <span>
#include <vector>

#include "bench/sparse/sample_choice.h"
#include "scene/view_rays.h"

namespace sconce
{

/// Shaded points kept over frames: each frame shows them from where the camera is, and says where new ones are wanted most (Walter,
/// Drettakis, Parker 1999, "Interactive Rendering using the Render Cache"). Deterministic. Cost a frame: a pass over the points and some
/// over the pixels.
class RenderCache
{
public:
    struct Point
    {
        vec3 position{0.0f}; // metres; of what is at infinity, far away
        vec3 colour{0.0f};
        float age = kEmpty; // frames, more where light is known to have changed about it
    };
    static constexpr float kEmpty = -1.0f;

    struct Desc
    {
        uint32_t width = 640, height = 360;
        float points = 1.5f; // as many times the pixels
        bool culls = true;   // leaves out points that lie behind those about them: they would shine through
        bool hastens = true; // where a new sample differs from what was shown, those about it age at once
    };

    explicit RenderCache(const Desc& desc);

    /// Takes the points to a camera's picture. Each is a frame older.
    void project(const Camera& camera);
    /// What is shown, row 0 at the top: points, and between them means of those within three pixels; elsewhere what was shown before.
    std::span<const vec3> picture() const { return shown; }
    /// Pixels without a point of their own, of the last projection.
    size_t holes() const;
    /// The pixels to shade next, at most `budget` of them, the more of them where none is known or what is known is old.
    std::vector<uint32_t> ask(size_t budget) const { return chooseSamples(priority, desc.width, budget); }
    /// Takes in what was asked for, of the camera that project() had. A new point takes the place of the one that its pixel showed, else of
    /// an old one.
    void add(std::span<const uint32_t> pixels, std::span<const Point> samples);
    /// Forgets all points and takes these: a whole frame, for warps of it.
    void replace(std::span<const Point> samples);

private:
    void cull();
    void interpolate();
    /// The mean of what is known about a pixel, within the least distance at which anything is; else what it showed before.
    vec3 between(int x, int y, int& known) const;
    size_t oldSlot();

    Desc desc;
    std::vector<Point> points;
    std::vector<uint32_t> nearest; // [pixel], of points; kNone
    std::vector<float> depth;      // [pixel], of that point
    std::vector<vec3> shown;
    std::vector<float> priority;
    size_t hand = 0; // of the clock that looks for an old point
};

} // namespace sconce
