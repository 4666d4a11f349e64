#include "scene/scene_gltf.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <tiny_gltf.h>

#include "base/numbers.h"
#include "scene/gltf_guard.h"
#include "scene/gltf_layout.h"
#include "scene/image_decode.h"

namespace sconce
{

namespace
{

namespace tg = tinygltf;
using glm::dmat3;
using glm::dmat4;
using glm::dvec3;

Error bad(const std::string& sentence)
{
    return {ErrorCode::badInput, sentence};
}
Error cancelled()
{
    return {ErrorCode::cancelled, "The import was cancelled."};
}

// Reads any accessor element by element, so that nothing is allocated for what a damaged file merely claims to hold.
struct AccessorView
{
    const uint8_t* base = nullptr; // null: all zero, as the specification says of accessors without a buffer view
    size_t stride = 0;
    size_t count = 0;
    int componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    int components = 1;
    bool normalized = false;
    std::vector<std::pair<uint32_t, const uint8_t*>> replaced; // sparse: element, its value; sorted by element

    double component(size_t element, int c) const
    {
        const uint8_t* from = base ? base + element * stride : nullptr;
        if (!replaced.empty())
        {
            const auto it =
                std::lower_bound(replaced.begin(), replaced.end(), element, [](const auto& r, size_t e) { return r.first < e; });
            if (it != replaced.end() && it->first == element) from = it->second;
        }
        return from ? decode(from + size_t(c) * componentBytes(uint64_t(componentType))) : 0.0;
    }
    dvec3 vec3At(size_t element) const { return {component(element, 0), component(element, 1), component(element, 2)}; }

private:
    template <class T> static double as(const uint8_t* from)
    {
        T value; // the file owes us no alignment
        std::memcpy(&value, from, sizeof value);
        return double(value);
    }
    double decode(const uint8_t* from) const
    {
        switch (componentType)
        {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return normalized ? std::max(as<int8_t>(from) / 127.0, -1.0) : as<int8_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return normalized ? as<uint8_t>(from) / 255.0 : as<uint8_t>(from);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return normalized ? std::max(as<int16_t>(from) / 32767.0, -1.0) : as<int16_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return normalized ? as<uint16_t>(from) / 65535.0 : as<uint16_t>(from);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return as<uint32_t>(from);
        default:
            return as<float>(from);
        }
    }
};

// One primitive in its mesh's own space, used vertices only.
struct Piece
{
    std::vector<vec3> positions;
    std::vector<vec3> normals; // empty: flat, by the triangles
    std::vector<vec2> uvs;
    std::vector<uvec3> triangles;
    uint32_t material = 0;
    uint64_t hidden = 0; // triangles left out for their alpha
};

struct Visit // of a node that waits for its turn
{
    int node;
    dmat4 worldFromParent;
    int depth;
};

struct Instance
{
    int mesh;
    dmat4 worldFromMesh;
};

class Importer
{
public:
    Importer(const GuardedGltf& file, const tg::Model& parsed, const Progress& listener) : guarded(file), model(parsed), progress(listener)
    {
    }
    Result<Scene> run(std::string name);

private:
    void note(const std::string& sentence) { ++notes[sentence]; } // becomes one warning, however often it happens
    Status collect();
    Status visit(const Visit& next, std::vector<Visit>& pending);
    Status addInstances(const tg::Node& node, int index, const dmat4& world);
    Status addLight(const tg::Node& node, int index, const dmat4& world);
    Status addCamera(const tg::Node& node, int index, const dmat4& world);
    Status checkBudget();
    Result<AccessorView> view(int accessor, int components, const std::string& owner) const;
    Result<std::vector<uint32_t>> indicesOf(const tg::Primitive& primitive, size_t vertices, const std::string& owner) const;
    Status buildPieces(int mesh);
    Status buildPiece(const tg::Primitive& primitive, const std::string& owner, std::vector<Piece>& out);
    Result<uint32_t> materialOf(int index);
    Status readTexture(const tg::ExtensionMap& extensions, int index, int texCoord, TextureRef& out, int& uvSet);
    Result<int> imageOf(int source);
    Status place(const Piece& piece, const dmat4& world);
    void noteIgnored();

