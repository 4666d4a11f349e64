// What lets one text compile as GLSL and as C++. Structs here use scalar block layout on both sides.
// Numbers in the shared algorithms are written real(0.5): float on the GPU, float or double in C++.
#ifndef SCONCE_GPU_TYPES_H
#define SCONCE_GPU_TYPES_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/packing.hpp>
#define SCONCE_FN inline
#define SCONCE_PURE static inline // asks nothing of the struct that it is included in: callable without one
#define SCONCE_OUT(type) type&
#define SCONCE_INOUT(type) type&
#define SCONCE_IN(type) const type&
#define SCONCE_CONST static constexpr
#define SCONCE_EXACT
#define SCONCE_CHECK_SIZE(type, bytes) static_assert(sizeof(type) == (bytes))
namespace sconce::gpu
{
using uint = std::uint32_t;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using DeviceAddress = std::uint64_t; // VkDeviceAddress
} // namespace sconce::gpu
#define SCONCE_ADDRESS(type) DeviceAddress
#define SCONCE_STRUCTS_BEGIN namespace sconce::gpu {
#define SCONCE_STRUCTS_END }
#else
#extension GL_EXT_scalar_block_layout : require
#define real float
#define DeviceAddress uvec2 // a buffer reference is made of one
#define vec2f vec2
#define vec3f vec3
#define SCONCE_FN
#define SCONCE_PURE
#define SCONCE_OUT(type) out type
#define SCONCE_INOUT(type) inout type
#define SCONCE_IN(type) in type
#define SCONCE_CONST const
#define SCONCE_EXACT precise // a compiler must not take (a + b) - a for b
#define SCONCE_CHECK_SIZE(type, bytes)
// The buffer_reference of that name: of push constants. In memory it is a DeviceAddress, since a reference that is loaded is taken to be aligned as what it
// refers to, and 8 bytes can't be loaded at 4.
#define SCONCE_ADDRESS(type) type
#define SCONCE_STRUCTS_BEGIN
#define SCONCE_STRUCTS_END
#endif

#endif
