// What a fragment of the scene is made of: glTF's metallic-roughness materials with their textures.
#include "gbuffer_push.glsl"
layout(set = 0, binding = 0) uniform sampler2D baseColorTexture;
layout(set = 0, binding = 1) uniform sampler2D metallicRoughnessTexture; // g roughness, b metallic
layout(set = 0, binding = 2) uniform sampler2D emissionTexture;
layout(set = 0, binding = 3) uniform sampler2D normalTexture; // white: there is none

/// glTF 2.0, section 3.9.3: x along growing u, y along falling v. The directions follow from how place and uv change from pixel to pixel, in a world
/// of either hand.
vec3 bent(vec3 n, vec3 texel, vec3 across, vec3 down, vec2 uvAcross, vec2 uvDown)
{
    float area = uvAcross.x * uvDown.y - uvAcross.y * uvDown.x;
    if (texel == vec3(1.0) || area == 0.0) return n;
    vec3 u = (across * uvDown.y - down * uvAcross.y) * sign(area), v = (down * uvAcross.x - across * uvDown.x) * sign(area);
    u -= n * dot(n, u);
    v -= n * dot(n, v);
    vec3 local = (2.0 * texel - 1.0) * vec3(normalScale, normalScale, 1.0);
    vec3 sum = normalize(u) * local.x - normalize(v) * local.y + n * max(local.z, 0.01);
    return any(isnan(sum)) ? n : normalize(sum);
}

struct Surface
{
    vec4 color;
    float metallic, roughness;
    vec3 emission;
    vec3 smoothed; // interpolated, unit
    vec3 shading;  // bent by its texture
    float together; // length of the mean of the normals that it stands for
    vec3 across;   // the triangle's, of any length, to either side
    bool isThere;  // else its alpha is below the cutoff: to be discarded, after all that asks the neighbours
};

/// @param seen  the fragment's place, from where it is seen
Surface surfaceAt(vec3 seen, vec3 normal, vec2 uv)
{
    vec3 across = dFdx(seen), down = dFdy(seen);
    vec4 data = texture(metallicRoughnessTexture, uv);
    Surface s;
    s.color = baseColor * texture(baseColorTexture, uv);
    s.metallic = metallic * data.b;
    s.roughness = roughness * data.g;
    s.emission = emission * texture(emissionTexture, uv).rgb;
    s.smoothed = dot(normal, normal) > 0.0 ? normalize(normal) : normalize(-seen);
    vec3 texel = texture(normalTexture, uv).xyz;
    s.shading = bent(s.smoothed, texel, across, down, dFdx(uv), dFdy(uv));
    s.together = texel == vec3(1.0) ? 1.0 : min(length(2.0 * texel - 1.0), 1.0); // smaller mips hold means
    s.across = cross(across, down);
    s.isThere = alphaCutoff == 0.0 || s.color.a >= alphaCutoff;
    return s;
}
