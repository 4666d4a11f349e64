#include "tools/view/panel.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <imgui/backends/imgui_impl_glfw.h>
#include <imgui/backends/imgui_impl_vulkan.h>
#include <imgui/imgui.h>

#include "tools/light_group_options.h"

namespace sconce::tools
{

namespace
{

constexpr size_t kKeptFrames = 120; // of the graph

void tooltip(const std::string& text)
{
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(28.0f * ImGui::GetFontSize());
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

std::string wordsOf(const KnobRow& row)
{
    std::string text = fmt::format("{}.", row.what);
    if (!row.buys.empty()) text += fmt::format("\nBuys and costs: {}.", row.buys);
    return text + fmt::format("\nDefault: {}; range: {}", row.byDefault, row.range);
}

/// A combo box over names. @return  whether `chosen` changed
bool combo(const char* label, std::span<const std::string> names, std::string& chosen)
{
    bool changed = false;
    if (!ImGui::BeginCombo(label, chosen.c_str())) return false;
    for (const std::string& name : names)
        if (ImGui::Selectable(name.c_str(), name == chosen))
        {
            changed = name != chosen;
            chosen = name;
        }
    ImGui::EndCombo();
    return changed;
}

template <size_t N> bool combo(const char* label, const std::array<std::string_view, N>& names, uint32_t& chosen)
{
    std::string now(names[chosen]);
    const std::vector<std::string> all(names.begin(), names.end());
    const bool changed = combo(label, all, now);
    chosen = uint32_t(std::ranges::find(names, now) - names.begin());
    return changed;
}

double numberIn(const std::string& text, double otherwise)
{
    double value = otherwise;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

} // namespace

Result<std::unique_ptr<Panel>> Panel::create(Window& window)
{
    std::unique_ptr<Panel> made(new Panel(window));
    if (Status status = made->make(); !status) return status.error();
    return made;
}

Status Panel::make()
{
    Gpu& gpu = window.gpu();
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // nothing is left behind in the folder where it runs
    ImGui::StyleColorsDark();
    ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 0.85f;
    ImGui_ImplGlfw_InitForVulkan(window.handle(), true);

    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8}};
    VkDescriptorPoolCreateInfo info{
        VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT, 8, 1, sizes};
    if (VkResult result = vkCreateDescriptorPool(gpu.host.device, &info, nullptr, &pool); result != VK_SUCCESS)
        return gpu.failure("vkCreateDescriptorPool", result);
    ImGui_ImplVulkan_InitInfo vulkan{};
    vulkan.Instance = gpu.host.instance;
    vulkan.PhysicalDevice = gpu.host.physicalDevice;
    vulkan.Device = gpu.host.device;
    vulkan.QueueFamily = gpu.host.queueFamily;
    vulkan.Queue = gpu.host.queue;
    vulkan.DescriptorPool = pool;
    vulkan.MinImageCount = 2;
    vulkan.ImageCount = std::max(2u, window.imageCount());
    vulkan.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    ImGui_ImplVulkan_Init(&vulkan, window.renderPass());
    const Status fonts = gpu.submit([](VkCommandBuffer cmd) { ImGui_ImplVulkan_CreateFontsTexture(cmd); });
    if (!fonts) return fonts;
    ImGui_ImplVulkan_DestroyFontUploadObjects();
    return success();
}

Panel::~Panel()
{
    window.waitIdle();
    ImGui_ImplVulkan_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    vkDestroyDescriptorPool(window.gpu().host.device, pool, nullptr);
}

void Panel::begin()
{
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Panel::record(VkCommandBuffer cmd)
{
    ImGui::Render();
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), cmd);
}

bool Panel::wantsMouse() const
{
    return ImGui::GetIO().WantCaptureMouse;
}

bool Panel::wantsKeyboard() const
{
    return ImGui::GetIO().WantTextInput;
}

void Panel::addTimes(const std::vector<GpuTimer::Scope>& times, double wallMs)
{
    const auto add = [](History& to, double milliseconds)
    {
        to.milliseconds.push_back(float(milliseconds));
        if (to.milliseconds.size() > kKeptFrames) to.milliseconds.pop_front();
        double sum = 0.0;
        for (const float kept : to.milliseconds) sum += kept;
        to.mean = sum / double(to.milliseconds.size());
    };
    passes.clear();
    for (const GpuTimer::Scope& scope : times)
    {
        passes.emplace_back(scope.name);
        add(history[scope.name], scope.milliseconds);
    }
    add(wall, wallMs);
}

