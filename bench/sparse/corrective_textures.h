#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "bench/sparse/sample_choice.h"
#include "bench/sparse/sparse_fill.h"

namespace sconce
{

/// Textures of what a picture that is cheap to draw lacks of one that is dear, on the surfaces themselves: learnt from some samples a frame
/// and kept while the camera moves (Stamminger, Haber, Schirmacher, Seidel 2000, "Walkthroughs with Corrective Texturing"). Texels are
/// cells of space and one of six facings, so that no surface needs coordinates of its own.
class CorrectiveTextures
{
public:
    struct Desc
    {
        float texel = 0.08f; // metres; as those of surface light
        float blend = 0.3f;  // share of a new sample in a texel that has been met before
    };
    explicit CorrectiveTextures(const Desc& wanted) : desc(wanted) {}

    /// The corrected picture of a frame; texels are a frame older.
    /// @param wanted  whether a pixel can be off at all; others are as they are and never asked for
    std::vector<vec3> correct(const SurfacePixels& pixels, std::span<const vec3> cheap, const std::vector<bool>& wanted);
    /// The pixels of that frame to draw dearly: where nothing is known first, then where what is known is old and large.
    std::vector<uint32_t> ask(size_t budget) const { return chooseSamples(priority, width, budget); }
    /// Takes in what those of ask() are, dear less cheap.
    void add(const SurfacePixels& pixels, std::span<const uint32_t> asked, std::span<const vec3> differences);
    /// 16 a texel: what a table on a device would take.
    size_t bytes() const { return 16 * texels.size(); }

private:
    struct Texel
    {
        vec3 difference{0.0f};
        uint32_t frame = 0; // in which it was met last
    };
    struct Corner
    {
        uint64_t key;
        float weight;
    };
    std::vector<Corner> cornersOf(vec3 position, vec3 normal) const;

    Desc desc;
    std::unordered_map<uint64_t, Texel> texels;
    std::vector<float> priority;
    uint32_t width = 1, frame = 0;
};

} // namespace sconce
