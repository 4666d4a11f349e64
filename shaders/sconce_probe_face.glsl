// What a host's fragment shader includes to draw what a probe sees, for BakeDesc::faces: sconceProbeTexel(). It binds nothing. Names: as sconce.glsl.
#ifndef SCONCE_PROBE_FACE_OF_HOST_GLSL
#define SCONCE_PROBE_FACE_OF_HOST_GLSL
#extension GL_GOOGLE_include_directive : require
#include "host_names.glsl"
#include "probe_face.glsl"
#include "host_names_end.glsl"
#endif
