#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace sconce
{

/// A number, choice or switch that someone may set, said once: structs take their defaults from here, checks their ranges and sentences,
/// `--help`, `sconce knobs` and the README's table their words, and the bench what it may sweep. Texts are plain; who prints Markdown
/// marks options and pages up.
/// @tparam T  a number; std::string_view for a choice among `only`; bool for a switch
template <class T> struct Knob
{
    std::string_view name;        // of the struct's member, as sentences name it
    std::string_view option = {}; // of the command, "render --samples"; none: the library's alone
    std::string_view member = {}; // of the library, "FrameView::glossyRays"; none: the command's alone
    T value = {};                 // the default; allowed even outside of the range, where it stands for "derived", see inWords
    T least = {}, most = {};      // both allowed; choices and switches have none
    std::span<const T> only = {}; // every value there is, where that isn't all of the range
    std::string_view unit = {};
    std::string_view also = {};    // what else a value must be
    std::string_view inWords = {}; // the default, where its value doesn't say it
    std::string_view what = {};    // what it is
    std::string_view buys = {};    // what it buys and costs
    bool readme = false;           // stands in the README's table

    /// For whom nothing is derived: the command, whose options are left out instead.
    constexpr bool inRange(T v) const // false for NaN
    {
        if (!only.empty()) return std::ranges::find(only, v) != only.end();
        if constexpr (std::is_same_v<T, bool>)
            return true;
        else
            return v >= least && v <= most;
    }
    constexpr bool allows(T v) const { return v == value || inRange(v); }
    /// Whether the default is this choice; place() is the default's place among them, which an enum of the same order has.
    constexpr bool is(std::string_view choice) const { return value == choice; }
    constexpr int place() const { return int(std::ranges::find(only, value) - only.begin()); }
};

/// A knob without its type, in words.
struct KnobRow
{
    std::string_view name, option, member;
    std::string byDefault, range; // "512", "64 to 2048 texels, power of two"
    std::string_view unit, what, buys;
    bool readme = false;
};
/// All of the table, in its order.
std::span<const KnobRow> knobRows();

/// As people write it: "0.995", "2^64-1", "on".
std::string knobText(uint32_t value);
std::string knobText(int value);
std::string knobText(uint64_t value);
std::string knobText(float value);
std::string knobText(double value);
std::string knobText(bool value);
std::string knobText(std::string_view value);

namespace knob_words
{
std::string range(const std::vector<std::string>& only, const std::string& least, const std::string& most, std::string_view unit,
                  std::string_view also);
std::string fault(std::string_view name, const std::string& value, const std::string& range);
} // namespace knob_words

template <class T> std::string defaultText(const Knob<T>& knob)
{
    return knob.inWords.empty() ? knobText(knob.value) : std::string(knob.inWords);
}

template <class T> std::string rangeText(const Knob<T>& knob)
{
    std::vector<std::string> only;
    for (const T value : knob.only) only.push_back(knobText(value));
    if constexpr (std::is_same_v<T, bool>)
        return knob_words::range({"on", "off"}, "", "", "", "");
    else if constexpr (std::is_same_v<T, std::string_view>)
        return knob_words::range(only, "", "", "", "");
    else if constexpr (std::is_floating_point_v<T>)
    {
        const bool positive = knob.least == std::numeric_limits<T>::min();
        const std::string least = positive ? "above 0" : knobText(knob.least);
        return knob_words::range(only, least, knob.most == std::numeric_limits<T>::max() ? "" : knobText(knob.most), knob.unit, knob.also);
    }
    else
        return knob_words::range(only, knobText(knob.least), knobText(knob.most), knob.unit, knob.also);
}

template <class T> KnobRow rowOf(const Knob<T>& knob)
{
    return {knob.name, knob.option, knob.member, defaultText(knob), rangeText(knob), knob.unit, knob.what, knob.buys, knob.readme};
}

/// The sentence for a value that the knob doesn't allow, without its full stop: "bounces is 65; give 0 to 64 bounces"; empty where it does.
template <class T> std::string faultOf(const Knob<T>& knob, std::type_identity_t<T> value)
{
    return knob.allows(value) ? std::string() : knob_words::fault(knob.name, knobText(value), rangeText(knob));
}

/// The sentence of the first that is none.
inline std::string firstFault(std::initializer_list<std::string> faults)
{
    for (const std::string& fault : faults)
        if (!fault.empty()) return fault;
    return {};
}

/// The table. Prices are what the bench measured.
namespace knobs
{

inline constexpr float kMostFloat = std::numeric_limits<float>::max(), kAboveZero = std::numeric_limits<float>::min();
inline constexpr uint64_t kMost64 = std::numeric_limits<uint64_t>::max();
inline constexpr uint32_t kMost32 = std::numeric_limits<uint32_t>::max();

// ---- where probes go

inline constexpr std::string_view kMethods[] = {"sdf", "balls", "grid"}; // in the order of PlaceSettings::Method
inline constexpr Knob<std::string_view> method{
    .name = "method",
    .option = "place --method",
    .value = "sdf",
    .only = kMethods,
    .what = "sdf: skeleton of the distance field; balls: skeleton by ball shrinking; grid: uniform grid in the reachable space"};
inline constexpr uint32_t kGridCount = 64; // and for the spacing while the count is open
inline constexpr Knob<uint32_t> count{.name = "count",
                                      .option = "place --count",
                                      .value = 0,
                                      .least = 1,
                                      .most = 65535,
                                      .unit = "probes",
                                      .inWords = "the fewest that reach --coverage; for a grid 64",
                                      .what = "Probes",
                                      .buys = "surface that some probe sees; memory and bake time grow in proportion to the probes",
                                      .readme = true};
inline constexpr Knob<bool> fitGrid{.name = "fitGrid",
                                    .option = "place --fit-grid",
                                    .value = false,
                                    .what = "Of a grid: of some shapes and distances from the bounds that whose cells' corners see best",
                                    .buys = "better views; a check of each"};
inline constexpr Knob<float> coverage{.name = "coverage",
                                      .option = "place --coverage",
                                      .value = 0.995f,
                                      .least = 0.01f,
                                      .most = 1.0f,
                                      .what =
                                          "Share of the surface points that rays hit which some probe must see, when --count is not given",
                                      .buys = "the same, where --count isn't given: probes are added until they see so much",
                                      .readme = true};
inline constexpr Knob<uint64_t> mapBytes{
    .name = "memory",
    .option = "place --memory",
    .value = 0,
    .least = 1,
    .most = kMost64,
    .unit = "bytes",
    .also = "at least what one probe takes",
    .inWords = "no budget",
    .what = "As many probes as fit these bytes of maps at --resolution, cube faces; the index of a few MB comes on top"};
inline constexpr Knob<uint64_t> placeSeed{.name = "seed",
                                          .option = "place --seed",
                                          .value = 1,
                                          .least = 0,
                                          .most = kMost64,
                                          .what = "Of every random choice; the same seed gives the same bytes"};
inline constexpr Knob<float> clearance{.name = "clearance",
                                       .option = "place --clearance",
                                       .value = 0.0f,
                                       .least = 0.0f,
                                       .most = 1e6f,
                                       .unit = "metres",
                                       .inWords = "one cell of the distance field",
                                       .what = "Least distance of a probe from every surface, sdf"};
inline constexpr Knob<uint32_t> distanceVoxels{.name = "voxels",
                                               .member = "PlaceSettings::voxels",
                                               .value = 12u << 20,
                                               .least = 4096,
                                               .most = 268'435'456,
                                               .unit = "cells",
                                               .what = "Most cells of the distance field",
                                               .buys = "detail of the free space; about 20 bytes and 0.3 us each"};
inline constexpr Knob<uint32_t> candidates{.name = "candidates",
                                           .member = "PlaceSettings::candidates",
                                           .value = 2800,
                                           .least = 100,
                                           .most = 100'000,
                                           .unit = "positions",
                                           .what = "Positions to choose from",
                                           .buys = "coverage: 500 instead of 1500 lost 20 points"};
inline constexpr Knob<uint32_t> surfels{.name = "surfels",
                                        .member = "PlaceSettings::surfels",
                                        .value = 48000,
                                        .least = 1000,
                                        .most = 1'000'000,
                                        .unit = "samples",
                                        .what = "Surface samples to choose by",
                                        .buys = "0.1 us times candidates times surfels"};
inline constexpr std::string_view kRefines[] = {"none", "gradient", "gibbs", "stochastic"}; // in the order of Refine
inline constexpr Knob<std::string_view> refine{.name = "refine",
                                               .member = "PlaceSettings::refine",
                                               .value = "gradient",
                                               .only = kRefines,
                                               .what = "How positions are moved after the choice, grid apart",
                                               .buys = "better views; gibbs and stochastic cost more than gradient and gain nothing"};
inline constexpr Knob<uint32_t> refineRounds{.name = "refineRounds",
                                             .member = "PlaceSettings::refineRounds",
                                             .value = 6,
                                             .least = 0,
                                             .most = 1000,
                                             .unit = "rounds",
                                             .what = "Times through all probes to move them",
                                             .buys = "better views; each costs 8 views a probe, or 9"};
inline constexpr Knob<uint32_t> refineSurfels{.name = "refineSurfels",
                                              .member = "PlaceSettings::refineSurfels",
                                              .value = 32000,
                                              .least = 1000,
                                              .most = 1'000'000,
                                              .unit = "samples",
                                              .what = "Surface samples to refine by; up to half where few probes see",
                                              .buys = "finer judgement; time in proportion"};

// ---- what a light field holds

inline constexpr Knob<uint32_t> resolution{
    .name = "resolution",
    .option = "bake --resolution",
    .member = "BakeDesc::resolution",
    .value = 512,
    .least = 64,
    .most = 2048,
    .unit = "texels",
    .also = "multiple of 32, or of 16 with octahedral maps",
    .what = "Side of an octahedral map in texels; the cube chart's faces have half of it",
    .buys = "detail of what a probe sees; memory grows with its square; 416 takes the memory of octahedral maps of 512",
    .readme = true};
inline constexpr Knob<uint32_t> bounces{.name = "bounces",
                                        .option = "bake --bounces",
                                        .member = "BakeDesc::bounces",
                                        .value = 16,
                                        .least = 0,
                                        .most = 64,
                                        .unit = "bounces",
                                        .what = "Times the baked light is re-injected at most",
                                        .buys = "light reflected again; each is one more pass over every probe",
                                        .readme = true};
inline constexpr Knob<float> converged{.name = "converged",
                                       .option = "bake --converged",
                                       .member = "BakeDesc::converged",
                                       .value = 0.003f,
                                       .least = 0.0f,
                                       .most = 1.0f,
                                       .what = "Stops before --bounces when one adds less than this share of all light; 0: never"};
inline constexpr uint32_t kSurfaceTexels[] = {0, 26, 52, 104};
inline constexpr Knob<uint32_t> surfaceTexels{
    .name = "surfaceTexels",
    .option = "bake --surface-texels",
    .member = "BakeDesc::surfaceTexels",
    .value = 52,
    .least = 0,
    .most = 104,
    .only = kSurfaceTexels,
    .unit = "texels",
    .what = "Side of a cube face of the surface light, at most that of the face itself; 0: none, and none with octahedral maps",
    .buys = "diffuse light read where surfaces are; bake time, and 24 bytes a probe times its square, 36 where normals have textures",
    .readme = true};
inline constexpr Knob<uint32_t> surfaceRays{.name = "surfaceRays",
                                            .option = "bake --surface-rays",
                                            .member = "BakeDesc::surfaceRays",
                                            .value = 64,
                                            .least = 1,
                                            .most = 1024,
                                            .unit = "rays",
                                            .what = "That gather light for each texel of the surface light",
                                            .buys = "less blotchy diffuse light; bake time and 4 bytes of main memory a ray and texel"};
inline constexpr Knob<float> surfaceRefined{
    .name = "surfaceRefined",
    .option = "bake --surface-refined",
    .member = "BakeDesc::surfaceRefined",
    .value = 0.02f,
    .least = 0.0f,
    .most = 0.25f,
    .what = "Share of the surface light's texels, where light changes most within one, that are refined into 4 x 4, by rays to triangles",
    .buys = "contact shadows, their edges and light next to lamps; bake time, and 68 bytes a refined texel",
    .readme = true};
inline constexpr uint32_t kLiveLinks[] = {0, 8, 16, 32, 64};
inline constexpr Knob<uint32_t> liveLinks{
    .name = "liveLinks",
    .option = "bake --live-links",
    .member = "BakeDesc::liveLinks",
    .value = 0,
    .least = 0,
    .most = 64,
    .only = kLiveLinks,
    .unit = "links",
    .what = "Of each texel of the surface light, at most as many as rays gather it, that tell where its light comes from, so that sun, "
            "points and "
            "spots can move afterwards; 0: they stay",
    .buys = "lights that move (LiveLight, relight --sun, render --sun-path); a bake more, and about 75 KiB a probe and link",
    .readme = true};
inline constexpr uint32_t kCapturedLinks = 16; // liveLinks of `sconce capture`, where none are asked for
inline constexpr Knob<bool> compact{.name = "compact",
                                    .option = "bake --compact",
                                    .member = "BakeDesc::compact",
                                    .value = false,
                                    .what = "Keeps the probes' maps in blocks of 4x4 texels: of cube faces whose light doesn't change",
                                    .buys = "0.4 of their memory; rays, which unpack them, take longer",
                                    .readme = true};
inline constexpr uint32_t kLampTexels[] = {0, 512, 1024, 2048, 4096, 8192};
inline constexpr Knob<uint32_t> lampTexels{
    .name = "lampTexels",
    .option = "bake --lamp-texels",
    .member = "BakeDesc::lampTexels",
    .value = 2048,
    .least = 0,
    .most = 8192,
    .only = kLampTexels,
    .unit = "texels",
    .what = "Side of the shadow map of an emitter whose shadows are sharper than surface light's texels, and which is kept as a lamp; 0: "
            "none is",
    .buys = "sharp shadows and reflections of small far emitters, without noise; 2 bytes a texel, and a pass over the picture",
    .readme = true};
inline constexpr std::string_view kGathers[] = {"triangles", "field"};
inline constexpr Knob<std::string_view> gather{
    .name = "gather",
    .option = "bake --gather",
    .member = "BakeDesc::rays",
    .value = "triangles",
    .only = kGathers,
    .what = "What the rays that gather surface light meet: the scene's triangles, exactly and on the processor, or the light field on the "
            "device, which is "
            "all that a host gives who brings no rays",
    .buys = "no light through walls and sharper shadows; time where the device is faster than the processor",
    .readme = true};
inline constexpr std::string_view kCharts[] = {"cube", "octahedral"}; // in the order of gpu::kChartCube, kChartOctahedral
inline constexpr Knob<std::string_view> chart{
    .name = "chart",
    .option = "bake --chart",
    .value = "cube",
    .only = kCharts,
    .what = "cube: six faces a probe; octahedral: one map a probe, for the tracers b0, b0plus and b0plus-octree",
    .buys = "octahedral maps are what the uniform-grid baseline reads",
    .readme = true};
inline constexpr Knob<uint64_t> deviceMebibytes{.name = "memory",
                                                .option = "bake --memory",
                                                .value = 0,
                                                .least = 1,
                                                .most = uint64_t(1) << 20,
                                                .unit = "MiB",
                                                .inWords = "80 % of the device's",
                                                .what = "Budget of device memory; too little is refused with the number needed"};
inline constexpr Knob<uint64_t> hostBytes{.name = "hostMemory",
                                          .member = "BakeSettings::hostMemory",
                                          .value = 0,
                                          .least = 1,
                                          .most = kMost64,
                                          .unit = "bytes",
                                          .inWords = "what is free",
                                          .what = "Main memory that a bake may take"};
inline constexpr Knob<float> submissionMs{
    .name = "submission",
    .option = "bake --submission",
    .member = "BakeDesc::submissionMs",
    .value = 200,
    .least = 1,
    .most = 60000,
    .unit = "ms",
    .what =
        "Time that a bake holds the device at once, as far as its passes can be cut; less lets others draw, and takes more submissions"};
inline constexpr Knob<int> octreeVoxels{.name = "voxels",
                                        .member = "OctreeSettings::voxels",
                                        .value = 0,
                                        .least = 8,
                                        .most = 256,
                                        .unit = "voxels",
                                        .inWords = "128 up to 54 probes, then with the root of their number to 256",
                                        .what = "Finest voxels of the octree along the longest side of the bounds",
                                        .buys = "lists that fit their place better; time and memory grow with the square"};
inline constexpr Knob<int> topShift{.name = "topShift",
                                    .member = "OctreeSettings::topShift",
                                    .value = 2,
                                    .least = 1,
                                    .most = 6,
                                    .unit = "levels",
                                    .what = "Levels of the octree below its top grid",
                                    .buys = "a smaller top grid; a descent reads at most one texel more"};
inline constexpr Knob<uint32_t> textureSize{.name = "maxTextureSize",
                                            .member = "DeviceSceneDesc::maxTextureSize",
                                            .value = 1024,
                                            .least = 1,
                                            .most = 4096,
                                            .unit = "texels",
                                            .what = "Side of the scene's largest textures; larger images are filtered down",
                                            .buys = "detail of albedo and emission; memory grows with its square"};
inline constexpr Knob<uint32_t> emitterSamples{.name = "emitterSamples",
                                               .member = "LightSettings::emitterSamples",
                                               .value = 64,
                                               .least = 0,
                                               .most = 340,
                                               .unit = "samples",
                                               .what = "Patches of emissive surfaces that have shadow maps",
                                               .buys = "less noise; bake time and shadow memory grow in proportion"};
inline constexpr Knob<uint32_t> skySamples{.name = "skySamples",
                                           .member = "LightSettings::skySamples",
                                           .value = 48,
                                           .least = 0,
                                           .most = 1024,
                                           .unit = "samples",
                                           .what = "Directions of the sky that have shadow maps",
                                           .buys = "less noise; bake time and shadow memory grow in proportion"};
inline constexpr Knob<uint32_t> tracedLightSamples{
    .name = "tracedLightSamples",
    .member = "kTracedLightSamples",
    .value = 1024,
    .least = 0,
    .most = 65536,
    .unit = "samples",
    .what = "Samples of the emitters, and as many of the sky, where rays shadow them: of LightSettings without areaShadows",
    .buys = "less noise; 112 bytes each, and no map"};
inline constexpr Knob<uint32_t> sunShadow{.name = "sunShadow",
                                          .member = "LightSettings::sunShadow",
                                          .value = 4096,
                                          .least = 256,
                                          .most = 8192,
                                          .unit = "texels",
                                          .what = "Side of a directional light's shadow map",
                                          .buys = "sharper shadows; memory grows with its square"};
inline constexpr Knob<uint32_t> pointShadow{.name = "pointShadow",
                                            .member = "LightSettings::pointShadow",
                                            .value = 512,
                                            .least = 64,
                                            .most = 2048,
                                            .unit = "texels",
                                            .what = "Side of each of a point light's six shadow maps",
                                            .buys = "sharper shadows; memory grows with its square"};
inline constexpr Knob<uint32_t> emitterShadow{.name = "emitterShadow",
                                              .member = "LightSettings::emitterShadow",
                                              .value = 256,
                                              .least = 32,
                                              .most = 1024,
                                              .unit = "texels",
                                              .what = "Side of each of an emitter sample's six shadow maps",
                                              .buys = "sharper shadows; memory grows with its square"};
inline constexpr Knob<uint32_t> skyShadow{.name = "skyShadow",
                                          .member = "LightSettings::skyShadow",
                                          .value = 1024,
                                          .least = 128,
                                          .most = 4096,
                                          .unit = "texels",
                                          .what = "Side of a sky direction's shadow map",
                                          .buys = "sharper shadows; memory grows with its square"};

// ---- a frame

inline constexpr Knob<uint32_t> glossyRays{
    .name = "glossyRays",
    .option = "render --samples",
    .member = "FrameView::glossyRays",
    .value = 1,
    .least = 1,
    .most = 64, // what randomPair() of shaders/shared/sample_pair.h tells apart: a 65th ray would be one that is there already
    .unit = "rays a pixel",
    .what = "Glossy and diffuse rays",
    .buys = "rays, and samples of emitters and sky; noise falls with the root, time grows in proportion",
    .readme = true};
inline constexpr std::string_view kDiffuse[] = {"surface", "irradiance", "patches", "traced"};
inline constexpr Knob<std::string_view> diffuse{
    .name = "diffuse",
    .option = "render --diffuse",
    .member = "IndirectEffects::surfaceLight, patches, tracedDiffuse",
    .value = "",
    .only = kDiffuse,
    .inWords = "surface; irradiance where the light field holds no surface light",
    .what =
        "Where diffuse light comes from; irradiance and patches take emitters and sky from shadowed samples, traced has them in its rays, "
        "of which there are as many as --samples; surface has them baked",
    .buys = "light: read at the surfaces that probes see, without noise; read from a probe's prefiltered irradiance; from 216 patches that "
            "it sees, which is right about what is "
            "near, for about twice the time of diffuse light; or found by cosine-weighted rays (docs/light.md)",
    .readme = true};
inline constexpr std::string_view kAreaShadows[] = {"maps", "field"};
inline constexpr Knob<std::string_view> areaShadows{
    .name = "areaShadows",
    .option = "render --area-shadows",
    .member = "IndirectEffects::fieldShadows",
    .value = "maps",
    .only = kAreaShadows,
    .what = "What shadows the samples of emitters and sky; nothing where --diffuse is traced",
    .buys = "light of emitters and sky by 64 and 48 samples with shadow maps (192 MiB), or by 1024 of either with rays through the light "
            "field, --area-samples of them a pixel; a ray costs about twenty mapped samples",
    .readme = true};
inline constexpr uint32_t kEvery[] = {1, 2, 4, 8, 16};
inline constexpr Knob<uint32_t> traceEvery{
    .name = "traceEvery",
    .option = "render --trace-every",
    .member = "IndirectLight::Desc::traceEvery",
    .value = 1,
    .least = 1,
    .most = 16,
    .only = kEvery,
    .unit = "pixels",
    .what = "Pixels for each that is traced",
    .buys = "rays on one pixel of so many, the others from those that show the same surface: on 1 of 4 the trace takes 0.4 to 0.6 times as "
            "long for 0 to 4 % more FLIP; sharp reflections and mirrors are traced everywhere",
    .readme = true};
inline constexpr Knob<uint32_t> surfaceProbes{
    .name = "surfaceProbes",
    .option = "render --surface-probes",
    .member = "IndirectLight::Desc::surfaceProbes",
    .value = 2,
    .least = 1,
    .most = 2,
    .unit = "probes",
    .what = "Probes whose surface light is blended at a look-up",
    .buys = "diffuse light without seams where the probe that sees most changes; of one, surface light takes less time",
    .readme = true};
inline constexpr Knob<uint32_t> resident{.name = "resident",
                                         .option = "render --resident",
                                         .member = "LightField::load",
                                         .value = 0,
                                         .least = 1,
                                         .most = 65535,
                                         .unit = "probes",
                                         .inWords = "all",
                                         .what = "Probes whose maps are on the device at a time, those that the picture asks for",
                                         .buys = "worlds larger than memory (FieldStream): most of a light field are its maps; what no "
                                                 "probe that is there sees gets light of the open",
                                         .readme = true};
inline constexpr Knob<float> raysBelow{.name = "raysBelow",
                                       .option = "render --rays-below",
                                       .member = "FrameView::raysBelow",
                                       .value = 0.4f,
                                       .least = 0.0f,
                                       .most = 2.0f,
                                       .unit = "roughness",
                                       .what = "Roughness below which reflections are traced",
                                       .buys = "rougher reflections come from prefiltered radiance instead of rays",
                                       .readme = true};
inline constexpr uint32_t kTracedAreaSamples = 2;
inline constexpr Knob<uint32_t> areaSamples{.name = "areaSamples",
                                            .option = "render --area-samples",
                                            .value = 8,
                                            .least = 1,
                                            .most = 1024,
                                            .unit = "samples",
                                            .inWords = "8 for each of --samples, 2 with --area-shadows field",
                                            .what = "Samples of the emitters, and as many of the sky, a pixel",
                                            .buys = "noise falls with the root, time grows in proportion"};
inline constexpr Knob<bool> denoise{.name = "denoise",
                                    .option = "render --no-denoise",
                                    .member = "IndirectEffects::denoise",
                                    .value = true,
                                    .inWords = "filtered",
                                    .what = "Leaves the glossy term unfiltered",
                                    .buys = "leaves out the cross-bilateral pass",
                                    .readme = true};
inline constexpr Knob<bool> temporal{.name = "temporal",
                                     .option = "render --temporal",
                                     .member = "IndirectEffects::temporal",
                                     .value = false,
                                     .what =
                                         "Filters over time, too: each of --frames N takes new random rays and blends with the one before"};
inline constexpr Knob<bool> screenTrace{.name = "screenTrace",
                                        .option = "render --screen-trace",
                                        .member = "IndirectEffects::screenTrace",
                                        .value = false,
                                        .what =
                                            "Traced reflections show what the picture of the frame before does where their rays meet it; "
                                            "from the second of --frames on",
                                        .buys = "what no probe knows is reflected where the eye sees it"};
inline constexpr Knob<float> normalOffset{.name = "normalOffset",
                                          .member = "FrameView::normalOffset", // in metres there
                                          .value = 1e-4f,
                                          .least = 0.0f,
                                          .most = 1.0f,
                                          .unit = "diagonals",
                                          .what = "How far off their surface rays start"};
inline constexpr Knob<float> roughness{.name = "roughness",
                                       .option = "render --roughness",
                                       .value = 0.0f,
                                       .least = 0.0f,
                                       .most = 1.0f,
                                       .inWords = "the materials' own",
                                       .what = "Roughness of every surface"};
inline constexpr Knob<uint32_t> frameSeed{.name = "seed",
                                          .option = "render --seed",
                                          .member = "FrameView::seed",
                                          .value = 1,
                                          .least = 0,
                                          .most = kMost32,
                                          .what = "Of the frame's rays"};
inline constexpr Knob<uint32_t> drawnFrames{.name = "frames",
                                            .option = "render --frames",
                                            .value = 1,
                                            .least = 1,
                                            .most = 1000,
                                            .unit = "frames",
                                            .what = "Draws the frame N times and reports the median of the times"};
inline constexpr Knob<float> warmUpSeconds{
    .name = "warm-up",
    .option = "render --warm-up",
    .value = 0.0f,
    .least = 0.0f,
    .most = 60.0f,
    .unit = "seconds",
    .what = "Draws frames for so long that don't count, before those that do: a GPU that was idle has its full "
            "clock after a second or two"};
inline constexpr Knob<uint32_t> width{.name = "width",
                                      .option = "render --size",
                                      .member = "IndirectLight::Desc::width", // where a host must say it
                                      .value = 640,
                                      .least = 1,
                                      .most = 16384,
                                      .unit = "pixels",
                                      .what = "Width of a picture"};
inline constexpr Knob<uint32_t> height{.name = "height",
                                       .option = "render --size",
                                       .member = "IndirectLight::Desc::height", // where a host must say it
                                       .value = 360,
                                       .least = 1,
                                       .most = 16384,
                                       .unit = "pixels",
                                       .what = "Height of a picture"};
inline constexpr Knob<float> verticalFov{.name = "fov",
                                         .option = "render --fov",
                                         .value = 60.0f,
                                         .least = 1.0f,
                                         .most = 170.0f,
                                         .unit = "degrees",
                                         .what = "Vertical field of view with --eye"};
inline constexpr Knob<float> exposure{.name = "exposure",
                                      .option = "render --exposure",
                                      .value = 0.0f,
                                      .least = 1e-6f,
                                      .most = 1e6f,
                                      .inWords = "from the picture's log-average",
                                      .what = "Factor before the tone map of --png"};
inline constexpr Knob<uint32_t> panoramaWidth{.name = "width",
                                              .option = "probe --width",
                                              .value = 1024,
                                              .least = 16,
                                              .most = width.most,
                                              .unit = "pixels",
                                              .what = "Width of a panorama, made even; each is half as high"};
inline constexpr Knob<uint32_t> explainedPaths{.name = "paths",
                                               .option = "explain --spp",
                                               .value = 4096,
                                               .least = 4,
                                               .most = 1'048'576,
                                               .unit = "paths",
                                               .what = "Paths of the pixel's reference, and of the radiance along its ray"};
inline constexpr Knob<float> light{.name = "light", // each component of it
                                   .option = "render --sky",
                                   .value = 0.0f,
                                   .least = 0.0f,
                                   .most = kMostFloat,
                                   .inWords = "the scene's own",
                                   .what = "Radiance of the sky, W/(m^2 sr)"};

// ---- the tracer

inline constexpr Knob<int> ranked{
    .name = "ranked",
    .member = "Quality::trace.ranked",
    .value = 4,
    .least = 1,
    .most = 4,
    .unit = "probes",
    .what = "Probes of a leaf that are asked",
    .buys = "probes of a voxel that a ray may ask: 2 leave 2.6 times as many rays unresolved, for 2 to 4 % of the time",
    .readme = true};
inline constexpr Knob<float> opinion{.name = "opinion",
                                     .member = "Quality::trace.opinion",
                                     .value = 1e-3f,
                                     .least = 0.0f,
                                     .most = 1.0f,
                                     .unit = "diagonals",
                                     .what = "Size of a texel from which on a hit in it is asked of a nearer probe; 0: never",
                                     .buys =
                                         "hits in larger texels are asked of a nearer probe: 0.3 points more exact hits for 7 % more reads",
                                     .readme = true};
inline constexpr Knob<int> maxHandoffs{.name = "maxHandoffs",
                                       .member = "Quality::trace.maxHandoffs",
                                       .value = 24,
                                       .least = 0,
                                       .most = 64,
                                       .unit = "hand-offs",
                                       .what = "Times a ray may change to another probe",
                                       .buys = "probes that a ray may change to before it ends unresolved",
                                       .readme = true};
inline constexpr int kLevels[] = {0, 2, 4, 6};
inline constexpr Knob<int> startLevel{.name = "startLevel",
                                      .member = "Quality::trace.startLevel",
                                      .value = 4,
                                      .least = 0,
                                      .most = 6,
                                      .only = kLevels,
                                      .unit = "level",
                                      .what = "Level of the Hi-Z chain that a ray starts at in a probe",
                                      .buys = "reads; the results don't depend on it"};
inline constexpr Knob<int> coarsestLevel{.name = "coarsestLevel",
                                         .member = "Quality::trace.coarsestLevel",
                                         .value = 6,
                                         .least = 0,
                                         .most = 6,
                                         .only = kLevels,
                                         .unit = "level",
                                         .what = "Coarsest level of the Hi-Z chain that a ray climbs to",
                                         .buys = "reads; the results don't depend on it"};
inline constexpr Knob<float> tolerance{.name = "tolerance",
                                       .member = "Quality::trace.tolerance",
                                       .value = 1.0f,
                                       .least = 0.25f,
                                       .most = 4.0f,
                                       .what = "Scale of the hit rule's thickness; 1 is derived from the texel's footprint",
                                       .buys = "fewer misses of thin things for more false hits"};
inline constexpr Knob<float> epsilon{.name = "epsilon",
                                     .member = "Quality::trace.epsilon",
                                     .value = 5e-4f,
                                     .least = 0.0f,
                                     .most = 1e-2f,
                                     .unit = "diagonals",
                                     .what = "Absolute slack of the hit rule",
                                     .buys = "fewer misses of what a probe sees at a slant for more false hits"};
inline constexpr Knob<int> farBounds{.name = "farBounds",
                                     .member = "Quality::trace.farBounds",
                                     .value = 0,
                                     .least = 0,
                                     .most = 1,
                                     .what = "1: reads the far bounds, too, and ends early behind them",
                                     .buys = "steps for reads; the results are the same"};

inline constexpr Knob<int> order{
    .name = "order",
    .member = "Quality::trace.order",
    .value = 0,
    .least = 0,
    .most = 3,
    .what = "Which of a leaf's probes a ray asks first. 0: as they are ranked; 1: to or from which it runs most straight; 2: from which it "
            "does; 3: that stands nearest to its line",
    .buys =
        "orders of the papers, to compare with: 3 takes up to a fifth fewer hand-offs, 1 and 2 up to twice as many and more wrong rays"};

// ---- the reference

inline constexpr Knob<uint32_t> paths{.name = "samples",
                                      .option = "reference --spp",
                                      .member = "ReferenceSettings::samples",
                                      .value = 64,
                                      .least = 1,
                                      .most = 1'048'576,
                                      .unit = "paths a pixel",
                                      .what = "Paths a pixel",
                                      .buys = "noise falls with the square root, time grows in proportion"};
inline constexpr Knob<double> pathsUntil{
    .name = "until",
    .option = "reference --until",
    .member = "KeepReference::until",
    .value = 0.0,
    .least = 0.0,
    .most = 1.0,
    .unit = "relMSE",
    .what = "Adds batches of paths, each as many as all before, until the picture's own relMSE by its noise, of "
            "both indirect terms, is no more; 0: one batch"};
inline constexpr Knob<uint32_t> pathBounces{.name = "bounces",
                                            .option = "reference --bounces",
                                            .member = "ReferenceSettings::bounces",
                                            .value = bounces.value,
                                            .least = bounces.least,
                                            .most = bounces.most,
                                            .unit = bounces.unit,
                                            .what = "As of bake: a path scatters at most N+2 times"};
inline constexpr Knob<uint64_t> pathSeed{.name = "seed",
                                         .option = "reference --seed",
                                         .member = "ReferenceSettings::seed",
                                         .value = 1,
                                         .least = 0,
                                         .most = kMost64,
                                         .what = "Of the paths; the same seed gives the same bytes"};
inline constexpr Knob<bool> pixelCentre{
    .name = "pixelCentre",
    .option = "reference --pixel-centre",
    .member = "ReferenceSettings::pixelCentre",
    .value = false,
    .what = "Every path starts at its pixel's centre as a rasteriser's: edges aren't smoothed, textures are"};
inline constexpr Knob<bool> parts{.name = "parts",
                                  .option = "reference --parts",
                                  .member = "ReferenceSettings::parts",
                                  .value = false,
                                  .what = "Parts of the paths as layers of their own, NAME_a, NAME_b and NAME_c",
                                  .buys = "errors against it without its own noise; nine layers of memory"};

// ---- the bench

inline constexpr Knob<uint32_t> benchProbes{.name = "probes",
                                            .option = "bench --probes",
                                            .member = "PlanSettings::probes",
                                            .value = 0,
                                            .least = count.least,
                                            .most = count.most,
                                            .unit = count.unit,
                                            .inWords = "by scene, 54 for others",
                                            .what = "Of the default points"};
inline constexpr Knob<uint32_t> benchResolution{.name = "resolution",
                                                .option = "bench --resolution",
                                                .member = "PointSettings::resolution",
                                                .value = 416,
                                                .least = resolution.least,
                                                .most = 1024, // opponents' curves have twice the next power of two
                                                .unit = resolution.unit,
                                                .also = "multiple of 32",
                                                .what = "Of our default points; the opponents' is the next power of two"};
inline constexpr Knob<uint32_t> referenceBounces{.name = "referenceBounces",
                                                 .member = "BenchSettings::referenceBounces",
                                                 .value = 8,
                                                 .least = bounces.least,
                                                 .most = bounces.most,
                                                 .unit = bounces.unit,
                                                 .what = "Of the bench's truth, and of the light fields that are measured"};
inline constexpr Knob<uint32_t> benchBounces{.name = "bounces",
                                             .option = "bench --bounces",
                                             .member = "PointSettings::bounces",
                                             .value = referenceBounces.value,
                                             .least = bounces.least,
                                             .most = referenceBounces.value,
                                             .unit = bounces.unit,
                                             .what = "Of the default points"};
inline constexpr Knob<uint32_t> benchWidth{.name = "width",
                                           .option = "bench --size",
                                           .member = "BenchSettings::width",
                                           .value = 320,
                                           .least = width.least,
                                           .most = width.most,
                                           .unit = width.unit,
                                           .what = "Width of the bench's frames"};
inline constexpr Knob<uint32_t> benchHeight{.name = "height",
                                            .option = "bench --size",
                                            .member = "BenchSettings::height",
                                            .value = 180,
                                            .least = height.least,
                                            .most = height.most,
                                            .unit = height.unit,
                                            .what = "Height of the bench's frames"};
inline constexpr Knob<uint32_t> judgedRays{.name = "rays",
                                           .option = "bench --rays",
                                           .member = "BenchSettings::rays",
                                           .value = 50000,
                                           .least = 100,
                                           .most = 10'000'000,
                                           .unit = "rays",
                                           .what = "Glossy rays that are judged against Embree"};
inline constexpr Knob<uint32_t> timedFrames{.name = "frames",
                                            .option = "bench --frames",
                                            .member = "BenchSettings::frames",
                                            .value = 20,
                                            .least = 1,
                                            .most = 1000,
                                            .unit = "frames",
                                            .what = "Timed frames of every point, in turns"};
inline constexpr Knob<uint32_t> warmUp{.name = "warmUp",
                                       .member = "BenchSettings::warmUp",
                                       .value = 2,
                                       .least = 0,
                                       .most = 1000,
                                       .unit = "frames",
                                       .what = "Frames before the timed ones"};
inline constexpr Knob<uint32_t> referencePaths{.name = "referencePaths",
                                               .option = "bench --spp",
                                               .member = "BenchSettings::referencePaths",
                                               .value = 256,
                                               .least = 4, // its parts need so many
                                               .most = paths.most,
                                               .unit = paths.unit,
                                               .what = "Paths a pixel of the reference"};
inline constexpr Knob<double> referenceUntil{
    .name = "referenceUntil",
    .option = "bench --until",
    .member = "BenchSettings::referenceUntil",
    .value = pathsUntil.value,
    .least = pathsUntil.least,
    .most = pathsUntil.most,
    .unit = pathsUntil.unit,
    .what = "Adds paths to the reference until its own relMSE by its noise, of both indirect terms, is no more; 0: "
            "none are added"};
inline constexpr Knob<uint64_t> benchSeed{.name = "seed",
                                          .option = "bench --seed",
                                          .member = "BenchSettings::seed",
                                          .value = 1,
                                          .least = 0,
                                          .most = kMost64,
                                          .what = "Of rays and paths"};
inline constexpr Knob<uint32_t> groupMebibytes{.name = "groupBytes",
                                               .option = "bench --group-memory",
                                               .member = "BenchSettings::groupBytes",
                                               .value = 2048,
                                               .least = 1,
                                               .most = 1u << 20,
                                               .unit = "MiB",
                                               .what = "Light fields timed in turns stand on the device together, up to so much memory"};
inline constexpr std::string_view kPlacements[] = {"optimised", "skeleton", "balls", "grid"};
inline constexpr Knob<std::string_view> placement{.name = "placement",
                                                  .member = "PointSettings::placement",
                                                  .value = "optimised",
                                                  .only = kPlacements,
                                                  .what = "What places a point's probes; skeleton: not refined afterwards"};
inline constexpr Knob<uint32_t> lowFactor{.name = "lowFactor",
                                          .member = "PointSettings::lowFactor",
                                          .value = 0,
                                          .least = 1,
                                          .most = resolution.most,
                                          .unit = "texels",
                                          .inWords = "the opponent's best",
                                          .what = "Texels of an opponent's map that one of its low-resolution map covers, per axis"};
inline constexpr Knob<float> lookUpBias{.name = "lookUpBias",
                                        .member = "PointSettings::lookUpBias",
                                        .value = -1.0f,
                                        .least = 0.0f,
                                        .most = 100.0f,
                                        .unit = "metres",
                                        .inWords = "with lookUpView the best of some for the picture",
                                        .what = "Of B0+'s light and of a volume's: how far look-ups are moved along the normal",
                                        .buys = "light that the surface itself doesn't hide; too much reaches through walls"};
inline constexpr Knob<float> lookUpView{.name = "lookUpView",
                                        .member = "PointSettings::lookUpView",
                                        .value = 1.0f,
                                        .least = 0.0f,
                                        .most = 100.0f,
                                        .what = "Of B0+'s light and of a volume's: times as far towards the viewer as along the normal"};
inline constexpr int kDistanceBits[] = {16, 24, 32};
inline constexpr Knob<int> distanceBits{.name = "distanceBits",
                                        .member = "PointSettings::distanceBits",
                                        .value = 32,
                                        .least = 16,
                                        .most = 32,
                                        .only = kDistanceBits,
                                        .unit = "bits a texel",
                                        .what = "Of a texel of ours: distance and plane",
                                        .buys = "exact hits; memory of the distances in proportion"};
inline constexpr Knob<uint32_t> tracedPaths{.name = "paths",
                                            .member = "PointSettings::paths",
                                            .value = 1,
                                            .least = paths.least,
                                            .most = paths.most,
                                            .unit = paths.unit,
                                            .what = "Of the path tracer, as an opponent"};
inline constexpr Knob<uint32_t> timedRuns{.name = "runs",
                                          .member = "RaceSettings::runs",
                                          .value = 0,
                                          .least = 0,
                                          .most = 1000,
                                          .unit = "runs",
                                          .what = "Timed runs of a race; 0 takes no times"};
inline constexpr Knob<uint32_t> timedRays{.name = "timed",
                                          .member = "RaceSettings::timed",
                                          .value = 50000,
                                          .least = 1,
                                          .most = 4'194'304,
                                          .unit = "rays",
                                          .what = "Rays of a timed run, evenly taken of all; where there are fewer, all again and again"};
inline constexpr Knob<double> goalTime{.name = "time",
                                       .option = "tune --time",
                                       .member = "TuneGoal::frameMs",
                                       .value = 0.0,
                                       .least = std::numeric_limits<double>::min(),
                                       .most = std::numeric_limits<double>::max(),
                                       .unit = "milliseconds",
                                       .inWords = "any",
                                       .what = "At most so long a frame of the size that was measured"};
inline constexpr Knob<double> goalError{.name = "error",
                                        .option = "tune --error",
                                        .member = "TuneGoal::error",
                                        .value = 0.0,
                                        .least = std::numeric_limits<double>::min(),
                                        .most = std::numeric_limits<double>::max(),
                                        .inWords = "any",
                                        .what = "At most so much of the metric; then the fastest is taken, else the most exact"};
inline constexpr Knob<double> goalMemory{.name = "memory",
                                         .option = "tune --memory",
                                         .member = "TuneGoal::bytes",
                                         .value = 0.0,
                                         .least = std::numeric_limits<double>::min(),
                                         .most = std::numeric_limits<double>::max(),
                                         .unit = "bytes",
                                         .inWords = "any",
                                         .what = "At most so large a light field"};
inline constexpr std::string_view kMetrics[] = {"wrong_rays",     "beauty.mse",   "beauty.relmse", "beauty.flip",   "diffuse.mse",
                                                "diffuse.relmse", "diffuse.flip", "glossy.mse",    "glossy.relmse", "glossy.flip"};
inline constexpr Knob<std::string_view> goalMetric{.name = "metric",
                                                   .option = "tune --metric",
                                                   .member = "TuneGoal::metric",
                                                   .value = "glossy.relmse",
                                                   .only = kMetrics,
                                                   .what = "What the error is"};

} // namespace knobs
} // namespace sconce
