#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "bench/reference/reference.h"

namespace sconce::tools
{

/// A path-traced reference that grows while the viewer draws: in threads of the least priority, begun anew for another camera, size or
/// scene.
class LiveReference
{
public:
    struct Picture
    {
        std::vector<float> beauty; // [height][width][3], linear
        uint32_t width = 0, height = 0;
        uint64_t paths = 0;  // a pixel
        double relMse = 0.0; // of the mean against the limit, estimated
    };

    LiveReference();
    ~LiveReference(); // cancels and waits, for milliseconds
    LiveReference(const LiveReference&) = delete;
    LiveReference& operator=(const LiveReference&) = delete;

    /// @param scene  as it is drawn; the same handle keeps its hierarchy. @param settings  `samples` is ignored
    void restart(std::shared_ptr<const Scene> scene, const ReferenceSettings& settings);
    void stop();
    /// The picture as it has grown since it was last taken; none: it hasn't.
    std::optional<Picture> take();
    /// What ended it, a sentence; empty: nothing.
    std::string fault() const;

private:
    struct Job
    {
        std::shared_ptr<const Scene> scene; // null: nothing to do
        ReferenceSettings settings;
        uint64_t number = 0;
    };
    void work();
    void grow(const Job& job, const RayScene& rays);
    bool current(uint64_t number) const;
    void fail(const std::string& sentence);

    mutable std::mutex mutex; // of all below
    std::condition_variable changed;
    Job job;
    bool ending = false;
    std::optional<Picture> fresh;
    std::string wrong;
    std::thread thread; // last: it uses the rest
};

} // namespace sconce::tools
