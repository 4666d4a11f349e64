#pragma once

#include <array>
#include <memory>
#include <span>

#include "runtime/bake/probe_faces.h"
#include "runtime/field/light_field.h"
#include "runtime/scene/device_scene.h"
#include "runtime/vulkan/paced_work.h"
#include "shaders/shared/bake_passes.h"

namespace sconce
{

inline constexpr float kProbeNear = 1e-4f; // share of the diagonal: the near plane of a probe's faces, nothing nearer is drawn

/// Where one probe's maps go: pieces of the arrays of a FieldData and of what the bounces need besides.
struct ProbeTarget
{
    std::span<uint32_t> distance;
    std::span<uint32_t> radiance;
    std::span<uint32_t> surface;         // reflectance 5:6:5 | shading normal << 16, a word a radiance texel; 0: sky
    std::span<uint32_t> emitted;         // R11G11B10F a radiance texel; empty when the scene has no emitters
    std::span<uint32_t> irradiance;      // [kIrradianceSize^2][2]
    std::span<uint32_t> faces;           // octahedral chart: level 0 words of the cube faces it was resampled from; else empty
    std::span<gpu::SurfaceTexel> texels; // [6 surfaceSize^2]; empty without surface light
};

/// The GPU's part of a bake, one probe at a time: each call submits, and waits.
class ProbeBaker
{
public:
    /// @param surfaceLight  whether surfaces are lit by surface light: direct light is then of what has no extent alone
    /// @param coatsByRays   whether rays to triangles find what coats reflect of it, so that it isn't in the probes' light
    /// @param faces         draws in place of the scene's mesh; null: the mesh is drawn
    /// @param work          that it is done by
    static Result<std::unique_ptr<ProbeBaker>> create(Gpu& gpu, const DeviceScene& scene, const gpu::LightFieldInfo& info,
                                                      bool surfaceLight, bool coatsByRays, ProbeFaces* faces, PacedWork& work);

    /// Faces, direct light, chain or octahedral map, and the irradiance of what the surfaces reflect of that light.
    /// Errors: those of ProbeFaces::draw(), outOfMemory, deviceFailure.
    Status bakeDirect(uint32_t probe, vec3 centre, const ProbeTarget& target);
    /// Radiance = direct + what the surfaces reflect of the field's irradiance; then the probe's irradiance of that, moments untouched.
    /// With surface light, which the field must hold by then, what the surfaces reflect of that.
    /// @param field   with a probe of the same number at the same place; may be another than that which is baked
    /// @param direct  the probe's radiance after bakeDirect
    Status bakeBounce(uint32_t probe, vec3 centre, const LightField& field, std::span<const uint32_t> direct, const ProbeTarget& target);

private:
    ProbeBaker(Gpu& device, const DeviceScene& deviceScene, const gpu::LightFieldInfo& fieldInfo, bool surfaceLight, bool coatsByRays,
               ProbeFaces* facesOfHost, PacedWork& paced)
        : gpu(device), scene(deviceScene), info(fieldInfo), surfacesLit(surfaceLight), coats(coatsByRays), hostFaces(facesOfHost),
          work(paced)
    {
    }
    Status createPipelines();
    Status createBuffers();
    void drawScene(VkCommandBuffer cmd, const gpu::SceneView& view);
    void toAttachments(VkCommandBuffer cmd);
    void toImagesRead(VkCommandBuffer cmd);
    Status drawFace(VkCommandBuffer cmd, uint32_t probe, vec3 centre, uint32_t face);
    /// @param drawn  of all faces; must be there until the work is run
    void addFaces(uint32_t probe, vec3 centre, Status& drawn);
    void addMaps(vec3 centre);
    void addGather(bool moments);
    /// A compute pass of width x width invocations in so many layers. @param scan  records after the last of it
    void add(std::string_view name, const Pipeline& pipeline, std::vector<VkDescriptorSet> sets, const gpu::BakePush& push, uint32_t width,
             uint32_t layers, std::function<void(VkCommandBuffer)> scan = {});
    void copyOut(VkCommandBuffer cmd, std::span<const VkBufferCopy> pieces, const Buffer& from);
    gpu::BakePush pushFor(vec3 centre) const;
    uint32_t texelWords() const { return 6 * info.surfaceSize * info.surfaceSize * uint32_t(sizeof(gpu::SurfaceTexel) / 4); }

    Gpu& gpu;
    const DeviceScene& scene;
    const gpu::LightFieldInfo info;
    const bool surfacesLit; // by surface light
    const bool coats;       // are lit by rays
    ProbeFaces* hostFaces;  // null: the scene's mesh is drawn
    PacedWork& work;
    bool octahedral = false;
    bool emitters = false;      // whether emission is kept a texel
    uint32_t radianceWords = 0; // of the chart
    GpuImage surfaceImage, depthImage;
    DescriptorSet images;
    Pipeline opaque, masked, surfacePass, chainPass, texelPass, octahedralPass, lowPass, bouncePass;
    std::array<Pipeline, 2> downsample, gather; // radiance, moments
    Buffer faceWords, faceLight;                // octahedral only: the faces' words, and their radiance, surfaces and emission
    Buffer words, light;                        // of the chart: distance words; radiance, surfaces, emission, then direct radiance
    Buffer cells, irradiance;
    Buffer texels;   // of the surface light; null without
    Buffer transfer; // mapped
    SceneDraws draws;
};

} // namespace sconce
