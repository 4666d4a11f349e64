#pragma once

#include <algorithm>

#include <nlohmann/json.hpp>

#include <glm/glm.hpp>

namespace sconce::tools
{

/// @return  whether there is a number; `to` stays otherwise
inline bool readNumber(const nlohmann::ordered_json& value, float& to)
{
    if (value.is_number()) to = value.get<float>();
    return value.is_number();
}

/// The same of an array of as many.
template <int N> bool readNumbers(const nlohmann::ordered_json& value, glm::vec<N, float>& to)
{
    const auto isNumber = [](const nlohmann::ordered_json& n) { return n.is_number(); };
    if (!value.is_array() || value.size() != size_t(N) || !std::ranges::all_of(value, isNumber)) return false;
    for (int i = 0; i < N; ++i) to[i] = value[size_t(i)].template get<float>();
    return true;
}

} // namespace sconce::tools
