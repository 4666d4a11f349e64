#include "gltf_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <tiny_gltf.h>

namespace
{

constexpr size_t kMostIndices = 300'000'000; // with all instances: a few kB of JSON can ask for any number
constexpr int kMostDepth = 256;              // of nodes

[[noreturn]] void refuse(const std::string& sentence)
{
    throw std::runtime_error(sentence + "; export the file again");
}

template <class List> const auto& at(const List& list, int index, const char* kind)
{
    if (index < 0 || size_t(index) >= list.size())
        refuse(std::string("the file uses ") + kind + " " + std::to_string(index) + " of " + std::to_string(list.size()));
    return list[size_t(index)];
}

template <class T> double read(const unsigned char* from)
{
    T value; // the file owes us no alignment
    std::memcpy(&value, from, sizeof value);
    return double(value);
}

/// An accessor whose bytes are all there.
class Elements
{
public:
    Elements(const tinygltf::Model& file, int index, int components);
    size_t size() const { return count; }
    double component(size_t element, int c) const;
    glm::vec3 vec3(size_t i) const { return {component(i, 0), component(i, 1), component(i, 2)}; }
    glm::vec2 vec2(size_t i) const { return {component(i, 0), component(i, 1)}; }

private:
    const unsigned char* base = nullptr;
    size_t stride = 0, count = 0, width = 0; // width: bytes of a component
    int kind = 0;
    bool normalized = false;
};

Elements::Elements(const tinygltf::Model& file, int index, int components)
{
    const tinygltf::Accessor& accessor = at(file.accessors, index, "accessor");
    const std::string name = "accessor " + std::to_string(index);
    if (accessor.sparse.isSparse || accessor.bufferView < 0) throw std::runtime_error(name + " is sparse, which this host doesn't read");
    if (tinygltf::GetNumComponentsInType(uint32_t(accessor.type)) != components)
        refuse(name + " has not the " + std::to_string(components) + " components that its use needs");
    const tinygltf::BufferView& view = at(file.bufferViews, accessor.bufferView, "buffer view");
    const std::vector<unsigned char>& bytes = at(file.buffers, view.buffer, "buffer").data;
    const int componentBytes = tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType));
    if (componentBytes <= 0) refuse(name + " has a component type that glTF 2.0 doesn't know");
    width = size_t(componentBytes);
    const size_t element = width * size_t(components);
    stride = view.byteStride != 0 ? view.byteStride : element;
    count = accessor.count;
    kind = accessor.componentType;
    normalized = accessor.normalized;
    // Each number is at most the size of the buffer before it is added to another.
    const bool fits = view.byteOffset <= bytes.size() && accessor.byteOffset <= bytes.size() && stride <= 255 && count <= bytes.size() &&
                      (count == 0 || view.byteOffset + accessor.byteOffset + stride * (count - 1) + element <= bytes.size());
    if (!fits) refuse(name + " reaches beyond the " + std::to_string(bytes.size()) + " bytes of its buffer");
    base = bytes.data() + view.byteOffset + accessor.byteOffset;
}

double Elements::component(size_t element, int c) const
{
    const unsigned char* from = base + element * stride + size_t(c) * width;
    switch (kind)
    {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return normalized ? std::max(read<int8_t>(from) / 127.0, -1.0) : read<int8_t>(from);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return normalized ? read<uint8_t>(from) / 255.0 : read<uint8_t>(from);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return normalized ? std::max(read<int16_t>(from) / 32767.0, -1.0) : read<int16_t>(from);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return normalized ? read<uint16_t>(from) / 65535.0 : read<uint16_t>(from);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return read<uint32_t>(from);
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return read<float>(from);
    default:
        return 0.0; // INT and DOUBLE are none of glTF's
    }
}

