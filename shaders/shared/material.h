// Materials as they lie in device memory; shaders/material.glsl evaluates them, scene.cpp's evaluateMaterial is the CPU's way.
#include "shared/gpu_types.h"
#ifndef SCONCE_SHARED_MATERIAL_H
#define SCONCE_SHARED_MATERIAL_H
SCONCE_STRUCTS_BEGIN

struct GpuTexture
{
    vec4 uvMatrix; // columns of TextureRef::uvScaleRotate
    vec2 uvOffset;
    int layer; // of the colour array (base colour, emission) or the data array (metallic-roughness, normal); -1: no texture
    uint wrap; // Wrap of u | Wrap of v << 2
};
SCONCE_CHECK_SIZE(GpuTexture, 32);

struct GpuMaterial
{
    vec4 baseColor;
    vec3 emission; // W/(m^2 sr)
    float metallic;
    float roughness;
    float alphaCutoff; // 0: opaque, kBlended: alpha is a chance
    float normalStrength;
    float retro; // kRetro: retroreflective; else 0
    GpuTexture baseColorTexture;
    GpuTexture metallicRoughnessTexture;
    GpuTexture emissionTexture;
    GpuTexture normalTexture;
};
SCONCE_CHECK_SIZE(GpuMaterial, 176);

const float kBlended = -1.0f;

SCONCE_STRUCTS_END
#endif
