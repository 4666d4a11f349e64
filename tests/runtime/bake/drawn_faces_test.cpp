// Faces that a host draws: what they are given, what a bake makes of them, and what it says of wrong ones.
#include "runtime/bake/drawn_faces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

#include <gtest/gtest.h>

#include "runtime/bake/bake.h"
#include "runtime/bake/bake_journal.h"
#include "runtime/bake/group_bake.h"
#include "runtime/field/field_space.h"
#include "runtime/scene/lights.h"
#include "scene/builtin_scenes.h"
#include "scene/triangle_rays.h"
#include "shaders/shared/pure.h"
#include "tests/support/device.h"
#include "tests/support/test_scenes.h"

#include "spirv/drawn_faces_frag.h"
#include "spirv/drawn_faces_vert.h"

namespace sconce
{
namespace
{

using Text = Pure<float>;

struct Push
{
    mat4 clipFromRelative;
    vec3 centre;
};

struct Vertex // metres
{
    vec3 position, normal;
    vec4 baseMetallic, emissionRoughness;
};

/// A renderer that shares nothing with the bake's: a triangle after the other, in metres, with the material of each at its vertices.
class HostsRenderer : public ProbeFaces
{
public:
    HostsRenderer(Gpu& device, const Scene& scene) : gpu(device)
    {
        std::vector<Vertex> vertices;
        for (size_t t = 0; t < scene.triangles.size(); ++t)
            for (int k = 0; k < 3; ++k)
            {
                const uint32_t v = scene.triangles[t][k];
                const Material& of = scene.materials[scene.triangleMaterial[t]];
                vertices.push_back(
                    {scene.positions[v], scene.normals[v], vec4(vec3(of.baseColor), of.metallic), vec4(of.emission, of.roughness)});
            }
        count = uint32_t(vertices.size());
        buffer = std::move(*gpu.makeBufferWith<Vertex>(vertices, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "A host's vertices"));
        const VkVertexInputBindingDescription binding{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
        const VkVertexInputAttributeDescription attributes[] = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
                                                                {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)},
                                                                {2, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, baseMetallic)},
                                                                {3, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, emissionRoughness)}};
        Pipeline::Graphics desc;
        desc.vertex = drawn_faces_vert;
        desc.fragment = drawn_faces_frag;
        desc.pushBytes = sizeof(Push);
        desc.vertexBindings = {&binding, 1};
        desc.vertexAttributes = attributes;
        desc.colorFormats = {&kProbeFaceFormat, 1};
        desc.depthFormat = kProbeDepthFormat;
        pipeline = std::move(*Pipeline::graphics(gpu, desc));
    }

    Status draw(VkCommandBuffer cmd, const ProbeFace& face) override
    {
        faces.push_back(face);
        const VkBuffer vertices = buffer.handle();
        const VkDeviceSize offset = 0;
        pipeline.bind(cmd);
        gpu.vk.CmdSetCullMode(cmd, VK_CULL_MODE_NONE);
        pipeline.push(cmd, spoil ? spoil(face) : Push{face.clipFromRelative, face.centre});
        gpu.vk.CmdBindVertexBuffers(cmd, 0, 1, &vertices, &offset);
        gpu.vk.CmdDraw(cmd, count, 1, 0, 0);
        return faces.size() == fails ? Status(Error{ErrorCode::deviceFailure, "the host has lost its shaders"}) : success();
    }

    std::vector<ProbeFace> faces;                // that were asked for
    std::function<Push(const ProbeFace&)> spoil; // what a host would get wrong
    size_t fails = 0;                            // the call that fails, from 1; 0: none

private:
    Gpu& gpu;
    Buffer buffer;
    Pipeline pipeline;
    uint32_t count = 0;
};

class DrawnFaces : public testing::Test
{
protected:
    Scene scene = *makeBuiltinScene("cornell-glossy");
    TriangleRays rays = std::move(*TriangleRays::build(scene));
    std::vector<vec3> probes = {{0.3f, 1.2f, 0.5f}, {-0.6f, 0.4f, 0.7f}};

    BakeSettings settings(bool exact, ProbeFaces* faces = nullptr)
    {
        BakeSettings out;
        out.resolution = 128;
        out.bounces = 2;
        out.surfaceTexels = 26;
        out.surfaceRefined = 0.0f;
        out.octree.voxels = 32;
        out.rays = exact ? &rays : nullptr;
        out.faces = faces;
        return out;
    }
    Result<FieldData> bake(const BakeSettings& with) { return bakeLightField(device.gpu(), scene, probes, with, {}, report); }
    HostsRenderer host() { return HostsRenderer(device.gpu(), scene); }

    testing_support::SharedDevice device;
    BakeReport report;
};