glm::dmat4 transformOf(const tinygltf::Node& node)
{
    glm::dmat4 local(1.0);
    if (node.matrix.size() == 16)
    {
        for (int i = 0; i < 16; ++i) local[i / 4][i % 4] = node.matrix[size_t(i)];
        return local;
    }
    const auto& t = node.translation;
    const auto& r = node.rotation;
    const auto& s = node.scale;
    if (t.size() == 3) local = glm::translate(local, glm::dvec3(t[0], t[1], t[2]));
    if (r.size() == 4) local *= glm::mat4_cast(glm::normalize(glm::dquat(r[3], r[0], r[1], r[2])));
    if (s.size() == 3) local = glm::scale(local, glm::dvec3(s[0], s[1], s[2]));
    return local;
}

/// Index of a texture's picture, or -1.
int pictureOf(const tinygltf::Model& file, int texture, int uvSet, Model& model)
{
    if (texture < 0) return -1;
    const int picture = at(file.textures, texture, "texture").source;
    if (uvSet != 0) model.warnings.push_back("Textures by a second set of coordinates are left out.");
    if (picture < 0 || uvSet != 0) return -1;
    at(file.images, picture, "image");
    return model.pictures[size_t(picture)].rgba.empty() ? -1 : picture;
}

Material materialOf(const tinygltf::Model& file, const tinygltf::Material& source, Model& model)
{
    const auto& pbr = source.pbrMetallicRoughness;
    Material made;
    if (pbr.baseColorFactor.size() == 4)
        for (int i = 0; i < 4; ++i) made.baseColor[i] = float(pbr.baseColorFactor[size_t(i)]);
    made.metallic = std::clamp(float(pbr.metallicFactor), 0.0f, 1.0f);
    made.roughness = std::clamp(float(pbr.roughnessFactor), 0.0f, 1.0f);
    made.normalScale = float(source.normalTexture.scale);
    if (source.alphaMode == "MASK") made.alphaCutoff = float(source.alphaCutoff);
    if (source.alphaMode == "BLEND") model.warnings.push_back("Blended materials are drawn as if they were opaque.");
    double strength = 1.0;
    const auto extension = source.extensions.find("KHR_materials_emissive_strength");
    if (extension != source.extensions.end() && extension->second.Has("emissiveStrength"))
        strength = extension->second.Get("emissiveStrength").GetNumberAsDouble();
    if (source.emissiveFactor.size() == 3)
        for (int i = 0; i < 3; ++i) made.emission[i] = float(source.emissiveFactor[size_t(i)] * strength);
    made.baseColorPicture = pictureOf(file, pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord, model);
    made.metallicRoughnessPicture = pictureOf(file, pbr.metallicRoughnessTexture.index, pbr.metallicRoughnessTexture.texCoord, model);
    made.emissionPicture = pictureOf(file, source.emissiveTexture.index, source.emissiveTexture.texCoord, model);
    made.normalPicture = pictureOf(file, source.normalTexture.index, source.normalTexture.texCoord, model);
    return made;
}

void addMaterials(const tinygltf::Model& file, Model& model)
{
    for (const tinygltf::Image& image : file.images)
    {
        Picture picture;
        const bool plain = image.width > 0 && image.height > 0 && image.component == 4 && image.bits == 8 &&
                           image.image.size() == size_t(image.width) * size_t(image.height) * 4;
        if (plain)
            picture = {uint32_t(image.width), uint32_t(image.height), image.image};
        else
            model.warnings.push_back("Picture '" + image.name + "' is left out: it has not 8 bits a channel, or can't be read.");
        model.pictures.push_back(std::move(picture));
    }
    for (const tinygltf::Material& material : file.materials) model.materials.push_back(materialOf(file, material, model));
    model.materials.push_back(materialOf(file, tinygltf::Material(), model)); // of what has none
}

std::vector<uint32_t> indicesOf(const tinygltf::Model& file, const tinygltf::Primitive& primitive, size_t vertices)
{
    std::vector<uint32_t> indices;
    if (primitive.indices < 0)
        for (size_t i = 0; i < vertices; ++i) indices.push_back(uint32_t(i));
    else
    {
        const Elements elements(file, primitive.indices, 1);
        for (size_t i = 0; i < elements.size(); ++i)
        {
            const double index = elements.component(i, 0);
            if (!(index >= 0.0 && index < double(vertices)))
                refuse("a mesh uses vertex " + std::to_string(index) + " of " + std::to_string(vertices));
            indices.push_back(uint32_t(index));
        }
    }
    indices.resize(indices.size() / 3 * 3);
    return indices;
}