    const GuardedGltf& guarded;
    const tg::Model& model;
    const Progress& progress;
    Scene scene;
    std::map<std::string, size_t> notes;
    std::vector<bool> visited; // nodes
    std::vector<Instance> instances;
    std::map<int, std::vector<Piece>> pieces; // by mesh
    std::map<int, uint32_t> materials;        // glTF material to ours; -1 is the default material
    std::vector<int> uvSets;                  // of our materials
    std::map<int, int> images;                // glTF image to ours
    uint64_t pixels = 0, degenerate = 0, invisible = 0;
};

// Number of an extension's object, or the default where it is missing or of another kind.
double numberOr(const tg::Value& object, const std::string& key, double missing)
{
    return object.Has(key) && object.Get(key).IsNumber() ? object.Get(key).GetNumberAsDouble() : missing;
}

int indexOr(const tg::Value& object, const std::string& key, int missing)
{
    return object.Has(key) && object.Get(key).IsInt() ? object.Get(key).GetNumberAsInt() : missing;
}

vec2 pairOr(const tg::Value& object, const std::string& key, vec2 missing)
{
    if (!object.Has(key)) return missing;
    const tg::Value& list = object.Get(key);
    if (!list.IsArray() || list.ArrayLen() != 2 || !list.Get(0).IsNumber() || !list.Get(1).IsNumber()) return missing;
    return {float(list.Get(0).GetNumberAsDouble()), float(list.Get(1).GetNumberAsDouble())};
}

template <class List> std::string outside(const char* kind, int index, const List& list)
{
    return fmt::format("{} {} of {}; the file is damaged, export it again.", kind, index, list.size());
}

template <class List> bool has(const List& list, int index)
{
    return index >= 0 && size_t(index) < list.size();
}

Result<dmat4> localTransform(const tg::Node& node, const std::string& owner)
{
    const auto sized = [](const std::vector<double>& list, size_t count) { return list.empty() || list.size() == count; };
    if (!sized(node.matrix, 16) || !sized(node.translation, 3) || !sized(node.rotation, 4) || !sized(node.scale, 3))
        return bad(fmt::format("{} has a transform with a wrong number of values; export the file again.", owner));
    dmat4 local(1.0);
    if (!node.matrix.empty())
    {
        for (int i = 0; i < 16; ++i) local[i / 4][i % 4] = node.matrix[size_t(i)];
        return local;
    }
    if (!node.translation.empty()) local = glm::translate(local, dvec3(node.translation[0], node.translation[1], node.translation[2]));
    if (!node.rotation.empty())
    {
        const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
        if (!(glm::length(q) > 0.0)) return bad(fmt::format("{} has a rotation of length 0; give a unit quaternion.", owner));
        local *= glm::mat4_cast(glm::normalize(q));
    }
    if (!node.scale.empty()) local = glm::scale(local, dvec3(node.scale[0], node.scale[1], node.scale[2]));
    return local;
}

Status Importer::collect()
{
    visited.assign(model.nodes.size(), false);
    std::vector<int> roots;
    if (model.scenes.empty()) // then every node without a parent belongs to the one scene there is
    {
        std::vector<bool> isChild(model.nodes.size(), false);
        for (const tg::Node& node : model.nodes)
            for (const int child : node.children)
                if (has(model.nodes, child)) isChild[size_t(child)] = true;
        for (size_t i = 0; i < isChild.size(); ++i)
            if (!isChild[i]) roots.push_back(int(i));
        if (roots.empty() && !model.nodes.empty())
            return bad("Every node is the child of another: the nodes form a cycle; export the file again.");
    }
    else
    {
        const int chosen = model.defaultScene < 0 ? 0 : model.defaultScene;
        if (!has(model.scenes, chosen)) return bad(fmt::format("The file's default is scene {}", outside("", chosen, model.scenes)));
        roots = model.scenes[size_t(chosen)].nodes;
    }
    // A stack of its own: 1024 levels of calls would not fit the small stacks that threads may have.
    std::vector<Visit> pending;
    // In reverse, here and in visit(), so that meshes, cameras and lights come in the file's order.
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) pending.push_back({*root, dmat4(1.0), 1});
    while (!pending.empty())
    {
        const Visit next = pending.back();
        pending.pop_back();
        if (Status status = visit(next, pending); !status) return status;
    }
    return success();
}

Status Importer::visit(const Visit& next, std::vector<Visit>& pending)
{
    const int index = next.node;
    if (!has(model.nodes, index)) return bad(fmt::format("The scene uses {}", outside("node", index, model.nodes)));
    const std::string owner = fmt::format("Node {}", index);
    if (next.depth > GltfLimits::nodeDepth)
        return bad(fmt::format("{} lies more than {} levels deep; flatten the hierarchy.", owner, GltfLimits::nodeDepth));
    // glTF 2.0 asks for trees. Besides cycles this stops the doubling of a node at every level by two parents.
    if (visited[size_t(index)])
        return bad(fmt::format("{} is reached twice: it has two parents or is part of a cycle; export the file again.", owner));
    visited[size_t(index)] = true;
    const tg::Node& node = model.nodes[size_t(index)];
    const auto local = localTransform(node, owner);
    if (!local) return local.error();
    const dmat4 world = next.worldFromParent * *local;
    if (node.mesh != -1)
        if (Status status = addInstances(node, index, world); !status) return status;
    if (node.camera != -1)
        if (Status status = addCamera(node, index, world); !status) return status;
    if (node.extensions.count("KHR_lights_punctual"))
        if (Status status = addLight(node, index, world); !status) return status;
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) pending.push_back({*child, world, next.depth + 1});
    return success();
}

