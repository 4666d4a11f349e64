// sconce scenes and check: what can be lit, what is in it, and what it calls for.
#include <iostream>

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
