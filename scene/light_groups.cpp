#include "scene/light_groups.h"

#include <algorithm>

#include <fmt/format.h>

namespace sconce
{
namespace
{

/// Whether a name is as a pattern says, in which * stands for any letters. Only the last star is ever widened, so that no pattern takes
/// longer than both lengths' product.
bool matches(std::string_view pattern, std::string_view name)
{
    size_t p = 0, n = 0, star = std::string_view::npos, widened = 0;
    while (n < name.size())
    {
        if (p < pattern.size() && pattern[p] == '*')
            star = p++, widened = n;
        else if (p < pattern.size() && pattern[p] == name[n])
            ++p, ++n;
        else if (star != std::string_view::npos)
            p = star + 1, n = ++widened;
        else
            return false;
    }
    return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

/// One light of a scene, and in which group it is.
struct Source
{
    enum class Kind
    {
        sun,
        punctual,
        emitters,
        sky
    } kind;
    uint32_t index; // of Scene's lights or materials
    std::string_view name;
    int group = -1;

    bool isMember(std::string_view member) const
    {
        constexpr std::string_view kinds[] = {"sun", "punctual", "emitters", "sky"};
        return member == kinds[int(kind)] || (!name.empty() && matches(member, name));
    }
    std::string spelled() const
    {
        constexpr const char* kinds[] = {"sun", "light", "material", "sky"};
        return kind == Kind::sky ? kinds[int(kind)] : fmt::format("{} '{}'", kinds[int(kind)], name);
    }
};

std::vector<Source> sourcesOf(const Scene& scene)
{
    std::vector<Source> all;
    if (scene.sky != vec3(0.0f)) all.push_back({Source::Kind::sky, 0, {}});
    for (uint32_t i = 0; i < scene.lights.size(); ++i)
        all.push_back(
            {scene.lights[i].type == LightType::directional ? Source::Kind::sun : Source::Kind::punctual, i, scene.lights[i].name});
    for (uint32_t i = 0; i < scene.materials.size(); ++i)
        if (scene.materials[i].emission != vec3(0.0f)) all.push_back({Source::Kind::emitters, i, scene.materials[i].name});
    return all;
}

std::string spelledAll(const std::vector<Source>& sources)
{
    constexpr size_t kMostNamed = 12;
    std::string text;
    for (size_t i = 0; i < std::min(sources.size(), kMostNamed); ++i) text += (i > 0 ? ", " : "") + sources[i].spelled();
    return sources.size() > kMostNamed ? fmt::format("{} and {} more", text, sources.size() - kMostNamed) : text;
}

std::string faultOfNames(const std::vector<LightGroupDesc>& groups)
{
    if (groups.empty()) return "no light group is given; give one at least";
    for (size_t i = 0; i < groups.size(); ++i)
    {
        if (groups[i].name.empty()) return "a light group has no name; give NAME=MEMBER,...";
        for (size_t j = 0; j < i; ++j)
            if (groups[j].name == groups[i].name) return fmt::format("two light groups are called '{}'; name them apart", groups[i].name);
    }
    return {};
}

} // namespace

Result<LightGroupDesc> parseLightGroup(std::string_view text)
{
    const size_t equals = text.find('=');
    LightGroupDesc group;
    group.name = std::string(text.substr(0, equals));
    std::string_view rest = equals == std::string_view::npos ? text : text.substr(equals + 1);
    const Error refused{
        ErrorCode::badArgument,
        fmt::format("light group '{}' is not NAME=MEMBER,MEMBER or one MEMBER; members are sun, sky, punctual, emitters, and "
                    "names of lights and of materials that shine",
                    text)};
    if (group.name.empty() || rest.empty()) return refused;
    while (!rest.empty())
    {
        const size_t comma = rest.find(',');
        group.members.emplace_back(rest.substr(0, comma));
        if (group.members.back().empty() || comma + 1 == rest.size()) return refused;
        rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
    }
    return group;
}

Result<std::vector<LightSelection>> selectLights(const Scene& scene, std::vector<LightGroupDesc>& groups)
{
    const auto refused = [](std::string sentence) { return Error{ErrorCode::badArgument, std::move(sentence)}; };
    if (std::string fault = faultOfNames(groups); !fault.empty()) return refused(std::move(fault));
    std::vector<Source> sources = sourcesOf(scene);
    for (size_t g = 0; g < groups.size(); ++g)
        for (const std::string& member : groups[g].members)
        {
            bool found = false;
            for (Source& source : sources)
            {
                if (!source.isMember(member)) continue;
                if (source.group >= 0 && source.group != int(g))
                    return refused(fmt::format("{} is in the light groups '{}' and '{}'; leave it in one", source.spelled(),
                                               groups[size_t(source.group)].name, groups[g].name));
                source.group = int(g);
                found = true;
            }
            if (!found)
                return refused(fmt::format("light group '{}': scene '{}' has no light '{}'; its light: {}", groups[g].name, scene.name,
                                           member, sources.empty() ? "none" : spelledAll(sources)));
        }
    auto rest = std::ranges::find_if(groups, [](const LightGroupDesc& group) { return group.members.empty(); });
    if (rest == groups.end() && std::ranges::find(sources, -1, &Source::group) != sources.end())
    {
        groups.push_back({"rest", {}});
        if (std::string fault = faultOfNames(groups); !fault.empty()) return refused(std::move(fault));
        rest = groups.end() - 1;
    }
    if (groups.size() > kMostLightGroups)
        return refused(
            fmt::format("there are {} light groups, with that of all other light; give at most {}", groups.size(), kMostLightGroups));
    std::vector<LightSelection> found(groups.size());
    for (const Source& source : sources)
    {
        LightSelection& into = found[source.group >= 0 ? size_t(source.group) : size_t(rest - groups.begin())];
        if (source.kind == Source::Kind::sky)
            into.sky = true;
        else
            (source.kind == Source::Kind::emitters ? into.materials : into.lights).push_back(source.index);
    }
    return found;
}

std::string weightFault(std::span<const LightGroupDesc> groups, std::span<const vec3> weights)
{
    if (weights.size() != groups.size())
        return fmt::format("there are {} light groups and {} weights; give one for each", groups.size(), weights.size());
    for (size_t g = 0; g < groups.size(); ++g)
        for (int c = 0; c < 3; ++c)
            if (!(weights[g][c] >= 0.0f && weights[g][c] <= kMostLightWeight))
                return fmt::format("the weight of light group '{}' is ({}, {}, {}); give numbers from 0 to {:.0f}", groups[g].name,
                                   weights[g].x, weights[g].y, weights[g].z, kMostLightWeight);
    return {};
}

void dimLights(Scene& scene, const LightSelection& group, vec3 weight)
{
    for (const uint32_t light : group.lights) scene.lights[light].intensity *= weight;
    for (const uint32_t material : group.materials) scene.materials[material].emission *= weight;
    if (group.sky) scene.sky *= weight;
}

} // namespace sconce
