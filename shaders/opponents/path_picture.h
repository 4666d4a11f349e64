// How a path tracer's picture lies in FieldData::radiance: for each pixel, row by row, bits of kPathWords floats.
#include "shared/gpu_types.h"
#ifndef SCONCE_PATH_PICTURE_H
#define SCONCE_PATH_PICTURE_H
SCONCE_STRUCTS_BEGIN

const uint kPathWords = 6u; // diffuse light r, g, b and reflections r, g, b: radiance to the eye

SCONCE_STRUCTS_END
#endif
