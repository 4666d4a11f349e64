#pragma once

#include <initializer_list>
#include <optional>

#include "runtime/bake/bake_journal.h"
#include "runtime/bake/triangle_gather.h"
#include "runtime/field/field_data.h"

namespace sconce
{

/// The parts of one bake in its journal; without a journal nothing is found, and nothing kept.
class BakeParts
{
public:
    BakeParts() = default;
    BakeParts(BakeJournal* kept, uint64_t key) : journal(kept), bake(key) {}
    bool kept() const { return journal != nullptr; }

    /// Fills arrays with what was kept of them, one after another; false, and nothing filled: it wasn't, or they had other lengths.
    bool take(BakeStage stage, uint32_t index, std::initializer_list<std::span<std::byte>> arrays) const;
    Status keep(BakeStage stage, uint32_t index, std::initializer_list<std::span<const std::byte>> arrays) const;

    struct Index
    {
        Octree octree;
        bool onDevice = false; // where it was built
    };
    /// @param probes  get their summaries
    std::optional<Index> takeIndex(std::span<gpu::ProbeHeader> probes) const;
    Status keepIndex(const Octree& octree, bool onDevice, std::span<const gpu::ProbeHeader> probes) const;

    /// @param cells, rays  how many there are, and of each facing
    std::optional<TriangleGather::Cells> takeCells(size_t cells, uint32_t rays) const;
    Status keepCells(const TriangleGather::Cells& cells) const;

private:
    BakeJournal* journal = nullptr;
    uint64_t bake = 0;
};

template <class Array> std::span<const std::byte> asBytes(const Array& array)
{
    return std::as_bytes(std::span(array));
}
template <class Array> std::span<std::byte> asWritableBytes(Array&& array)
{
    return std::as_writable_bytes(std::span(array));
}

} // namespace sconce
