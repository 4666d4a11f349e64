// The shared texts that need nothing but numbers, together. GLSL, or C++ inside a struct that names `real`.
#include "shared/texel.h"
#include "shared/chart.h"
#include "shared/color.h"
#include "shared/face_chain.h"
