#include "runtime/scene/lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/numbers.h"
#include "scene/closed_parts.h"

namespace sconce
{

namespace
{

constexpr float kPi = std::numbers::pi_v<float>;

/// Van der Corput's radical inverse in base 2 and 3: the points of a patch within its triangle.
float radicalInverse(uint32_t i, uint32_t base)
{
    float inverse = 0.0f, digit = 1.0f / float(base);
    for (; i > 0; i /= base, digit /= float(base)) inverse += digit * float(i % base);
    return inverse;
}

/// Samples of what shines, see buildLightList().
class EmitterSamples
{
public:
    EmitterSamples(const Scene& of, const gpu::LightFieldInfo& in, std::span<const uint32_t> lamps, LightList& into)
        : scene(of), space(in), list(into), first(into.lights.size())
    {
        collect(lamps);
    }

    /// @param count  0: none, and nothing is asked of the mesh
    /// @param most   where there are too many lamps for `count`
    void draw(uint32_t count, uint32_t most)
    {
        if (count == 0 || !(power > 0.0)) return;
        outside = outsideOf(scene, shining);
        partOf = joinedParts(scene, shining);
        size_t parts = 0;
        for (size_t i = 0; i < partOf.size(); ++i) parts += partOf[i] == i;
        spread(std::max(count, uint32_t(std::min<size_t>(most, kSamplesOfALamp * parts))));
        keepPower(most);
        placeLight();
        list.header.emitterCount += uint32_t(sampled.size());
        for (size_t i = 0; i < sampled.size(); ++i) list.lights[first + i].area = float(emitters[sampled[i]].patch);
        for (size_t i = 0; i < emitters.size(); ++i)
            list.emitters.push_back({emitters[i].triangle,
                                     emitters[i].emission / std::max(meanCoverage(scene, emitters[i].triangle), 1e-6f),
                                     float(emitters[i].patch),
                                     outside[i] == Outside::both   ? 0
                                     : outside[i] == Outside::back ? -1
                                                                   : 1});
    }

private:
    struct Emitter
    {
        uint32_t triangle;
        vec3 emission;
        double area, power;
        double share = 0.0, end = 0.0; // of the samples, and of its stretch of the cumulated shares
        double patch = 0.0;            // that a sample stands for
        double carried() const { return patch * double(luminance(emission)); }
    };

    void collect(std::span<const uint32_t> lamps)
    {
        for (uint32_t t = 0; t < scene.triangles.size(); ++t)
        {
            const vec3 emission = meanEmission(scene, t);
            if (emission == vec3(0.0f)) continue;
            list.shines = true;
            if (std::ranges::binary_search(lamps, t)) continue;
            const uvec3 corner = scene.triangles[t];
            const glm::dvec3 a(scene.positions[corner.x]), b(scene.positions[corner.y]), c(scene.positions[corner.z]);
            const double own = 0.5 * glm::length(glm::cross(b - a, c - a)) / (double(space.scale) * space.scale);
            if (!(own > 0.0)) continue;
            emitters.push_back({t, emission, own, own * luminance(emission)});
            shining.push_back(t);
            power += emitters.back().power;
            area += own;
        }
    }

    /// @param share  of the triangle's corners in the point
    void add(size_t number, vec3 point, vec3 share)
    {
        const Emitter& emitter = emitters[number];
        gpu::GpuLight light{};
        light.type = gpu::kLightEmitter;
        light.position = (point - space.origin) / space.scale;
        // A back that nobody sees lights nothing: shadows are not exact enough to keep the light of a small globe's far side in it.
        light.direction = geometricNormal(scene, emitter.triangle) * (outside[number] == Outside::back ? -1.0f : 1.0f);
        light.innerCone = outside[number] == Outside::both ? 0.0f : 1.0f;
        light.intensity = emitter.emission;
        light.shadowLayer = kNoShadowMap;
        list.lights.push_back(light);
        sampled.push_back(number);
        shares.push_back(share);
    }

