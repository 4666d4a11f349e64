// Writes the stored inputs that only our own writers can make: seeds FOLDER [the folder corpora]. Run anew when a format changes.
#include <cstdio>

#include "bench/race/ray_file.h"
#include "bench/reference/image_io.h"
#include "runtime/bake/bake_journal.h"
#include "runtime/field/map_blocks.h"
#include "tests/fuzzers/field_blocks.h"
#include "tests/support/files.h"
#include "tests/support/small_field.h"

using namespace sconce;
using testing_support::readText;
using testing_support::writeText;

namespace
{

/// The grouped field with lights that may move.
FieldData liveField()
{
    FieldData field = testing_support::groupedField();
    const size_t texels = size_t(6) * field.info.surfaceSize * field.info.surfaceSize * field.info.probeCount,
                 half = field.info.faceSize / 2;
    field.live.links = 1;
    field.live.texels.resize(texels);
    field.live.texelLinks.resize(texels);
    field.live.tints.resize(gpu::kTints);
    field.live.albedo.resize((6 * half * half * field.info.probeCount + 1) / 2);
    field.live.lights.push_back({.name = "sun"});
    return field;
}

FieldData compactField()
{
    FieldData field = testing_support::smallField(gpu::kChartCube, 8, 1);
    if (const Status put = putInBlocks(field); !put) std::fprintf(stderr, "%s\n", put.error().message.c_str());
    return field;
}

bool writeField(FieldData field, const std::string& file)
{
    if (const Status saved = saveField(field, file); !saved) return std::fprintf(stderr, "%s\n", saved.error().message.c_str()), false;
    const std::string text = readText(file);
    const auto blocks = testing_support::FieldBlocks::of({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    const std::vector<uint8_t> open = blocks->file(256); // small parts as they are, for changes to reach
    writeText(file, std::string(open.begin(), open.end()));
    return true;
}

bool writeJournal(const std::string& file)
{
    auto journal = JournalFile::open(file, {.build = 1, .content = 2, .probes = 3, .shards = 2});
    const std::byte some[24] = {};
    const std::span<const std::byte> pieces[] = {std::span(some), std::span(some).first(3)};
    return journal && journal->keep({7, BakeStage::command, 0}, pieces) && journal->keep({7, BakeStage::maps, 1}, pieces) &&
           journal->commitAs(file + "_whole");
}

bool writePicture(const std::string& file)
{
    ImageSet images;
    images.width = 3, images.height = 2;
    images.add("beauty", 3).pixels[4] = 1.5f;
    images.add("depth", 1).pixels[1] = 2.0f;
    return bool(writeExr(images, file));
}

} // namespace

int main(int count, char** arguments)
{
    if (count != 2) return 2;
    const std::string folder = std::string(arguments[1]) + "/";
    RaySet rays;
    rays.origins.resize(2), rays.normals.resize(2), rays.truth.resize(2), rays.fartherTruth.resize(2);
    rays.directions.assign(2, vec3(0.0f, 1.0f, 0.0f));
    const bool done = writeField(testing_support::smallField(gpu::kChartCube, 8, 1), folder + "field/cube") &&
                      writeField(testing_support::smallField(gpu::kChartOctahedral, 16, 1), folder + "field/octahedral") &&
                      writeField(compactField(), folder + "field/compact") &&
                      writeField(testing_support::groupedField(), folder + "field/groups") &&
                      writeField(liveField(), folder + "field/live") && writeJournal(folder + "journal/open") &&
                      writePicture(folder + "exr/layers") && saveRays(rays, folder + "rays/race");
    return done ? 0 : 5;
}
