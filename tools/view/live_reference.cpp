#include "tools/view/live_reference.h"

#include <algorithm>

#include <sys/resource.h>
#include <unistd.h>

#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

namespace sconce::tools
{

namespace
{

constexpr uint64_t kMostPaths = 65536; // a pixel, after which it rests
constexpr uint32_t kMostOfABatch = 16; // paths a pixel between two pictures

/// Linux gives each thread a priority of its own, by its number.
void yieldToOthers()
{
    setpriority(PRIO_PROCESS, id_t(gettid()), 19);
}

/// Lowers the priority of the workers that help in an arena.
class Yielding : public tbb::task_scheduler_observer
{
public:
    explicit Yielding(tbb::task_arena& arena) : tbb::task_scheduler_observer(arena) { observe(true); }
    ~Yielding() override { observe(false); }
    void on_scheduler_entry(bool) override { yieldToOthers(); }
};

} // namespace

LiveReference::LiveReference() : thread([this] { work(); }) {}

LiveReference::~LiveReference()
{
    {
        std::scoped_lock lock(mutex);
        ending = true;
        ++job.number;
    }
    changed.notify_all();
    thread.join();
}

void LiveReference::restart(std::shared_ptr<const Scene> scene, const ReferenceSettings& settings)
{
    {
        std::scoped_lock lock(mutex);
        job = {std::move(scene), settings, job.number + 1};
        fresh.reset();
        wrong.clear();
    }
    changed.notify_all();
}

void LiveReference::stop()
{
    restart(nullptr, {});
}

std::optional<LiveReference::Picture> LiveReference::take()
{
    std::scoped_lock lock(mutex);
    return std::exchange(fresh, std::nullopt);
}

std::string LiveReference::fault() const
{
    std::scoped_lock lock(mutex);
    return wrong;
}

bool LiveReference::current(uint64_t number) const
{
    std::scoped_lock lock(mutex);
    return number == job.number;
}

void LiveReference::fail(const std::string& sentence)
{
    std::scoped_lock lock(mutex);
    wrong = sentence;
}

void LiveReference::work()
{
    yieldToOthers();
    tbb::task_arena arena;
    const Yielding yielding(arena);
    std::shared_ptr<const Scene> built;
    std::optional<RayScene> rays; // of `built`
    uint64_t done = 0;
    while (true)
    {
        Job next;
        {
            std::unique_lock lock(mutex);
            changed.wait(lock, [&] { return ending || job.number != done; });
            if (ending) return;
            next = job;
        }
        done = next.number;
        if (!next.scene) continue;
        arena.execute(
            [&]
            {
                if (next.scene != built)
                {
                    rays.reset();
                    auto made = RayScene::create(*next.scene);
                    if (!made) return fail(made.error().message);
                    rays.emplace(std::move(*made));
                    built = next.scene;
                }
                grow(next, *rays);
            });
    }
}

void LiveReference::grow(const Job& wanted, const RayScene& rays)
{
    ReferenceSettings settings = wanted.settings;
    settings.guides = settings.parts = false;
    Reference all;
    uint64_t paths = 0;
    while (paths < kMostPaths)
    {
        // A first picture soon, of two paths, by which its noise can be told; then larger batches: what joins them costs the less.
        settings.samples = uint32_t(std::clamp<uint64_t>(paths, 2, kMostOfABatch));
        settings.firstPath = paths;
        auto batch = renderReference(rays, settings, [&](std::string_view, double) { return current(wanted.number); });
        if (!batch && batch.error().code == ErrorCode::cancelled) return;
        if (!batch) return fail(batch.error().message);
        all = paths == 0 ? std::move(*batch) : joined(all, paths, *batch, settings.samples);
        paths += settings.samples;
        const Layer* beauty = all.images.find("beauty");
        std::scoped_lock lock(mutex);
        if (wanted.number != job.number) return;
        fresh = Picture{beauty->pixels, settings.width, settings.height, paths, all.estimatedRelMse};
    }
}

} // namespace sconce::tools
