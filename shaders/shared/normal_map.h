// Normal textures without stored tangents: the tangents follow from how positions and texture coordinates change together over the surface. Shared
// text, see texel.h.
#if defined(__cplusplus) || !defined(SCONCE_NORMAL_MAP) // C++ includes it once for each precision
#define SCONCE_NORMAL_MAP

/// Directions on the surface in which u and v grow, any length; 0 where the texture coordinates don't span the surface.
struct UvTangents
{
    vec3 u;
    vec3 v;
};

/// @param p0, p1    two changes of position along the surface
/// @param uv0, uv1  the changes of the texture coordinates with them
SCONCE_PURE UvTangents uvTangents(vec3 p0, vec3 p1, vec2 uv0, vec2 uv1)
{
    real side = uv0.x * uv1.y - uv0.y * uv1.x < real(0.0) ? real(-1.0) : real(1.0);
    UvTangents along;
    along.u = (p0 * uv1.y - p1 * uv0.y) * side;
    along.v = (p1 * uv0.x - p0 * uv1.x) * side;
    return along;
}

/// The shading normal bent by a normal texture (glTF 2.0, section 3.9.3): x along growing u, y along falling v, z along the normal.
/// @param normal    unit
/// @param read      the texture's value, [0,1]
/// @param strength  glTF's scale of x and y
SCONCE_PURE vec3 bentNormal(vec3 normal, UvTangents along, vec3 read, real strength)
{
    vec3 tangent = along.u - normal * dot(normal, along.u);
    real length2 = dot(tangent, tangent);
    if (!(length2 > real(0.0))) return normal;
    tangent = tangent / sqrt(length2);
    vec3 bitangent = cross(normal, tangent);
    if (dot(bitangent, along.v) > real(0.0)) bitangent = -bitangent;
    vec3 local = read * real(2.0) - vec3(real(1.0));
    vec3 bent = tangent * (local.x * strength) + bitangent * (local.y * strength) + normal * (local.z > real(0.01) ? local.z : real(0.01));
    return bent / sqrt(dot(bent, bent));
}

#endif
