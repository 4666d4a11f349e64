#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/field/live_light.h"
#include "runtime/scene/device_scene.h"
#include "runtime/vulkan/gpu_timer.h"
#include "tools/frame_setup.h"
#include "tools/view/live_knobs.h"
#include "tools/view/show.h"

namespace sconce::tools
{

/// How a scene's light is changed in the viewer.
struct LightChoice
{
    std::optional<SunPlace> sun;   // none: as the scene has it
    std::vector<std::string> dims; // NAME=W or NAME=R,G,B, as --dim

    bool any() const { return sun || !dims.empty(); }
};

/// A scene and its field on the device, drawn with knobs that change from frame to frame: what `sconce render` sets up once. Whatever a
/// change doesn't touch stays as it is.
class Session
{
public:
    struct Desc
    {
        Scene scene; // whole: effects take of it what they will
        FieldData field;
        std::string fieldName;              // for sentences
        std::vector<LightGroupDesc> groups; // of the scene, where the field has none
    };
    /// Errors: as makeLightField().
    static Result<std::unique_ptr<Session>> create(Gpu& gpu, Desc desc);

    ~Session(); // after waiting for the device
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Makes what the next frame needs. After an error there may be nothing to draw with, until it succeeds with other knobs.
    /// Errors: badArgument (a knob, an effect, a light: named), outOfMemory, deviceFailure.
    Status apply(const ViewKnobs& knobs, const LightChoice& light, uint32_t width, uint32_t height);
    /// Draws a frame and makes its picture. Light that moves settles on the way: a little a frame, or at once.
    /// Errors: badArgument (camera), deviceFailure.
    Status draw(const Camera& camera, const Shown& shown, bool settleAtOnce);
    /// Makes the picture of the last frame anew.
    Status redraw(const Shown& shown);
    /// The last frame in host memory.
    Result<RenderedFrame> read() { return renderer->read(); }
    bool ready() const { return renderer != nullptr; }
    void cut(); // the next frame doesn't follow the one before: camera or light jumped

    const std::vector<GpuTimer::Scope>& times() const { return lastTimes; } // of the last frame
    const EffectPlan& plan() const { return effects; }
    const RenderSettings& settings() const { return drawn; }
    const Scene& litScene() const { return *lit; } // as it is drawn
    std::shared_ptr<const Scene> litSceneShared() const { return lit; }
    uint64_t sceneVersion() const { return version; } // another when it is another
    const Scene& wholeScene() const { return desc.scene; }
    const FieldData& field() const { return desc.field; }
    const std::vector<std::string>& groups() const { return groupNames; } // that may be dimmed
    bool sunMoves() const { return desc.field.live.links > 0; }
    bool settled() const { return !live || live->settled(); }
    uint64_t deviceBytes() const;
    Show& show() { return *shown; }

private:
    Session(Gpu& made, Desc wanted) : gpu(made), desc(std::move(wanted)) {}
    Status relight(const LightChoice& light, const Lighting& lighting);
    Status rebuildScene(Scene scene, const RenderSettings& settings);
    Status rebuildRenderer(const RenderSettings& settings);
    void dropRenderer();

    Gpu& gpu;
    Desc desc;
    std::vector<std::string> groupNames;
    std::optional<LightField> lightField;
    std::optional<LiveLight> live;
    std::optional<LightGroups> lightGroups;
    std::optional<DeviceScene> deviceScene;
    vec3 eye{0.0f}; // of the last frame, metres
    std::unique_ptr<SceneRenderer> renderer;
    std::optional<Show> shown;
    std::optional<GpuTimer> timer;
    std::vector<GpuTimer::Scope> lastTimes;

    std::shared_ptr<const Scene> lit;
    uint64_t version = 0;
    EffectPlan effects;
    RenderSettings drawn;
    Quality quality;
    LightChoice lightNow;
    LightState liveState; // that `live` is set to
    std::string sceneKey; // what the scene on the device was made for
    uint32_t frame = 0;   // since the last cut
};

} // namespace sconce::tools