Status Importer::addInstances(const tg::Node& node, int index, const dmat4& world)
{
    // Before checkBudget(), which counts triangles per instance: the list of instances must fit memory, too.
    constexpr size_t kMaxInstances = 10'000'000;
    const std::string owner = fmt::format("Node {}", index);
    if (!has(model.meshes, node.mesh)) return bad(fmt::format("{} uses {}", owner, outside("mesh", node.mesh, model.meshes)));
    if (node.skin != -1) note("Skins are ignored; skinned meshes stand in their rest pose.");
    const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
    if (extension == node.extensions.end() || !extension->second.Has("attributes"))
    {
        instances.push_back({node.mesh, world});
        return success();
    }
    const tg::Value& attributes = extension->second.Get("attributes");
    std::optional<AccessorView> parts[3];
    const char* names[3] = {"TRANSLATION", "ROTATION", "SCALE"};
    std::optional<size_t> count;
    for (int i = 0; i < 3; ++i)
    {
        if (!attributes.Has(names[i])) continue;
        auto part = view(indexOr(attributes, names[i], -2), i == 1 ? 4 : 3, fmt::format("{} (instancing)", owner));
        if (!part) return part.error();
        if (count && *count != part->count)
            return bad(fmt::format("{} has instance attributes of different length; export the file again.", owner));
        count = part->count;
        parts[i] = std::move(*part);
    }
    if (instances.size() + count.value_or(1) > kMaxInstances)
        return bad(fmt::format("{} brings the scene above 10 million instances; use fewer.", owner));
    for (size_t i = 0; i < count.value_or(1); ++i)
    {
        dmat4 local(1.0);
        if (parts[0]) local = glm::translate(local, parts[0]->vec3At(i));
        if (parts[1])
        {
            const glm::dquat q(parts[1]->component(i, 3), parts[1]->component(i, 0), parts[1]->component(i, 1), parts[1]->component(i, 2));
            if (!(glm::length(q) > 0.0))
                return bad(fmt::format("{} has an instance with a rotation of length 0; give unit quaternions.", owner));
            local *= glm::mat4_cast(glm::normalize(q));
        }
        if (parts[2]) local = glm::scale(local, parts[2]->vec3At(i));
        // The extension's transforms apply within the node's own.
        instances.push_back({node.mesh, world * local});
    }
    return success();
}

Status Importer::addLight(const tg::Node& node, int index, const dmat4& world)
{
    const int which = indexOr(node.extensions.at("KHR_lights_punctual"), "light", -1);
    if (!has(model.lights, which)) return bad(fmt::format("Node {} uses {}", index, outside("light", which, model.lights)));
    const tg::Light& source = model.lights[size_t(which)];
    Light light;
    light.name = source.name.empty() ? node.name : source.name;
    if (source.type != "directional" && source.type != "point" && source.type != "spot")
    {
        note(fmt::format("A light of unknown type '{}' is ignored.", source.type.substr(0, 40)));
        return success();
    }
    light.type = source.type == "directional" ? LightType::directional : source.type == "point" ? LightType::point : LightType::spot;
    light.position = vec3(world[3]);
    const dvec3 along = -dvec3(world[2]); // a light shines along its node's -z; scale doesn't change its intensity
    const double length = glm::length(along);
    if (light.type != LightType::point && !(length > 0.0 && std::isfinite(length)))
        return bad(fmt::format("Light '{}' has a node scaled to nothing, so it has no direction; mend the node's scale.", light.name));
    if (length > 0.0) light.direction = vec3(along / length);
    vec3 colour(1.0f);
    if (source.color.size() == 3) colour = vec3(source.color[0], source.color[1], source.color[2]);
    light.intensity = glm::max(colour * float(source.intensity), vec3(0.0f));
    light.range = float(std::max(source.range, 0.0));
    light.outerCone = float(std::clamp(source.spot.outerConeAngle, 0.0, 1.5707963));
    light.innerCone = float(std::clamp(source.spot.innerConeAngle, 0.0, double(light.outerCone)));
    if (!finite(light.position) || !finite(light.intensity) || !std::isfinite(light.range))
        return bad(fmt::format("Light '{}' has a position, intensity or range that is not finite; mend it.", light.name));
    scene.lights.push_back(std::move(light));
    return success();
}

