#pragma once

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/view/session.h"
#include "tools/view/window.h"

namespace sconce::tools
{

/// What panel, script, keys and mouse change; the viewer makes each frame of it.
struct ViewState
{
    ViewKnobs knobs;
    LightChoice light;
    Camera camera;
    Shown shown;
    float speed = 1.0f;      // metres a second
    uint32_t everyPixel = 1; // of the window that is drawn, along each axis; the others repeat it
    bool panel = true;
    bool keepDrawing = true; // while nothing changes and no reference grows
    // Wishes, taken by the viewer.
    bool wantsShot = false, wantsExposure = false;
    // What there is to say.
    std::string message;         // the last thing that was done, or why not
    uint64_t referencePaths = 0; // a pixel
    double referenceError = 0.0; // relMSE that the reference itself has, estimated
};

/// The panel over the picture, by Dear ImGui. One a process; goes before its window.
class Panel
{
public:
    /// Errors: deviceFailure.
    static Result<std::unique_ptr<Panel>> create(Window& window);
    ~Panel();
    Panel(const Panel&) = delete;
    Panel& operator=(const Panel&) = delete;

    /// Begins a frame: whatever is built until record() is shown.
    void begin();
    void build(ViewState& state, const Session& session);
    void buildProgress(const std::string& stage, double done, const std::string& note);
    /// Draws what was built, in the window's render pass.
    void record(VkCommandBuffer cmd);

    bool wantsMouse() const;
    bool wantsKeyboard() const;
    /// Takes the times of a frame into the graph.
    void addTimes(const std::vector<GpuTimer::Scope>& times, double wallMs);

private:
    explicit Panel(Window& shown) : window(shown) {}
    Status make();
    void buildTimes(const Session& session);
    void buildView(ViewState& state);
    void buildKnobs(ViewState& state, bool ofTracer);
    void buildKnob(const LiveKnob& knob, ViewState& state);
    bool editNumber(const LiveKnob& knob, const std::string& shown, std::string& text);
    void buildEffects(ViewState& state, const Session& session);
    void buildLight(ViewState& state, const Session& session);

    struct History
    {
        double mean = 0.0; // of the frames that are kept
        std::deque<float> milliseconds;
    };
    Window& window;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    std::vector<std::string> passes;        // in the order of the frame
    std::map<std::string, History> history; // by pass
    History wall;
    std::map<std::string, double> edited; // numbers of knobs while they are dragged
    std::map<std::string, vec3> weights;  // of light groups
    vec3 sunDirection{0.0f, -1.0f, 0.0f}, sunIrradiance{1.0f};
    SunPlace sunTaken;                  // of the state, that the two above have followed
    std::vector<std::string> dimsTaken; // that the weights have
    bool sunRead = false;
};

} // namespace sconce::tools
