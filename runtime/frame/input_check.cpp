#include "runtime/frame/input_check.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "runtime/field/light_field.h"
#include "runtime/frame/frame_inputs.h"
#include "shaders/shared/frame_passes.h"
#include "shaders/shared/input_check.h"
#include "spirv/check_inputs_comp.h"

namespace sconce
{
namespace
{

using Faults = std::vector<std::string>;

constexpr uint32_t kPixels = 1u << 14; // looked at, about
// Shares of pixels. Of a static scene all but a few per cent lie where a probe sees a surface; what moves and what no probe sees does not.
constexpr double kMostlyKnown = 0.5; // from here on a frame is taken for right where nothing explains it better
constexpr double kBetter = 1.25;     // times as many pixels another meaning must explain
constexpr double kLeastExplained = 0.4;
constexpr int kLeastCells = 9; // eight meet in a point
constexpr double kSome = 0.01; // that are wrong in a way of their own

/// A guess at what a host's matrix and depth mean, with what a host is told.
struct Meaning
{
    gpu::InputGuess guess;
    const char* fault; // empty of the first, which is right
};

mat4 scaled(float by)
{
    mat4 m(by);
    m[3][3] = 1.0f;
    return m;
}

/// Axes of a world by rows.
mat4 axes(vec3 x, vec3 y, vec3 z)
{
    return glm::transpose(mat4(vec4(x, 0), vec4(y, 0), vec4(z, 0), vec4(0, 0, 0, 1)));
}

std::vector<Meaning> meaningsOf(const mat4& m)
{
    const mat4 same(1.0f), upsideDown = axes({1, 0, 0}, {0, -1, 0}, {0, 0, 1}), mirrored = axes({-1, 0, 0}, {0, 1, 0}, {0, 0, 1}),
                           zUp = axes({1, 0, 0}, {0, 0, 1}, {0, -1, 0}), leftHanded = axes({1, 0, 0}, {0, 1, 0}, {0, 0, -1});
    return {
        {{m, same, gpu::kDepthReversed}, ""},
        {{m, same, gpu::kDepthForward},
         "The depth image is 0 at the near plane: reverse it (1 there, 0 where nothing was drawn), and its matrix with it"},
        {{m, same, gpu::kDepthAlongAxis},
         "The depth image holds metres along the camera's axis: write the depth of a reversed projection, as worldFromClip undoes it"},
        {{m, same, gpu::kDepthAlongRay},
         "The depth image holds metres along each pixel's ray: write the depth of a reversed projection, as worldFromClip undoes it"},
        {{m * upsideDown, same, gpu::kDepthReversed},
         "The picture stands upside down to FrameView::worldFromClip: clip y is -1 at the first row, so negate the matrix's second column"},
        {{m * mirrored, same, gpu::kDepthReversed},
         "The picture is mirrored to FrameView::worldFromClip, as of a camera of the other handedness: negate the matrix's first column"},
        {{glm::transpose(m), same, gpu::kDepthReversed},
         "FrameView::worldFromClip is transposed: it is column-major, times a column vector of clip space"},
        {{glm::inverse(m), same, gpu::kDepthReversed}, "FrameView::worldFromClip takes the world to clip space: give its inverse"},
        {{scaled(0.01f) * m, same, gpu::kDepthReversed},
         "FrameView::worldFromClip gives centimetres, and the field's world is in metres: give inFieldsWorld() a matrix that scales by "
         "0.01"},
        {{scaled(0.001f) * m, same, gpu::kDepthReversed},
         "FrameView::worldFromClip gives millimetres, and the field's world is in metres: give inFieldsWorld() a matrix that scales by "
         "0.001"},
        {{scaled(100.0f) * m, same, gpu::kDepthReversed},
         "FrameView::worldFromClip gives hundreds of metres, and the field's world is in metres: give inFieldsWorld() a matrix "
         "that scales by 100"},
        {{zUp * m, zUp, gpu::kDepthReversed},
         "The frame's world has z up and the field's has y: give inFieldsWorld() a matrix that takes (x, y, z) to (x, z, -y)"},
        {{leftHanded * m, leftHanded, gpu::kDepthReversed},
         "The frame's world is left-handed and the field's is right-handed: give inFieldsWorld() a matrix that negates z"},
    };
}

constexpr const char* kNormalFaults[gpu::kNormalMeanings] = {
    "",
    "Normals are packed, 0 to 1 for -1 to 1: write them as they are, in a format with a sign",
    "Normals point into the surface: turn them to the viewer's side",
    "Normals are in view space, z towards the viewer: turn them into the world",
    "Normals are in view space, z away from the viewer: turn them into the world",
};

constexpr const char* kColorFaults[gpu::kColorMeanings] = {
    "",
    "Base colour is sRGB-encoded: decode it, or give its view an _SRGB format, since it is read as linear",
    "Base colour is darker than what the field was baked with, as if decoded from sRGB twice: take the _SRGB off its view, or the decoding "
    "out of the shader",
};

vec3 homogeneous(vec4 v)
{
    return vec3(v) / v.w;
}

std::string text(vec3 v)
{
    return fmt::format("{:.4g},{:.4g},{:.4g}", v.x, v.y, v.z);
}

bool isFinite(const mat4& m)
{
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            if (!std::isfinite(m[i][j])) return false;
    return true;
}

/// Whether depth falls with distance, as reversed depth does, by what a matrix makes of it.
bool isOfReversedDepth(const mat4& worldFromClip)
{
    const vec3 eye = homogeneous(worldFromClip * vec4(0, 0, 1, 0));
    const auto away = [&](float depth) { return glm::distance(homogeneous(worldFromClip * vec4(0, 0, depth, 1)), eye); };
    return away(0.5f) >= away(0.9f);
}

constexpr const char* kForwardMatrix =
    "FrameView::worldFromClip is of a depth that grows with distance: make it of the reversed projection, 1 at "
    "the near plane and 0 at infinity";

/// What a view says of itself, without a pixel.
Faults faultsOfView(const LightField& field, const gpu::FrameView& view)
{
    Faults faults;
    const float diagonal = field.info().diagonal * field.info().scale, offset = knobs::normalOffset.value * diagonal;
    const vec3 eye = homogeneous(view.worldFromClip * vec4(0, 0, 1, 0));
    if (!(glm::distance(eye, view.eye) <= 1e-3f * diagonal))
        faults.push_back(
            fmt::format("FrameView::eye is {}, but the rays of worldFromClip start at {}: give the camera's place in the world",
                        text(view.eye), text(eye)));
    if (!isOfReversedDepth(view.worldFromClip)) faults.emplace_back(kForwardMatrix);
    if (view.follows > 0)
    {
        const vec4 before = view.clipFromWorldBefore * vec4(view.eyeBefore, 1);
        if (!(std::abs(before.w) <=
              1e-3f * diagonal *
                  glm::length(vec3(view.clipFromWorldBefore[0].w, view.clipFromWorldBefore[1].w, view.clipFromWorldBefore[2].w))))
            faults.push_back(
                fmt::format("FrameView::clipFromWorldBefore doesn't see from eyeBefore {}: w must be 0 there and grow ahead; is it "
                            "transposed, inverse, or of another frame?",
                            text(view.eyeBefore)));
        if (glm::distance(view.eyeBefore, view.eye) > 0.1f * diagonal)
            faults.push_back(fmt::format("The eye was at {} in the frame before and is at {}: set FrameView::follows to 0 after a cut",
                                         text(view.eyeBefore), text(view.eye)));
    }
    if (!(view.normalOffset >= 0.1f * offset && view.normalOffset <= 100.0f * offset))
        faults.push_back(fmt::format("FrameView::normalOffset is {:.3g} m; LightField::frameView() of this field has {:.3g}",
                                     view.normalOffset, offset));
    for (const std::string& fault : {faultOf(knobs::glossyRays, view.glossyRays), faultOf(knobs::raysBelow, view.raysBelow)})
        if (!fault.empty()) faults.push_back("FrameView: " + fault);
    return faults;
}

double share(uint32_t part, uint32_t all)
{
    return all > 0 ? double(part) / double(all) : 0.0;
}

/// Pixels that a guess explains: that lie on a surface, and again those whose normal is that surface's.
double explained(const gpu::InputCounts& counts, uint32_t guess)
{
    return 0.5 * (share(counts.met[guess], counts.shown[guess]) + share(counts.facing[guess], counts.shown[guess]));
}

/// The guess that explains the pixels, 0 where none does so better than the host's own.
uint32_t bestGuess(const gpu::InputCounts& counts, uint32_t guesses)
{
    uint32_t best = 0;
    for (uint32_t guess = 1; guess < guesses; ++guess)
        // Most of the picture and not all in one place, or what a wrong guess happens to put onto a surface would speak for it.
        if (counts.shown[guess] * 2 > counts.pixels - counts.broken - counts.empty && std::popcount(counts.cells[guess]) >= kLeastCells &&
            explained(counts, guess) > explained(counts, best))
            best = guess;
    return explained(counts, best) >= kLeastExplained * 0.5 && explained(counts, best) >= kBetter * explained(counts, 0) ? best : 0;
}

void addPicture(Faults& faults, const gpu::InputCounts& counts, const gpu::FrameView& view)
{
    if (counts.size.x != view.size.x || counts.size.y != view.size.y)
        faults.push_back(fmt::format("The G-buffer has {} x {} pixels and FrameView::size says {} x {}: give the size of its images",
                                     counts.size.x, counts.size.y, view.size.x, view.size.y));
    if (counts.empty + counts.broken == counts.pixels && counts.broken < counts.pixels)
        faults.push_back(
            "No pixel of the depth image shows a surface: draw the G-buffer before, and make it visible by a barrier to compute "
            "shaders' sampled reads");
    if (share(counts.broken, counts.pixels) > kSome)
        faults.push_back(
            fmt::format("{:.0f} % of the pixels hold a number that is NaN, infinite or huge, and count as sky: clear the images, "
                        "and look for divisions by 0 in the G-buffer's shader",
                        100.0 * share(counts.broken, counts.pixels)));
}

void addPlace(Faults& faults, const gpu::InputCounts& counts, const std::vector<Meaning>& meanings, uint32_t chosen)
{
    const double met = share(counts.met[0], counts.shown[0]);
    const gpu::InputGuess& guess = meanings[chosen].guess;
    const bool ofMatrix = guess.depth == gpu::kDepthForward && !isOfReversedDepth(guess.worldFromClip);
    if (chosen != 0)
        faults.push_back(fmt::format("{} (so read, {:.0f} % of the pixels lie on surfaces that the field knows, and {:.0f} % as they are)",
                                     ofMatrix ? kForwardMatrix : meanings[chosen].fault,
                                     100.0 * share(counts.met[chosen], counts.shown[chosen]), 100.0 * met));
    else if (counts.shown[0] > 0 && met < kMostlyKnown)
        faults.push_back(
            fmt::format("Only {:.0f} % of the pixels lie on surfaces that the field knows: is it the field of this scene, and are "
                        "worldFromClip and the depth of the same frame?",
                        100.0 * met));
}

void addNormals(Faults& faults, const gpu::InputCounts& counts)
{
    uint32_t best = 0;
    for (uint32_t meaning = 1; meaning < gpu::kNormalMeanings; ++meaning)
        if (counts.agree[meaning] > counts.agree[best]) best = meaning;
    const double own = share(counts.agree[gpu::kNormalWorld], counts.known);
    if (best != gpu::kNormalWorld && share(counts.agree[best], counts.known) >= kLeastExplained &&
        counts.agree[best] > kBetter * counts.agree[0])
        faults.push_back(fmt::format("{} (so read, {:.0f} % agree with the field's surfaces, and {:.0f} % as they are)",
                                     kNormalFaults[best], 100.0 * share(counts.agree[best], counts.known), 100.0 * own));
    else if (counts.known > 0 && own < kMostlyKnown)
        faults.push_back(fmt::format("Only {:.0f} % of the normals agree with the field's surfaces: they are to be of the shading, in the "
                                     "world, unit, on the viewer's side",
                                     100.0 * own));
    else if (share(counts.uneven, counts.shown[0]) > kSome)
        faults.push_back(fmt::format("{:.0f} % of the normals aren't unit: normalise them in the G-buffer's shader",
                                     100.0 * share(counts.uneven, counts.shown[0])));
}

void addMaterials(Faults& faults, const gpu::InputCounts& counts)
{
    const auto outside = [&](uint32_t pixels, const char* what, const std::string& remedy)
    {
        if (share(pixels, counts.shown[0]) > kSome)
            faults.push_back(
                fmt::format("{:.0f} % of the pixels have {} outside of 0 to 1: {}", 100.0 * share(pixels, counts.shown[0]), what, remedy));
    };
    outside(counts.colors, "a base colour", "divide by 255 where it is in bytes, and leave light out of it");
    outside(counts.metals, "a metallic (a of the base colour)", "it is 0 for dielectrics and 1 for metals");
    outside(counts.roughnesses, "a roughness (w of the normal)",
            fmt::format("it is perceptual roughness, as glTF has it, and {:g} more where a surface is retroreflective", gpu::kRetro));
    uint32_t best = 0;
    for (uint32_t meaning = 1; meaning < gpu::kColorMeanings; ++meaning)
        if (counts.tint[meaning] > counts.tint[best]) best = meaning;
    // Albedos of many pixels hang on the light that reaches them straight from the host's own lights: those that fit another meaning must
    // be many.
    constexpr uint32_t kEnough = 64;
    if (best != gpu::kColorLinear && counts.colors == 0 && counts.tint[best] >= kEnough &&
        share(counts.tint[best], counts.lit) >= kLeastExplained && counts.tint[best] > 2 * counts.tint[0])
        faults.push_back(
            fmt::format("{} (so read, {:.0f} % of the pixels scatter what the field saw them scatter, and {:.0f} % as they are)",
                        kColorFaults[best], 100.0 * share(counts.tint[best], counts.lit), 100.0 * share(counts.tint[0], counts.lit)));
}

/// The pass, and what it reads and writes.
class InputCheck
{
public:
    InputCheck(Gpu& device, const LightField& asked) : gpu(device), field(asked) {}

