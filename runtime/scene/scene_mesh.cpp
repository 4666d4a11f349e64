#include "runtime/scene/scene_mesh.h"

#include <algorithm>
#include <cstddef>
#include <unordered_map>

#include "base/numbers.h"

namespace sconce
{

namespace
{

constexpr size_t kClusterTriangles = 192;

struct Vertex
{
    vec3 position, normal;
    vec2 uv;
    uint32_t material;
};
static_assert(sizeof(Vertex) == 36);

uint32_t morton(vec3 unit)
{
    return mortonCode(glm::uvec3(glm::clamp(unit, 0.0f, 1.0f) * 1023.0f));
}

void append(std::vector<SceneDraws::Run>& runs, uint32_t first, uint32_t count)
{
    if (!runs.empty() && runs.back().first + runs.back().count == first)
        runs.back().count += count;
    else
        runs.push_back({first, count});
}

} // namespace

Result<SceneMesh> SceneMesh::create(Gpu& gpu, const Scene& scene, const gpu::LightFieldInfo& space)
{
    SceneMesh mesh;
    mesh.gpu = &gpu;
    // In the field's units once, here, rather than in every shader that meets a vertex.
    std::vector<vec3> positions(scene.positions.size());
    for (size_t i = 0; i < positions.size(); ++i) positions[i] = (scene.positions[i] - space.origin) / space.scale;

    // Opaque triangles before masked ones, so that each kind is one stretch of the index buffer with a pipeline of its own; along a Morton
    // curve within, so that clusters have small boxes and culling finds some to leave out.
    struct Key
    {
        // The triangle last: std::sort keeps no order among equals, and the same scene should give the same buffers everywhere.
        uint32_t masked, code, triangle;
        bool operator<(const Key& other) const
        {
            return std::tie(masked, code, triangle) < std::tie(other.masked, other.code, other.triangle);
        }
    };
    std::vector<Key> order(scene.triangles.size());
    // A flat scene has no extent along one axis: nothing may be divided by 0.
    const vec3 low = space.sceneLow, size = glm::max(space.sceneHigh - space.sceneLow, vec3(1e-12f));
    for (uint32_t t = 0; t < order.size(); ++t)
    {
        const uvec3 corner = scene.triangles[t];
        const vec3 middle = (positions[corner.x] + positions[corner.y] + positions[corner.z]) / 3.0f;
        const Material& material = scene.materials[scene.triangleMaterial[t]];
        order[t] = {material.blended || material.alphaCutoff > 0.0f ? 1u : 0u, morton((middle - low) / size), t};
    }
    mesh.twoSided = scene.twoSided;
    std::sort(order.begin(), order.end());

    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
    indices.reserve(3 * order.size());
    // A vertex names its material, so one that two materials share is there twice.
    std::unordered_map<uint64_t, uint32_t> known; // (material, scene vertex) -> vertex
    known.reserve(positions.size());
    for (size_t i = 0; i < order.size(); ++i)
    {
        // No cluster has both kinds, since each kind is drawn by its own pipeline.
        const bool startsMasked = i > 0 && order[i].masked && !order[i - 1].masked;
        if (mesh.clusters.empty() || mesh.clusters.back().count == 3 * kClusterTriangles || startsMasked)
        {
            if (!order[i].masked) ++mesh.opaqueClusters;
            mesh.clusters.push_back({vec3(INFINITY), vec3(-INFINITY), uint32_t(indices.size()), 0});
        }
        Cluster& cluster = mesh.clusters.back();
        const uint32_t material = scene.triangleMaterial[order[i].triangle];
        for (int k = 0; k < 3; ++k)
        {
            const uint32_t v = scene.triangles[order[i].triangle][k];
            const auto [entry, added] = known.try_emplace(uint64_t(material) << 32 | v, uint32_t(vertices.size()));
            if (added) vertices.push_back({positions[v], scene.normals[v], scene.uvs[v], material});
            indices.push_back(entry->second);
            cluster.low = glm::min(cluster.low, positions[v]);
            cluster.high = glm::max(cluster.high, positions[v]);
        }
        cluster.count += 3;
    }
    for (size_t i = 0; i < mesh.clusters.size(); ++i)
        append(i < mesh.opaqueClusters ? mesh.all.opaque : mesh.all.masked, mesh.clusters[i].first, mesh.clusters[i].count);

    auto vertexBuffer = gpu.makeBufferWith<Vertex>(vertices, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "The scene's vertices");
    if (!vertexBuffer) return vertexBuffer.error();
    auto indexBuffer = gpu.makeBufferWith<uint32_t>(indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT, "The scene's indices");
    if (!indexBuffer) return indexBuffer.error();
    mesh.vertices = std::move(*vertexBuffer);
    mesh.indices = std::move(*indexBuffer);
    return mesh;
}

void SceneMesh::cull(const gpu::SceneView& view, SceneDraws& draws) const
{
    draws.clear();
    const mat4 rows = glm::transpose(view.clip);
    // Inside: -w <= x <= w, -w <= y <= w, 0 <= z <= w (Gribb and Hartmann 2001, "Fast Extraction of Viewing Frustum Planes").
    const std::array<vec4, 6> planes = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
                                        rows[3] - rows[1], rows[2],           rows[3] - rows[2]};
    for (size_t i = 0; i < clusters.size(); ++i)
    {
        const Cluster& cluster = clusters[i];
        const vec3 low = cluster.low - view.centre, high = cluster.high - view.centre;
        bool outside = false;
        for (const vec4& plane : planes)
        {
            const vec3 farthest(plane.x > 0.0f ? high.x : low.x, plane.y > 0.0f ? high.y : low.y, plane.z > 0.0f ? high.z : low.z);
            const vec3 terms = vec3(plane) * farthest;
            // Slack of a few roundings: a triangle in the plane itself must stay.
            const float slack = 4e-7f * (std::abs(terms.x) + std::abs(terms.y) + std::abs(terms.z) + std::abs(plane.w));
            outside = outside || terms.x + terms.y + terms.z + plane.w < -slack;
        }
        if (!outside) append(i < opaqueClusters ? draws.opaque : draws.masked, cluster.first, cluster.count);
    }
}

