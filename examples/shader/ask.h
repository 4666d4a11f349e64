// What ask.cpp sends and ask.comp answers: one text for both languages, in scalar layout.
#ifdef __cplusplus
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
using glm::vec3;
using uint = uint32_t;
#define ADDRESS uint64_t
#else
#define ADDRESS uvec2
#endif

struct Question // world, metres
{
    vec3 point;
    vec3 normal;    // unit, of the surface that the point is on, on the side that is looked at
    vec3 direction; // unit, of a ray from the point
    vec3 light;     // a place that light may come from
    ADDRESS answer; // of an Answer
};

struct Answer
{
    vec3 arriving;  // mean radiance, cosine-weighted, of all light but the host's own; -1 where the field holds no surface light
    vec3 reflected; // the same of what surfaces reflect
    uint status;    // of the ray: 0 it hits nothing, 1 it hits something, 2 no probe knows
    float distance; // metres along it
    vec3 place;     // where it ends
    vec3 facing;    // normal of what it hits
    vec3 radiance;  // that comes against it
    uint reaches;   // 1: nothing is between the light and the point
};