/// Of triangles that say nothing about their normals: flat.
void addFlat(const std::vector<uint32_t>& indices, std::vector<Vertex>& vertices)
{
    std::vector<Vertex> flat;
    for (size_t i = 0; i < indices.size(); ++i) flat.push_back(vertices[indices[i]]);
    for (size_t i = 0; i + 2 < flat.size(); i += 3)
    {
        const glm::vec3 across = glm::cross(flat[i + 1].position - flat[i].position, flat[i + 2].position - flat[i].position);
        const float size = glm::length(across);
        for (size_t k = i; k < i + 3; ++k) flat[k].normal = size > 0.0f ? across / size : glm::vec3(0.0f, 1.0f, 0.0f);
    }
    vertices = std::move(flat);
}

void addPrimitive(const tinygltf::Model& file, const tinygltf::Primitive& primitive, const glm::dmat4& world, Model& model)
{
    const auto attribute = [&](const char* name)
    {
        const auto found = primitive.attributes.find(name);
        return found == primitive.attributes.end() ? -1 : found->second;
    };
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES || attribute("POSITION") < 0)
    {
        model.warnings.push_back("What is no plain list of triangles with positions is left out.");
        return;
    }
    const Elements positions(file, attribute("POSITION"), 3);
    std::vector<Vertex> vertices(positions.size());
    for (size_t i = 0; i < vertices.size(); ++i) vertices[i].position = glm::vec3(world * glm::dvec4(positions.vec3(i), 1.0));
    if (attribute("TEXCOORD_0") >= 0)
    {
        const Elements uvs(file, attribute("TEXCOORD_0"), 2);
        for (size_t i = 0; i < std::min(vertices.size(), uvs.size()); ++i) vertices[i].uv = uvs.vec2(i);
    }
    std::vector<uint32_t> indices = indicesOf(file, primitive, vertices.size());
    if (model.indices.size() + indices.size() > kMostIndices) throw std::runtime_error("the scene has too many triangles; simplify it");
    if (attribute("NORMAL") >= 0)
    {
        const glm::dmat3 turned = glm::transpose(glm::inverse(glm::dmat3(world)));
        const Elements normals(file, attribute("NORMAL"), 3);
        for (size_t i = 0; i < std::min(vertices.size(), normals.size()); ++i)
            vertices[i].normal = glm::vec3(glm::normalize(turned * glm::dvec3(normals.vec3(i))));
    }
    else
    {
        addFlat(indices, vertices);
        for (size_t i = 0; i < indices.size(); ++i) indices[i] = uint32_t(i);
    }
    const auto first = uint32_t(model.vertices.size());
    const bool named = primitive.material >= 0;
    if (named) at(file.materials, primitive.material, "material");
    const size_t material = named ? size_t(primitive.material) : model.materials.size() - 1;
    model.parts.push_back({uint32_t(model.indices.size()), uint32_t(indices.size()), uint32_t(material)});
    model.vertices.insert(model.vertices.end(), vertices.begin(), vertices.end());
    for (const uint32_t index : indices) model.indices.push_back(first + index);
}

void addCamera(const tinygltf::Camera& source, const std::string& name, const glm::dmat4& world, Model& model)
{
    if (source.type != "perspective")
    {
        model.warnings.push_back("Cameras without a perspective are left out.");
        return;
    }
    const glm::dvec3 forward = glm::normalize(-glm::dvec3(world[2])), above(world[1]);
    const glm::dvec3 up = glm::normalize(above - glm::dot(above, forward) * forward);
    const bool usable = std::isfinite(glm::length(up)) && std::isfinite(glm::length(glm::dvec3(world[3]))) &&
                        source.perspective.yfov > 0.0 && source.perspective.yfov < 3.14;
    if (usable)
        model.cameras.push_back({name, glm::vec3(world[3]), glm::vec3(forward), glm::vec3(up), float(source.perspective.yfov)});
    else
        model.warnings.push_back("Camera '" + name + "' has no direction or no field of view and is left out.");
}

