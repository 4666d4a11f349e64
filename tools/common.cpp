#include "tools/common.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <iostream>

#include <sys/resource.h>
#include <unistd.h>

#include <fmt/format.h>

#include "base/listed.h"
#include "scene/named_scene.h"
#include "tools/view/walk.h"

namespace sconce::tools
{

int exitCode(ErrorCode code)
{
    switch (code)
    {
    case ErrorCode::badArgument:
        return exitUsage;
    case ErrorCode::badInput:
        return exitInput;
    case ErrorCode::missingFeature:
    case ErrorCode::deviceFailure:
    case ErrorCode::outOfMemory:
        return exitDevice;
    case ErrorCode::fileError:
        return exitFile;
    case ErrorCode::cancelled:
        return exitInterrupted;
    }
    return exitInput;
}

std::string spelledForShell(int argc, const char* const* argv)
{
    std::string line = "sconce";
    for (int i = 1; i < argc; ++i)
    {
        const std::string argument = argv[i];
        const bool plain = !argument.empty() && argument.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                                                           "-_=+:,./@%") == std::string::npos;
        line += ' ';
        if (plain)
        {
            line += argument;
            continue;
        }
        line += '\'';
        for (const char c : argument) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
        line += '\'';
    }
    return line;
}

CLI::App* addCommand(CLI::App& app, Context& context, const std::string& name, const std::string& description)
{
    CLI::App* command = app.add_subcommand(name, description);
    command->add_flag("--json", context.json, described("Machine-readable results on stdout", words("text")));
    command->add_flag("--quiet,-q", context.quiet, described("No progress and no notes on stderr, errors only", words("off")));
    return command;
}

int fail(const Error& error)
{
    endProgress();
    const bool ended = error.message.ends_with('.') || error.message.ends_with('!');
    std::cerr << "sconce: " << error.message << (ended ? "" : ".") << std::endl;
    return exitCode(error.code);
}

int fail(ErrorCode code, const std::string& message)
{
    return fail(Error{code, message});
}

void print(const Json& json)
{
    std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << std::endl;
}

void note(const Context& context, const std::string& text)
{
    if (context.quiet) return;
    endProgress();
    std::cerr << text << std::endl;
}

// ---- progress

namespace
{

std::atomic<bool> interruptedFlag{false};
bool barDrawn = false;

double now()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string minutes(double seconds)
{
    char text[32];
    std::snprintf(text, sizeof(text), "%d:%02d", int(seconds) / 60, int(seconds) % 60);
    return text;
}

struct ProgressState
{
    std::string stage;
    double stageStart = 0.0;
    double lastShown = -1e9;
    double lastDone = 0.0;
};

} // namespace

