#include "tools/view/viewer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <tuple>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "tools/frame_pictures.h"
#include "tools/view/background_bake.h"
#include "tools/view/live_reference.h"
#include "tools/view/panel.h"
#include "tools/view/walk.h"

namespace sconce::tools
{

namespace
{

constexpr float kLookSpeed = 0.003f;     // radians a pixel of the mouse's way
constexpr uint32_t kPictureSettles = 16; // frames, until what reflections show of reflections has come

const Error kInterrupted{ErrorCode::cancelled, "Interrupted; the window was closed."};

double now()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool sameKnobs(const ViewKnobs& a, const ViewKnobs& b)
{
    const auto tied = [](const gpu::TraceQuality& t)
    { return std::tie(t.ranked, t.maxHandoffs, t.startLevel, t.coarsestLevel, t.tolerance, t.epsilon, t.opinion, t.farBounds, t.order); };
    return a.frame == b.frame && a.normalOffset == b.normalOffset && tied(a.quality.trace) == tied(b.quality.trace);
}

bool sameCamera(const Camera& a, const Camera& b)
{
    return a.eye == b.eye && a.forward == b.forward && a.up == b.up && a.verticalFov == b.verticalFov;
}

class Viewer
{
public:
    Viewer(ViewDesc wanted, const Context& told) : desc(std::move(wanted)), context(told) {}
    Status run();

private:
    Status bake();
    Status start();
    Status goOn(); // until the window is closed
    Status frame(WindowPicture* grab = nullptr);
    Status apply();
    Status expose();
    void followReference();
    bool rests() const;
    void control();
    bool closing() const { return window->closed() || interrupted(); }

    Status play(const ScriptStep& step);
    Status playChange(const ScriptStep& step);
    Status playView(const std::string& name);
    Status playFrames(uint32_t count);
    Status playShot(const std::string& file);
    Status playScreen(const std::string& file);
    Status playCompare(const ScriptStep& step);
    void saveShot();
    Error at(const ScriptStep& step, const Error& error) const;

    ViewDesc desc;
    const Context& context;
    // In the order of making: the later use the earlier.
    std::unique_ptr<Window> window;
    std::unique_ptr<Panel> panel;
    std::unique_ptr<Session> session;
    std::optional<LiveReference> reference;

