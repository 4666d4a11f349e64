#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include <glm/glm.hpp>
#include <glm/packing.hpp>

#include "runtime/field/field_data.h"
#include "shaders/shared/light_field.h"

namespace sconce::twin
{
using namespace glm; // the shared text calls GLSL's functions by their plain names

/// The shaders' own text, run on the CPU in float or double: the oracle of the GPU, and what tests and tools trace with.
/// Refers to the field: keep that alive. Safe from many threads, unless it counts.
/// @tparam kCounts  what is read of the field is counted in `read`
template <class Real, bool kCounts = false> struct LightFieldTwin
{
    using real = Real;
    using uint = std::uint32_t;
    using vec2 = glm::vec<2, Real>;
    using vec3 = glm::vec<3, Real>;
    using vec4 = glm::vec<4, Real>;
    using vec2f = glm::vec2;
    using vec3f = glm::vec3;
    using RayHit = gpu::RayHit;
    using ProbeHeader = gpu::ProbeHeader;
    using TraceQuality = gpu::TraceQuality;
    static constexpr uint kNoProbe = gpu::kNoProbe;
    static constexpr uint kChartCube = gpu::kChartCube;
    static constexpr uint kIrradianceSize = gpu::kIrradianceSize;
    static constexpr int kRanked = gpu::kRanked;
    static constexpr int kOrderRanked = gpu::kOrderRanked;
    static constexpr int kOrderParallel = gpu::kOrderParallel;
    static constexpr int kOrderBehind = gpu::kOrderBehind;
    static constexpr uint kCellWords = gpu::kCellWords;
    static constexpr uint kCellKnown = gpu::kCellKnown;
    static constexpr uint kHiddenShiftBits = gpu::kHiddenShiftBits;
    static constexpr int kHiddenTries = gpu::kHiddenTries;
    static constexpr int kFineLog = gpu::kFineLog;
    static constexpr uint kFineWords = gpu::kFineWords;
    static constexpr uint kRefinedWord = gpu::kRefinedWord;
    static constexpr int kPatchSide = gpu::kPatchSide;
    static constexpr uint kPatches = gpu::kPatches;
    static constexpr uint kPrefilteredSize = gpu::kPrefilteredSize;
    static constexpr uint kPrefilteredWords = gpu::kPrefilteredWords;
    static constexpr int kPrefilteredLevels = gpu::kPrefilteredLevels;

    explicit LightFieldTwin(const FieldData& data, const TraceQuality& traceQuality)
        : field(data.info), quality(traceQuality), source(data), blocks(inBlocks(data.info))
    {
    }

#include "shaders/shared/pure_text.h"

#include "shaders/shared/distance_block.h"

#include "shaders/shared/radiance_block.h"

    /// Of 4 bytes, but for an octree's texel of 8 and a header of 16.
    struct Reads
    {
        size_t headers = 0, distance = 0, surface = 0, octree = 0;
    };

    const gpu::LightFieldInfo& field;
    TraceQuality quality;
    const FieldData& source;
    const bool blocks;
    mutable Reads read;

    bool readsFarBounds() const
    {
        return quality.farBounds != 0;
    }
    int probeOrder() const
    {
        return quality.order;
    }
    bool shortTurns() const
    {
        return false;
    }
    bool onOctahedron() const
    {
        return field.chart == gpu::kChartOctahedral;
    }
    bool holdsRadiance() const
    {
        return !source.radiance.empty();
    }
    bool holdsPrefiltered() const
    {
        return !source.prefiltered.empty();
    }
    bool holdsMaps(uint) const
    {
        return true;
    }
    uint mapSlot(uint probe) const
    {
        return probe;
    }
    void askForMaps(uint) const {}
    int surfaceProbes() const
    {
        return kSurfaceProbes;
    }
    const ProbeHeader& probeHeader(uint probe) const
    {
        if constexpr (kCounts) ++read.headers;
        return source.probes[probe];
    }
    uint distanceWord(uint index) const
    {
        if constexpr (kCounts) ++read.distance;
        return source.distance[index];
    }
    uint radianceWord(uint index) const
    {
        return source.radiance[index];
    }
    bool mapsInBlocks() const
    {
        return blocks;
    }
    uvec4 radianceBlock(uint index) const
    {
        const uint* words = source.radiance.data() + 4 * size_t(index);
        return uvec4(words[0], words[1], words[2], words[3]);
    }
    uint irradianceWord(uint index) const
    {
        return source.irradiance[index];
    }
    uvec4 patchWords(uint pair) const
    {
        const uint* words = source.patches.data() + 4 * pair;
        return uvec4(words[0], words[1], words[2], words[3]);
    }
    uint prefilteredWord(uint index) const
    {
        return source.prefiltered[index];
    }
    bool holdsRefined() const
    {
        return field.refinedTexels > 0;
    }
    uint surfaceWord(uint index) const
    {
        if constexpr (kCounts) ++read.surface;
        return source.surfaceLight[index];
    }
    std::span<const uint> live; // incident live light of the texels (live_light.h); empty: there is none
    bool holdsLive() const
    {
        return !live.empty();
    }
    vec3 fixedWeight() const
    {
        return vec3(real(1));
    }
    uint liveWord(uint index) const
    {
        return live[index];
    }
    uint albedoWord(uint index) const
    {
        return source.live.albedo[index];
    }
    uvec4 octreeTexel(ivec3 p) const
    {
        if constexpr (kCounts) ++read.octree;
        const glm::uvec3 size = source.octree.textureSize();
        const size_t at = 4 * (size_t(p.x) + size.x * (size_t(p.y) + size_t(size.y) * p.z));
        const uint16_t* texel = source.octree.texels.data() + at;
        return {texel[0], texel[1], texel[2], texel[3]};
    }

#include "shaders/shared/octree_descent.h"

#include "shaders/shared/ray_state.h"

#include "shaders/shared/face_march.h"

#include "shaders/shared/probe_trace.h"

#include "shaders/shared/prefiltered.h"

#include "shaders/shared/light_lookup.h"

#include "shaders/shared/light_cells.h"

#include "shaders/shared/refined.h"

#include "shaders/shared/hidden_light.h"

#include "shaders/shared/surface_light.h"

#include "shaders/shared/live_text.h"

#include "shaders/shared/ray_query.h"
};

} // namespace sconce::twin
