#include "bench/sweep/keys.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <type_traits>

#include <xxhash.h>

#include <fmt/format.h>

#include "base/commit_mark.h"

namespace sconce
{
namespace
{

std::string hex(uint64_t value)
{
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
    return text;
}

class Hash
{
public:
    Hash() { XXH3_64bits_reset(state.get()); }
    template <class T> void add(const T& value)
    {
        // Padding has no fixed value: what has some would hash differently from run to run.
        static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>);
        XXH3_64bits_update(state.get(), &value, sizeof value);
    }
    template <int N> void add(const glm::vec<N, float, glm::defaultp>& value)
    {
        for (int i = 0; i < N; ++i) add(value[i]);
    }
    void add(std::span<const char> bytes) { XXH3_64bits_update(state.get(), bytes.data(), bytes.size()); }
    template <class T> void addAll(const std::vector<T>& values) // without padding
    {
        // The length, too, so that two arrays that follow each other can't be cut at another place for the same key.
        add(values.size());
        XXH3_64bits_update(state.get(), values.data(), values.size() * sizeof(T));
    }
    void add(const TextureRef& texture)
    {
        add(texture.image), add(texture.wrapU), add(texture.wrapV), add(texture.uvOffset);
        for (int i = 0; i < 2; ++i) add(texture.uvScaleRotate[i]);
    }
    uint64_t value() const { return XXH3_64bits_digest(state.get()); }

private:
    struct Free
    {
        void operator()(XXH3_state_t* s) const { XXH3_freeState(s); }
    };
    std::unique_ptr<XXH3_state_t, Free> state{XXH3_createState()};
};

} // namespace

std::string keyOf(const nlohmann::ordered_json& json)
{
    const std::string text = json.dump();
    return hex(XXH3_64bits(text.data(), text.size()));
}

Result<std::string> keyOfFile(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    Hash hash;
    std::vector<char> piece(size_t(1) << 20);
    while (stream)
    {
        stream.read(piece.data(), std::streamsize(piece.size()));
        hash.add(std::span<const char>(piece).first(size_t(stream.gcount())));
    }
    if (!stream.eof())
        return Error{ErrorCode::fileError, fmt::format("Cannot read '{}'; check that it is there and may be read.", file.string())};
    return hex(hash.value());
}

Result<std::string> keyOfThisBuild()
{
    std::ifstream stream("/proc/self/exe", std::ios::binary);
    std::string program((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    if (program.empty()) return Error{ErrorCode::fileError, "Cannot read this program at '/proc/self/exe'; check that /proc is there."};
    return hex(keyWithoutCommit(std::move(program)));
}

uint64_t keyWithoutCommit(std::string program)
{
    for (size_t at = program.find(kCommitMark); at != std::string::npos; at = program.find(kCommitMark, at + 1))
        program.replace(at + kCommitMark.size(), std::min(kCommitLength, program.size() - at - kCommitMark.size()), kCommitLength, ' ');
    return XXH3_64bits(program.data(), program.size());
}

std::string keyOf(const Scene& scene)
{
    Hash hash;
    hash.addAll(scene.positions), hash.addAll(scene.normals), hash.addAll(scene.uvs);
    hash.addAll(scene.triangles), hash.addAll(scene.triangleMaterial);
    for (const Material& m : scene.materials)
    {
        hash.add(m.baseColor), hash.add(m.baseColorTexture), hash.add(m.metallic), hash.add(m.roughness);
        hash.add(m.metallicRoughnessTexture), hash.add(m.emission), hash.add(m.emissionTexture), hash.add(m.alphaCutoff);
        hash.add(m.blended), hash.add(m.normalTexture), hash.add(m.normalStrength), hash.add(m.doubleSided);
    }
    for (const Image& image : scene.images) hash.add(image.width), hash.add(image.height), hash.addAll(image.rgba);
    for (const Light& light : scene.lights)
    {
        hash.add(light.type), hash.add(light.position), hash.add(light.direction), hash.add(light.intensity);
        hash.add(light.range), hash.add(light.innerCone), hash.add(light.outerCone);
    }
    hash.add(scene.sky), hash.add(scene.twoSided);
    return hex(hash.value());
}

} // namespace sconce