Status Importer::addCamera(const tg::Node& node, int index, const dmat4& world)
{
    if (!has(model.cameras, node.camera)) return bad(fmt::format("Node {} uses {}", index, outside("camera", node.camera, model.cameras)));
    const tg::Camera& source = model.cameras[size_t(node.camera)];
    if (source.type != "perspective")
    {
        note("Orthographic cameras are ignored; only perspective ones are used.");
        return success();
    }
    Camera camera;
    camera.name = !node.name.empty() ? node.name : !source.name.empty() ? source.name : fmt::format("camera {}", scene.cameras.size());
    camera.eye = vec3(world[3]);
    const dvec3 forward = -dvec3(world[2]), side = glm::cross(forward, dvec3(world[1]));
    camera.verticalFov = float(source.perspective.yfov);
    const bool usable =
        glm::length(side) > 0.0 && std::isfinite(glm::length(side)) && camera.verticalFov > 0.0f && camera.verticalFov < 3.1415925f;
    if (!usable || !finite(camera.eye))
    {
        note("A camera without a usable direction or field of view is ignored.");
        return success();
    }
    camera.forward = vec3(glm::normalize(forward));
    camera.up = vec3(glm::normalize(glm::cross(glm::normalize(side), glm::normalize(forward))));
    scene.cameras.push_back(std::move(camera));
    return success();
}

uint64_t trianglesIn(const tg::Primitive& primitive, uint64_t corners)
{
    if (primitive.mode == TINYGLTF_MODE_TRIANGLES) return corners / 3;
    const bool run = primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP || primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
    return run && corners >= 3 ? corners - 2 : 0;
}

// What the instances will need, from the accessors' counts alone: a few kB of JSON can ask for any number of triangles.
Status Importer::checkBudget()
{
    uint64_t total = 0;
    for (const Instance& instance : instances)
        for (const tg::Primitive& primitive : model.meshes[size_t(instance.mesh)].primitives)
        {
            const auto position = primitive.attributes.find("POSITION");
            // Corners, of which an indexed primitive has as many as indices.
            const int counted = primitive.indices != -1                  ? primitive.indices
                                : position != primitive.attributes.end() ? position->second
                                                                         : -1;
            if (has(model.accessors, counted)) total += trianglesIn(primitive, model.accessors[size_t(counted)].count);
            if (total > GltfLimits::triangles)
                return bad(
                    fmt::format("The scene has more than {} triangles with its instances; split or simplify it.", GltfLimits::triangles));
        }
    return success();
}

Result<AccessorView> Importer::view(int index, int components, const std::string& owner) const
{
    if (!has(model.accessors, index)) return bad(fmt::format("{} uses {}", owner, outside("accessor", index, model.accessors)));
    const tg::Accessor& accessor = model.accessors[size_t(index)];
    AccessorView out;
    out.components = tg::GetNumComponentsInType(uint32_t(accessor.type));
    if (out.components != components)
        return bad(fmt::format("{} uses accessor {} with {} components where {} are needed; export the file again.", owner, index,
                               out.components, components));
    out.count = accessor.count;
    out.componentType = accessor.componentType;
    out.normalized = accessor.normalized;
    const size_t size = componentBytes(uint64_t(accessor.componentType)) * size_t(components);
    // All ranges were checked by checkLayout on the same numbers.
    const auto bytes = [&](int bufferView, size_t offset)
    {
        const tg::BufferView& from = model.bufferViews[size_t(bufferView)];
        return guarded.buffers[size_t(from.buffer)].data() + from.byteOffset + offset;
    };
    if (accessor.bufferView >= 0)
    {
        const size_t stride = model.bufferViews[size_t(accessor.bufferView)].byteStride;
        out.base = bytes(accessor.bufferView, accessor.byteOffset);
        out.stride = stride != 0 ? stride : size;
    }
    if (!accessor.sparse.isSparse) return out;
    AccessorView where;
    where.componentType = accessor.sparse.indices.componentType;
    where.base = bytes(accessor.sparse.indices.bufferView, size_t(accessor.sparse.indices.byteOffset));
    where.stride = componentBytes(uint64_t(where.componentType));
    const uint8_t* values = bytes(accessor.sparse.values.bufferView, size_t(accessor.sparse.values.byteOffset));
    for (size_t i = 0; i < size_t(accessor.sparse.count); ++i)
    {
        const auto element = uint32_t(where.component(i, 0));
        // Ascending, as glTF 2.0 asks: component() finds them by binary search.
        if (element >= out.count || (!out.replaced.empty() && element <= out.replaced.back().first))
            return bad(fmt::format("Accessor {} has sparse index {} of {} out of range or order; export the file again.", index, element,
                                   out.count));
        out.replaced.emplace_back(element, values + i * size);
    }
    return out;
}

Result<std::vector<uint32_t>> Importer::indicesOf(const tg::Primitive& primitive, size_t vertices, const std::string& owner) const
{
    std::vector<uint32_t> indices;
    if (primitive.indices == -1)
    {
        indices.resize(vertices);
        for (size_t i = 0; i < vertices; ++i) indices[i] = uint32_t(i);
        return indices;
    }
    const auto from = view(primitive.indices, 1, owner);
    if (!from) return from.error();
    const bool isUnsigned = from->componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                            from->componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                            from->componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (!isUnsigned) return bad(fmt::format("{} has indices that are not unsigned integers; export the file again.", owner));
    AccessorView plain = *from;
    plain.normalized = false;
    indices.resize(plain.count);
    for (size_t i = 0; i < plain.count; ++i)
    {
        indices[i] = uint32_t(plain.component(i, 0));
        if (indices[i] >= vertices)
            return bad(fmt::format("{} has index {} of {} vertices; the file is damaged, export it again.", owner, indices[i], vertices));
    }
    return indices;
}

