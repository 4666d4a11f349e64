// Materials at a uv: the GPU's twin of scene.cpp's evaluateMaterial. Textures of all materials share two arrays of one size, so that no
// bindless access is needed; wrap modes are done here, since one sampler serves all layers.
#ifndef SCONCE_MATERIAL_GLSL
#define SCONCE_MATERIAL_GLSL
#include "scene.glsl"
#include "shared/normal_map.h"

struct SurfacePoint
{
    vec4 baseColor; // linear
    float metallic;
    float roughness;
    vec3 emission; // W/(m^2 sr)
};

float sconceWrap(float u, uint mode, float halfTexel)
{
    if (mode == 0u) return u - floor(u);                   // repeat
    if (mode == 1u) return clamp(u, halfTexel, 1.0 - halfTexel); // clamp
    float t = u - 2.0 * floor(0.5 * u);                    // mirror
    return clamp(t > 1.0 ? 2.0 - t : t, halfTexel, 1.0 - halfTexel);
}

vec4 sconceTexture(sampler2DArray textures, GpuTexture slot, vec2 uv, vec2 uvDx, vec2 uvDy)
{
    if (slot.layer < 0) return vec4(1.0);
    mat2 m = mat2(slot.uvMatrix.xy, slot.uvMatrix.zw);
    vec2 at = m * uv + slot.uvOffset;
    vec2 halfTexel = 0.5 / vec2(textureSize(textures, 0).xy);
    vec2 wrapped = vec2(sconceWrap(at.x, slot.wrap & 3u, halfTexel.x), sconceWrap(at.y, slot.wrap >> 2, halfTexel.y));
    return textureGrad(textures, vec3(wrapped, float(slot.layer)), m * uvDx, m * uvDy);
}

/// @param uvDx, uvDy  change of uv to the next pixel, which picks the mip level
SurfacePoint evaluateMaterial(uint material, vec2 uv, vec2 uvDx, vec2 uvDy)
{
    GpuMaterial m = sconceMaterials[material];
    vec4 data = sconceTexture(sconceDataTextures, m.metallicRoughnessTexture, uv, uvDx, uvDy);
    SurfacePoint point;
    point.baseColor = m.baseColor * sconceTexture(sconceColorTextures, m.baseColorTexture, uv, uvDx, uvDy);
    point.metallic = m.metallic * data.b;
    point.roughness = m.roughness * data.g;
    point.emission = m.emission * sconceTexture(sconceColorTextures, m.emissionTexture, uv, uvDx, uvDy).rgb;
    return point;
}

/// The shading normal that a normal texture makes of the interpolated one; as RayScene's.
/// @param normal              unit
/// @param acrossX, acrossY    change of the position to the next pixel, as uvDx and uvDy
/// @param together            length of the mean of all normals that this one stands for: 1 where they are one
vec3 mappedNormal(uint material, vec2 uv, vec2 uvDx, vec2 uvDy, vec3 normal, vec3 acrossX, vec3 acrossY, out float together)
{
    GpuMaterial m = sconceMaterials[material];
    together = 1.0;
    if (m.normalTexture.layer < 0) return normal;
    mat2 turned = mat2(m.normalTexture.uvMatrix.xy, m.normalTexture.uvMatrix.zw);
    vec3 read = sconceTexture(sconceDataTextures, m.normalTexture, uv, uvDx, uvDy).rgb;
    together = min(length(2.0 * read - 1.0), 1.0); // the mips are means
    return bentNormal(normal, uvTangents(acrossX, acrossY, turned * uvDx, turned * uvDy), read, m.normalStrength);
}

vec3 mappedNormal(uint material, vec2 uv, vec2 uvDx, vec2 uvDy, vec3 normal, vec3 acrossX, vec3 acrossY)
{
    float together;
    return mappedNormal(material, uv, uvDx, uvDy, normal, acrossX, acrossY, together);
}

/// A fragment's lot, [0,1): by the bits of its place and depth, so that layers behind each other draw their own (PCG hash).
float lotOf(vec4 fragment)
{
    uvec3 bits = uvec3(uvec2(fragment.xy), floatBitsToUint(fragment.z));
    uint state = (bits.x * 747796405u + bits.y) * 2891336453u + bits.z;
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return float(((word >> 22u) ^ word) >> 8u) / 16777216.0;
}

/// Whether a point of a masked or blended material is there at all.
/// @param fragment  gl_FragCoord
bool isThere(uint material, vec2 uv, vec2 uvDx, vec2 uvDy, vec4 fragment)
{
    GpuMaterial m = sconceMaterials[material];
    if (m.alphaCutoff == 0.0) return true;
    float alpha = m.baseColor.a * sconceTexture(sconceColorTextures, m.baseColorTexture, uv, uvDx, uvDy).a;
    return m.alphaCutoff == kBlended ? alpha > lotOf(fragment) : alpha >= m.alphaCutoff;
}

#endif
