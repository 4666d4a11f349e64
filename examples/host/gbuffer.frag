#version 460
#extension GL_GOOGLE_include_directive : require
#include "gbuffer_push.glsl"

// What Sconce reads of a pixel, and its emission. Normals are turned to the viewer's side, in this host's world.
layout(location = 0) in vec3 fromEye;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec4 outNormalRoughness;
layout(location = 1) out vec4 outBaseColorMetallic;
layout(location = 2) out vec4 outEmission;
layout(set = 0, binding = 0) uniform sampler2D baseColorTexture;
layout(set = 0, binding = 1) uniform sampler2D metallicRoughnessTexture; // g roughness, b metallic
layout(set = 0, binding = 2) uniform sampler2D emissionTexture;
layout(set = 0, binding = 3) uniform sampler2D normalTexture; // white: there is none

/// glTF 2.0, section 3.9.3: x along growing u, y along falling v. The directions follow from how place and uv change from pixel to pixel, in a world
/// of either hand.
vec3 bent(vec3 n, vec3 across, vec3 down, vec2 uvAcross, vec2 uvDown)
{
    vec3 texel = texture(normalTexture, uv).xyz;
    float area = uvAcross.x * uvDown.y - uvAcross.y * uvDown.x;
    if (texel == vec3(1.0) || area == 0.0) return n;
    vec3 u = (across * uvDown.y - down * uvAcross.y) * sign(area), v = (down * uvAcross.x - across * uvDown.x) * sign(area);
    u -= n * dot(n, u);
    v -= n * dot(n, v);
    vec3 local = (2.0 * texel - 1.0) * vec3(normalScale, normalScale, 1.0);
    vec3 sum = normalize(u) * local.x - normalize(v) * local.y + n * max(local.z, 0.01);
    return any(isnan(sum)) ? n : normalize(sum);
}

void main()
{
    vec4 color = baseColor * texture(baseColorTexture, uv);
    vec3 across = dFdx(fromEye), down = dFdy(fromEye);
    vec2 uvAcross = dFdx(uv), uvDown = dFdy(uv);
    vec4 data = texture(metallicRoughnessTexture, uv);
    vec3 emitted = emission * texture(emissionTexture, uv).rgb;
    vec3 smoothed = dot(normal, normal) > 0.0 ? normalize(normal) : normalize(-fromEye);
    vec3 shading = bent(smoothed, across, down, uvAcross, uvDown);
    if (alphaCutoff > 0.0 && color.a < alphaCutoff) discard; // after the derivatives, which need all pixels of a quad

    vec3 view = normalize(-fromEye), flat_ = cross(across, down);
    flat_ = dot(flat_, flat_) > 0.0 ? normalize(flat_) : smoothed;
    if (dot(flat_, view) < 0.0) flat_ = -flat_;
    if (dot(smoothed, flat_) < 0.0) shading = -shading;
    if (dot(shading, view) <= 0.0) shading = flat_; // interpolated or bent away from the eye
    outNormalRoughness = vec4(shading, roughness * data.g);
    outBaseColorMetallic = vec4(color.rgb, metallic * data.b);
    outEmission = vec4(emitted, 1.0);
}
