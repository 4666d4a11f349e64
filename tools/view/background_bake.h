#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "base/result.h"
#include "runtime/field/field_data.h"
#include "scene/scene.h"

namespace sconce::tools
{

/// Places probes and bakes their light field with every default of `place` and `bake`, in a thread and on a device of its own, so that a
/// window answers meanwhile.
class BackgroundBake
{
public:
    /// @param scene  outlives this. @param device  as OwnDevice::Desc
    BackgroundBake(const Scene& scene, std::string device);
    ~BackgroundBake(); // cancels and waits
    BackgroundBake(const BackgroundBake&) = delete;
    BackgroundBake& operator=(const BackgroundBake&) = delete;

    struct State
    {
        std::string stage; // as Progress names it
        double done = 0.0; // share of the stage
        bool finished = false;
    };
    State state() const;
    /// Once it has finished. Errors: as placeProbes() and bakeLightField().
    Result<FieldData> take();

private:
    Result<FieldData> work(const Scene& scene, const std::string& device);
    bool report(std::string_view stage, double done);

    mutable std::mutex mutex; // of all below
    State now;
    bool cancelled = false;
    std::optional<Result<FieldData>> made;
    std::thread thread; // last: it uses the rest
};

} // namespace sconce::tools
