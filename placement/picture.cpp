#include "placement/picture.h"

#include <algorithm>
#include <cmath>

namespace sconce
{
namespace
{

constexpr uint32_t kWidth = 1400; // pixels
constexpr int kMargin = 12;

/// One view: which world axes run to the right and down, and where it lies in the picture.
struct View
{
    int right = 0, down = 0;
    bool flipped = false; // the world axis grows upward
    int top = 0;
    glm::ivec2 size{0};
    vec3 low{0.0f};
    float perMetre = 1.0f;

    glm::ivec2 pixel(vec3 point) const
    {
        const int x = int((point[right] - low[right]) * perMetre), y = int((point[down] - low[down]) * perMetre);
        return {kMargin + x, top + (flipped ? size.y - 1 - y : y)};
    }
};

void paint(Picture& picture, glm::ivec2 at, vec3 colour)
{
    if (at.x < 0 || at.y < 0 || at.x >= int(picture.width) || at.y >= int(picture.height)) return;
    float* texel = picture.rgb.data() + 3 * (size_t(at.y) * picture.width + size_t(at.x));
    for (int channel = 0; channel < 3; ++channel) texel[channel] = colour[channel];
}

void paintDisc(Picture& picture, glm::ivec2 centre, int radius, vec3 colour)
{
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x)
            if (x * x + y * y <= radius * radius) paint(picture, centre + glm::ivec2(x, y), colour);
}

void paintSpace(Picture& picture, const View& view, const FreeSpace& space)
{
    const DistanceField& field = space.field;
    const int across = 3 - view.right - view.down;
    std::vector<uint32_t> depth(size_t(field.size[view.right]) * size_t(field.size[view.down]), 0);
    for (uint32_t at : space.cells)
    {
        const glm::ivec3 cell = field.cell(at);
        ++depth[size_t(cell[view.right]) + size_t(field.size[view.right]) * size_t(cell[view.down])];
    }
    for (int y = 0; y < view.size.y; ++y)
        for (int x = 0; x < view.size.x; ++x)
        {
            vec3 point = view.low;
            point[view.right] += (float(x) + 0.5f) / view.perMetre;
            point[view.down] += (float(y) + 0.5f) / view.perMetre;
            const glm::ivec3 cell = field.cellAt(point);
            if (cell[view.right] < 0 || cell[view.right] >= field.size[view.right] || cell[view.down] < 0 ||
                cell[view.down] >= field.size[view.down])
                continue;
            const uint32_t cells = depth[size_t(cell[view.right]) + size_t(field.size[view.right]) * size_t(cell[view.down])];
            const float share = float(cells) / float(field.size[across]);
            paint(picture, view.pixel(point), cells ? vec3(0.08f + 0.35f * share) : vec3(0.0f));
        }
}

} // namespace

Picture drawPlacement(const FreeSpace& space, std::span<const vec3> probes, const Coverage& coverage)
{
    Bounds shown = space.bounds;
    for (const vec3& probe : probes) shown.add(probe);
    const vec3 size = glm::max(shown.size(), vec3(0.01f * shown.diagonal()));
    // A tall narrow scene is drawn smaller, so that the picture stays within four times its width.
    const float perMetre = std::min(float(kWidth - 2 * kMargin) / size.x, 2.0f * float(kWidth) / std::max(size.y, size.z));
    View plan{0, 2, false, kMargin, {int(size.x * perMetre) + 1, int(size.z * perMetre) + 1}, shown.low, perMetre};
    View section{0, 1, true, plan.top + plan.size.y + kMargin, {plan.size.x, int(size.y * perMetre) + 1}, shown.low, perMetre};

    Picture picture;
    picture.width = kWidth;
    picture.height = uint32_t(section.top + section.size.y + kMargin);
    picture.rgb.assign(size_t(picture.width) * picture.height * 3, 0.02f);
    for (const View& view : {plan, section})
    {
        paintSpace(picture, view, space);
        for (size_t point = 0; point < coverage.points.size(); ++point)
        {
            const float quality = coverage.quality[point];
            if (quality > 0.0f) paint(picture, view.pixel(coverage.points[point].position), {0.5f * (1.0f - quality), 0.4f, 0.0f});
        }
        for (const Surfel& gap : coverage.unseen) paintDisc(picture, view.pixel(gap.position), 1, {1.0f, 0.0f, 0.0f});
        for (const vec3& probe : probes)
        {
            paintDisc(picture, view.pixel(probe), 5, vec3(0.0f));
            paintDisc(picture, view.pixel(probe), 4, vec3(1.0f));
        }
    }
    return picture;
}

} // namespace sconce