void Panel::buildProgress(const std::string& stage, double done, const std::string& note)
{
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * screen.x, 0.5f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({std::min(420.0f, 0.9f * screen.x), 0.0f});
    ImGui::Begin("Sconce", nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse);
    ImGui::TextWrapped("%s", note.c_str());
    ImGui::ProgressBar(float(done), {-1.0f, 0.0f}, fmt::format("{}: {:.0f} %", stage, 100.0 * done).c_str());
    ImGui::End();
}

void Panel::buildTimes(const Session& session)
{
    double sum = 0.0;
    for (const std::string& pass : passes) sum += history[pass].mean;
    const std::vector<float> walls(wall.milliseconds.begin(), wall.milliseconds.end());
    ImGui::Text("%s", fmt::format("{} on {}", session.wholeScene().name, window.deviceName()).c_str());
    ImGui::TextWrapped("%s", fmt::format("{} x {}, passes {:.2f} ms, frame {:.2f} ms, {:.0f} MB", session.settings().width,
                                         session.settings().height, sum, wall.mean, double(session.deviceBytes()) / 1e6)
                                 .c_str());
    ImGui::PlotLines("##frames", walls.data(), int(walls.size()), 0, nullptr, 0.0f, float(2.0 * wall.mean),
                     {ImGui::GetContentRegionAvail().x, 48.0f});
    tooltip("Milliseconds of the last frames, presentation included");
    if (passes.empty()) ImGui::TextUnformatted("The device's queue has no clock: passes aren't timed.");
    if (!ImGui::BeginTable("passes", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
    for (const std::string& pass : passes)
    {
        const History& of = history[pass];
        const std::vector<float> values(of.milliseconds.begin(), of.milliseconds.end());
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(pass.c_str());
        ImGui::TableNextColumn();
        ImGui::Text("%.3f ms", of.mean);
        ImGui::TableNextColumn();
        ImGui::PushID(pass.c_str());
        ImGui::PlotHistogram("##pass", values.data(), int(values.size()), 0, nullptr, 0.0f, float(2.0 * of.mean),
                             {ImGui::GetContentRegionAvail().x, 14.0f});
        ImGui::PopID();
    }
    ImGui::EndTable();
}

void Panel::buildView(ViewState& state)
{
    combo("view", kViews, state.shown.view);
    tooltip("What the window shows, by the names of `sconce render --aov`");
    if (combo("compare", kCompares, state.shown.compare) && state.shown.compare != 0) state.shown.view = 0;
    tooltip("With a path-traced reference, which grows while the camera stands: ours left of the split; or their difference, red where "
            "ours is brighter and blue where it is darker, four times over");
    if (state.shown.compare == 1) ImGui::SliderFloat("split", &state.shown.split, 0.0f, 1.0f);
    if (state.shown.compare != 0)
        ImGui::Text("%s",
                    fmt::format("reference: {} paths a pixel, its own relMSE {:.2g}", state.referencePaths, state.referenceError).c_str());
    if (ImGui::Button("expose")) state.wantsExposure = true;
    tooltip("Exposes for what is seen now");
    ImGui::SameLine();
    if (ImGui::Button("screenshot")) state.wantsShot = true;
    tooltip("Writes sconce-N.exr, all layers, and sconce-N.png, as it looks, into the folder that the command was started in");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(80.0f);
    int every = int(state.everyPixel);
    if (ImGui::SliderInt("coarse", &every, 1, 4)) state.everyPixel = uint32_t(std::clamp(every, 1, 4));
    tooltip("Draws one pixel for so many of the window, along each axis");
    ImGui::Checkbox("keep drawing", &state.keepDrawing);
    tooltip("Draws on while nothing changes, so that times can be read; off while a reference grows");
    ImGui::SliderFloat("speed", &state.speed, 0.01f, 100.0f, "%.2f m/s", ImGuiSliderFlags_Logarithmic);
    const vec3 eye = state.camera.eye;
    ImGui::Text("%s", fmt::format("eye {:.3f},{:.3f},{:.3f}", eye.x, eye.y, eye.z).c_str());
}

/// @param text  out: what it was set to @return  whether it was
bool Panel::editNumber(const LiveKnob& knob, const std::string& shown, std::string& text)
{
    const std::string name(knob.row.name);
    const bool derived = shown == kDefaultWord;
    const auto kept = edited.find(name);
    double value = kept != edited.end() ? kept->second : numberIn(shown, knob.kind == LiveKnob::Kind::real ? 0.0 : knob.least);
    const std::string label = fmt::format("{}{}{}", name, knob.row.unit.empty() ? "" : ", ", knob.row.unit);
    bool changed = false;
    if (knob.kind == LiveKnob::Kind::real)
    {
        float number = float(value);
        // Over decades where the range has many.
        const bool wide = knob.most > 1e3 * std::max(knob.least, 1e-6);
        changed = ImGui::SliderFloat(label.c_str(), &number, float(knob.least), float(std::min(knob.most, 1e4)),
                                     derived ? "default" : "%.5g", wide ? ImGuiSliderFlags_Logarithmic : 0);
        value = double(number);
    }
    else
    {
        int number = int(std::min(value, 1e9));
        changed = ImGui::SliderInt(label.c_str(), &number, int(knob.least), int(std::min(knob.most, 1e4)), derived ? "default" : "%d");
        value = number;
    }
    if (changed) edited[name] = value;
    const bool released = ImGui::IsItemDeactivatedAfterEdit();
    // What the renderer is made for is set when the slider is let go.
    const bool commit = name == "roughness" ? released : changed;
    if (commit) text = knob.kind == LiveKnob::Kind::real ? fmt::format("{}", float(value)) : fmt::format("{}", int64_t(value));
    if (released || !ImGui::IsItemActive()) edited.erase(name);
    return commit;
}

void Panel::buildKnob(const LiveKnob& knob, ViewState& state)
{
    const std::string name(knob.row.name), shown = knob.get(state.knobs);
    std::string text = shown;
    bool changed = false;
    ImGui::PushID(name.c_str());
    ImGui::SetNextItemWidth(0.42f * ImGui::GetContentRegionAvail().x);
    if (knob.kind == LiveKnob::Kind::flag)
    {
        bool on = shown == "on";
        changed = ImGui::Checkbox(name.c_str(), &on);
        text = on ? "on" : "off";
    }
    else if (!knob.choices.empty())
        changed = combo(fmt::format("{}{}{}", name, knob.row.unit.empty() ? "" : ", ", knob.row.unit).c_str(), knob.choices, text);
    else
        changed = editNumber(knob, shown, text);
    tooltip(wordsOf(knob.row));
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 18.0f);
    if (ImGui::SmallButton("x"))
    {
        changed = true;
        text = kDefaultWord;
    }
    tooltip("Back to the default");
    ImGui::PopID();
    if (!changed) return;
    if (const std::string fault = knob.set(state.knobs, text); !fault.empty()) state.message = fault + ".";
}

void Panel::buildKnobs(ViewState& state, bool ofTracer)
{
    for (const LiveKnob& knob : liveKnobs())
        if (knob.row.member.starts_with("Quality::") == ofTracer) buildKnob(knob, state);
}

void Panel::buildEffects(ViewState& state, const Session& session)
{
    for (const char* all : {"auto", "all", "none"})
    {
        if (ImGui::RadioButton(all, state.knobs.frame.effects == all)) state.knobs.frame.effects = all;
        ImGui::SameLine();
    }
    ImGui::Text("%s", state.knobs.frame.effects.size() > 4 ? state.knobs.frame.effects.c_str() : "");
    for (const PlannedEffect& effect : session.plan().effects)
    {
        bool on = effect.on;
        ImGui::PushID(effect.name.c_str());
        if (!effect.called) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.5f);
        if (ImGui::Checkbox(effect.name.c_str(), &on))
        {
            const auto wanted = effectsWith(session.plan(), effect.name, on);
            if (wanted)
                state.knobs.frame.effects = *wanted;
            else
                state.message = wanted.error().message;
        }
        if (!effect.called) ImGui::PopStyleVar();
        tooltip(fmt::format("{}\n{}{}{}", effect.why, effect.cost, effect.givenUp.empty() ? "" : "\n", effect.givenUp));
        ImGui::PopID();
    }
}