Status Importer::buildPieces(int mesh)
{
    std::vector<Piece> built;
    const auto& primitives = model.meshes[size_t(mesh)].primitives;
    for (size_t i = 0; i < primitives.size(); ++i)
        if (Status status = buildPiece(primitives[i], fmt::format("Mesh {} primitive {}", mesh, i), built); !status) return status;
    pieces.emplace(mesh, std::move(built));
    return success();
}

std::vector<uvec3> trianglesOf(int mode, const std::vector<uint32_t>& corners)
{
    std::vector<uvec3> triangles;
    const size_t count = corners.size();
    if (mode == TINYGLTF_MODE_TRIANGLES)
        for (size_t i = 0; i + 2 < count; i += 3) triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) // every other triangle of a strip is turned, glTF 2.0 section 3.7.2.1
        for (size_t i = 0; i + 2 < count; ++i) triangles.push_back({corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
    else
        for (size_t i = 0; i + 2 < count; ++i) triangles.push_back({corners[i + 1], corners[i + 2], corners[0]});
    return triangles;
}

Status Importer::buildPiece(const tg::Primitive& primitive, const std::string& owner, std::vector<Piece>& out)
{
    // Left out with a note rather than refused: the rest of the scene is as good without it.
    const int mode = primitive.mode;
    if (mode == TINYGLTF_MODE_POINTS || mode == TINYGLTF_MODE_LINE || mode == TINYGLTF_MODE_LINE_LOOP || mode == TINYGLTF_MODE_LINE_STRIP)
    {
        note("Points and lines are ignored; they have no surface.");
        return success();
    }
    if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP && mode != TINYGLTF_MODE_TRIANGLE_FAN)
        return bad(fmt::format("{} has mode {}, which glTF 2.0 doesn't have; export the file again.", owner, mode));
    if (!primitive.attributes.count("POSITION"))
    {
        note("A mesh primitive without positions is ignored; export it with positions.");
        return success();
    }
    const auto positions = view(primitive.attributes.at("POSITION"), 3, owner);
    if (!positions) return positions.error();
    if (!primitive.targets.empty()) note("Morph targets are ignored; meshes stand in their rest shape.");
    if (primitive.attributes.count("COLOR_0")) note("Vertex colours are ignored.");

    // Before vertices are read: the material may hide them all by its alpha, and it names the set of texture coordinates.
    auto material = materialOf(primitive.material);
    if (!material) return material.error();
    const auto corners = indicesOf(primitive, positions->count, owner);
    if (!corners) return corners.error();
    Piece piece;
    piece.material = *material;
    piece.triangles = trianglesOf(mode, *corners);
    const Material& surface = scene.materials[*material];
    const bool never = surface.blended ? surface.baseColor.a <= 0.0f : surface.baseColor.a < surface.alphaCutoff;
    if (never && surface.baseColorTexture.image < 0)
    {
        // An empty piece is kept, so that each of its instances is counted among the triangles that are told of as hidden.
        piece.hidden = piece.triangles.size(); // never there, by its constant alpha
        piece.triangles.clear();
        out.push_back(std::move(piece));
        return success();
    }

    std::optional<AccessorView> normals, uvs;
    const std::string uvName = fmt::format("TEXCOORD_{}", uvSets[*material]);
    const auto optional = [&](const std::string& name, int components, std::optional<AccessorView>& into) -> Status
    {
        const auto it = primitive.attributes.find(name);
        if (it == primitive.attributes.end()) return success();
        auto found = view(it->second, components, owner);
        if (!found) return found.error();
        // The indices are checked against the positions alone: a shorter attribute would be read past its end.
        if (found->count < positions->count)
            return bad(fmt::format("{} has {} of {} for {} vertices; export the file again.", owner, found->count, name, positions->count));
        into = std::move(*found);
        return success();
    };
    if (Status status = optional("NORMAL", 3, normals); !status) return status;
    if (Status status = optional(uvName, 2, uvs); !status) return status;
    const bool textured =
        surface.baseColorTexture.image >= 0 || surface.metallicRoughnessTexture.image >= 0 || surface.emissionTexture.image >= 0;
    if (textured && !uvs) note("A textured mesh has no texture coordinates; its textures are read at (0,0).");

    // Primitives may share one accessor of all vertices: only those that the triangles of this one name are copied.
    std::vector<uint32_t> used(*corners);
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (uvec3& t : piece.triangles)
        for (int i = 0; i < 3; ++i) t[i] = uint32_t(std::lower_bound(used.begin(), used.end(), t[i]) - used.begin());
    for (const uint32_t vertex : used)
    {
        const vec3 position(positions->vec3At(vertex));
        if (!finite(position)) return bad(fmt::format("{} has a position that is not finite at vertex {}; mend the mesh.", owner, vertex));
        vec2 uv(0.0f);
        if (uvs) uv = {float(uvs->component(vertex, 0)), float(uvs->component(vertex, 1))};
        // Mended rather than refused: unlike a position it spoils no more than a texture.
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
        {
            note("Texture coordinates that are not finite were set to 0.");
            uv = vec2(0.0f);
        }
        piece.positions.push_back(position);
        piece.uvs.push_back(uv);
        if (normals) piece.normals.push_back(vec3(normals->vec3At(vertex)));
    }
    out.push_back(std::move(piece));
    return success();
}

