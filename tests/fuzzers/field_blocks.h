#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include <zstd.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace sconce::testing_support
{

/// A .sconce file taken apart and put together with its checksums right, so that what lies behind them is reached (docs: file formats).
struct FieldBlocks
{
    struct Block
    {
        uint32_t section = 0, chunk = 0;
        std::vector<uint8_t> raw;
    };
    uint32_t version = 0;
    std::vector<Block> blocks;

    static constexpr size_t kHeader = 40, kEntry = 48, kFooter = 16;

    static std::optional<FieldBlocks> of(std::span<const uint8_t> file)
    {
        if (file.size() < kHeader + kFooter) return {};
        FieldBlocks made;
        made.version = at<uint32_t>(file, 8);
        const uint64_t count = at<uint32_t>(file, 12);
        if (count * kEntry > file.size() - kHeader - kFooter) return {};
        for (uint64_t i = 0; i < count; ++i)
        {
            const size_t entry = kHeader + i * kEntry;
            const uint64_t offset = at<uint64_t>(file, entry + 16), stored = at<uint64_t>(file, entry + 24),
                           raw = at<uint64_t>(file, entry + 32);
            if (offset > file.size() || stored > file.size() - offset || raw > 1u << 20) return {};
            Block block{at<uint32_t>(file, entry), at<uint32_t>(file, entry + 4), std::vector<uint8_t>(raw)};
            const auto piece = file.subspan(offset, stored);
            if (at<uint32_t>(file, entry + 8) == 1)
            {
                if (ZSTD_decompress(block.raw.data(), raw, piece.data(), stored) != raw) return {};
            }
            else
                block.raw.assign(piece.begin(), piece.end());
            made.blocks.push_back(std::move(block));
        }
        return made;
    }

    /// Uncompressed, but for blocks that are more than so many bytes.
    std::vector<uint8_t> file(size_t most) const
    {
        std::vector<uint8_t> out(kHeader + blocks.size() * kEntry);
        std::memcpy(out.data(), "\x89SCONCE\n", 8);
        for (size_t i = 0; i < blocks.size(); ++i)
        {
            const std::vector<uint8_t>& raw = blocks[i].raw;
            std::vector<uint8_t> packed = raw;
            if (raw.size() > most)
            {
                packed.resize(ZSTD_compressBound(raw.size()));
                packed.resize(ZSTD_compress(packed.data(), packed.size(), raw.data(), raw.size(), 3));
            }
            const size_t entry = kHeader + i * kEntry;
            put(out, entry, blocks[i].section), put(out, entry + 4, blocks[i].chunk);
            put(out, entry + 8, uint32_t(raw.size() > most)), put(out, entry + 12, uint32_t(0));
            put(out, entry + 16, uint64_t(out.size())), put(out, entry + 24, uint64_t(packed.size()));
            put(out, entry + 32, uint64_t(raw.size())), put(out, entry + 40, uint64_t(XXH3_64bits(packed.data(), packed.size())));
            out.insert(out.end(), packed.begin(), packed.end());
        }
        put(out, 8, version), put(out, 12, uint32_t(blocks.size())), put(out, 16, uint64_t(out.size() + kFooter));
        put(out, 24, uint64_t(XXH3_64bits(out.data() + kHeader, blocks.size() * kEntry)));
        const uint64_t sum = XXH3_64bits(out.data(), 32);
        put(out, 32, sum);
        out.resize(out.size() + kFooter);
        put(out, out.size() - kFooter, sum);
        std::memcpy(out.data() + out.size() - 8, "SCONCE.\n", 8);
        return out;
    }

private:
    template <class T> static T at(std::span<const uint8_t> file, size_t place)
    {
        T value;
        std::memcpy(&value, file.data() + place, sizeof(T));
        return value;
    }
    template <class T> static void put(std::vector<uint8_t>& file, size_t place, T value)
    {
        std::memcpy(file.data() + place, &value, sizeof(T));
    }
};

} // namespace sconce::testing_support