void Panel::buildLight(ViewState& state, const Session& session)
{
    if (!session.sunMoves() && session.groups().empty())
    {
        ImGui::TextWrapped("This field's light is fixed: bake with --live-links to move its lights, with --group to switch and dim them.");
        return;
    }
    if (session.sunMoves())
    {
        if (!sunRead)
        {
            const std::vector<Light>& lights = session.litScene().lights;
            const auto sun = std::ranges::find(lights, LightType::directional, &Light::type);
            if (sun != lights.end()) sunDirection = sun->direction, sunIrradiance = sun->intensity;
        }
        sunRead = true;
        // A script's, or the panel's own.
        if (const auto& sun = state.light.sun; sun && (sun->direction != sunTaken.direction || sun->irradiance != sunTaken.irradiance))
        {
            sunTaken = *sun;
            sunDirection = sun->direction;
            if (sun->irradiance) sunIrradiance = *sun->irradiance;
        }
        float height = glm::degrees(std::asin(std::clamp(-sunDirection.y, -1.0f, 1.0f))),
              around = glm::degrees(std::atan2(sunDirection.x, sunDirection.z));
        ImGui::SliderFloat("sun's height", &height, 0.0f, 90.0f, "%.1f degrees");
        bool released = ImGui::IsItemDeactivatedAfterEdit();
        ImGui::SliderFloat("sun's way", &around, -180.0f, 180.0f, "%.1f degrees");
        released = ImGui::IsItemDeactivatedAfterEdit() || released;
        ImGui::DragFloat3("irradiance", &sunIrradiance.x, 0.02f, 0.0f, 1e4f);
        released = ImGui::IsItemDeactivatedAfterEdit() || released;
        tooltip("On a surface that faces it, W/m^2");
        const float up = glm::radians(height), way = glm::radians(around);
        sunDirection = vec3(std::sin(way) * std::cos(up), -std::sin(up), std::cos(way) * std::cos(up));
        // Its shadow map is made anew: not while it is dragged.
        if (released) state.light.sun = SunPlace{glm::normalize(sunDirection), glm::max(sunIrradiance, vec3(0.0f))};
        if (!session.settled()) ImGui::TextUnformatted("light settles ...");
    }
    if (state.light.dims != dimsTaken) // a script's, or the panel's own
    {
        dimsTaken = state.light.dims;
        weights.clear();
        std::vector<LightGroupDesc> groups;
        for (const std::string& group : session.groups()) groups.push_back({group, {}});
        if (const auto taken = weightsOf(dimsTaken, groups)) // else the session says what is wrong
            for (size_t g = 0; g < groups.size(); ++g) weights[groups[g].name] = (*taken)[g];
    }
    for (const std::string& group : session.groups())
    {
        vec3& weight = weights.emplace(group, vec3(1.0f)).first->second;
        ImGui::DragFloat3(group.c_str(), &weight.x, 0.01f, 0.0f, 100.0f);
        tooltip("The group's light times so much, in red, green and blue");
        if (!ImGui::IsItemDeactivatedAfterEdit()) continue;
        state.light.dims.clear();
        for (const auto& [name, w] : weights)
            if (w != vec3(1.0f)) state.light.dims.push_back(fmt::format("{}={},{},{}", name, w.x, w.y, w.z));
    }
}

void Panel::build(ViewState& state, const Session& session)
{
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({8.0f, 8.0f}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({std::min(400.0f, 0.6f * screen.x), std::max(120.0f, screen.y - 16.0f)}, ImGuiCond_FirstUseEver);
    ImGui::Begin("Sconce");
    ImGui::PushItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
    buildTimes(session);
    ImGui::Separator();
    buildView(state);
    if (!state.message.empty()) ImGui::TextWrapped("%s", state.message.c_str());
    if (ImGui::CollapsingHeader("Frame", ImGuiTreeNodeFlags_DefaultOpen)) buildKnobs(state, false);
    if (ImGui::CollapsingHeader("Effects")) buildEffects(state, session);
    if (ImGui::CollapsingHeader("Light")) buildLight(state, session);
    if (ImGui::CollapsingHeader("Tracer")) buildKnobs(state, true);
    if (ImGui::CollapsingHeader("Keys"))
        ImGui::TextWrapped(
            "W A S D: forward, left, back, right; Q E: down, up; shift: faster; right button held: look; F1: this panel; Escape: close");
    ImGui::PopItemWidth();
    ImGui::End();
}

} // namespace sconce::tools