    ViewState state;
    ViewKnobs applied;
    LightChoice appliedLight;
    bool drawn = false;             // the last frame is of the state as it is now
    uint32_t stillFrames = 0;       // drawn since it or the camera has changed
    bool exposed = false;           // state.shown.exposure is of the picture
    uint32_t width = 0, height = 0; // of the picture
    Camera lastCamera;
    Camera referenceCamera;
    uint64_t referenceScene = 0, referenceSize = 0;
    std::optional<float> referenceRoughness;
    bool referenceRuns = false;
    double lastTime = 0.0, mouseX = 0.0, mouseY = 0.0;
    bool panelKeyDown = false, scripted = false;
    uint32_t shots = 0;
};

Status Viewer::run()
{
    scripted = !desc.script.empty();
    auto opened = Window::create({fmt::format("Sconce: {}", desc.scene.name), desc.width, desc.height, scripted, desc.device});
    if (!opened) return opened.error();
    window = std::move(*opened);
    auto made = Panel::create(*window);
    if (!made) return made.error();
    panel = std::move(*made);
    if (!desc.field)
        if (Status baked = bake(); !baked) return baked;
    if (closing()) return interrupted() ? Status(kInterrupted) : success();
    if (Status started = start(); !started) return started;
    for (const ScriptStep& step : desc.script)
    {
        if (step.command == ScriptCommand::quit) return success();
        if (Status played = play(step); !played)
            return played.error().code == ErrorCode::cancelled ? played.error() : at(step, played.error());
        if (closing()) return interrupted() ? Status(kInterrupted) : success();
    }
    return goOn();
}

Error Viewer::at(const ScriptStep& step, const Error& error) const
{
    return {error.code, fmt::format("The script '{}', line {}: {}", desc.scriptName, step.line, error.message)};
}

/// Places and bakes with every default, while the window shows how far it is.
Status Viewer::bake()
{
    BackgroundBake job(desc.scene, desc.device);
    const Progress progress = consoleProgress(context);
    while (!job.state().finished)
    {
        window->wait(0.1);
        const BackgroundBake::State now = job.state();
        if (closing()) return interrupted() ? Status(kInterrupted) : success();
        if (now.stage.empty()) continue;
        progress(now.stage, std::min(now.done, 0.999));
        panel->begin();
        panel->buildProgress(now.stage, now.done, "No --field is given: probes are placed and their light is baked, with every default.");
        if (Status shown = window->present(nullptr, [&](VkCommandBuffer cmd) { panel->record(cmd); }); !shown) return shown;
    }
    endProgress();
    auto field = job.take();
    if (!field) return field.error();
    desc.field = std::move(*field);
    desc.fieldName = "baked here";
    return success();
}

Status Viewer::start()
{
    state.knobs.frame = desc.frame;
    state.knobs.exposure = desc.exposure;
    state.camera = lastCamera = desc.camera;
    state.speed = walkSpeed(desc.scene);
    state.shown.depthMiddle = 0.25f * desc.scene.bounds().diagonal();
    auto made = Session::create(window->gpu(), {std::move(desc.scene), std::move(*desc.field), desc.fieldName, desc.groups});
    if (!made) return made.error();
    session = std::move(*made);
    lastTime = now();
    if (!scripted) return success();
    const VkExtent2D size = window->extent();
    if (size.width == desc.width && size.height == desc.height) return success();
    return Error{ErrorCode::deviceFailure, fmt::format("The desktop made the window {} x {} instead of {} x {}; give a smaller --size.",
                                                       size.width, size.height, desc.width, desc.height)};
}

/// Makes what panel and script have changed.
Status Viewer::apply()
{
    const VkExtent2D size = window->extent();
    const uint32_t every = state.everyPixel, wide = std::max(1u, size.width / every), high = std::max(1u, size.height / every);
    const bool otherLight = state.light.dims != appliedLight.dims || state.light.sun.has_value() != appliedLight.sun.has_value() ||
                            (state.light.sun && (state.light.sun->direction != appliedLight.sun->direction ||
                                                 state.light.sun->irradiance != appliedLight.sun->irradiance));
    if (session->ready() && !otherLight && wide == width && high == height && sameKnobs(state.knobs, applied)) return success();
    Status made = session->apply(state.knobs, state.light, wide, high);
    if (!made && scripted) return made;
    if (!made)
    {
        // As it was; if even that is gone, so is the viewer.
        if (!session->ready() && sameKnobs(state.knobs, applied) && !otherLight) return made;
        state.message = made.error().message;
        state.knobs = applied;
        state.light = appliedLight;
        made = session->apply(state.knobs, state.light, wide, high);
        if (!made) return made;
    }
    if (otherLight) exposed = exposed && !scripted;
    applied = state.knobs;
    appliedLight = state.light;
    width = wide;
    height = high;
    drawn = false;
    return success();
}

/// Exposes for the picture that was drawn.
Status Viewer::expose()
{
    if (state.knobs.exposure)
    {
        state.shown.exposure = *state.knobs.exposure;
        exposed = false; // once it is taken back
        return success();
    }
    if (exposed && !state.wantsExposure) return success();
    auto frame = session->read();
    if (!frame) return frame.error();
    const ImageSet images = imagesOf(*frame);
    state.shown.exposure = autoExposure(images.find("beauty")->pixels);
    exposed = true;
    state.wantsExposure = false;
    return success();
}

/// Keeps the reference to what is drawn, and takes what it has grown to.
void Viewer::followReference()
{
    if (state.shown.compare == 0)
    {
        if (referenceRuns) reference->stop();
        referenceRuns = false;
        return;
    }
    if (!reference) reference.emplace();
    const uint64_t size = uint64_t(width) << 32 | height;
    const std::optional<float> roughness = applied.frame.roughness;
    if (!referenceRuns || !sameCamera(referenceCamera, state.camera) || referenceScene != session->sceneVersion() ||
        referenceSize != size || referenceRoughness != roughness)
    {
        ReferenceSettings settings;
        settings.width = width;
        settings.height = height;
        settings.camera = state.camera;
        settings.roughness = roughness;
        settings.pixelCentre = true; // as a rasteriser's pixels: no edge differs by how it is smoothed
        reference->restart(session->litSceneShared(), settings);
        referenceCamera = state.camera;
        referenceScene = session->sceneVersion();
        referenceSize = size;
        referenceRoughness = roughness;
        referenceRuns = true;
        state.referencePaths = 0;
        session->show().dropReference();
    }
    if (const std::string fault = reference->fault(); !fault.empty()) state.message = fault;
    const auto grown = reference->take();
    if (!grown || grown->width != width || grown->height != height) return;
    if (const Status set = session->show().setReference(grown->beauty); !set) state.message = set.error().message;
    state.referencePaths = grown->paths;
    state.referenceError = grown->relMse;
}

/// Whether the picture as it was drawn is still right, and time is better spent on the reference, or not at all.
bool Viewer::rests() const
{
    const IndirectEffects& effects = session->settings().effects;
    // Reflections of what the frame before showed are of a frame more each time.
    const bool asksPicture = effects.screenTrace && (effects.glossy || effects.mirror);
    const bool still = drawn && sameCamera(lastCamera, state.camera) && !effects.temporal &&
                       stillFrames >= (asksPicture ? kPictureSettles : 1) && session->settled();
    return still && !scripted && (state.shown.compare != 0 || !state.keepDrawing);
}

Status Viewer::frame(WindowPicture* grab)
{
    if (Status made = apply(); !made) return made;
    followReference();
    const double begun = now();
    const bool resting = rests();
    if (!resting)
        if (Status made = session->draw(state.camera, state.shown, scripted); !made) return made;
    const float before = state.shown.exposure;
    if (Status done = expose(); !done) return done;
    if (resting || state.shown.exposure != before)
        if (Status made = session->redraw(state.shown); !made) return made;
    if (!resting) stillFrames = drawn && sameCamera(lastCamera, state.camera) ? stillFrames + 1 : 1;
    drawn = true;
    lastCamera = state.camera;
    const bool withPanel = state.panel;
    if (withPanel)
    {
        panel->begin();
        panel->build(state, *session);
    }
    const Status shown = window->present(
        &session->show().target(),
        [&](VkCommandBuffer cmd)
        {
            if (withPanel) panel->record(cmd);
        },
        grab);
    if (!resting) panel->addTimes(session->times(), 1e3 * (now() - begun));
    return shown;
}

/// Keys and mouse.
void Viewer::control()
{
    GLFWwindow* const keys = window->handle();
    const auto down = [&](int key) { return glfwGetKey(keys, key) == GLFW_PRESS; };
    const auto axis = [&](int plus, int minus) { return float(down(plus)) - float(down(minus)); };
    const double time = now();
    Step step;
    step.seconds = float(std::min(time - lastTime, 0.25));
    lastTime = time;
    double x = 0.0, y = 0.0;
    glfwGetCursorPos(keys, &x, &y);
    const bool panelHasMouse = state.panel && panel->wantsMouse(), panelHasKeys = state.panel && panel->wantsKeyboard();
    const bool looking = glfwGetMouseButton(keys, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS && !panelHasMouse;
    if (looking) step.turn = kLookSpeed * vec2(float(x - mouseX), float(mouseY - y));
    mouseX = x, mouseY = y;
    if (!panelHasKeys) step.move = {axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_W, GLFW_KEY_S)};
    step.fast = down(GLFW_KEY_LEFT_SHIFT) || down(GLFW_KEY_RIGHT_SHIFT);
    walk(state.camera, step, state.speed);
    if (down(GLFW_KEY_F1) && !panelKeyDown) state.panel = !state.panel;
    panelKeyDown = down(GLFW_KEY_F1);
    if (down(GLFW_KEY_ESCAPE)) glfwSetWindowShouldClose(keys, GLFW_TRUE);
}

Status Viewer::goOn()
{
    scripted = false;
    while (!closing())
    {
        if (window->minimised())
        {
            window->wait(0.2);
            continue;
        }
        if (rests())
            window->wait(0.05);
        else
            window->poll();
        control();
        if (Status made = frame(); !made) return made;
        if (state.wantsShot) saveShot();
    }
    return interrupted() ? Status(kInterrupted) : success();
}

void Viewer::saveShot()
{
    state.wantsShot = false;
    std::string name;
    do name = fmt::format("sconce-{}", ++shots);
    while (std::filesystem::exists(name + ".exr") || std::filesystem::exists(name + ".png"));
    for (const char* kind : {".exr", ".png"})
        if (const Status saved = playShot(name + kind); !saved)
        {
            state.message = saved.error().message;
            return;
        }
    state.message = fmt::format("Wrote {}.exr and {}.png.", name, name);
}

Status Viewer::playShot(const std::string& file)
{
    if (!drawn)
        if (Status made = frame(); !made) return made;
    auto frame = session->read();
    if (!frame) return frame.error();
    const ImageSet images = imagesOf(*frame);
    if (file.ends_with(".exr")) return writeExr(images, file);
    const std::vector<float>& beauty = images.find("beauty")->pixels;
    return writePng(toneMap(beauty, state.knobs.exposure.value_or(autoExposure(beauty))), images.width, images.height, file);
}

Status Viewer::playScreen(const std::string& file)
{
    WindowPicture picture;
    // The last frame's picture with the panel as it is now.
    if (Status made = frame(&picture); !made) return made;
    if (picture.rgb.empty()) return Error{ErrorCode::deviceFailure, "The window shows nothing now; it may be minimised."};
    // writePng() encodes; it gives back the bytes that it is given decoded.
    std::vector<float> linear(picture.rgb.size());
    for (size_t i = 0; i < linear.size(); ++i)
    {
        const float s = float(picture.rgb[i]) / 255.0f;
        linear[i] = s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
    }
    return writePng(linear, picture.width, picture.height, file);
}

Status Viewer::playCompare(const ScriptStep& step)
{
    const auto found = std::ranges::find(kCompares, step.words[0]);
    if (found == kCompares.end())
        return Error{ErrorCode::badArgument,
                     fmt::format("there is no comparison '{}'; there are {}.", step.words[0], fmt::join(kCompares, ", "))};
    state.shown.compare = uint32_t(found - kCompares.begin());
    if (state.shown.compare == 0) return success();
    state.shown.view = 0;
    if (Status made = apply(); !made) return made;
    followReference();
    // Without drawing meanwhile: on a software device the reference would get no time at all.
    while (state.referencePaths < step.count && !closing())
    {
        window->wait(0.02);
        followReference();
        if (const std::string fault = reference->fault(); !fault.empty()) return Error{ErrorCode::badInput, fault};
    }
    return success();
}

/// A step that changes what is drawn.
Status Viewer::playChange(const ScriptStep& step)
{
    const std::vector<std::string>& words = step.words;
    switch (step.command)
    {
    case ScriptCommand::camera:
        state.camera = lookAt(step.eye, step.target, state.camera.verticalFov);
        break;
    case ScriptCommand::set:
        if (const std::string fault = setKnob(state.knobs, words[0], words[1]); !fault.empty())
            return Error{ErrorCode::badArgument, fault + "."};
        break;
    case ScriptCommand::effect:
    {
        if (Status made = apply(); !made) return made; // its plan says what is on
        auto wanted = effectsWith(session->plan(), words[0], step.on);
        if (!wanted) return wanted.error();
        state.knobs.frame.effects = *wanted;
        break;
    }
    case ScriptCommand::effects:
        state.knobs.frame.effects = words[0];
        break;
    case ScriptCommand::sun:
        state.light.sun = SunPlace{glm::normalize(step.eye), step.on ? std::optional(step.target) : std::nullopt};
        break;
    default: // dim
        std::erase_if(state.light.dims, [&](const std::string& dim) { return dim.starts_with(words[0] + "="); });
        state.light.dims.push_back(words[0] + "=" + words[1]);
    }
    if (Status made = apply(); !made) return made;
    drawn = exposed = false;
    session->cut();
    return success();
}

Status Viewer::playView(const std::string& name)
{
    const auto found = std::ranges::find(kViews, name);
    if (found == kViews.end())
        return Error{ErrorCode::badArgument, fmt::format("there is no view '{}'; there are {}.", name, fmt::join(kViews, ", "))};
    state.shown.view = uint32_t(found - kViews.begin());
    return success();
}

Status Viewer::playFrames(uint32_t count)
{
    for (uint32_t i = 0; i < count && !closing(); ++i)
    {
        window->poll();
        if (Status made = frame(); !made) return made;
    }
    return success();
}

Status Viewer::play(const ScriptStep& step)
{
    window->poll();
    switch (step.command)
    {
    case ScriptCommand::view:
        return playView(step.words[0]);
    case ScriptCommand::compare:
        return playCompare(step);
    case ScriptCommand::panel:
        state.panel = step.on;
        return success();
    case ScriptCommand::frame:
        return playFrames(step.count);
    case ScriptCommand::shot:
        return playShot(step.words[0]);
    case ScriptCommand::screen:
        return playScreen(step.words[0]);
    default:
        return playChange(step);
    }
}

} // namespace

bool hasViewer()
{
    return true;
}

Status runViewer(ViewDesc desc, const Context& context)
{
    return Viewer(std::move(desc), context).run();
}

} // namespace sconce::tools
