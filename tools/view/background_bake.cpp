#include "tools/view/background_bake.h"

#include <new>

#include "placement/place.h"
#include "runtime/bake/bake.h"
#include "runtime/frame/effect_plan.h"
#include "runtime/vulkan/host_vulkan.h"
#include "scene/scene_check.h"
#include "scene/triangle_rays.h"

namespace sconce::tools
{

BackgroundBake::BackgroundBake(const Scene& scene, std::string device)
{
    thread = std::thread(
        [this, &scene, device = std::move(device)]
        {
            Result<FieldData> field = Error{ErrorCode::outOfMemory, "There is not enough main memory to place and bake; lower --count or "
                                                                    "--resolution."};
            try
            {
                field = work(scene, device);
            }
            catch (const std::bad_alloc&) // said as above
            {
            }
            std::scoped_lock lock(mutex);
            made = std::move(field);
            now.finished = true;
        });
}

BackgroundBake::~BackgroundBake()
{
    {
        std::scoped_lock lock(mutex);
        cancelled = true;
    }
    thread.join();
}

BackgroundBake::State BackgroundBake::state() const
{
    std::scoped_lock lock(mutex);
    return now;
}

Result<FieldData> BackgroundBake::take()
{
    std::scoped_lock lock(mutex);
    return std::move(*made);
}

bool BackgroundBake::report(std::string_view stage, double done)
{
    std::scoped_lock lock(mutex);
    now.stage = stage;
    now.done = done;
    return !cancelled;
}

Result<FieldData> BackgroundBake::work(const Scene& scene, const std::string& device)
{
    const Progress progress = [this](std::string_view stage, double done) { return report(stage, done); };
    PlaceReport placed;
    auto probes = placeProbes(scene, {}, placed, progress);
    if (!probes) return probes.error();
    std::vector<vec3> positions;
    for (const PlacedProbe& probe : probes->probes) positions.push_back(probe.position);

    auto own = OwnDevice::create({.device = device});
    if (!own) return own.error();
    const auto gpu = Gpu::create(own->host());
    if (!gpu) return gpu.error();
    BakeSettings settings;
    const auto plan = planEffects(checkScene(scene));
    if (!plan) return plan.error();
    settings.take(*plan, false);
    auto rays = TriangleRays::build(scene);
    if (!rays) return rays.error();
    settings.rays = &*rays;
    BakeReport baked;
    return bakeLightField(**gpu, scene, positions, settings, progress, baked);
}

} // namespace sconce::tools