    /// Puts the light of emitters that aren't alike all over, of textures and holes, where it is: each sample has what its own point emits,
    /// all of a triangle together what the triangle does.
    void placeLight()
    {
        std::vector<double> carried(emitters.size(), 0.0);
        std::vector<uint32_t> count(emitters.size(), 0);
        std::vector<vec3> shown(sampled.size());
        for (size_t i = 0; i < sampled.size(); ++i)
        {
            const uint32_t triangle = emitters[sampled[i]].triangle, index = scene.triangleMaterial[triangle];
            if (emitsAlike(scene.materials[index])) continue;
            const uvec3 corner = scene.triangles[triangle];
            const vec2 uv = shares[i].x * scene.uvs[corner.x] + shares[i].y * scene.uvs[corner.y] + shares[i].z * scene.uvs[corner.z];
            shown[i] = emissionAt(scene, index, uv);
            carried[sampled[i]] += double(luminance(shown[i]));
            ++count[sampled[i]];
        }
        for (size_t i = 0; i < sampled.size(); ++i)
        {
            const size_t number = sampled[i];
            if (!(carried[number] > 0.0)) continue; // alike all over, or all of its samples are in holes
            list.lights[first + i].intensity =
                shown[i] * float(count[number] * double(luminance(emitters[number].emission)) / carried[number]);
        }
    }

    /// In strata of the scene's order.
    void spread(uint32_t count)
    {
        // Half by power and half by area: a dim lamp alone in its room has samples beside bright ones elsewhere.
        double shares = 0.0;
        for (Emitter& emitter : emitters)
        {
            emitter.share = 0.5 * (emitter.power / power + emitter.area / area);
            emitter.end = shares += emitter.share;
            emitter.patch = emitter.area / (count * emitter.share); // about count * share samples fall on it
        }
        for (uint32_t i = 0; i < count; ++i)
        {
            const double target = shares * (i + 0.5) / count;
            const auto found =
                std::lower_bound(emitters.begin(), emitters.end(), target, [](const Emitter& e, double p) { return e.end < p; });
            const Emitter& emitter = found == emitters.end() ? emitters.back() : *found;
            const uvec3 corner = scene.triangles[emitter.triangle];
            const double begin = found == emitters.begin() || found == emitters.end() ? 0.0 : (found - 1)->end;
            // Where the stratum lies in the triangle's stretch is one coordinate, so that strata of one triangle spread over it as rows.
            const float along = found == emitters.end() ? 0.5f : float((target - begin) / (emitter.end - begin));
            const float root = std::sqrt(std::clamp(along, 0.0f, 1.0f)), across = radicalInverse(i + 1, 2);
            const vec3 a = scene.positions[corner.x], b = scene.positions[corner.y], c = scene.positions[corner.z];
            // Osada et al. 2002, uniform in a triangle
            const vec3 share(1.0f - root, root * (1.0f - across), root * across);
            add(size_t(&emitter - emitters.data()), share.x * a + share.y * b + share.z * c, share);
        }
    }

    /// Rounding to samples takes from some lamps and gives to others: those of each part carry its power. What no sample carries is all
    /// samples' to carry.
    void keepPower(uint32_t most)
    {
        struct Part
        {
            double power = 0.0, carried = 0.0;
            size_t brightest = 0; // emitter
        };
        std::vector<Part> parts(emitters.size()); // by the first of its emitters
        for (size_t i = 0; i < emitters.size(); ++i)
        {
            Part& part = parts[partOf[i]];
            if (part.power == 0.0 || emitters[i].power > emitters[part.brightest].power) part.brightest = i;
            part.power += emitters[i].power;
        }
        for (const size_t number : sampled) parts[partOf[number]].carried += emitters[number].carried();
        for (size_t i = 0; i < emitters.size() && sampled.size() < most; ++i)
        {
            Part& part = parts[partOf[i]];
            if (part.carried > 0.0) continue;
            const uvec3 corner = scene.triangles[emitters[part.brightest].triangle];
            add(part.brightest, (scene.positions[corner.x] + scene.positions[corner.y] + scene.positions[corner.z]) / 3.0f,
                vec3(1.0f / 3.0f));
            part.carried = emitters[part.brightest].carried();
        }
        double carried = 0.0;
        for (const Part& part : parts) carried += part.carried > 0.0 ? part.power : 0.0;
        for (size_t i = 0; i < emitters.size(); ++i)
            if (const Part& part = parts[partOf[i]]; part.carried > 0.0) emitters[i].patch *= part.power / part.carried * power / carried;
    }