void catchInterrupts()
{
    struct sigaction action = {};
    action.sa_handler = [](int) { interruptedFlag = true; };
    action.sa_flags = SA_RESETHAND; // a second Ctrl-C ends the process at once
    for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

bool interrupted()
{
    return interruptedFlag;
}

void endProgress()
{
    if (barDrawn) std::cerr << std::endl;
    barDrawn = false;
}

Progress consoleProgress(const Context& context)
{
    if (context.quiet) return [](std::string_view, double) { return !interrupted(); };
    const bool terminal = isatty(STDERR_FILENO) != 0;
    return [terminal, state = std::make_shared<ProgressState>()](std::string_view stage, double done)
    {
        const double time = now();
        const bool fresh = stage != state->stage;
        if (fresh)
        {
            endProgress();
            *state = {std::string(stage), time, -1e9, 0.0};
        }
        done = std::clamp(done, 0.0, 1.0);
        // A bar follows the work; a log gets a line when a stage begins, ends, and every few seconds between.
        const bool finished = done >= 1.0 && state->lastDone < 1.0;
        if (!fresh && state->lastDone >= 1.0) return !interrupted();
        if (!fresh && !finished && time - state->lastShown < (terminal ? 0.1 : 5.0)) return !interrupted();
        state->lastShown = time;
        state->lastDone = done;
        const double elapsed = time - state->stageStart;
        std::string text = fmt::format("{} %", int(100.0 * done));
        if (done >= 1.0)
            text += fmt::format(", took {}", minutes(elapsed));
        else if (done > 0.02 && elapsed > 1.0)
            text += fmt::format(", {} left", minutes(elapsed * (1.0 - done) / done));
        if (terminal)
        {
            const int filled = int(24.0 * done);
            std::cerr << "\r\x1b[K[" << std::string(size_t(filled), '#') << std::string(size_t(24 - filled), ' ') << "] " << stage << ": "
                      << text << std::flush;
            barDrawn = true;
            if (done >= 1.0) endProgress();
        }
        else
            std::cerr << stage << ": " << text << std::endl;
        return !interrupted();
    };
}

// ---- numbers

std::vector<std::string> split(const std::string& text, char separator)
{
    std::vector<std::string> parts(1);
    for (const char c : text)
        if (c == separator)
            parts.emplace_back();
        else
            parts.back() += c;
    return parts;
}

Result<std::vector<float>> parseNumbers(const std::string& text, std::initializer_list<size_t> counts)
{
    std::vector<float> numbers;
    for (const std::string& part : split(text, ','))
    {
        float number = 0.0f;
        const char* first = part.data() + (part.starts_with('+') ? 1 : 0);
        const auto [end, error] = std::from_chars(first, part.data() + part.size(), number);
        if (part.empty() || error != std::errc{} || end != part.data() + part.size() || !std::isfinite(number))
            return Error{ErrorCode::badArgument, fmt::format("'{}' in '{}' is not a finite number", part, text)};
        numbers.push_back(number);
    }
    if (std::ranges::find(counts, numbers.size()) == counts.end())
    {
        std::string wanted;
        for (const size_t count : counts) wanted += fmt::format("{}{}", wanted.empty() ? "" : " or ", count);
        return Error{ErrorCode::badArgument,
                     fmt::format("'{}' has {} numbers instead of {}, separated by commas", text, numbers.size(), wanted)};
    }
    return numbers;
}

Result<std::vector<uint32_t>> parseSize(const std::string& text, size_t count)
{
    std::vector<uint32_t> numbers;
    for (const std::string& part : split(text, 'x'))
    {
        uint32_t number = 0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
        if (part.empty() || error != std::errc{} || end != part.data() + part.size() || number == 0 || number > 65535)
            return Error{ErrorCode::badArgument, fmt::format("'{}' in '{}' is not a whole number from 1 to 65535", part, text)};
        numbers.push_back(number);
    }
    if (numbers.size() != count)
        return Error{ErrorCode::badArgument, fmt::format("'{}' has {} numbers instead of {}, separated by x", text, numbers.size(), count)};
    return numbers;
}

void addVec3(CLI::App* command, const std::string& name, std::optional<vec3>& target, const std::string& description)
{
    command
        ->add_option_function<std::string>(
            name,
            [&target, name](const std::string& text)
            {
                const Result<std::vector<float>> numbers = parseNumbers(text, {3});
                if (!numbers) throw CLI::ValidationError(name, numbers.error().message);
                target = vec3((*numbers)[0], (*numbers)[1], (*numbers)[2]);
            },
            description)
        ->type_name("X,Y,Z");
}

void addSize(CLI::App* command, uint32_t& width, uint32_t& height)
{
    const auto spelled = [](uint32_t across, uint32_t down) { return fmt::format("{}x{}", across, down); };
    const std::string most = spelled(knobs::width.most, knobs::height.most);
    command
        ->add_option_function<std::string>(
            "--size",
            [&width, &height, most](const std::string& text)
            {
                const Result<std::vector<uint32_t>> numbers = parseSize(text, 2);
                if (!numbers) throw CLI::ValidationError("--size", numbers.error().message);
                width = (*numbers)[0], height = (*numbers)[1];
                if (!knobs::width.inRange(width) || !knobs::height.inRange(height))
                    throw CLI::ValidationError("--size", fmt::format("'{}' is beyond {}.", text, most));
            },
            described("Picture size in pixels", spelled(width, height),
                      fmt::format("{} to {}", spelled(knobs::width.least, knobs::height.least), most)))
        ->type_name("WxH");
}

// ---- scene and camera

void SceneOptions::add(CLI::App* command)
{
    command->add_option("SCENE", name, "A .gltf or .glb file, or the name of a built-in scene (see `sconce scenes`)")
        ->required()
        ->type_name("");
    addLight(command);
}

void SceneOptions::addLight(CLI::App* command)
{
    lights.add(command);
    command
        ->add_option_function<std::string>(
            "--sky",
            [this](const std::string& text)
            {
                const Result<std::vector<float>> n = parseNumbers(text, {3});
                if (!n) throw CLI::ValidationError("--sky", n.error().message);
                sky = vec3((*n)[0], (*n)[1], (*n)[2]);
                if (glm::any(glm::lessThan(*sky, vec3(0.0f))))
                    throw CLI::ValidationError("--sky", fmt::format("'{}' has negative light", text));
            },
            described(knobs::light.what, defaultText(knobs::light), rangeText(knobs::light)))
        ->type_name("R,G,B");
}

Result<Scene> SceneOptions::load(const Context& context) const
{
    Result<Scene> scene = namedScene(name, consoleProgress(context));
    endProgress();
    if (!scene) return scene;
    for (const std::string& warning : scene->warnings) note(context, fmt::format("Note: {}", warning));
    if (Status lit = lights.apply(scene->lights); !lit) return lit.error();
    if (sky) scene->sky = *sky;
    if (!lights.any() && !sky && addDefaultLight(*scene))
        note(context, "Note: the scene has no light; a default sun and sky are used (--sun, --sky).");
    return scene;
}

void CameraOptions::add(CLI::App* command)
{
    command->add_option("--camera", name, described("Camera of the scene, by name or number", words("the first")))->type_name("NAME");
    addVec3(command, "--eye", eye, described("Where the camera is, metres", words("the scene's camera")));
    addVec3(command, "--target", target, "What it looks at, metres; needed with --eye");
    addKnob(command, "--fov", fov, knobs::verticalFov, "DEGREES");
}

Result<Camera> CameraOptions::choose(const Scene& scene) const
{
    if (eye.has_value() != target.has_value()) return Error{ErrorCode::badArgument, "--eye and --target belong together; give both."};
    if (eye && !name.empty()) return Error{ErrorCode::badArgument, "--camera and --eye contradict each other; give one."};
    if (eye)
    {
        const vec3 forward = *target - *eye;
        if (!(glm::length(forward) > 0.0f)) return Error{ErrorCode::badArgument, "--eye and --target are the same point; move one."};
        return lookAt(*eye, *target, glm::radians(fov));
    }
    if (scene.cameras.empty())
        return Error{ErrorCode::badInput, fmt::format("The scene '{}' has no camera; give --eye and --target.", scene.name)};
    if (name.empty()) return scene.cameras.front();
    for (size_t i = 0; i < scene.cameras.size(); ++i)
        if (scene.cameras[i].name == name || fmt::to_string(i) == name) return scene.cameras[i];
    const std::string known = listed(scene.cameras, &Camera::name);
    return Error{ErrorCode::badArgument,
                 fmt::format("The scene '{}' has no camera '{}'; it has: {}.", scene.name, name, known.empty() ? "none" : known)};
}

void addDevice(CLI::App* command, std::string& device)
{
    command
        ->add_option("--device", device, described("Vulkan device, by number or part of its name, see `sconce doctor`", words("the best")))
        ->type_name("NAME");
}

// ---- cost

Stopwatch::Stopwatch() : start(now()) {}
double Stopwatch::seconds() const
{
    return now() - start;
}

double peakRssMb()
{
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_maxrss) / 1024.0; // Linux counts kilobytes
}

void addCost(Json& json, const Stopwatch& watch)
{
    json["seconds"] = std::round(watch.seconds() * 1000.0) / 1000.0;
    json["peak_rss_mb"] = std::round(peakRssMb() * 10.0) / 10.0;
}

Json toJson(vec3 v)
{
    return Json::array({v.x, v.y, v.z});
}

} // namespace sconce::tools
