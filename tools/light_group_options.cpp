#include "tools/light_group_options.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "base/listed.h"

namespace sconce::tools
{

namespace
{

/// W or R,G,B.
std::optional<vec3> weightIn(std::string_view text)
{
    const std::vector<std::string> parts = split(std::string(text), ',');
    if (parts.size() != 1 && parts.size() != 3) return std::nullopt;
    vec3 weight(0.0f);
    for (size_t i = 0; i < parts.size(); ++i)
    {
        const auto read = std::from_chars(parts[i].data(), parts[i].data() + parts[i].size(), weight[int(i)]);
        if (parts[i].empty() || read.ec != std::errc() || read.ptr != parts[i].data() + parts[i].size()) return std::nullopt;
    }
    return parts.size() == 1 ? vec3(weight.x) : weight;
}

} // namespace

void addGroups(CLI::App* command, std::vector<std::string>& groups, const std::string& what)
{
    command
        ->add_option("--group", groups,
                     described(what +
                                   ": NAME=MEMBER,... or one MEMBER; members are sun, sky, punctual, emitters, and names of lights and of "
                                   "materials that shine, where * is any letters. Give it once for each group; all other light is one "
                                   "more, `rest`",
                               words("none")))
        ->expected(1)
        ->take_all()
        ->type_name("GROUP");
}

Result<std::vector<LightGroupDesc>> groupsOf(std::span<const std::string> texts)
{
    std::vector<LightGroupDesc> groups;
    for (const std::string& text : texts)
    {
        auto group = parseLightGroup(text);
        if (!group) return group.error();
        groups.push_back(std::move(*group));
    }
    return groups;
}

void addDims(CLI::App* command, std::vector<std::string>& dims, const std::string& then)
{
    command
        ->add_option("--dim", dims,
                     described("Light of a group times so much, of all or of red, green and blue; 0 switches it off. Give it once for each "
                               "group" +
                                   then,
                               words("as it was baked"), fmt::format("0 to {:.0f}", kMostLightWeight)))
        ->expected(1)
        ->take_all()
        ->type_name("NAME=W|NAME=R,G,B");
}

Result<std::vector<vec3>> weightsOf(std::span<const std::string> dims, std::span<const LightGroupDesc> groups)
{
    std::vector<vec3> weights(groups.size(), vec3(1.0f));
    for (const std::string& dim : dims)
    {
        const size_t equals = dim.rfind('=');
        const std::optional<vec3> weight = equals == std::string::npos ? std::nullopt : weightIn(std::string_view(dim).substr(equals + 1));
        if (!weight) return Error{ErrorCode::badArgument, fmt::format("--dim {} is not NAME=W or NAME=R,G,B.", dim)};
        const auto found = std::ranges::find(groups, dim.substr(0, equals), &LightGroupDesc::name);
        if (found == groups.end())
            return Error{ErrorCode::badArgument,
                         fmt::format("--dim {}: there is no light group '{}'; {}.", dim, dim.substr(0, equals),
                                     groups.empty() ? "give some with --group" : "there are " + listed(groups, &LightGroupDesc::name))};
        weights[size_t(found - groups.begin())] = *weight;
    }
    if (std::string fault = weightFault(groups, weights); !fault.empty()) return Error{ErrorCode::badArgument, fault + "."};
    return weights;
}

Result<std::vector<vec3>> dimScene(Scene& scene, std::vector<LightGroupDesc> groups, std::span<const std::string> dims)
{
    const auto selected = selectLights(scene, groups); // which may name one more
    if (!selected) return selected.error();
    auto weights = weightsOf(dims, groups);
    if (!weights) return weights;
    for (size_t g = 0; g < groups.size(); ++g) dimLights(scene, (*selected)[g], (*weights)[g]);
    return weights;
}

} // namespace sconce::tools