void SceneMesh::bind(VkCommandBuffer cmd) const
{
    const VkBuffer buffer = vertices.handle();
    const VkDeviceSize offset = 0;
    gpu->vk.CmdBindVertexBuffers(cmd, 0, 1, &buffer, &offset);
    gpu->vk.CmdBindIndexBuffer(cmd, indices.handle(), 0, VK_INDEX_TYPE_UINT32);
    gpu->vk.CmdSetCullMode(cmd, VK_CULL_MODE_NONE);
}

void SceneMesh::leaveOutBackFaces(VkCommandBuffer cmd, const gpu::SceneView& view) const
{
    if (twoSided) return;
    // Every second face of a cube looks through a mirror: x right, y down and w forward are then left-handed.
    const bool mirrored = glm::determinant(view.clip) > 0.0f;
    gpu->vk.CmdSetCullMode(cmd, mirrored ? VK_CULL_MODE_FRONT_BIT : VK_CULL_MODE_BACK_BIT);
}

void SceneMesh::draw(VkCommandBuffer cmd, std::span<const SceneDraws::Run> runs) const
{
    for (const SceneDraws::Run& run : runs) gpu->vk.CmdDrawIndexed(cmd, run.count, 1, run.first, 0, 0);
}

std::span<const VkVertexInputBindingDescription> SceneMesh::vertexBindings()
{
    static constexpr VkVertexInputBindingDescription bindings[] = {{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX}};
    return bindings;
}

std::span<const VkVertexInputAttributeDescription> SceneMesh::vertexAttributes()
{
    static constexpr VkVertexInputAttributeDescription attributes[] = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
                                                                       {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)},
                                                                       {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, uv)},
                                                                       {3, 0, VK_FORMAT_R32_UINT, offsetof(Vertex, material)}};
    return attributes;
}

} // namespace sconce
