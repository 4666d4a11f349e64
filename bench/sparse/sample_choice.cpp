#include "bench/sparse/sample_choice.h"

#include <algorithm>

namespace sconce
{

std::vector<uint32_t> chooseSamples(std::span<const float> priority, uint32_t width, size_t budget)
{
    double sum = 0.0;
    for (const float wish : priority) sum += double(wish);
    const float scale = float(double(budget) / std::max(sum, 1e-9));
    std::vector<uint32_t> asked;
    std::vector<float> row(width, 0.0f), below(width, 0.0f);
    for (uint32_t y = 0; y < priority.size() / width; ++y)
    {
        std::ranges::fill(below, 0.0f);
        for (uint32_t i = 0; i < width; ++i)
        {
            const int step = y % 2 == 0 ? 1 : -1; // there and back, so that the error doesn't drift to one side
            const auto x = int(y % 2 == 0 ? i : width - 1 - i);
            const size_t pixel = size_t(y) * width + size_t(x);
            float wish = std::min(scale * priority[pixel], 1.0f) + row[size_t(x)];
            if (wish >= 0.5f && priority[pixel] > 0.0f)
            {
                if (asked.size() < budget) asked.push_back(uint32_t(pixel));
                wish -= 1.0f;
            }
            // Past an end of the row there is no pixel: its share goes below.
            const auto clamped = [&](int at) { return size_t(std::clamp(at, 0, int(width) - 1)); };
            const bool isLast = i + 1 == width;
            (isLast ? below[size_t(x)] : row[clamped(x + step)]) += 7.0f / 16.0f * wish;
            below[clamped(x - step)] += 3.0f / 16.0f * wish;
            below[size_t(x)] += 5.0f / 16.0f * wish;
            below[clamped(x + step)] += 1.0f / 16.0f * wish;
        }
        std::swap(row, below);
    }
    return asked;
}

} // namespace sconce