Result<uint32_t> Importer::materialOf(int index)
{
    if (const auto known = materials.find(index); known != materials.end()) return known->second;
    if (index != -1 && !has(model.materials, index)) return bad(fmt::format("A mesh uses {}", outside("material", index, model.materials)));
    static const tg::Material standard; // glTF 2.0 section 3.9.6: no material means the defaults, a white rough metal
    const tg::Material& source = index == -1 ? standard : model.materials[size_t(index)];
    const tg::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    Material m;
    m.name = index == -1 ? "default" : source.name.empty() ? fmt::format("material {}", index) : source.name;
    const auto clamped = [&](double value)
    {
        if (!(value >= 0.0 && value <= 1.0)) note("Material factors outside [0,1] were clamped.");
        return value >= 0.0 ? float(std::min(value, 1.0)) : 0.0f;
    };
    if (pbr.baseColorFactor.size() == 4)
        for (int i = 0; i < 4; ++i) m.baseColor[i] = clamped(pbr.baseColorFactor[size_t(i)]);
    m.metallic = clamped(pbr.metallicFactor);
    m.roughness = clamped(pbr.roughnessFactor);
    m.doubleSided = source.doubleSided;
    m.retroreflective = source.extras.Has("retroreflective") && source.extras.Get("retroreflective").IsBool() &&
                        source.extras.Get("retroreflective").Get<bool>();
    if (source.alphaMode == "MASK") m.alphaCutoff = float(std::max(source.alphaCutoff, 0.0));
    m.blended = source.alphaMode == "BLEND";
    double strength = 1.0;
    if (const auto it = source.extensions.find("KHR_materials_emissive_strength"); it != source.extensions.end())
        strength = std::max(numberOr(it->second, "emissiveStrength", 1.0), 0.0);
    if (source.emissiveFactor.size() == 3)
        for (int i = 0; i < 3; ++i) m.emission[i] = float(std::max(source.emissiveFactor[size_t(i)], 0.0) * strength);
    if (!finite(m.emission)) return bad(fmt::format("Material '{}' has an emission that is not finite; lower its strength.", m.name));

    int uvSet = -1; // the first textured slot decides; the base colour comes first
    if (Status s = readTexture(pbr.baseColorTexture.extensions, pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord,
                               m.baseColorTexture, uvSet);
        !s)
        return s.error();
    const tg::TextureInfo& mr = pbr.metallicRoughnessTexture;
    if (Status s = readTexture(mr.extensions, mr.index, mr.texCoord, m.metallicRoughnessTexture, uvSet); !s) return s.error();
    if (m.emission != vec3(0.0f)) // a black factor blacks the texture out
        if (Status s = readTexture(source.emissiveTexture.extensions, source.emissiveTexture.index, source.emissiveTexture.texCoord,
                                   m.emissionTexture, uvSet);
            !s)
            return s.error();
    const tg::NormalTextureInfo& bump = source.normalTexture;
    if (Status s = readTexture(bump.extensions, bump.index, bump.texCoord, m.normalTexture, uvSet); !s) return s.error();
    m.normalStrength = float(bump.scale);
    if (source.occlusionTexture.index >= 0) note("Occlusion textures are ignored; occlusion is computed.");
    scene.materials.push_back(std::move(m));
    uvSets.push_back(std::max(uvSet, 0));
    return materials[index] = uint32_t(scene.materials.size() - 1);
}

