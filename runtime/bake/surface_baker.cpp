#include "runtime/bake/surface_baker.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/numbers.h"
#include "runtime/field/tracer_cpu.h"
#include "runtime/vulkan/nan_scan.h"
#include "shaders/shared/pure.h"

#include "spirv/cell_gather_comp.h"
#include "spirv/surface_bounce_comp.h"
#include "spirv/surface_filter_comp.h"
#include "spirv/surface_gather_comp.h"
#include "spirv/surface_tilt_comp.h"

namespace sconce
{

Result<SurfaceBaker> SurfaceBaker::create(Gpu& gpu, const DeviceScene& scene, const LightField& field,
                                          std::span<const gpu::SurfaceTexel> texels, const Desc& desc)
{
    assert(desc.shadowRays <= gpu::kMostShadowRays && field.info().surfaceSize > 0);
    SurfaceBaker baker(gpu, scene, field, desc);
    if (auto status = baker.make(texels); !status) return status.error();
    return baker;
}

Status SurfaceBaker::make(std::span<const gpu::SurfaceTexel> asked)
{
    assert(asked.size() == texels());
    links.resize(asked.size() * desc.rays);
    auto known = gpu->makeBufferWith(asked, 0, "surface texels");
    if (!known) return known.error();
    texelBuffer = std::move(*known);
    std::vector<vec4> colours(gpu::kTints, vec4(1.0f));
    colours[0].w = 0.0f;
    if (desc.triangles) std::ranges::copy(desc.triangles->tints(), colours.begin());
    auto metals = gpu->makeBufferWith(std::span<const vec4>(colours), 0, "tints of metals");
    if (!metals) return metals.error();
    tints = std::move(*metals);
    struct Need
    {
        Buffer& buffer;
        uint64_t bytes;
        const char* what;
    };
    for (const Need& need : {Need{first, texels() * 16, "first light at surfaces"}, Need{light, texels() * 16, "light at surfaces"},
                             Need{sent, gpu::kSentKept * texels() * 4, "light that surfaces send"},
                             Need{reflected, gpu::kReflectionsCounted * texels() * 4, "light by specular reflection at surfaces"},
                             Need{filtered, words() * 4, "filtered light at surfaces"},
                             Need{tilts, directions() ? texels() * 16 : 0, "tilts of light at surfaces"},
                             Need{tilted, directions() ? texels() * 4 : 0, "filtered tilts of light at surfaces"},
                             Need{linkBuffer, texelsOfProbe() * std::max(desc.rays, 1u) * 4, "links of a probe's surfaces"}})
    {
        if (need.bytes == 0) continue;
        auto buffer = gpu->makeBuffer(need.bytes, 0, MemoryUse::device, need.what);
        if (!buffer) return buffer.error();
        need.buffer = std::move(*buffer);
    }
    const VkDescriptorSetLayout sets[] = {field.layout(), scene->layout()};
    const auto constants = shaderConstants(field);
    struct Pass
    {
        Pipeline* pipeline;
        Spirv code;
        size_t sets;
        bool ofFieldRays = false;
    };
    for (const auto& [pipeline, code, setCount, ofFieldRays] :
         {Pass{&gatherPass, surface_gather_comp, 2, true}, Pass{&cellPass, cell_gather_comp, 2, true},
          Pass{&bouncePass, surface_bounce_comp, 1}, Pass{&tiltPass, surface_tilt_comp, 1}, Pass{&filterPass, surface_filter_comp, 1}})
    {
        if (ofFieldRays && desc.triangles) continue; // two of the largest there are, and never run
        auto made = Pipeline::compute(*gpu, code, std::span(sets).first(setCount), sizeof(gpu::SurfacePush), constants,
                                      VK_PIPELINE_CREATE_DISPATCH_BASE_BIT);
        if (!made) return made.error();
        *pipeline = std::move(*made);
    }
    std::vector<uint32_t> direct(asked.size());
    std::ranges::transform(asked, direct.begin(), &gpu::SurfaceTexel::sent);
    // Sky is never written to: it stays 0.
    auto cleared = gpu->submit(
        [&](VkCommandBuffer cmd)
        {
            for (const Buffer* buffer : {&first, &light, &sent, &reflected})
                gpu->vk.CmdFillBuffer(cmd, buffer->handle(), 0, VK_WHOLE_SIZE, 0);
            if (directions()) gpu->vk.CmdFillBuffer(cmd, tilts.handle(), 0, VK_WHOLE_SIZE, 0);
        });
    if (!cleared) return cleared;
    return gpu->upload(sent, keptAt(bounceMade), std::as_bytes(std::span(direct)));
}

gpu::SurfacePush SurfaceBaker::pushFor(uint32_t probe, uint32_t rays) const
{
    gpu::SurfacePush push{};
    push.texels = texelBuffer.address();
    push.first = first.address();
    push.light = light.address();
    push.links = linkBuffer.address();
    push.tilts = directions() ? tilts.address() : 0;
    push.tilted = directions() ? tilted.address() : 0;
    push.reflected = reflected.address();
    push.tints = tints.address();
    push.sentKept = sent.address();
    push.sent = sent.address() + keptAt(bounceMade);
    push.bounce = uint32_t(std::max(bounceMade, 0));
    push.texelCount = uint32_t(texels());
    push.probe = probe;
    push.rays = rays;
    push.shadowRays = desc.shadowRays;
    push.offset = desc.offset;
    return push;
}

Status SurfaceBaker::dispatch(const Pipeline& pipeline, bool withScene, const gpu::SurfacePush& push, const char* name,
                              const Buffer* floats)
{
    const uint32_t side = (field.info().surfaceSize + 7) / 8;
    return dispatch(pipeline, withScene, push, name, glm::uvec3(side, side, 6), floats);
}

Status SurfaceBaker::dispatch(const Pipeline& pipeline, bool withScene, const gpu::SurfacePush& push, const char* name, glm::uvec3 groups,
                              const Buffer* floats)
{
    const uint32_t rows = groups.y * groups.z;
    desc.work->add(name, rows,
                   [&](VkCommandBuffer cmd, uint32_t firstRow, uint32_t count)
                   {
                       const VkDescriptorSet sets[] = {field.descriptorSet(), scene->descriptorSet()};
                       pipeline.bind(cmd, std::span(sets).first(withScene ? 2 : 1));
                       pipeline.push(cmd, push);
                       dispatchRows(*gpu, cmd, groups, firstRow, count);
                       if (floats && firstRow + count == rows) scanBuffer(*gpu, cmd, name, *floats, {});
                       // For the copies out, which are of the next submit.
                       memoryBarrier(*gpu, cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                     VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT);
                   });
    return desc.work->run();
}

Status SurfaceBaker::findCells()
{
    if (!desc.triangles || !cells.places.empty()) return success();
    if (auto kept = desc.parts.takeCells(cellWords(field.info()) / gpu::kCellWords, desc.rays))
    {
        cells = std::move(*kept);
        return success();
    }
    cells = desc.triangles->gatherCells();
    return desc.parts.keepCells(cells);
}

Status SurfaceBaker::gatherTriangles(uint32_t probe)
{
    const size_t count = texelsOfProbe();
    std::vector<vec4> straight(count), arriving(count), moments(directions() ? count : 0);
    std::vector<gpu::SurfaceTexel> sending(count);
    std::vector<uint32_t> shine(gpu::kReflectionsCounted * count), direct(desc.live ? count : 0);
    const std::span<uint32_t> ends = std::span(links).subspan(probe * count * desc.rays, count * desc.rays);
    if (!desc.parts.take(BakeStage::gather, probe,
                         {asWritableBytes(ends), asWritableBytes(straight), asWritableBytes(arriving), asWritableBytes(shine),
                          asWritableBytes(moments), asWritableBytes(sending), asWritableBytes(direct)}))
    {
        desc.triangles->gather(probe, {ends, straight, arriving, shine, moments, sending, direct});
        auto kept = desc.parts.keep(
            BakeStage::gather, probe,
            {asBytes(ends), asBytes(straight), asBytes(arriving), asBytes(shine), asBytes(moments), asBytes(sending), asBytes(direct)});
        if (!kept) return kept;
    }
    for (size_t i = 0; i < direct.size(); ++i)
    {
        const uint32_t reach = straight[i].w > 0.0f ? twin::LightFieldTwin<float>::packReach(straight[i].w) : 0u;
        const bool known = (sending[i].normal & gpu::kSurfaceKnown) != 0;
        liveTexels.push_back({known ? sending[i].albedo : 0u, direct[i], known ? sending[i].normal | reach << gpu::kReachShift : 0u});
    }
    const auto write = [&](const Buffer& buffer, const auto& values)
    { return values.empty() ? success() : gpu->upload(buffer, probe * count * sizeof(values[0]), std::as_bytes(std::span(values))); };
    if (auto status = write(first, straight); !status) return status;
    if (auto status = write(light, arriving); !status) return status;
    for (size_t i = 0; i < gpu::kReflectionsCounted; ++i)
    {
        const auto part = std::as_bytes(std::span(shine).subspan(i * count, count));
        if (auto status = gpu->upload(reflected, 4 * (i * texels() + probe * count), part); !status) return status;
    }
    if (auto status = write(tilts, moments); !status) return status;
    return write(texelBuffer, sending);
}

Status SurfaceBaker::gatherThroughField(uint32_t probe)
{
    const size_t count = texelsOfProbe();
    const std::span<uint32_t> ends = std::span(links).subspan(probe * count * desc.rays, count * desc.rays);
    if (!desc.parts.kept())
    {
        if (auto status = dispatch(gatherPass, true, pushFor(probe, desc.rays), "surface gather", &first); !status) return status;
        return gpu->download(linkBuffer, 0, std::as_writable_bytes(ends));
    }
    std::vector<vec4> straight(count), arriving(count), moments(directions() ? count : 0);
    struct Array
    {
        const Buffer& buffer;
        std::span<vec4> values;
    };
    const Array arrays[] = {{first, straight}, {light, arriving}, {tilts, moments}};
    if (desc.parts.take(BakeStage::gather, probe,
                        {asWritableBytes(ends), asWritableBytes(straight), asWritableBytes(arriving), asWritableBytes(moments)}))
    {
        for (const Array& array : arrays)
            if (auto status =
                    array.values.empty() ? success() : gpu->upload(array.buffer, probe * count * sizeof(vec4), asBytes(array.values));
                !status)
                return status;
        return success();
    }
    if (auto status = dispatch(gatherPass, true, pushFor(probe, desc.rays), "surface gather", &first); !status) return status;
    if (auto status = gpu->download(linkBuffer, 0, std::as_writable_bytes(ends)); !status) return status;
    for (const Array& array : arrays)
        if (auto status = array.values.empty()
                              ? success()
                              : gpu->download(array.buffer, probe * count * sizeof(vec4), std::as_writable_bytes(array.values));
            !status)
            return status;
    return desc.parts.keep(BakeStage::gather, probe, {asBytes(ends), asBytes(straight), asBytes(arriving), asBytes(moments)});
}

Status SurfaceBaker::gather(uint32_t probe)
{
    return desc.triangles ? gatherTriangles(probe) : gatherThroughField(probe);
}

/// A probe's links, to the buffer that holds one probe's.
Status SurfaceBaker::upload(uint32_t probe)
{
    const size_t count = texelsOfProbe() * desc.rays;
    return gpu->upload(linkBuffer, 0, std::as_bytes(std::span(links).subspan(probe * count, count)));
}

Status SurfaceBaker::bounce()
{
    ++bounceMade;
    const uint32_t rays = bounceMade > 0 ? desc.rays : 0;
    for (uint32_t probe = 0; probe < field.info().probeCount; ++probe)
    {
        if (rays > 0)
            if (auto status = upload(probe); !status) return status;
        if (auto status = dispatch(bouncePass, false, pushFor(probe, rays), "surface bounce", &light); !status) return status;
    }
    if (bounceMade > 0) return success();
    // Before the first bounce nothing was scattered that reflections could ask for.
    return gpu->submit([&](VkCommandBuffer cmd) { gpu->vk.CmdFillBuffer(cmd, sent.handle(), keptAt(-1), texels() * 4, 0); });
}

Result<double> SurfaceBaker::meanSent()
{
    const uint32_t side = field.info().surfaceSize;
    std::vector<uint32_t> words(texels());
    if (auto status = gpu->download(sent, keptAt(bounceMade), std::as_writable_bytes(std::span(words))); !status) return status.error();
    double sum = 0.0, all = 0.0;
    for (size_t i = 0; i < words.size(); ++i)
    {
        const glm::dvec2 uv = (glm::dvec2(i % side, i / side % side) + 0.5) * (2.0 / side) - 1.0;
        const double stretch = 1.0 + glm::dot(uv, uv), solidAngle = 1.0 / (stretch * std::sqrt(stretch));
        sum += solidAngle * glm::dot(Pure<float>::unpackSharedExponent(words[i]), kLuminance);
        all += solidAngle;
    }
    return sum / all;
}

/// Of what the texels sent before the last bounce, as what arrived at them.
Status SurfaceBaker::gatherCells()
{
    gpu::SurfacePush push = pushFor(0, desc.rays);
    push.sent = filtered.address();
    const size_t facings = 6 * cellWords(field.info()) / gpu::kCellWords;
    const size_t row = size_t(gpu::kCellGroup) * gpu::kCellRow;
    return dispatch(cellPass, true, push, "cell gather", glm::uvec3(gpu::kCellRow, (facings + row - 1) / row, 1), nullptr);
}

/// The same from what rays to triangles found.
Status SurfaceBaker::cellsFromTriangles(std::span<uint32_t> found)
{
    const auto before = sentBefore();
    if (!before) return before.error();
    desc.triangles->lightCells(cells, *before, found);
    return success();
}

Result<TriangleGather::Sent> SurfaceBaker::sentBefore()
{
    TriangleGather::Sent words;
    for (size_t reflections = 0; reflections < words.size(); ++reflections)
    {
        words[reflections].resize(texels());
        const VkDeviceSize at = keptAt(bounceMade - 1 - int(reflections));
        if (auto status = gpu->download(sent, at, std::as_writable_bytes(std::span(words[reflections]))); !status) return status.error();
    }
    return words;
}

/// Of the light after the last bounce.
Status SurfaceBaker::findTilts()
{
    for (uint32_t probe = 0; probe < field.info().probeCount; ++probe)
    {
        if (auto status = upload(probe); !status) return status;
        if (auto status = dispatch(tiltPass, false, pushFor(probe, desc.rays), "surface tilt", &tilts); !status) return status;
    }
    return success();
}

Status SurfaceBaker::read(std::span<uint32_t> found)
{
    assert(found.size() == words());
    if (directions())
        if (auto status = findTilts(); !status) return status;
    for (uint32_t probe = 0; probe < field.info().probeCount; ++probe)
    {
        gpu::SurfacePush push = pushFor(probe, 0);
        push.sent = filtered.address();
        if (auto status = dispatch(filterPass, false, push, "surface filter", nullptr); !status) return status;
    }
    if (!desc.triangles)
        if (auto status = gatherCells(); !status) return status;
    if (auto status = gpu->download(filtered, 0, std::as_writable_bytes(found)); !status) return status;
    if (desc.triangles)
        if (auto status = cellsFromTriangles(found.subspan(surfaceTexelWords(field.info()))); !status) return status;
    if (!directions()) return success();
    std::vector<uint32_t> halves(texels());
    if (auto status = gpu->download(tilted, 0, std::as_writable_bytes(std::span(halves))); !status) return status;
    const std::span<uint32_t> packed = found.subspan(texels(), (texels() + 1) / 2);
    std::ranges::fill(packed, 0u);
    for (size_t i = 0; i < halves.size(); ++i) packed[i / 2] |= halves[i] << (16 * (i & 1));
    return success();
}

Status SurfaceBaker::refine(FieldData& data, float share, LightLayout* layout)
{
    if (!desc.triangles) return success();
    const auto before = sentBefore();
    if (!before) return before.error();
    lightHiddenSurfaces(data, *desc.triangles, *before, layout ? &layout->hidden : nullptr);
    refineTexels(data, *desc.triangles, *before, share, layout ? &layout->refined : nullptr);
    return success();
}

LiveTransport SurfaceBaker::transport(const FieldData& data, uint32_t count, const HiddenPlaces& hidden) const
{
    assert(desc.live && desc.triangles && count <= desc.rays && liveTexels.size() == texels());
    LiveTransport live;
    live.links = count;
    live.texels = liveTexels;
    for (uint32_t probe = 0; probe < data.info.probeCount; ++probe)
    {
        const auto own = links.begin() + std::ptrdiff_t(probe * texelsOfProbe() * desc.rays);
        live.texelLinks.insert(live.texelLinks.end(), own, own + std::ptrdiff_t(texelsOfProbe() * count));
    }
    std::vector<std::vector<uint32_t>> linksOf; // of each place
    for (size_t facing = 0; facing < cells.straight.size(); ++facing)
    {
        if (cells.straight[facing].x < 0.0f) continue;
        live.places.push_back(uint32_t(surfaceTexelWords(data.info) + gpu::kCellWords * (facing / 6) + facing % 6));
        const auto own = cells.links.begin() + std::ptrdiff_t(facing * desc.rays);
        linksOf.emplace_back(own, own + std::ptrdiff_t(count));
    }
    const std::vector<HiddenLinks> below = hiddenLinks(data, hidden, *desc.triangles, count);
    for (const HiddenLinks& place : below)
    {
        live.places.push_back(place.word);
        linksOf.push_back(place.links);
    }
    live.placeLinks.resize(count * live.places.size());
    for (size_t place = 0; place < linksOf.size(); ++place)
        for (size_t i = 0; i < count; ++i) live.placeLinks[i * live.places.size() + place] = linksOf[place][i];
    live.tints.assign(desc.triangles->tints().begin(), desc.triangles->tints().end());
    live.tints.resize(gpu::kTints, vec3(1.0f));
    return live;
}

} // namespace sconce