/// The share of words that are the same.
double sameShare(std::span<const uint32_t> a, std::span<const uint32_t> b)
{
    size_t same = 0;
    for (size_t i = 0; i < a.size(); ++i) same += a[i] == b[i];
    return double(same) / double(a.size());
}

/// The share of level 0 distances that are alike to two steps of a half float, and of texels of radiance to two of theirs, red and green.
struct Alike
{
    double distances = 0.0, radiances = 0.0;
};
Alike alike(const FieldData& a, const FieldData& b)
{
    const size_t n = a.info.faceSize, stride = a.info.wordsPerProbe / 6;
    size_t distances = 0, radiances = 0, all = 0;
    for (size_t face = 0; face < 6 * a.probes.size(); ++face)
        for (size_t i = 0; i < n * n; ++i, ++all)
        {
            const float x = Text::halfToReal(a.distance[face * stride + i]), y = Text::halfToReal(b.distance[face * stride + i]);
            distances += std::abs(x - y) <= 2.0f / 1024.0f * std::max(x, y);
            const glm::vec3 p = Text::unpackRadiance(a.radiance[face * n * n + i]), q = Text::unpackRadiance(b.radiance[face * n * n + i]);
            radiances +=
                std::abs(p.x - q.x) <= 2.0f / 64.0f * std::max(p.x, q.x) && std::abs(p.y - q.y) <= 2.0f / 64.0f * std::max(p.y, q.y);
        }
    return {double(distances) / double(all), double(radiances) / double(all)};
}

/// A triangle that turns counter-clockwise to a viewer is clockwise in the picture of a mirrored face, and only there.
TEST(FaceInWorld, TellsWhichFacesAreMirrored)
{
    gpu::LightFieldInfo space{};
    space.origin = vec3(3.0f, -2.0f, 8.0f);
    space.scale = 16.0f;
    for (int i = 0; i < 6; ++i)
    {
        const vec3 centre(0.2f, -0.1f, 0.3f);
        const ProbeFace face = faceInWorld(faceView(centre, i, 1e-4f), space, 7, uint32_t(i));
        EXPECT_EQ(face.probe, 7u);
        EXPECT_EQ(face.face, uint32_t(i));
        const vec3 forward = Text::faceDirection(i, vec3(0.0f, 0.0f, 1.0f));
        const vec3 side = std::abs(forward.y) > 0.5f ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 1.0f, 0.0f);
        const vec3 right = glm::cross(forward, side), up = glm::cross(right, forward);
        // Seen from the centre: right, then up of it, is counter-clockwise.
        const vec3 corners[] = {2.0f * forward, 2.0f * forward + 0.5f * right, 2.0f * forward + 0.5f * up};
        glm::vec2 at[3];
        for (int k = 0; k < 3; ++k)
        {
            const vec4 clip = face.clipFromRelative * vec4(corners[k], 1.0f);
            EXPECT_GT(clip.w, 0.0f);
            EXPECT_FLOAT_EQ(clip.z / clip.w, 16.0f * 1e-4f / 2.0f) << "the near plane in metres over the distance";
            at[k] = glm::vec2(clip) / clip.w;
        }
        // Vulkan's framebuffer has y downwards: there a positive area is clockwise.
        const glm::vec2 u = at[1] - at[0], v = at[2] - at[0];
        EXPECT_EQ(u.x * v.y - u.y * v.x > 0.0f, face.mirrored) << "face " << i;
    }
}

/// Two renderers may draw an edge a pixel apart. On software Vulkan, in a box whose corners are short numbers, they don't: all words are
/// the same.
TEST_F(DrawnFaces, OfTheSameSceneGiveTheSameField)
{
    HostsRenderer drawn = host();
    const auto own = bake(settings(true));
    const auto theirs = bake(settings(true, &drawn));
    ASSERT_TRUE(own && theirs) << (theirs ? "" : theirs.error().message);
    ASSERT_EQ(drawn.faces.size(), 12u);
    for (size_t i = 0; i < 12; ++i)
    {
        EXPECT_EQ(drawn.faces[i].probe, i / 6);
        EXPECT_EQ(drawn.faces[i].face, i % 6);
        EXPECT_LT(glm::distance(drawn.faces[i].centre, probes[i / 6]), 1e-6f);
    }
    const Alike far = alike(*own, *theirs);
    EXPECT_GT(far.distances, 0.9999);
    EXPECT_GT(far.radiances, 0.9999);
    EXPECT_GT(sameShare(own->distance, theirs->distance), 0.999);
    EXPECT_GT(sameShare(own->surfaceLight, theirs->surfaceLight), 0.99);
    EXPECT_EQ(report.energy.size(), 3u);
}