Status Importer::readTexture(const tg::ExtensionMap& extensions, int index, int texCoord, TextureRef& out, int& uvSet)
{
    if (index == -1) return success();
    if (!has(model.textures, index)) return bad(fmt::format("A material uses {}", outside("texture", index, model.textures)));
    const tg::Texture& texture = model.textures[size_t(index)];
    int source = texture.source;
    if (const auto webp = texture.extensions.find("EXT_texture_webp"); webp != texture.extensions.end())
        source = indexOr(webp->second, "source", source);
    if (source == -1)
    {
        note("A texture without an image this importer can read (PNG, JPEG, WebP) is ignored.");
        return success();
    }
    const auto image = imageOf(source);
    if (!image) return image.error();
    out.image = *image;
    if (texture.sampler != -1)
    {
        if (!has(model.samplers, texture.sampler))
            return bad(fmt::format("Texture {} uses {}", index, outside("sampler", texture.sampler, model.samplers)));
        const auto wrap = [](int mode)
        {
            return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::clamp
                   : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror
                                                                   : Wrap::repeat;
        };
        out.wrapU = wrap(model.samplers[size_t(texture.sampler)].wrapS);
        out.wrapV = wrap(model.samplers[size_t(texture.sampler)].wrapT);
    }
    if (const auto it = extensions.find("KHR_texture_transform"); it != extensions.end())
    {
        // Counter-clockwise as the extension's schema says, v down: u' = u cos + v sin. (The GLSL in its README turns the other way; the
        // sample viewer and the test model follow the schema.)
        const double angle = numberOr(it->second, "rotation", 0.0);
        const float c = float(std::cos(angle)), s = float(std::sin(angle));
        const vec2 scale = pairOr(it->second, "scale", vec2(1.0f));
        out.uvScaleRotate = glm::mat2(scale.x * c, -scale.x * s, scale.y * s, scale.y * c);
        out.uvOffset = pairOr(it->second, "offset", vec2(0.0f));
        texCoord = indexOr(it->second, "texCoord", texCoord);
        const float sum = scale.x + scale.y + out.uvOffset.x + out.uvOffset.y + c;
        if (!std::isfinite(sum)) return bad(fmt::format("Texture {} has a transform that is not finite; mend it.", index));
    }
    if (uvSet < 0) uvSet = std::max(texCoord, 0);
    if (uvSet != texCoord) note("Only one set of texture coordinates per material is used, that of its first texture.");
    return success();
}

Result<int> Importer::imageOf(int source)
{
    if (const auto known = images.find(source); known != images.end()) return known->second;
    if (!has(guarded.images, source)) return bad(fmt::format("A texture uses {}", outside("image", source, guarded.images)));
    const GltfImage& entry = guarded.images[size_t(source)];
    std::vector<uint8_t> file;
    std::span<const uint8_t> bytes;
    if (entry.bufferView >= 0)
    {
        const tg::BufferView& from = model.bufferViews[size_t(entry.bufferView)];
        const auto& buffer = guarded.buffers[size_t(from.buffer)];
        if (from.byteOffset + from.byteLength <= buffer.size()) bytes = std::span(buffer).subspan(from.byteOffset, from.byteLength);
    }
    else
    {
        auto read = guarded.folder.read(entry.uri, fmt::format("Image '{}'", entry.name));
        if (!read) return read.error();
        file = std::move(*read);
        bytes = file;
    }
    auto image = decodeImage(bytes, entry.name);
    if (!image) return image.error();
    if ((pixels += uint64_t(image->width) * image->height) > GltfLimits::imagePixels)
        return bad(fmt::format("The images hold more than {} Mpixel together; scale them down.", GltfLimits::imagePixels >> 20));
    scene.images.push_back(std::move(*image));
    if (!report(progress, "images", double(scene.images.size()) / double(guarded.images.size()))) return cancelled();
    return images[source] = int(scene.images.size() - 1);
}

Status Importer::place(const Piece& piece, const dmat4& world)
{
    constexpr uint32_t kNone = ~0u;
    invisible += piece.hidden;
    const dmat3 linear(world);
    // Cofactor matrix: the inverse transpose times the determinant; it also exists where a scale is zero.
    const dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]), glm::cross(linear[0], linear[1]));
    const double determinant = glm::dot(linear[0], cofactor[0]);
    const bool mirrored = determinant < 0.0;
    std::vector<vec3> positions(piece.positions.size());
    for (size_t i = 0; i < positions.size(); ++i)
    {
        // Numbers that are finite in the file may be beyond a float's range as a product.
        positions[i] = vec3(world * glm::dvec4(piece.positions[i], 1.0));
        if (!finite(positions[i])) return bad("A mesh instance has a world position that is not finite; mend the nodes' transforms.");
    }
    // Filled as triangles ask: a vertex of degenerate ones alone doesn't enter the scene.
    std::vector<uint32_t> placed(positions.size(), kNone); // our vertex of each
    const auto vertex = [&](uint32_t from, vec3 normal)
    {
        scene.positions.push_back(positions[from]);
        scene.normals.push_back(normal);
        scene.uvs.push_back(piece.uvs[from]);
        return uint32_t(scene.positions.size() - 1);
    };
    for (uvec3 t : piece.triangles)
    {
        // A negative determinant turns the winding, glTF 2.0 section 3.7.4.
        if (mirrored) std::swap(t.y, t.z);
        // In double, but of the positions as they are kept: a triangle that rounding has flattened has no area either.
        const dvec3 a(positions[t.x]), cross = glm::cross(dvec3(positions[t.y]) - a, dvec3(positions[t.z]) - a);
        const double area = glm::length(cross);
        if (!(area > 0.0))
        {
            ++degenerate;
            continue;
        }
        const vec3 flat(cross / area);
        uvec3 corner;
        for (int i = 0; i < 3; ++i)
        {
            if (piece.normals.empty()) // flat, so the vertices can't be shared
            {
                corner[i] = vertex(t[i], flat);
                continue;
            }
            uint32_t& known = placed[t[i]];
            if (known == kNone)
            {
                // The cofactor matrix has the determinant's sign and turns normals over where that is negative.
                const dvec3 normal = cofactor * dvec3(piece.normals[t[i]]) * (mirrored ? -1.0 : 1.0);
                const double length = glm::length(normal);
                const bool usable = length > 0.0 && std::isfinite(length);
                if (!usable) note("Normals of length 0 were replaced by those of the triangles.");
                known = vertex(t[i], usable ? vec3(normal / length) : flat);
            }
            corner[i] = known;
        }
        scene.triangles.push_back(corner);
        scene.triangleMaterial.push_back(piece.material);
    }
    return success();
}

