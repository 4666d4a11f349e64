#include "sconce_bake.h"

#include <stdexcept>

#include <glm/gtc/matrix_transform.hpp>

#include "draw_pipeline.h"
#include "gbuffer_vert.h"
#include "probe_face_frag.h"
#include "sconce_gi.h"

namespace
{

/// Draws a probe's face as the G-buffer is drawn, in this host's world.
class Faces : public sconce::ProbeFaces
{
public:
    Faces(const Vulkan& vulkan, const DrawnScene& drawn, Convention convention) : scene(drawn), axes(convention.axes())
    {
        const vk::Format formats[] = {vk::Format(sconce::kProbeFaceFormat)};
        layout = scene.drawLayout();
        pipeline = makeDrawPipeline(vulkan, {.vertex = gbuffer_vert,
                                             .fragment = probe_face_frag,
                                             .colors = formats,
                                             .nearer = vk::CompareOp::eGreater,
                                             .input = DrawnScene::vertexInput(),
                                             .layout = *layout});
    }

    sconce::Status draw(VkCommandBuffer cmd, const sconce::ProbeFace& face) override
    {
        vk::CommandBuffer(cmd).bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline);
        scene.draw(cmd, *layout, face.clipFromRelative * glm::scale(glm::mat4(1.0f), axes), axes * face.centre, axes.z);
        return sconce::success();
    }

private:
    const DrawnScene& scene;
    glm::vec3 axes;
    vk::raii::PipelineLayout layout = nullptr;
    vk::raii::Pipeline pipeline = nullptr;
};

sconce::Material described(const Material& material)
{
    sconce::Material out;
    out.baseColor = material.baseColor;
    out.baseColorTexture.image = material.baseColorPicture;
    out.metallic = material.metallic;
    out.roughness = material.roughness;
    out.metallicRoughnessTexture.image = material.metallicRoughnessPicture;
    out.emission = material.emission;
    out.emissionTexture.image = material.emissionPicture;
    out.normalTexture.image = material.normalPicture;
    out.normalStrength = material.normalScale;
    out.alphaCutoff = material.alphaCutoff;
    return out;
}

/// What the bake has to know beside what it is shown: where triangles are, and what shines.
sconce::Scene described(const Model& model, glm::vec3 axes)
{
    sconce::Scene scene;
    scene.name = "host";
    for (const Vertex& vertex : model.vertices)
    {
        scene.positions.push_back(axes * vertex.position);
        scene.normals.push_back(axes * vertex.normal);
        scene.uvs.push_back(vertex.uv);
    }
    for (const Part& part : model.parts)
        for (uint32_t i = part.firstIndex; i < part.firstIndex + part.indices; i += 3)
        {
            scene.triangles.emplace_back(model.indices[i], model.indices[i + 1], model.indices[i + 2]);
            scene.triangleMaterial.push_back(part.material);
        }
    for (const Material& material : model.materials) scene.materials.push_back(described(material));
    for (const Picture& picture : model.pictures) scene.images.push_back({"", picture.width, picture.height, picture.rgba});
    if (model.sun)
    {
        sconce::Light& sun = scene.lights.emplace_back();
        sun.direction = axes * model.sun->along;
        sun.intensity = model.sun->irradiance;
    }
    return scene;
}

} // namespace

void bakeField(const Vulkan& vulkan, Allocators& lent, const DrawnScene& scene, Convention convention, std::span<const glm::vec3> probes,
               const std::filesystem::path& file)
{
    Faces faces(vulkan, scene, convention);
    const sconce::BakeDesc desc{.resolution = 128, .bounces = 3, .faces = &faces}; // what a room takes
    const auto baked =
        sconce::bakeLightField(SconceGi::deviceOf(vulkan, lent), described(scene.model(), convention.axes()), probes, desc, file);
    if (!baked) throw std::runtime_error(baked.error().message);
}