void addLight(const tinygltf::Light& source, const glm::dmat4& world, Model& model)
{
    if (source.type != "directional" || model.sun)
    {
        model.warnings.push_back("Light '" + source.name + "' is left out: this host draws the first directional light alone.");
        return;
    }
    Sun sun;
    sun.along = glm::vec3(glm::normalize(-glm::dvec3(world[2])));
    const glm::vec3 color = source.color.size() == 3 ? glm::vec3(source.color[0], source.color[1], source.color[2]) : glm::vec3(1.0f);
    sun.irradiance = color * float(source.intensity);
    if (std::isfinite(glm::length(sun.along)) && std::isfinite(glm::length(sun.irradiance))) model.sun = sun;
}

/// @param seen  nodes that were visited: glTF's are trees, and a cycle would have no end
void addNode(const tinygltf::Model& file, int index, const glm::dmat4& parent, int depth, std::vector<bool>& seen, Model& model)
{
    const tinygltf::Node& node = at(file.nodes, index, "node");
    if (seen[size_t(index)] || depth > kMostDepth) refuse("node " + std::to_string(index) + " has two parents or lies too deep");
    seen[size_t(index)] = true;
    const glm::dmat4 world = parent * transformOf(node);
    if (node.mesh >= 0)
        for (const tinygltf::Primitive& primitive : at(file.meshes, node.mesh, "mesh").primitives)
            addPrimitive(file, primitive, world, model);
    if (node.camera >= 0) addCamera(at(file.cameras, node.camera, "camera"), node.name, world, model);
    const auto light = node.extensions.find("KHR_lights_punctual");
    if (light != node.extensions.end() && light->second.Has("light"))
        addLight(at(file.lights, light->second.Get("light").GetNumberAsInt(), "light"), world, model);
    for (const int child : node.children) addNode(file, child, world, depth + 1, seen, model);
}

tinygltf::Model parse(const std::filesystem::path& file)
{
    tinygltf::TinyGLTF parser;
    tinygltf::Model model;
    std::string error, warning;
    const bool binary = file.extension() == ".glb";
    const bool read = binary ? parser.LoadBinaryFromFile(&model, &error, &warning, file.string())
                             : parser.LoadASCIIFromFile(&model, &error, &warning, file.string());
    while (!error.empty() && (error.back() == '\n' || error.back() == '.')) error.pop_back();
    if (!read) throw std::runtime_error("'" + file.string() + "' can't be read as glTF: " + error + "; check the path, or export it again");
    return model;
}

} // namespace

Model loadGltf(const std::filesystem::path& file, glm::vec3 axes)
{
    const tinygltf::Model source = parse(file);
    Model model;
    addMaterials(source, model);
    std::vector<bool> seen(source.nodes.size(), false);
    const int scene = source.defaultScene < 0 ? 0 : source.defaultScene;
    const glm::dmat4 hostFromFile = glm::scale(glm::dmat4(1.0), glm::dvec3(axes));
    for (const int root : at(source.scenes, scene, "scene").nodes) addNode(source, root, hostFromFile, 1, seen, model);
    if (model.indices.empty())
        throw std::runtime_error("'" + file.string() + "' has no triangles in its default scene; export its meshes, too");
    if (!model.sun) model.warnings.push_back("There is no directional light, so no sun is drawn.");
    model.low = model.high = model.vertices.front().position;
    for (const Vertex& vertex : model.vertices)
    {
        model.low = glm::min(model.low, vertex.position);
        model.high = glm::max(model.high, vertex.position);
        if (!std::isfinite(glm::length(vertex.position))) refuse("a vertex lies at no finite place");
    }
    std::ranges::sort(model.warnings);
    const auto repeated = std::ranges::unique(model.warnings);
    model.warnings.erase(repeated.begin(), repeated.end());
    return model;
}
