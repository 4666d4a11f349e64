#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/result.h"
#include "scene/scene.h"

namespace sconce
{

/// XXH3, 64 bits, of values one after another: what tells contents apart by which kept work is found again.
class ContentHash
{
public:
    ContentHash();
    ContentHash(ContentHash&&) noexcept;
    ContentHash& operator=(ContentHash&&) noexcept;
    ~ContentHash();

    void addBytes(std::span<const std::byte> bytes);
    template <class T> void add(const T& value)
    {
        // Padding has no fixed value: what has some would hash differently from run to run.
        static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>);
        addBytes(std::as_bytes(std::span(&value, 1)));
    }
    template <int N> void add(const glm::vec<N, float, glm::defaultp>& value)
    {
        for (int i = 0; i < N; ++i) add(value[i]);
    }
    /// The length, too, so that two arrays that follow each other can't be cut at another place for the same key.
    template <class T> void addAll(const std::vector<T>& values) // without padding
    {
        add(values.size());
        addBytes(std::as_bytes(std::span(values)));
    }
    void addText(std::string_view text);
    uint64_t value() const;

private:
    struct State;
    std::unique_ptr<State> state;
};

/// 16 hexadecimal digits.
std::string keyText(uint64_t key);

/// The key of the running program, shaders and all that is linked into it: what two builds made is never taken for one's. Two commits that
/// make the same program are one build. Errors: fileError.
Result<std::string> keyOfThisBuild();
uint64_t keyWithoutCommit(std::string program); // of a program's bytes

/// The key of everything in a scene that light depends on: triangles, materials, images, lights, sky; not its cameras or its name.
std::string keyOf(const Scene& scene);
void addScene(ContentHash& hash, const Scene& scene); // the same, to a key of more

} // namespace sconce
