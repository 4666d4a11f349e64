// sconce scenes and check: what can be lit, what is in it, and what it calls for.
#include <iostream>

#include "runtime/frame/effect_plan.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_check.h"
#include "tools/common.h"

namespace sconce::tools
{

namespace
{

struct NoOptions
{
};

int runScenes(const NoOptions&, const Context& context)
{
    Json list = Json::array();
    for (const BuiltinScene& scene : builtinScenes())
    {
        list.push_back({{"name", scene.name}, {"description", scene.description}});
        if (!context.json)
            std::cout << scene.name << std::string(scene.name.size() < 16 ? 16 - scene.name.size() : 1, ' ') << scene.description << "\n";
    }
    if (context.json) print(list);
    std::cout << std::flush;
    return exitOk;
}

const char* severityName(Severity severity)
{
    return severity == Severity::info ? "info" : severity == Severity::warning ? "warning" : "error";
}

Json reportJson(const Scene& scene, const SceneReport& r, const EffectPlan& plan)
{
    Json json;
    json["scene"] = scene.name;
    const std::pair<const char*, uint64_t> counts[] = {{"triangles", r.triangles},
                                                       {"vertices", r.vertices},
                                                       {"materials", r.materials},
                                                       {"used_materials", r.usedMaterials},
                                                       {"textures", r.textures},
                                                       {"texture_bytes", r.textureBytes},
                                                       {"directional_lights", r.directionalLights},
                                                       {"point_lights", r.pointLights},
                                                       {"spot_lights", r.spotLights},
                                                       {"emissive_triangles", r.emissiveTriangles},
                                                       {"rough_materials", r.roughMaterials},
                                                       {"glossy_materials", r.glossyMaterials},
                                                       {"mirror_materials", r.mirrorMaterials},
                                                       {"metal_materials", r.metalMaterials},
                                                       {"masked_materials", r.maskedMaterials},
                                                       {"double_sided_materials", r.doubleSidedMaterials},
                                                       {"edges", r.edges},
                                                       {"open_edges", r.openEdges},
                                                       {"degenerate_triangles", r.degenerateTriangles},
                                                       {"duplicate_triangles", r.duplicateTriangles}};
    for (const auto& [name, count] : counts) json[name] = count;
    json["area"] = r.area;
    json["emissive_area"] = r.emissiveArea;
    json["open_edge_share"] = r.openEdgeShare;
    json["bounds"] = r.bounds.empty() ? Json(nullptr) : Json{{"low", toJson(r.bounds.low)}, {"high", toJson(r.bounds.high)}};
    json["cameras"] = Json::array();
    for (const Camera& camera : scene.cameras) json["cameras"].push_back(camera.name);
    json["effects"] = Json::array();
    for (const PlannedEffect& effect : plan.effects)
        json["effects"].push_back({{"name", effect.name}, {"called", effect.called}, {"why", effect.why}, {"cost", effect.cost}});
    json["findings"] = Json::array();
    for (const Finding& finding : r.findings)
        json["findings"].push_back({{"code", finding.code}, {"severity", severityName(finding.severity)}, {"sentence", finding.sentence}});
    json["warnings"] = scene.warnings;
    return json;
}

void printReport(const Scene& scene, const SceneReport& r, const EffectPlan& plan)
{
    std::cout << scene.name << ": " << r.triangles << " triangles, " << r.vertices << " vertices, " << r.materials << " materials, "
              << r.textures << " textures (" << (r.textureBytes >> 10) << " KiB), " << r.cameras << " cameras\n";
    if (!r.bounds.empty())
        std::cout << "bounds: " << r.bounds.size().x << " x " << r.bounds.size().y << " x " << r.bounds.size().z << " m, surface " << r.area
                  << " m^2\n";
    std::cout << "lights: " << r.directionalLights << " directional, " << r.pointLights << " point, " << r.spotLights << " spot, "
              << r.emissiveTriangles << " emissive triangles (" << r.emissiveArea << " m^2)\n"
              << "edges: " << r.openEdges << " of " << r.edges << " open; " << r.degenerateTriangles << " degenerate and "
              << r.duplicateTriangles << " duplicate triangles\n";
    for (const PlannedEffect& effect : plan.effects)
    {
        std::cout << (effect.called ? "effect  + " : "effect  - ") << effect.name << ": " << effect.why;
        if (effect.called) std::cout << " Cost: " << effect.cost;
        std::cout << "\n";
    }
    for (const Finding& finding : r.findings)
        std::cout << severityName(finding.severity) << " [" << finding.code << "]: " << finding.sentence << "\n";
    std::cout << std::flush;
}

int runCheck(const SceneOptions& options, const Context& context)
{
    const Result<Scene> scene = options.load(context);
    if (!scene) return fail(scene.error());
    const SceneReport report = checkScene(*scene);
    const Result<EffectPlan> plan = planEffects(report);
    if (!plan) return fail(plan.error());
    if (context.json)
        print(reportJson(*scene, report, *plan));
    else
        printReport(*scene, report, *plan);
    for (const Finding& finding : report.findings)
        if (finding.severity == Severity::error) return fail(ErrorCode::badInput, finding.sentence);
    return exitOk;
}

} // namespace

void addSceneCommands(CLI::App& app, Context& context)
{
    onChosen(addCommand(app, context, "scenes", "The built-in scenes"), context, std::make_shared<NoOptions>(), runScenes);
    auto options = std::make_shared<SceneOptions>();
    CLI::App* check =
        addCommand(app, context, "check", "What is in a scene, what is wrong with it, and which effects it calls for and why");
    options->add(check);
    onChosen(check, context, options, runCheck);
}

} // namespace sconce::tools