    Status make(const FrameInputs& inputs, const gpu::FrameView& view, std::span<const gpu::InputGuess> guesses)
    {
        auto block = gpu.makeBufferWith<gpu::FrameView>(std::span(&view, 1), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, "view of checked inputs");
        if (!block) return block.error();
        frame = std::move(*block);
        auto tried = gpu.makeBufferWith<gpu::InputGuess>(guesses, 0, "guesses at inputs");
        if (!tried) return tried.error();
        guessed = std::move(*tried);
        const gpu::InputCounts none{};
        auto zero = gpu.makeBufferWith<gpu::InputCounts>(std::span(&none, 1), 0, "counts of inputs");
        if (!zero) return zero.error();
        counted = std::move(*zero);
        const DescriptorSet::Binding bindings[] = {{gpu::kCheckGuessesBinding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                                                   {gpu::kCheckCountsBinding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
        auto made = makeFrameSet(gpu, frame, bindings);
        if (!made) return made.error();
        set = std::move(*made);
        set.write(gpu::kCheckGuessesBinding, guessed);
        set.write(gpu::kCheckCountsBinding, counted);
        writeInputs(set, inputs);
        const VkDescriptorSetLayout layouts[] = {field.layout(), set.layout()};
        auto built = Pipeline::compute(gpu, check_inputs_comp, layouts, sizeof(gpu::InputCheckPush), shaderConstants(field));
        if (!built) return built.error();
        pipeline = std::move(*built);
        return success();
    }

    /// Runs a pass, and tells what has been counted by then.
    Result<gpu::InputCounts> count(const gpu::FrameView& view, uint32_t chosen, uint32_t guesses)
    {
        const double pixels = double(view.size.x) * double(view.size.y);
        const auto every = uint32_t(std::max(1.0, std::ceil(std::sqrt(pixels / kPixels))));
        const uint64_t lattice = uint64_t((view.size.x + every - 1) / every) * ((view.size.y + every - 1) / every);
        const Status run = gpu.submit(
            [&](VkCommandBuffer cmd)
            {
                // The host drew the G-buffer in whatever stage, and a pass before counted in the same buffer. A diagnosis waits for all.
                memoryBarrier(
                    gpu, cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
                const VkDescriptorSet sets[] = {field.descriptorSet(), set.handle()};
                pipeline.bind(cmd, sets);
                pipeline.push(cmd, gpu::InputCheckPush{every, chosen, guesses});
                gpu.vk.CmdDispatch(cmd, workgroupsInARow(lattice, gpu::kCheckGroup), 1, 1);
            });
        if (!run) return run.error();
        gpu::InputCounts counts;
        if (Status read = gpu.download(counted, 0, std::as_writable_bytes(std::span(&counts, 1))); !read) return read.error();
        return counts;
    }

private:
    Gpu& gpu;
    const LightField& field;
    Buffer frame, guessed, counted;
    DescriptorSet set;
    Pipeline pipeline;
};

} // namespace

Result<std::vector<std::string>> checkInputs(Gpu& gpu, const LightField& field, const FrameInputs& inputs, const gpu::FrameView& view)
{
    if (inputs.depth == VK_NULL_HANDLE || inputs.normalRoughness == VK_NULL_HANDLE || inputs.baseColorMetallic == VK_NULL_HANDLE)
        return Error{ErrorCode::badArgument, "FrameInputs lacks a view; give depth, normalRoughness and baseColorMetallic"};
    if (view.size.x == 0 || view.size.y == 0 || !isFinite(view.worldFromClip))
        return Error{ErrorCode::badArgument,
                     fmt::format("A FrameView of {} x {} pixels{} shows nothing; begin with LightField::frameView()", view.size.x,
                                 view.size.y, isFinite(view.worldFromClip) ? "" : ", whose worldFromClip isn't finite,")};
    if (Status status = checkDevice(gpu, field); !status) return status.error();
    const std::vector<Meaning> meanings = meaningsOf(view.worldFromClip);
    std::vector<gpu::InputGuess> guesses;
    for (const Meaning& meaning : meanings) guesses.push_back(meaning.guess);
    InputCheck check(gpu, field);
    if (Status made = check.make(inputs, view, guesses); !made) return made.error();
    const auto first = check.count(view, gpu::kMostGuesses, uint32_t(guesses.size()));
    if (!first) return first.error();
    const uint32_t chosen = bestGuess(*first, uint32_t(guesses.size()));
    const auto counts = check.count(view, chosen, uint32_t(guesses.size()));
    if (!counts) return counts.error();

    Faults faults;
    addPicture(faults, *counts, view);
    if (counts->empty + counts->broken < counts->pixels)
    {
        addPlace(faults, *counts, meanings, chosen);
        addNormals(faults, *counts);
        addMaterials(faults, *counts);
    }
    // A matrix that means something else speaks of other eyes, too: one fault, one sentence.
    if (chosen == 0)
        for (std::string& fault : faultsOfView(field, view)) faults.push_back(std::move(fault));
    return faults;
}

} // namespace sconce
