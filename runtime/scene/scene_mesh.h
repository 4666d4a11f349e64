#pragma once

#include <array>
#include <vector>

#include "runtime/vulkan/gpu.h"
#include "runtime/vulkan/pipeline.h"
#include "scene/scene.h"
#include "shaders/shared/light_field.h"
#include "shaders/shared/scene_passes.h"

namespace sconce
{

/// Runs of indices that a view may see; opaque ones need no material to be drawn as depth.
struct SceneDraws
{
    struct Run
    {
        uint32_t first, count; // indices
    };
    std::vector<Run> opaque, masked;
    void clear() { opaque.clear(), masked.clear(); }
};

/// The scene's triangles on the device: in Morton order, in clusters of up to 192 triangles that are culled against a view on the CPU.
/// Vertices are field space and split by material, so that each carries its own.
class SceneMesh
{
public:
    static Result<SceneMesh> create(Gpu& gpu, const Scene& scene, const gpu::LightFieldInfo& space);

    /// Which clusters a view may see; `draws` keeps its memory, so that a frame allocates nothing once it has grown.
    void cull(const gpu::SceneView& view, SceneDraws& draws) const;
    /// All triangles.
    const SceneDraws& everything() const { return all; }
    void bind(VkCommandBuffer cmd) const;
    /// After bind: leaves out the back faces that a view would see of a scene that is not two-sided. Shadow maps keep them: samples of an
    /// emitter shine to both sides of it, and through a box if they met no back face.
    void leaveOutBackFaces(VkCommandBuffer cmd, const gpu::SceneView& view) const;
    bool hasMasked() const { return opaqueClusters < clusters.size(); }
    void draw(VkCommandBuffer cmd, std::span<const SceneDraws::Run> runs) const;
    uint64_t deviceBytes() const { return vertices.size() + indices.size(); }

    static std::span<const VkVertexInputBindingDescription> vertexBindings();
    static std::span<const VkVertexInputAttributeDescription> vertexAttributes();

private:
    struct Cluster
    {
        vec3 low, high; // field space
        uint32_t first, count;
    };
    SceneMesh() = default;
    Gpu* gpu = nullptr;
    Buffer vertices, indices;
    std::vector<Cluster> clusters; // opaque ones first
    size_t opaqueClusters = 0;
    bool twoSided = true;
    SceneDraws all;
};

} // namespace sconce
