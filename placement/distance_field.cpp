#include "placement/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/parallel_for.h>

namespace sconce
{
namespace
{

/// What OpenVDB wants of a mesh; points in index space, where cell centres are whole numbers.
class IndexSpaceTriangles
{
public:
    IndexSpaceTriangles(const Scene& source, const DistanceField& field, std::vector<uint32_t> which)
        : scene(source), origin(field.origin), perVoxel(1.0 / double(field.voxel)), triangles(std::move(which))
    {
    }
    size_t polygonCount() const { return triangles.size(); }
    size_t pointCount() const { return 3 * triangles.size(); }
    size_t vertexCount(size_t) const { return 3; }
    void getIndexSpacePoint(size_t polygon, size_t corner, openvdb::Vec3d& point) const
    {
        const vec3 position = scene.positions[scene.triangles[triangles[polygon]][int(corner)]];
        for (int axis = 0; axis < 3; ++axis) point[axis] = (double(position[axis]) - double(origin[axis])) * perVoxel - 0.5;
    }

private:
    const Scene& scene;
    vec3 origin;
    double perVoxel;
    std::vector<uint32_t> triangles;
};

/// Squared distance transform of one line. Source: Felzenszwalb and Huttenlocher 2012, "Distance Transforms of Sampled Functions".
void transformLine(std::vector<float>& f, std::vector<float>& out, std::vector<int>& apex, std::vector<float>& from, int n)
{
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    int k = -1;
    for (int q = 0; q < n; ++q)
    {
        if (f[size_t(q)] == kInfinity) continue;
        float s = -kInfinity;
        while (k >= 0)
        {
            const int p = apex[size_t(k)];
            s = float((double(f[size_t(q)]) + double(q) * q - double(f[size_t(p)]) - double(p) * p) / (2.0 * (q - p)));
            if (s > from[size_t(k)]) break;
            --k;
        }
        if (k < 0) s = -kInfinity;
        apex[size_t(++k)] = q;
        from[size_t(k)] = s;
    }
    if (k < 0)
    {
        std::fill_n(out.begin(), n, kInfinity);
        return;
    }
    for (int q = 0, at = 0; q < n; ++q)
    {
        while (at < k && from[size_t(at) + 1] < float(q)) ++at;
        const float step = float(q - apex[size_t(at)]);
        out[size_t(q)] = step * step + f[size_t(apex[size_t(at)])];
    }
}

/// Replaces every entry of the box by the least of (entry of another cell + squared distance in cells to it), one axis after the other.
void squaredTransform(std::vector<float>& squared, glm::ivec3 size)
{
    const size_t stride[3] = {1, size_t(size.x), size_t(size.x) * size_t(size.y)};
    for (int axis = 0; axis < 3; ++axis)
    {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3, n = size[axis];
        tbb::parallel_for(0, size[v],
                          [&](int j)
                          {
                              std::vector<float> line(static_cast<size_t>(n)), out(static_cast<size_t>(n)),
                                  from(static_cast<size_t>(n) + 1);
                              std::vector<int> apex(static_cast<size_t>(n) + 1);
                              for (int i = 0; i < size[u]; ++i)
                              {
                                  float* first = squared.data() + size_t(i) * stride[u] + size_t(j) * stride[v];
                                  for (int q = 0; q < n; ++q) line[size_t(q)] = first[size_t(q) * stride[axis]];
                                  transformLine(line, out, apex, from, n);
                                  for (int q = 0; q < n; ++q) first[size_t(q) * stride[axis]] = out[size_t(q)];
                              }
                          });
    }
}

} // namespace

DistanceField buildDistanceField(const Scene& scene, const std::vector<Presence>& presence, const Bounds& box, uint32_t voxels)
{
    // OpenVDB must register its types before its first use, and fields may be built on several threads.
    static std::once_flag initialised;
    std::call_once(initialised, [] { openvdb::initialize(); });

    DistanceField field;
    const glm::dvec3 extent(box.size());
    const double longest = std::max({extent.x, extent.y, extent.z});
    // Cells are whole along each axis, so their number has no inverse: the side grows by 2 % until they are few enough.
    double voxel = longest / 1024.0;
    const auto cellsAt = [&extent](double side)
    { return std::ceil(extent.x / side) * std::ceil(extent.y / side) * std::ceil(extent.z / side); };
    while (cellsAt(voxel) > double(voxels)) voxel *= 1.02;
    field.voxel = float(voxel);
    field.size = glm::max(glm::ivec3(glm::ceil(extent / double(field.voxel))), glm::ivec3(1));
    field.origin = box.centre() - 0.5f * field.voxel * vec3(field.size);

    // Triangles farther from the box than the exact band change no cell's distance.
    const float margin = (kExactBand + 1.0f) * field.voxel;
    std::vector<uint32_t> near;
    for (uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle)
    {
        if (presence[triangle] == Presence::absent) continue;
        Bounds around;
        for (int corner = 0; corner < 3; ++corner) around.add(scene.positions[scene.triangles[triangle][corner]]);
        const uvec3 corners = scene.triangles[triangle];
        const vec3 a = scene.positions[corners.x];
        // Of no area: no surface of its own, and its edges are its neighbours'.
        const bool flat = glm::cross(scene.positions[corners.y] - a, scene.positions[corners.z] - a) == vec3(0.0f);
        const bool apart =
            glm::any(glm::greaterThan(around.low, box.high + margin)) || glm::any(glm::lessThan(around.high, box.low - margin));
        if (!flat && !apart) near.push_back(triangle);
    }
    const IndexSpaceTriangles mesh(scene, field, std::move(near));
    // Unsigned: real assets are not watertight, so that no side of a surface is its inside.
    const auto band = openvdb::tools::meshToVolume<openvdb::FloatGrid>(mesh, *openvdb::math::Transform::createLinearTransform(1.0),
                                                                       kExactBand, kExactBand, openvdb::tools::UNSIGNED_DISTANCE_FIELD);

    // OpenVDB gives exact distances in a narrow band alone, and no more is asked of it.
    // Far field: distance in cells to the nearest cell that a surface passes through or touches.
    constexpr float kTouching = 0.8660254f; // half the diagonal of a unit cube
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const size_t cells = size_t(field.size.x) * size_t(field.size.y) * size_t(field.size.z);
    std::vector<float> exact(cells, kInfinity);
    field.distance.assign(cells, kInfinity);
    for (auto voxelOn = band->cbeginValueOn(); voxelOn; ++voxelOn)
    {
        openvdb::CoordBBox covered;
        voxelOn.getBoundingBox(covered); // one cell, or a tile
        const glm::ivec3 low = glm::max(glm::ivec3(covered.min().x(), covered.min().y(), covered.min().z()), glm::ivec3(0));
        const glm::ivec3 high = glm::min(glm::ivec3(covered.max().x(), covered.max().y(), covered.max().z()), field.size - 1);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x)
                {
                    const size_t at = field.index({x, y, z});
                    exact[at] = voxelOn.getValue();
                    if (exact[at] <= kTouching) field.distance[at] = 0.0f;
                }
    }
    squaredTransform(field.distance, field.size);
    tbb::parallel_for(size_t(0), cells,
                      [&](size_t at)
                      {
                          // What OpenVDB left out is at least the band away; the far field, up to a cell off, may say less.
                          const float cellsAway = exact[at] < kExactBand ? exact[at] : std::max(std::sqrt(field.distance[at]), kExactBand);
                          // No surface in the whole box: everything in it is as free as it can be.
                          field.distance[at] = field.voxel * std::min(cellsAway, float(glm::length(vec3(field.size))));
                      });
    return field;
}

} // namespace sconce
