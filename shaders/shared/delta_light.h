// Light of what has no extent (point, spot, directional), without its shadow. Shared text, see probe_trace.h; needs brdf_text.h and GpuLight besides.

struct DeltaLight
{
    vec3 toLight;    // unit
    vec3 irradiance; // on a surface that faces the light, W/m^2
    real distance;   // field units; of a directional light `far`
};

/// @param kind   light.type; a constant where the caller knows it
/// @param point  field space
/// @param far    field units: beyond the scene
SCONCE_PURE DeltaLight deltaLightAt(SCONCE_IN(GpuLight) light, uint kind, vec3 point, real far)
{
    DeltaLight at;
    at.toLight = -vec3(light.direction);
    at.irradiance = vec3(light.intensity);
    at.distance = far;
    if (kind == kLightDirectional) return at;
    vec3 away = vec3(light.position) - point;
    real d2 = max(dot(away, away), real(1e-14));
    at.toLight = away * inversesqrt(d2);
    at.distance = sqrt(d2);
    at.irradiance *= distanceAttenuation(at.distance, real(light.range));
    if (kind == kLightSpot) at.irradiance *= spotAttenuation(dot(-at.toLight, vec3(light.direction)), real(light.innerCone), real(light.outerCone));
    return at;
}
