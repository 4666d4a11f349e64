#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace sconce
{

/// The gate in front of tinygltf. tinygltf 2.7 reads files outside the scene's folder, overflows the stack on deep JSON and accepts
/// accessors past their buffer, so it is given none of that to do: this file reads every byte, and hands on only checked JSON without
/// `buffers` and `images`.
struct GltfLimits
{
    static constexpr uint64_t fileBytes = (2ull << 30) - 1; // of one file; tinygltf keeps sparse offsets in an int
    static constexpr uint64_t totalBytes = 6ull << 30;      // of all buffers together
    static constexpr uint64_t jsonBytes = 256ull << 20;
    static constexpr int jsonDepth = 64;
    static constexpr int nodeDepth = 1024;
    static constexpr uint64_t triangles = 50'000'000;     // after instancing
    static constexpr uint64_t imagePixels = 512ull << 20; // of all images together
};

/// Files of one folder and its sub-folders, named by URI. No absolute path, no scheme, no "..", also not written as %2e%2e, no symbolic
/// link that leads outside; regular files of bounded size only.
class SceneFolder
{
public:
    explicit SceneFolder(std::filesystem::path folder) : root(std::move(folder)) {}
    /// The bytes behind a URI, data URIs included. `what` names the asker in the error's sentence.
    Result<std::vector<uint8_t>> read(std::string_view uri, const std::string& what) const;

private:
    std::filesystem::path root;
};

struct GltfImage
{
    std::string name; // the file's name for it, or image N
    std::string uri;  // empty when it lies in bufferView
    int bufferView = -1;
};

struct GuardedGltf
{
    std::string json;                          // checked, without buffers and images
    std::vector<std::vector<uint8_t>> buffers; // at least byteLength each; empty for a compression fallback without data
    std::vector<GltfImage> images;
    SceneFolder folder{{}};
};

/// Reads a .gltf or .glb and everything its buffers name. Errors: fileError when a file can't be read, badInput for everything that is
/// wrong inside, both naming the thing.
Result<GuardedGltf> openGltf(const std::filesystem::path& file);

// Parts of it, for tests and fuzzers.
Status checkJsonDepth(std::string_view json);
Result<std::string> percentDecode(std::string_view uri);
Result<std::vector<uint8_t>> readRegularFile(const std::filesystem::path& file, const std::string& what);

} // namespace sconce
