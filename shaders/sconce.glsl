// What a host's shader includes to ask a light field: sconceQuery() traces a ray, sconceLightAt() and its like read light. Every name that it brings begins
// with sconce, Sconce or kSconce; what light_field.glsl, lamps.glsl and the headers of shared call RayHit or lightReaches() is SconceRayHit and
// sconceLightReaches() here. Bind LightField::descriptorSet() at SCONCE_FIELD_SET (0 where it isn't defined), and give LightField::constants(). Include it
// before macros of your own that have names of ours (shaders/host_names.glsl), and not beside the files without the prefix.
#ifndef SCONCE_GLSL
#define SCONCE_GLSL
#extension GL_GOOGLE_include_directive : require
#include "host_names.glsl"
#include "light_field.glsl"
#include "lamps.glsl"
#include "host_names_end.glsl"
#endif
