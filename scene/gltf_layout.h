#pragma once

#include <cstdint>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/result.h"

namespace sconce
{

/// Checks with 64-bit arithmetic that can't overflow that every buffer view lies in its buffer and every accessor, sparse ones included,
/// in its view. @param bufferBytes  bytes that are really there, per buffer
Status checkLayout(const nlohmann::json& gltf, const std::vector<uint64_t>& bufferBytes);

/// Bytes of a component: 1, 2 or 4; 0 for a component type that glTF 2.0 does not have.
uint32_t componentBytes(uint64_t componentType);

} // namespace sconce
