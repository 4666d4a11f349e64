#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

/// One layer of a picture; its channels are R, G, B, with `name.` before them where there is a name.
struct ExrLayer
{
    std::string name;
    std::vector<glm::vec4> pixels; // row 0 at the top; a is not written
};

/// 32-bit float. Throws std::runtime_error with a sentence where the file can't be written.
void writeExr(const std::filesystem::path& file, uint32_t width, uint32_t height, std::span<const ExrLayer> layers);
