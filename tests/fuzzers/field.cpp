// A light field from its file to its answers: whatever loadField() takes, rays and look-ups end within it.
#include <algorithm>

#include "runtime/field/light_field_file.h"
#include "runtime/field/quality.h"
#include "runtime/field/tracer_cpu.h"
#include "tests/fuzzers/field_blocks.h"
#include "tests/fuzzers/input.h"

namespace
{

using namespace sconce;

void ask(const FieldData& field)
{
    twin::LightFieldTwin<float> text(field, Quality{}.trace);
    const vec3 low = field.info.boundsLow, middle = low + 0.5f * (field.octree.boundsHigh - low);
    for (const vec3 direction : {vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, -1.0f, 0.0f), glm::normalize(vec3(0.3f, 0.2f, -0.9f))})
        for (const vec3 place : {middle, low + 0.01f * (middle - low), middle + 3.0f * direction})
        {
            (void)text.queryRay(field.info.origin + field.info.scale * place, direction);
            int reads = 0;
            if (!field.surfaceLight.empty()) (void)text.surfaceLightAt(place, direction, direction, place, reads);
        }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    const auto file = testing_support::inputFile(bytes, size);
    (void)verifyField(file);
    if (const auto field = loadField(file); field) ask(*field);
    if (auto opened = openField(file); opened)
    {
        MapFile& maps = opened->maps;
        std::vector<uint32_t> distance(maps.distanceWords()), light(maps.radianceWords()), shares(maps.groups() * light.size());
        for (const uint32_t probe : {0u, std::max(opened->field.info.probeCount, 1u) - 1u})
        {
            (void)maps.read(probe, distance, light);
            (void)maps.readShares(probe, distance, shares);
        }
    }
    return 0;
}

#ifdef SCONCE_FUZZ
extern "C" size_t LLVMFuzzerMutate(uint8_t* bytes, size_t size, size_t most);

/// Of eight changes one is to the file as it is, the others to what a block holds, or to the blocks themselves.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* bytes, size_t size, size_t most, unsigned seed)
{
    auto field = testing_support::FieldBlocks::of({bytes, size});
    if (seed % 8 == 0 || !field || field->blocks.empty()) return LLVMFuzzerMutate(bytes, size, most);
    const size_t which = seed / 8 % field->blocks.size();
    auto& block = field->blocks[which];
    if (seed / 1024 % 32 == 0)
        field->blocks.erase(field->blocks.begin() + ptrdiff_t(which));
    else if (seed / 1024 % 32 == 1)
        field->version = seed >> 16 & 15;
    else
    {
        const size_t held = block.raw.size();
        block.raw.resize(held + 64);
        // Mostly of the size that the others call for: another one is refused before anything is looked at.
        const size_t made = LLVMFuzzerMutate(block.raw.data(), held, seed / 1024 % 8 == 2 ? held + 64 : std::max<size_t>(held, 1));
        block.raw.resize(seed / 1024 % 8 == 2 ? made : held);
    }
    const std::vector<uint8_t> file = field->file(256);
    if (file.size() > most) return size;
    std::ranges::copy(file, bytes);
    return file.size();
}
#endif
