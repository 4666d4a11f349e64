#include "runtime/scene/shape_meshes.h"

#include <glm/gtc/matrix_transform.hpp>

#include <fmt/format.h>

#include "scene/mesh_builder.h"

namespace sconce
{
namespace
{

constexpr uint32_t kSegments = 48, kRings = 24; // around, and from end to end

void addShape(MeshBuilder& mesh, const MovingShape& shape, uint32_t material)
{
    mesh.place = glm::translate(mat4(1.0f), shape.centre) * glm::mat4_cast(glm::normalize(shape.turn));
    switch (shape.kind)
    {
    case MovingShape::Kind::sphere:
        mesh.sphere(vec3(0.0f), shape.half.x, kSegments, kRings, material);
        return;
    case MovingShape::Kind::box:
        mesh.box(-shape.half, shape.half, material);
        return;
    case MovingShape::Kind::capsule:
        for (const float end : {-shape.half.y, shape.half.y}) mesh.sphere({0.0f, end, 0.0f}, shape.half.x, kSegments, kRings, material);
        if (shape.half.y > 0.0f) mesh.cylinder({0.0f, -shape.half.y, 0.0f}, shape.half.x, 2.0f * shape.half.y, kSegments, material);
    }
}

} // namespace

void addShapes(Scene& scene, std::span<const MovingShape> shapes)
{
    MeshBuilder mesh(scene);
    for (size_t i = 0; i < shapes.size(); ++i)
    {
        const uint32_t material = mesh.material(fmt::format("moving shape {}", i), shapes[i].albedo);
        scene.materials[material].emission = shapes[i].emission;
        addShape(mesh, shapes[i], material);
    }
}

} // namespace sconce
