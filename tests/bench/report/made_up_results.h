#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

namespace sconce::testing_support
{

/// Results that nobody measured, of the shape that the bench writes (docs/formats.md), to try the page on.
struct MadeUp
{
    int scenes = 2;
    int points = 55;             // of the first scene; the others have as many
    int width = 96, height = 54; // of the images
};

/// Writes the image files and returns results.json. Every figure is a smooth function of the settings, so orders and fronts are known:
/// more probes and texels cost more and err less. Some figures are missing, null or not finite, as they can be.
nlohmann::ordered_json madeUpResults(const std::filesystem::path& folder, const MadeUp& what = {});

/// Writes an image file whose pixels are given: halves as their bits, three a pixel, or numbers.
void writeHalves(const std::filesystem::path& file, int width, int height, const std::vector<uint16_t>& bits);
void writeNumbers(const std::filesystem::path& file, int width, int height, const std::vector<uint32_t>& numbers);

} // namespace sconce::testing_support