void Importer::noteIgnored()
{
    static constexpr std::string_view known[] = {
        "KHR_mesh_quantization",   "KHR_materials_emissive_strength", "KHR_texture_transform",
        "KHR_lights_punctual",     "EXT_mesh_gpu_instancing",         "EXT_texture_webp",
        "EXT_meshopt_compression", "KHR_meshopt_compression",         "KHR_draco_mesh_compression"};
    for (const std::string& extension : model.extensionsUsed)
        if (std::find(std::begin(known), std::end(known), extension) == std::end(known))
            note(fmt::format("The extension {} is ignored.", extension));
    if (!model.animations.empty()) note("Animations are ignored; everything stands as its nodes say.");
}

Result<Scene> Importer::run(std::string name)
{
    scene.name = std::move(name);
    if (Status status = collect(); !status) return status.error();
    if (Status status = checkBudget(); !status) return status.error();
    for (size_t i = 0; i < instances.size(); ++i)
    {
        if (i % 64 == 0 && !report(progress, "meshes", double(i) / double(instances.size()))) return cancelled();
        if (!pieces.count(instances[i].mesh))
            if (Status status = buildPieces(instances[i].mesh); !status) return status.error();
        for (const Piece& piece : pieces.at(instances[i].mesh))
            if (Status status = place(piece, instances[i].worldFromMesh); !status) return status.error();
    }
    noteIgnored();
    for (const auto& [sentence, count] : notes)
        scene.warnings.push_back(count == 1 ? sentence : fmt::format("{} ({} times)", sentence, count));
    if (degenerate > 0) scene.warnings.push_back(fmt::format("{} triangles without area were dropped.", degenerate));
    if (invisible > 0) scene.warnings.push_back(fmt::format("{} triangles that their constant alpha takes away were dropped.", invisible));
    if (scene.triangles.empty()) scene.warnings.push_back("The scene has no triangles; check that its default scene holds meshes.");
    if (const std::string fault = validate(scene); !fault.empty()) return bad(fault);
    return std::move(scene);
}

} // namespace

Result<Scene> loadGltf(const std::filesystem::path& file, const Progress& progress)
{
    if (!report(progress, "read", 0.0)) return cancelled();
    const auto guarded = openGltf(file);
    if (!guarded) return guarded.error();
    if (!report(progress, "read", 1.0)) return cancelled();
    try
    {
        tg::Model model;
        tg::TinyGLTF parser;
        // It is handed JSON without files in it, and gets no way to open one.
        parser.SetFsCallbacks({[](const std::string&, void*) { return false; }, [](const std::string& path, void*) { return path; },
                               [](std::vector<unsigned char>*, std::string*, const std::string&, void*) { return false; },
                               [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }, nullptr});
        std::string error, warning;
        if (!parser.LoadASCIIFromString(&model, &error, &warning, guarded->json.data(), unsigned(guarded->json.size()), "",
                                        tg::REQUIRE_VERSION))
        {
            while (!error.empty() && (error.back() == '\n' || error.back() == '.')) error.pop_back();
            return bad(fmt::format("'{}' can't be parsed as glTF: {}; export it again.", file.filename().string(), error.substr(0, 300)));
        }
        return Importer(*guarded, model, progress).run(file.stem().string());
    }
    catch (const std::bad_alloc&)
    {
        return Error{ErrorCode::outOfMemory,
                     fmt::format("The import of '{}' ran out of memory; simplify the scene.", file.filename().string())};
    }
    catch (const std::exception& problem) // tinygltf's; ours throws nothing
    {
        return bad(fmt::format("'{}' can't be parsed as glTF ({}); export it again.", file.filename().string(), problem.what()));
    }
}

} // namespace sconce
