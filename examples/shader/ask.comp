#version 460
#extension GL_GOOGLE_include_directive : require
#include "sconce.glsl"
#include "ask.h"
#if SCONCE_GLSL_VERSION != 1
#error "written for version 1 of sconce.glsl: read its change note"
#endif

// A shader of a host that asks the light field what it wants to know: irradiance, a ray, and whether light reaches a point. The field's set is bound
// at SCONCE_FIELD_SET, which is 0 where nothing else is said; the constants 0 and 1 are LightField::constants().
layout(local_size_x = 1) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer AnswerAt { Answer answer; };
layout(scalar, push_constant) uniform Push { Question question; };

void main()
{
    Answer a;
    a.arriving = vec3(-1.0);
    if (sconceField.surfaceSize > 0u)
        a.arriving = sconceLightAt(question.point, question.normal, question.normal) + sconceLampLightAt(question.point, question.normal, question.normal);
    a.reflected = sconceIrradianceAt(question.point, question.normal);

    // Rays start a little off their surface.
    vec3 start = question.point + 1e-4 * sconceField.diagonal * sconceField.scale * question.normal;
    SconceRayHit hit = sconceQuery(start, question.direction, question.normal);
    a.status = hit.status;
    a.distance = hit.t;
    a.place = hit.position;
    a.facing = hit.normal;
    a.radiance = hit.radiance;

    vec3 to = question.light - start;
    float away = max(length(to), 1e-6);
    a.reaches = dot(to, question.normal) > 0.0 && sconceLightReaches(start, to / away, away, question.normal) ? 1u : 0u;
    AnswerAt(question.answer).answer = a;
}