TEST_F(DrawnFaces, AreResampledToOctahedralMaps)
{
    HostsRenderer drawn = host();
    BakeSettings with = settings(true);
    with.chart = gpu::kChartOctahedral;
    with.surfaceTexels = 0;
    with.bounces = 0;
    const auto own = bake(with);
    with.faces = &drawn;
    const auto theirs = bake(with);
    ASSERT_TRUE(own && theirs) << (theirs ? "" : theirs.error().message);
    EXPECT_GT(sameShare(own->distance, theirs->distance), 0.999);
    EXPECT_GT(sameShare(own->radiance, theirs->radiance), 0.999);
}

/// Materials are the host's: what it draws white is white, whatever the scene says.
TEST_F(DrawnFaces, HaveTheHostsMaterials)
{
    Scene painted = scene;
    for (Material& material : painted.materials) material.baseColor = vec4(0.0f, 0.0f, 0.0f, 1.0f), material.metallic = 1.0f;
    HostsRenderer drawn(device.gpu(), painted);
    const auto own = bake(settings(true));
    const auto black = bake(settings(true, &drawn));
    ASSERT_TRUE(own && black) << (black ? "" : black.error().message);
    EXPECT_GT(sameShare(own->distance, black->distance), 0.99);
    // Of what isn't a lamp hardly a coat's share is left: 5.4 %.
    const auto reflected = [](const FieldData& field)
    {
        double sum = 0.0;
        for (const uint32_t word : field.radiance)
            if (const float green = Text::unpackRadiance(word).y; green < 4.0f) sum += green;
        return sum;
    };
    EXPECT_LT(reflected(*black), 0.1 * reflected(*own));
}

TEST_F(DrawnFaces, OfAnotherWorldAreNamed)
{
    HostsRenderer drawn = host();
    const std::pair<const char*, std::function<Push(const ProbeFace&)>> mistakes[] = {
        {"centimetres",
         [](const ProbeFace& face) {
             return Push{face.clipFromRelative * glm::mat4(glm::mat3(100.0f)), face.centre};
         }},
        {"a matrix that is transposed",
         [](const ProbeFace& face) {
             return Push{glm::transpose(face.clipFromRelative), face.centre};
         }},
        {"the probe not subtracted",
         [](const ProbeFace& face) {
             return Push{face.clipFromRelative, vec3(0.0f)};
         }},
        {"z for y",
         [](const ProbeFace& face)
         {
             mat4 turned(0.0f);
             turned[0][0] = turned[1][2] = turned[2][1] = turned[3][3] = 1.0f;
             return Push{face.clipFromRelative * turned, face.centre};
         }},
        {"nothing is drawn", [](const ProbeFace&) {
             return Push{mat4(0.0f), vec3(0.0f)};
         }}};
    for (const auto& [what, mistake] : mistakes)
    {
        drawn.spoil = mistake;
        const auto field = bake(settings(true, &drawn));
        ASSERT_FALSE(field) << what;
        EXPECT_EQ(field.error().code, ErrorCode::badInput) << what;
        EXPECT_NE(field.error().message.find("the host has drawn what probe "), std::string::npos) << what << ": " << field.error().message;
    }
}

TEST_F(DrawnFaces, WhoseHostFailsEndTheBakeWithItsSentence)
{
    HostsRenderer drawn = host();
    drawn.fails = 8;
    const auto field = bake(settings(false, &drawn));
    ASSERT_FALSE(field);
    EXPECT_EQ(field.error().code, ErrorCode::deviceFailure);
    EXPECT_EQ(field.error().message, "the host has lost its shaders");
    EXPECT_EQ(drawn.faces.size(), 8u) << "nothing is asked for after that";
}

/// No journal's key holds what a host draws, and all lights' emission is in one picture.
TEST_F(DrawnFaces, AreRefusedWhereTheyCantBeKeptApart)
{
    struct Nothing : BakeJournal
    {
        std::optional<std::vector<std::byte>> find(const BakePart&) const override { return std::nullopt; }
        Status keep(const BakePart&, Pieces) override { return success(); }
    } journal;
    HostsRenderer drawn = host();
    BakeSettings with = settings(true, &drawn);
    with.journal = &journal;
    const auto kept = bake(with);
    ASSERT_FALSE(kept);
    EXPECT_EQ(kept.error().code, ErrorCode::badArgument);
    EXPECT_NE(kept.error().message.find("journal"), std::string::npos);
    with.journal = nullptr;
    const auto grouped = bakeLightGroups(device.gpu(), scene, probes, with, {{"rest", {}}}, {}, report);
    ASSERT_FALSE(grouped);
    EXPECT_EQ(grouped.error().code, ErrorCode::badArgument);
    EXPECT_NE(grouped.error().message.find("light groups"), std::string::npos);
    EXPECT_TRUE(drawn.faces.empty());
}

} // namespace
} // namespace sconce
