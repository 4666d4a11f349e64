#include "runtime/scene/content_key.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/commit_mark.h"

namespace sconce
{
namespace
{

void addTexture(ContentHash& hash, const TextureRef& texture)
{
    hash.add(texture.image), hash.add(texture.wrapU), hash.add(texture.wrapV), hash.add(texture.uvOffset);
    for (int i = 0; i < 2; ++i) hash.add(texture.uvScaleRotate[i]);
}

} // namespace

struct ContentHash::State
{
    State() { XXH3_64bits_reset(hash); }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { XXH3_freeState(hash); }
    XXH3_state_t* hash = XXH3_createState(); // which is aligned as it must be
};

ContentHash::ContentHash() : state(std::make_unique<State>()) {}
ContentHash::ContentHash(ContentHash&&) noexcept = default;
ContentHash& ContentHash::operator=(ContentHash&&) noexcept = default;
ContentHash::~ContentHash() = default;

void ContentHash::addBytes(std::span<const std::byte> bytes)
{
    XXH3_64bits_update(state->hash, bytes.data(), bytes.size());
}

void ContentHash::addText(std::string_view text)
{
    add(text.size());
    addBytes(std::as_bytes(std::span(text)));
}

uint64_t ContentHash::value() const
{
    return XXH3_64bits_digest(state->hash);
}

std::string keyText(uint64_t key)
{
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(key));
    return text;
}

Result<std::string> keyOfThisBuild()
{
    const char* const self = "/proc/self/exe";
    std::error_code failed;
    const uintmax_t size = std::filesystem::file_size(self, failed);
    std::string program(failed ? 0 : size, '\0');
    std::ifstream stream(self, std::ios::binary);
    if (program.empty() || !stream.read(program.data(), std::streamsize(program.size())))
        return Error{ErrorCode::fileError, fmt::format("Cannot read this program at '{}'; check that /proc is there.", self)};
    return keyText(keyWithoutCommit(std::move(program)));
}

uint64_t keyWithoutCommit(std::string program)
{
    for (size_t at = program.find(kCommitMark); at != std::string::npos; at = program.find(kCommitMark, at + 1))
        program.replace(at + kCommitMark.size(), std::min(kCommitLength, program.size() - at - kCommitMark.size()), kCommitLength, ' ');
    return XXH3_64bits(program.data(), program.size());
}

void addScene(ContentHash& hash, const Scene& scene)
{
    hash.addAll(scene.positions), hash.addAll(scene.normals), hash.addAll(scene.uvs);
    hash.addAll(scene.triangles), hash.addAll(scene.triangleMaterial);
    for (const Material& m : scene.materials)
    {
        hash.add(m.baseColor), addTexture(hash, m.baseColorTexture), hash.add(m.metallic), hash.add(m.roughness);
        addTexture(hash, m.metallicRoughnessTexture), hash.add(m.emission), addTexture(hash, m.emissionTexture), hash.add(m.alphaCutoff);
        hash.add(m.blended), addTexture(hash, m.normalTexture), hash.add(m.normalStrength), hash.add(m.doubleSided),
            hash.add(m.retroreflective);
    }
    for (const Image& image : scene.images) hash.add(image.width), hash.add(image.height), hash.addAll(image.rgba);
    for (const Light& light : scene.lights)
    {
        hash.add(light.type), hash.add(light.position), hash.add(light.direction), hash.add(light.intensity);
        hash.add(light.range), hash.add(light.innerCone), hash.add(light.outerCone);
    }
    hash.add(scene.sky), hash.add(scene.twoSided);
}

std::string keyOf(const Scene& scene)
{
    ContentHash hash;
    addScene(hash, scene);
    return keyText(hash.value());
}

} // namespace sconce
