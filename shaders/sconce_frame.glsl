// What a host's lighting pass includes: sconceComposeIndirect() puts the images of IndirectLight together, by the reflection model that they are made for,
// which lights straight from the host may go through, too (sconceEvaluateLobes()). It binds nothing. Names: as sconce.glsl.
#ifndef SCONCE_FRAME_GLSL
#define SCONCE_FRAME_GLSL
#extension GL_GOOGLE_include_directive : require
#include "host_names.glsl"
#include "shared/frame.h"
#include "host_names_end.glsl"
#endif
