#include "runtime/frame/indirect_light.h"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/frame/moving_shapes.h"
#include "runtime/vulkan/nan_scan.h"
#include "spirv/gather_light_comp.h"
#include "spirv/lamp_light_comp.h"
#include "spirv/moving_facings_comp.h"
#include "spirv/moving_light_comp.h"
#include "spirv/reconstruct_comp.h"
#include "spirv/surface_light_comp.h"
#include "spirv/trace_glossy_comp.h"

namespace sconce
{
namespace
{

std::string problemOf(const Gpu& gpu, const LightField& field, const IndirectLight::Desc& desc)
{
    const uint32_t most = gpu.properties.limits.maxImageDimension2D;
    if (desc.width < 1 || desc.height < 1 || desc.width > most || desc.height > most)
        return fmt::format("frame size {}x{} is outside 1..{} pixels a side", desc.width, desc.height, most);
    if (const std::string fault = faultOf(knobs::traceEvery, desc.traceEvery); !fault.empty()) return fault;
    if (const std::string fault = faultOf(knobs::surfaceProbes, desc.surfaceProbes); !fault.empty()) return fault;
    if (desc.movingShapes > gpu::kMostMovingShapes)
        return fmt::format("movingShapes is {}; give at most {}", desc.movingShapes, gpu::kMostMovingShapes);
    if (desc.effects.rough && !field.holdsPrefiltered())
        return "the light field holds no prefiltered radiance; bake it with the effect 'rough', or leave that out";
    if (desc.effects.diffuse && desc.effects.patches && !desc.effects.tracedDiffuse && !field.holdsPatches())
        return "the light field holds no patches: it holds surface light, is older, or its maps are octahedral; bake it again with cube "
               "faces and --surface-texels 0, or leave patches out";
    const bool rays = desc.effects.glossy || desc.effects.mirror || (desc.effects.diffuse && desc.effects.tracedDiffuse);
    if (rays && !field.holdsRadiance() && !field.holdsPrefiltered())
        return "the light field holds no radiance; bake it with the effect 'glossy', or leave 'glossy', 'mirror' and traced diffuse light "
               "out";
    return {};
}

/// The inverse of FrameView::worldFromClip, with w above 0 before the eye: that of clip space is, and a matrix may be scaled by any number.
mat4 clipFromWorldOf(const mat4& worldFromClip)
{
    const glm::dmat4 to(worldFromClip), from = glm::inverse(to);
    const glm::dvec4 point = to * glm::dvec4(0.0, 0.0, 0.5, 1.0);
    const double w = (from * (point / point.w)).w;
    return mat4(w < 0.0 ? -from : from);
}

} // namespace

Status IndirectLight::State::makeImage(GpuImage& target, VkFormat format, const char* what)
{
    auto made = makeLightImage(*gpu, format, desc.width, desc.height, what);
    if (!made) return made.error();
    target = std::move(*made);
    return success();
}

/// @param images     each with its binding; what a pass lacks of them is bound to something that is there
/// @param constants  besides the field's and whether the pass runs on tiles
/// @param traces     it is trace_glossy.comp, which may ask the picture
Status IndirectLight::State::makePass(Pipeline& pipeline, DescriptorSet& set, Spirv shader, std::initializer_list<Bound> images,
                                      std::vector<ShaderConstant> constants, bool traces)
{
    std::vector<DescriptorSet::Binding> bindings = {{gpu::kTileBinding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                                                    {gpu::kMovingBinding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
    for (const Bound& bound : images) bindings.push_back({bound.binding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE});
    if (traces)
        bindings.insert(bindings.end(), {{gpu::kPictureBeforeBinding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                                         {gpu::kScreenBinding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}});
    auto made = makeFrameSet(*gpu, frame, bindings);
    if (!made) return made.error();
    set = std::move(*made);
    if (traces) set.write(gpu::kScreenBinding, screen ? screen : frame);
    for (const Bound& bound : images) set.write(bound.binding, bound.image->view(), VK_IMAGE_LAYOUT_GENERAL);
    set.write(gpu::kTileBinding, tileList->buffer());
    set.write(gpu::kMovingBinding, moving ? moving : tileList->buffer()); // of few passes; what isn't read is bound all the same
    std::vector<ShaderConstant> values(constants);
    for (const ShaderConstant& ofField : shaderConstants(field)) values.push_back(ofField);
    values.push_back(tileList->constant());
    const VkDescriptorSetLayout layouts[] = {field.layout(), set.layout()};
    auto built = Pipeline::compute(*gpu, shader, layouts, 0, values);
    if (!built) return built.error();
    pipeline = std::move(*built);
    return success();
}

Status IndirectLight::State::makeTrace(uint32_t term, GpuImage& image, Pipeline& pipeline, DescriptorSet& set)
{
    if (!image)
        if (auto s = makeImage(image, kLightFormat,
                               term == gpu::kTermMirror    ? "mirrored light"
                               : term == gpu::kTermDiffuse ? "diffuse light"
                                                           : "glossy light");
            !s)
            return s;
    const bool counts = desc.counts && term != gpu::kTermDiffuse; // a pixel's reflections are counted
    if (!counts && !noCounts) // what isn't written is bound all the same, in the format that the shader names
    {
        auto made = makeLightImage(*gpu, VK_FORMAT_R32G32B32A32_UINT, 1, 1, "stand-in for trace counts");
        if (!made) return made.error();
        noCounts = std::move(*made);
    }
    if (counts && !countImage)
        if (auto s = makeImage(countImage, VK_FORMAT_R32G32B32A32_UINT, "trace counts"); !s) return s;
    const Spirv shader = shaders.glossy.empty() ? Spirv(trace_glossy_comp) : shaders.glossy;
    return makePass(pipeline, set, shader,
                    {{gpu::kTraceLightBinding, &image},
                     {gpu::kTraceCountsBinding, counts ? &countImage : &noCounts},
                     {gpu::kPackedBinding, &tileList->packedPixels()}},
                    {{gpu::kTermId, term},
                     {gpu::kCountId, counts ? 1u : 0u},
                     {gpu::kEveryLogId, term == gpu::kTermMirror ? 0u : everyLog()},
                     {gpu::kUntintedId, untinted(term)},
                     {gpu::kMovingId, moving ? 1u : 0u},
                     {gpu::kScreenId, asksPicture() && term != gpu::kTermDiffuse ? 1u : 0u}},
                    true);
}

Status IndirectLight::State::makeFill(uint32_t term, const GpuImage& image, Pipeline& pipeline, DescriptorSet& set)
{
    if (desc.traceEvery == 1) return success();
    return makePass(pipeline, set, reconstruct_comp, {{gpu::kFillLightBinding, &image}, {gpu::kPackedBinding, &tileList->packedPixels()}},
                    {{gpu::kTermId, term}, {gpu::kEveryLogId, everyLog()}, {gpu::kUntintedId, untinted(term)}});
}

/// Of the pass that reads light at surfaces, whose light scales rough reflections, too, and of the one that adds lamps; of what the first
/// leaves; of the one that gathers light at probes; of what lamps leave.
std::vector<TileList::LookUps> IndirectLight::State::lookUps() const
{
    constexpr uint32_t diffuse = 1u << gpu::kTermDiffuse, rough = 1u << gpu::kTermRough;
    const IndirectEffects& effects = desc.effects;
    std::vector<TileList::LookUps> lists;
    const bool bent = field.info().surfaceDirections;
    const uint32_t alsoRough = effects.rough ? rough : 0;
    constexpr uint32_t all = (1u << gpu::kTermCount) - 1;
    if (readsSurfaces() || hasLamps())
        lists = {{hasLamps() ? all : diffuse | alsoRough, bent ? gpu::kLookUpsBent : gpu::kLookUpsPerQuad}, {0, gpu::kLookUpsPerPixel}};
    const uint32_t gathered = (gathersDiffuse() ? diffuse : 0) | alsoRough;
    // Each pixel draws one probe's patches by lot.
    if (gathered != 0) lists.push_back({gathered, effects.patches ? gpu::kLookUpsPerPixel : gpu::kLookUpsPerQuad});
    if (hasLamps()) lists.push_back({0, gpu::kLookUpsPerPixel});
    return lists;
}

Status IndirectLight::State::makeGather()
{
    const IndirectEffects& effects = desc.effects;
    if (effects.rough)
        if (auto s = makeImage(roughImage, kLightFormat, "rough reflections"); !s) return s;
    const GpuImage& diffuse = diffuseImage ? diffuseImage : roughImage;
    const GpuImage& rough = effects.rough ? roughImage : diffuseImage;
    const Spirv shader = shaders.gather.empty() ? Spirv(gather_light_comp) : shaders.gather;
    std::vector<ShaderConstant> constants = {{gpu::kGatherDiffuseId, gathersDiffuse() ? 1u : 0u},
                                             {gpu::kGatherRoughId, effects.rough ? 1u : 0u},
                                             {gpu::kLookUpListId, gatherLookUps()},
                                             {gpu::kByPatchesId, effects.patches ? 1u : 0u},
                                             {gpu::kBySurfaceId, readsSurfaces() ? 1u : 0u}};
    constants.insert(constants.end(), shaders.constants.begin(), shaders.constants.end());
    return makePass(gatherPass, gatherSet, shader, {{gpu::kGatherDiffuseBinding, &diffuse}, {gpu::kGatherRoughBinding, &rough}}, constants);
}

Status IndirectLight::State::makeLamps()
{
    const std::pair<uint32_t, const GpuImage*> images[] = {
        {gpu::kTermDiffuse, readsSurfaces() || tracesDiffuse() ? &diffuseImage : nullptr},
        {gpu::kTermRough, &roughImage},
        {gpu::kTermGlossy, &glossyImage},
        {gpu::kTermMirror, &mirrored()}};
    uint32_t terms = 0;
    const GpuImage* any = nullptr;
    for (const auto& [term, image] : images)
        if (image && *image) terms |= 1u << term, any = image;
    if (terms == 0) return success();
    const auto of = [&](uint32_t term) { return terms & (1u << term) ? images[term].second : any; };
    const uint32_t left = lampLookUps = uint32_t(lookUps().size()) - 1;
    for (uint32_t isRest : {0u, 1u})
        if (auto s = makePass(isRest ? lampRestPass : lampPass, lampSet, lamp_light_comp,
                              {{gpu::kLampDiffuseBinding, of(gpu::kTermDiffuse)},
                               {gpu::kLampRoughBinding, of(gpu::kTermRough)},
                               {gpu::kLampGlossyBinding, of(gpu::kTermGlossy)},
                               {gpu::kLampMirrorBinding, of(gpu::kTermMirror)}},
                              {{gpu::kLampTermsId, terms},
                               {gpu::kLampEachId, field.info().surfaceDirections},
                               {gpu::kLookUpListId, isRest ? left : 0},
                               {gpu::kLookUpRestId, left},
                               {gpu::kIsRestId, isRest}});
            !s)
            return s;
    return success();
}

/// Light of traced rays meets the shapes itself.
Status IndirectLight::State::makeMoving()
{
    const bool looksUp = gathersDiffuse() || readsSurfaces();
    if (!looksUp && !roughImage && !glossyPass && !mirrorPass && !diffusePass) return success();
    const GpuImage& any = diffuseImage ? diffuseImage : roughImage ? roughImage : glossyImage ? glossyImage : mirrorImage;
    if (auto s = makePass(movingFacings, movingFacingsSet, moving_facings_comp, {{gpu::kMovingLightBinding, &any}}, {}); !s) return s;
    const uint32_t looks = field.holdsPrefiltered() && readsSurfaces() ? 1u : 0u;
    for (const uint32_t boxes : {0u, 1u})
    {
        if (looksUp)
            if (auto s = makePass(movingDiffuse[boxes], movingDiffuseSet, moving_light_comp, {{gpu::kMovingLightBinding, &diffuseImage}},
                                  {{gpu::kTermId, gpu::kTermDiffuse}, {gpu::kMovingBoxesId, boxes}, {gpu::kMovingLooksId, looks}});
                !s)
                return s;
        if (roughImage)
            if (auto s = makePass(movingRough[boxes], movingRoughSet, moving_light_comp, {{gpu::kMovingLightBinding, &roughImage}},
                                  {{gpu::kTermId, gpu::kTermRough}, {gpu::kMovingBoxesId, boxes}, {gpu::kMovingLooksId, 0}});
                !s)
                return s;
    }
    return success();
}

Status IndirectLight::State::setShapes(std::span<const MovingShape> shapes)
{
    if (const std::string fault = faultOf(shapes, desc.movingShapes); !fault.empty())
        return Error{ErrorCode::badArgument, "Moving shapes: " + fault};
    shapeBytes = packShapes(shapes);
    kindsMove = {};
    for (const MovingShape& shape : shapes) kindsMove[shape.kind == MovingShape::Kind::box] = true;
    return success();
}

IndirectLight::State::State(Gpu& device, const LightField& asked, const Desc& wanted, const LightShaders& passes)
    : gpu(device.shared_from_this()), field(asked), desc(wanted), shaders(passes)
{
}

Status IndirectLight::State::make()
{
    if (const std::string problem = problemOf(*gpu, field, desc); !problem.empty()) return Error{ErrorCode::badArgument, problem};
    auto block = gpu->makeBuffer(sizeof(gpu::FrameView), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, MemoryUse::device, "frame view");
    if (!block) return block.error();
    frame = std::move(*block);
    const IndirectEffects& effects = desc.effects;
    if (asksPicture())
    {
        auto made = gpu->makeBuffer(sizeof(mat4), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, MemoryUse::device, "clip space of the picture");
        if (!made) return made.error();
        screen = std::move(*made);
    }
    if (desc.movingShapes > 0)
    {
        auto made = gpu->makeBuffer(kMovingBytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::device, "shapes that move");
        if (!made) return made.error();
        moving = std::move(*made);
        shapeBytes = packShapes({});
    }
    if (effects.diffuse || effects.rough || effects.glossy || effects.mirror)
    {
        auto tiles = TileList::create(*gpu, frame, {desc.width, desc.height, everyLog(), effects.tiles, lookUps()});
        if (!tiles) return tiles.error();
        tileList = std::make_unique<TileList>(std::move(*tiles));
    }
    if (gathersDiffuse() || readsSurfaces())
        if (auto s = makeImage(diffuseImage, kLightFormat, "diffuse light"); !s) return s;
    if (readsSurfaces())
        for (uint32_t isRest : {0u, 1u})
            if (auto s = makePass(isRest ? surfaceRestPass : surfacePass, surfaceSet, surface_light_comp,
                                  {{gpu::kSurfaceDiffuseBinding, &diffuseImage}, {gpu::kPackedBinding, &tileList->packedPixels()}},
                                  {{gpu::kLookUpListId, isRest},
                                   {gpu::kLookUpRestId, 1},
                                   {gpu::kIsRestId, isRest},
                                   {gpu::kSurfaceProbesId, desc.surfaceProbes}});
                !s)
                return s;
    if (gathersDiffuse() || effects.rough)
        if (auto s = makeGather(); !s) return s;
    if (tracesDiffuse())
    {
        if (auto s = makeTrace(gpu::kTermDiffuse, diffuseImage, diffusePass, diffuseSet); !s) return s;
        if (auto s = makeFill(gpu::kTermDiffuse, diffuseImage, diffuseFill, diffuseFillSet); !s) return s;
    }
    if (effects.glossy)
        if (auto s = makeTrace(gpu::kTermGlossy, glossyImage, glossyPass, glossySet); !s) return s;
    if (effects.mirror) // after the glossy image, which may be its own
        if (auto s = makeTrace(gpu::kTermMirror, mirrorsInGlossy() ? glossyImage : mirrorImage, mirrorPass, mirrorSet); !s) return s;
    if (!effects.glossy) return success();
    if (auto s = makeFill(gpu::kTermGlossy, glossyImage, glossyFill, glossyFillSet); !s) return s;
    if (!effects.denoise) return success();
    if (auto s = makeImage(scratch, kLightFormat, "scratch of the glossy filter"); !s) return s;
    auto made = Denoiser::create(*gpu,
                                 {field.layout(), gpu::kTermGlossy, true, effects.temporal, desc.movingShapes > 0 || asksPicture(),
                                  tileList.get(), desc.width, desc.height},
                                 frame, glossyImage, scratch);
    if (!made) return made.error();
    denoiser = std::move(*made);
    return success();
}

Result<IndirectLight> makeIndirectLight(Gpu& gpu, const LightField& field, const IndirectLight::Desc& desc, const LightShaders& passes)
{
    if (Status status = checkDevice(gpu, field); !status) return status.error();
    auto state = std::make_unique<IndirectLight::State>(gpu, field, desc, passes);
    if (Status status = state->make(); !status) return status.error();
    if (field.state().lampCount > 0)
        if (Status status = state->makeLamps(); !status) return status.error();
    if (desc.movingShapes > 0)
        if (Status status = state->makeMoving(); !status) return status.error();
    return IndirectLight(std::move(state));
}

void IndirectLight::State::setInputs(const FrameInputs& inputs)
{
    for (const auto& [pass, set] : {std::pair{&glossyPass, &glossySet},
                                    {&mirrorPass, &mirrorSet},
                                    {&diffusePass, &diffuseSet},
                                    {&surfacePass, &surfaceSet},
                                    {&gatherPass, &gatherSet},
                                    {&lampPass, &lampSet},
                                    {&glossyFill, &glossyFillSet},
                                    {&diffuseFill, &diffuseFillSet},
                                    {&movingFacings, &movingFacingsSet},
                                    {&movingDiffuse[0], &movingDiffuseSet},
                                    {&movingRough[0], &movingRoughSet}})
        if (*pass) writeInputs(*set, inputs);
    // What isn't asked is bound all the same.
    const VkImageView picture = asksPicture() ? inputs.pictureBefore : inputs.baseColorMetallic;
    for (const auto& [pass, set] : {std::pair{&glossyPass, &glossySet}, {&mirrorPass, &mirrorSet}, {&diffusePass, &diffuseSet}})
        if (*pass) set->write(gpu::kPictureBeforeBinding, picture, asksPicture() ? inputs.pictureLayout : inputs.layout);
    if (tileList) tileList->setInputs(inputs);
    if (denoiser) denoiser.setInputs(inputs);
}

/// A frame on its way into a command buffer: its passes, in their order, with what stands between them.
class IndirectLight::State::Recording
{
public:
    Recording(State& of, VkCommandBuffer into, GpuTimer* by) : state(of), cmd(into), timer(by) {}

    void begin(const gpu::FrameView& view);
    void classify();
    void moveShapes(); // the light of what moves
    void lookUps();
    void traces();
    void fills();
    void filter();
    void overShapes(); // what they hide
    void lamps();
    void end();

private:
    static constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    static constexpr VkPipelineStageFlags2 kTransfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    static constexpr VkAccessFlags2 kRead = VK_ACCESS_2_SHADER_STORAGE_READ_BIT, kWrite = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;

    /// What compute passes have stored, before others use it so.
    void between(VkAccessFlags2 use) { memoryBarrier(*state.gpu, cmd, kCompute, kWrite, kCompute, use); }
    template <class Work> void timed(const char* name, const Work& work)
    {
        if (timer) timer->begin(cmd, name);
        work();
        if (timer) timer->end(cmd);
    }
    template <class Dispatch> void run(const Pipeline& pipeline, const DescriptorSet& set, const Dispatch& dispatch)
    {
        const VkDescriptorSet sets[] = {state.field.descriptorSet(), set.handle()};
        pipeline.bind(cmd, sets);
        dispatch();
    }
    template <class Dispatch> void pass(const Pipeline& pipeline, const DescriptorSet& set, const char* name, const Dispatch& dispatch)
    {
        if (pipeline) timed(name, [&] { run(pipeline, set, dispatch); });
    }
    auto onTiles(uint32_t term, uint32_t tilesLog = 0)
    {
        return [=, this] { state.tileList->dispatch(cmd, term, tilesLog); };
    }
    auto byLookUps(uint32_t list)
    {
        return [=, this] { state.tileList->dispatchLookUps(cmd, list); };
    }
    void inTwo(const Pipeline& first, const Pipeline& rest, const DescriptorSet& set, uint32_t left);
    void scan(const char* name, std::initializer_list<const GpuImage*> images)
    {
        for (const GpuImage* image : images)
            if (*image) scanImage(*state.gpu, cmd, name, *image);
    }
    uint32_t shapes() const // that move
    {
        return state.moving ? reinterpret_cast<const gpu::MovingShapesHead*>(state.shapeBytes.data())->count : 0;
    }

    State& state;
    VkCommandBuffer cmd;
    GpuTimer* timer;
};

void IndirectLight::State::Recording::begin(const gpu::FrameView& view)
{
    const Gpu& gpu = *state.gpu;
    // Write after read and after write: view, lists, counts and images are the same ones each frame. The frame before may still read its
    // outputs in whatever stage the host composes in, a fragment shader or a blit, so all of them are waited for. Once for all that a frame
    // writes anew; and for the picture of the frame before, whatever stage drew it, where rays ask it.
    memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, kTransfer | kCompute,
                  VK_ACCESS_2_MEMORY_WRITE_BIT | (state.screen ? VK_ACCESS_2_SHADER_SAMPLED_READ_BIT : 0));
    // Recorded, not written by the host: the frame before may still run with its own view.
    gpu.vk.CmdUpdateBuffer(cmd, state.frame.handle(), 0, sizeof(view), &view);
    if (state.screen)
    {
        const mat4 clip = clipFromWorldOf(view.worldFromClip);
        gpu.vk.CmdUpdateBuffer(cmd, state.screen.handle(), 0, sizeof(clip), &clip);
    }
    if (state.tileList) state.tileList->clear(cmd);
    if (state.moving) gpu.vk.CmdUpdateBuffer(cmd, state.moving.handle(), 0, state.shapeBytes.size(), state.shapeBytes.data());
    // Traces write where rays start; the other pixels must not keep the counts of the frame before.
    if (state.countImage)
    {
        const VkClearColorValue nothing{.uint32 = {gpu::kNoProbe, 0, 0, 0}};
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        gpu.vk.CmdClearColorImage(cmd, state.countImage.handle(), VK_IMAGE_LAYOUT_GENERAL, &nothing, 1, &all);
    }
    // Every pass reads the view; classification counts up by atomics from the cleared lists; traces write over the cleared counts.
    memoryBarrier(gpu, cmd, kTransfer, VK_ACCESS_2_TRANSFER_WRITE_BIT, kCompute, VK_ACCESS_2_UNIFORM_READ_BIT | kRead | kWrite);
}

/// Ahead of all passes, which run by its lists.
void IndirectLight::State::Recording::classify()
{
    if (state.tileList) timed("classify tiles", [&] { state.tileList->record(cmd); });
}

void IndirectLight::State::Recording::moveShapes()
{
    if (!state.movingFacings || shapes() == 0) return;
    run(state.movingFacings, state.movingFacingsSet,
        [&] { state.gpu->vk.CmdDispatch(cmd, (shapes() * gpu::kShapeFacings + 63) / 64, 1, 1); });
    between(kRead); // rays and the passes over shapes read their light
}

/// A pass by two lists of look-ups: what the first leaves, the rest does.
void IndirectLight::State::Recording::inTwo(const Pipeline& first, const Pipeline& rest, const DescriptorSet& set, uint32_t left)
{
    for (const Pipeline* half : {&first, &rest})
    {
        run(*half, set, byLookUps(half == &rest ? left : 0));
        // The first adds to the list that the second runs by, and both may write to the lists that all later passes run by, as far as a
        // driver can tell. The light at surfaces is read by the gathering pass, which scales rough reflections by it.
        memoryBarrier(*state.gpu, cmd, kCompute, kWrite, kCompute | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
                      kRead | kWrite | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
    }
}

void IndirectLight::State::Recording::lookUps()
{
    if (state.surfacePass) timed("surface light", [&] { inTwo(state.surfacePass, state.surfaceRestPass, state.surfaceSet, 1); });
    scan("surface light", {&state.diffuseImage});
    pass(state.gatherPass, state.gatherSet, "gather light", byLookUps(state.gatherLookUps()));
    scan("gather light", {&state.diffuseImage, &state.roughImage});
}

void IndirectLight::State::Recording::traces()
{
    pass(state.diffusePass, state.diffuseSet, "diffuse trace", onTiles(gpu::kTermDiffuse, state.everyLog()));
    scan("diffuse trace", {&state.diffuseImage});
    pass(state.glossyPass, state.glossySet, "glossy trace", onTiles(gpu::kTermGlossy, state.everyLog()));
    scan("glossy trace", {&state.glossyImage});
    // Write after write: both traces store counts into one image, each its own pixels of it. Passes before them share no image, so that
    // nothing stands between those.
    if (state.countImage && state.glossyPass && state.mirrorPass) between(kWrite);
    pass(state.mirrorPass, state.mirrorSet, "mirror trace", onTiles(gpu::kTermMirror));
    scan("mirror trace", {&state.mirrored()});
}

void IndirectLight::State::Recording::fills()
{
    if (!state.glossyFill && !state.diffuseFill) return;
    // Read after write: a fill takes light from the traced pixels about its own, and stores into the same image. One barrier for both
    // fills: each has an image of its own.
    between(kRead | kWrite);
    pass(state.diffuseFill, state.diffuseFillSet, "diffuse fill", onTiles(gpu::kTermDiffuse));
    scan("diffuse fill", {&state.diffuseImage});
    pass(state.glossyFill, state.glossyFillSet, "glossy fill", onTiles(gpu::kTermGlossy));
    scan("glossy fill", {&state.glossyImage});
}

/// After the fills: where the trace is sparse, most pixels have no light before them that a filter could take.
void IndirectLight::State::Recording::filter()
{
    if (state.denoiser) timed("glossy denoise", [&] { state.denoiser.record(cmd, state.field.descriptorSet()); });
    scan("glossy denoise", {&state.glossyImage, &state.scratch});
}

void IndirectLight::State::Recording::overShapes()
{
    if ((!state.movingDiffuse[0] && !state.movingRough[0]) || shapes() == 0) return;
    timed("moving shapes",
          [&]
          {
              for (const size_t boxes : {0, 1})
              {
                  if (!state.kindsMove[boxes]) continue;
                  // Read after write: what is looked up has been stored by then, and so has what shapes of the other kind left of it.
                  between(kRead | kWrite);
                  if (state.movingDiffuse[boxes]) run(state.movingDiffuse[boxes], state.movingDiffuseSet, onTiles(gpu::kTermDiffuse));
                  if (state.movingRough[boxes])
                      run(state.movingRough[boxes], state.movingRoughSet, onTiles(gpu::kTermRough)); // another image
              }
          });
    scan("moving shapes", {&state.diffuseImage, &state.roughImage});
}

void IndirectLight::State::Recording::lamps()
{
    if (!state.lampPass) return;
    // Read after write: the light of lamps is added to what the passes and filters before have stored.
    between(kRead | kWrite);
    timed("lamp light", [&] { inTwo(state.lampPass, state.lampRestPass, state.lampSet, state.lampLookUps); });
    scan("lamp light", {&state.diffuseImage, &state.roughImage, &state.glossyImage, &state.mirrorImage});
}

/// Who reads the outputs is the host's choice, so all commands; nothing later in the frame may write them without a barrier of its own.
void IndirectLight::State::Recording::end()
{
    memoryBarrier(*state.gpu, cmd, kCompute, kWrite, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT);
}

void IndirectLight::State::record(VkCommandBuffer cmd, const gpu::FrameView& view, GpuTimer* timer) noexcept
{
    // Lists and images are of the size that all was made for, and more rays would be the same ones again.
    gpu::FrameView own = view;
    own.size = {desc.width, desc.height};
    own.glossyRays = std::clamp(view.glossyRays, knobs::glossyRays.least, knobs::glossyRays.most);
    if (own.fieldFromNormals == mat3(0.0f)) own.fieldFromNormals = mat3(1.0f); // of a view that was filled by hand
    Recording recording(*this, cmd, timer);
    recording.begin(own);
    recording.classify();
    recording.moveShapes();
    recording.lookUps();
    recording.traces();
    recording.fills();
    recording.filter();
    recording.overShapes();
    recording.lamps();
    recording.end();
}

uint64_t IndirectLight::State::deviceBytes() const
{
    uint64_t bytes = frame.size() + (screen ? screen.size() : 0) + (moving ? moving.size() : 0) + (tileList ? tileList->deviceBytes() : 0);
    for (const GpuImage* image : {&glossyImage, &scratch, &mirrorImage, &countImage, &diffuseImage, &roughImage})
        if (*image) bytes += image->bytes();
    return bytes + denoiser.deviceBytes();
}

namespace
{

IndirectLight::Output outputOf(const GpuImage& image)
{
    return image ? IndirectLight::Output{image.handle(), image.view(), image.desc().format} : IndirectLight::Output{};
}

} // namespace

IndirectLight::IndirectLight(std::unique_ptr<State> made) : owned(std::move(made)) {}
IndirectLight::IndirectLight(IndirectLight&&) noexcept = default;
IndirectLight& IndirectLight::operator=(IndirectLight&&) noexcept = default;
IndirectLight::~IndirectLight() = default;

void IndirectLight::setInputs(const FrameInputs& inputs)
{
    owned->setInputs(inputs);
}

Status IndirectLight::setShapes(std::span<const MovingShape> shapes)
{
    return owned->setShapes(shapes);
}

void IndirectLight::record(VkCommandBuffer cmd, const gpu::FrameView& view, GpuTimer* timer) noexcept
{
    owned->record(cmd, view, timer);
}

IndirectLight::Output IndirectLight::diffuse() const
{
    return outputOf(owned->diffuseImage);
}

IndirectLight::Output IndirectLight::rough() const
{
    return outputOf(owned->roughImage);
}

IndirectLight::Output IndirectLight::glossy() const
{
    return outputOf(owned->glossyImage);
}

IndirectLight::Output IndirectLight::mirror() const
{
    return outputOf(owned->mirrored());
}

IndirectLight::Output IndirectLight::counts() const
{
    return outputOf(owned->countImage);
}

uint32_t IndirectLight::made() const
{
    const auto bit = [](const GpuImage& image, uint32_t term) { return image ? 1u << term : 0u; };
    return bit(owned->diffuseImage, gpu::kTermDiffuse) | bit(owned->roughImage, gpu::kTermRough) |
           bit(owned->glossyImage, gpu::kTermGlossy) | bit(owned->mirrored(), gpu::kTermMirror);
}

uint64_t IndirectLight::deviceBytes() const
{
    return owned->deviceBytes();
}

} // namespace sconce