    const Scene& scene;
    const gpu::LightFieldInfo& space;
    LightList& list;
    const size_t first;
    std::vector<Emitter> emitters;
    std::vector<uint32_t> shining; // their triangles
    std::vector<uint32_t> partOf;  // the first emitter that each hangs together with
    std::vector<Outside> outside;
    std::vector<size_t> sampled; // emitter of each sample
    std::vector<vec3> shares;    // of each sample: its triangle's corners' in it
    double power = 0.0, area = 0.0;
};

/// An orthographic map of the whole scene along a light's direction.
void fitDirectional(gpu::GpuLight& light, const gpu::LightFieldInfo& space, uint32_t size)
{
    const vec3 forward = light.direction;
    const vec3 helper = std::abs(forward.y) < 0.9f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
    const vec3 axes[3] = {glm::normalize(glm::cross(helper, forward)), glm::normalize(glm::cross(forward, glm::cross(helper, forward))),
                          forward};
    vec4 rows[3];
    const vec3 middle = 0.5f * (space.sceneLow + space.sceneHigh), half = 0.5f * (space.sceneHigh - space.sceneLow);
    for (int i = 0; i < 3; ++i)
    {
        const float centre = glm::dot(axes[i], middle);
        // The margin keeps the border of the scene inside the map's filter, and depth off its ends.
        const float reach = std::max(glm::dot(glm::abs(axes[i]), half), 1e-6f) * (1.0f + 4.0f / float(size)) + 1e-4f * space.diagonal;
        rows[i] = vec4(axes[i], -centre) * (0.5f / reach) + vec4(0.0f, 0.0f, 0.0f, 0.5f);
        if (i < 2) light.shadowTexel = std::max(light.shadowTexel, 2.0f * reach / float(size));
    }
    light.shadowX = rows[0];
    light.shadowY = rows[1];
    light.shadowDepth = vec4(0.0f, 0.0f, 0.0f, 1.0f) - rows[2];
}

void addDelta(const Scene& scene, const gpu::LightFieldInfo& space, LightList& list)
{
    for (const Light& source : scene.lights)
    {
        gpu::GpuLight light = deltaLight(source, space);
        uint32_t& layers = source.type == LightType::directional ? list.sunLayers : list.pointLayers;
        light.shadowLayer = int(layers);
        layers += source.type == LightType::directional ? 1 : 6;
        list.lights.push_back(light);
        ++list.header.deltaCount;
    }
}

void addSky(const Scene& scene, uint32_t count, LightList& list)
{
    if (scene.sky == vec3(0.0f)) return;
    for (uint32_t i = 0; i < count; ++i)
    {
        const float y = 1.0f - (2.0f * float(i) + 1.0f) / float(count), r = std::sqrt(std::max(0.0f, 1.0f - y * y));
        // In double: a float with 65,536 turns before the point has few bits left for the fraction, which is all that counts.
        const double turn = double(i) * (std::numbers::phi - 1.0);
        const float angle = 2.0f * kPi * float(turn - std::floor(turn));
        gpu::GpuLight light{};
        light.type = gpu::kLightSky;
        light.direction = vec3(r * std::cos(angle), y, r * std::sin(angle));
        light.intensity = scene.sky * (4.0f * kPi / float(count));
        light.shadowLayer = kNoShadowMap;
        list.lights.push_back(light);
        ++list.header.skyCount;
    }
}

/// Halves the size of maps until all of them take at most kShadowBytes.
void limitMaps(uint32_t& size, uint32_t layers, uint32_t texelBytes)
{
    while (size > 32 && uint64_t(layers) * size * size * texelBytes > kShadowBytes) size /= 2;
}

/// How many maps a directional light has, so that the finest one's texels are no wider than some, as far as the maps of all such lights
/// keep their size.
/// @param texel  of the map of the whole scene, metres
uint32_t sunLevels(float texel, uint32_t suns, uint32_t size)
{
    constexpr float kFineTexel = 0.004f; // metres: a pixel of 1280 across 60 degrees, at 4 m
    constexpr uint32_t kMostLayers = 32; // any device has 256
    uint32_t levels = 1;
    const auto fits = [&](uint32_t layers) { return layers <= kMostLayers && 4 * uint64_t(layers) * size * size <= kShadowBytes; };
    for (; texel > kFineTexel && fits(suns * (levels + 1)); ++levels) texel /= gpu::kFinerSun;
    return levels;
}

/// Gives directional lights maps about the eye.
void addFinerSuns(const gpu::LightFieldInfo& space, vec3 eye, LightList& list)
{
    const uint32_t size = list.settings.sunShadow;
    float texel = 0.0f;
    for (gpu::GpuLight light : list.lights)
    {
        if (light.type != gpu::kLightDirectional) continue;
        fitDirectional(light, space, size);
        texel = std::max(texel, light.shadowTexel * space.scale);
    }
    list.header.sunLevels = sunLevels(texel, list.sunLayers, size);
    list.header.eye = (eye - space.origin) / space.scale;
    list.sunLayers *= list.header.sunLevels;
    for (gpu::GpuLight& light : list.lights)
        if (light.type == gpu::kLightDirectional) light.shadowLayer *= int(list.header.sunLevels);
}

/// Gives the emitters' and the sky's entries their layers.
void addAreaShadows(LightList& list)
{
    for (gpu::GpuLight& light : list.lights)
    {
        if (light.type == gpu::kLightEmitter)
        {
            light.shadowLayer = int(list.emitterLayers);
            list.emitterLayers += 6;
        }
        else if (light.type == gpu::kLightSky)
            light.shadowLayer = int(list.skyLayers++);
    }
}

} // namespace

gpu::GpuLight deltaLight(const Light& source, const gpu::LightFieldInfo& space)
{
    gpu::GpuLight light{};
    light.position = (source.position - space.origin) / space.scale;
    light.direction = source.direction;
    light.intensity = source.type == LightType::directional ? source.intensity : source.intensity / (space.scale * space.scale);
    light.range = source.range / space.scale;
    light.innerCone = source.innerCone;
    light.outerCone = source.outerCone;
    light.type = uint32_t(source.type);
    light.shadowLayer = kNoShadowMap;
    return light;
}

LightList buildLightList(const Scene& scene, const gpu::LightFieldInfo& space, const LightSettings& settings)
{
    LightList list;
    list.header.pointNear = 1e-4f * space.diagonal;
    list.header.sunLevels = 1;
    addDelta(scene, space, list);
    list.settings = settings;
    limitMaps(list.settings.sunShadow, list.sunLayers, 4);
    if (settings.eye) addFinerSuns(space, *settings.eye, list);
    EmitterSamples(scene, space, settings.lamps, list)
        .draw(settings.emitterSamples, settings.areaShadows ? 0 : kSamplesOfLamps * settings.emitterSamples);
    addSky(scene, settings.skySamples, list);
    if (settings.areaShadows) addAreaShadows(list);
    limitMaps(list.settings.skyShadow, list.skyLayers, 2);
    limitMaps(list.settings.pointShadow, list.pointLayers, 4);
    limitMaps(list.settings.emitterShadow, list.emitterLayers, 4);
    for (gpu::GpuLight& light : list.lights)
    {
        if (light.type == gpu::kLightDirectional)
            fitDirectional(light, space, list.settings.sunShadow);
        else if (light.type == gpu::kLightSky)
            fitDirectional(light, space, list.settings.skyShadow);
        else
            light.shadowTexel = 2.0f / float(light.type == gpu::kLightEmitter ? list.settings.emitterShadow : list.settings.pointShadow);
    }
    return list;
}

gpu::SceneView faceView(vec3 centre, int face, float nearPlane)
{
    const int axis = face >> 1;
    mat4 rows(0.0f); // glm keeps columns: filled as rows, then turned
    rows[0][(axis + 1) % 3] = 1.0f;
    rows[1][(axis + 2) % 3] = 1.0f;
    rows[2][3] = nearPlane;
    rows[3][axis] = (face & 1) ? -1.0f : 1.0f;
    return {glm::transpose(rows), centre};
}

std::vector<gpu::SceneView> shadowViews(const gpu::GpuLight& light, const gpu::LightsHeader& header)
{
    std::vector<gpu::SceneView> views;
    if (light.type != gpu::kLightDirectional && light.type != gpu::kLightSky)
    {
        for (int face = 0; face < 6; ++face) views.push_back(faceView(light.position, face, header.pointNear));
        return views;
    }
    const vec4 one(0.0f, 0.0f, 0.0f, 1.0f), eye(header.eye, 1.0f);
    vec4 rows[2] = {light.shadowX, light.shadowY};
    for (uint32_t level = 0; level < (light.type == gpu::kLightSky ? 1 : header.sunLevels); ++level)
    {
        if (level > 0)
            for (vec4& row : rows)
            {
                row *= gpu::kFinerSun;
                row.w += 0.5f - glm::dot(row, eye);
            }
        views.push_back({glm::transpose(mat4(2.0f * rows[0] - one, 2.0f * rows[1] - one, light.shadowDepth, one)), vec3(0.0f)});
    }
    return views;
}

} // namespace sconce
