#pragma once

#include <cstdint>
#include <vector>

#include "base/random.h"
#include "scene/scene.h"

namespace sconce
{

/// The emissive triangles, drawn in proportion to area times mean emission. Emission leaves both sides.
class Emitters
{
public:
    explicit Emitters(const Scene& lit);

    struct Sample
    {
        uint32_t triangle = 0;
        vec3 position{0.0f};
        vec2 uv{0.0f};
        float areaPdf = 0.0f; // 1/m^2
    };
    Sample draw(Random& random) const;
    /// Density per area with which draw() picks points of this triangle; 0 when it doesn't emit.
    float areaPdf(uint32_t triangle) const { return pdf.empty() ? 0.0f : pdf[triangle]; }
    bool empty() const { return triangles.empty(); }

private:
    const Scene& scene;
    std::vector<uint32_t> triangles;
    std::vector<double> cumulative; // [triangles], last is 1
    std::vector<float> pdf;         // [scene triangles], empty without emitters
};

} // namespace sconce
