// How the volumes of irradiance that engines ship lie in FieldData::irradiance: kVolumeHeaderWords, then each probe's words.
#include "shared/gpu_types.h"
#ifndef SCONCE_VOLUME_H
#define SCONCE_VOLUME_H
SCONCE_STRUCTS_BEGIN

const uint kVolumeDdgi = 0u;       // Majercik et al. 2019 and 2021, on a uniform grid
const uint kVolumeDdgiPlaced = 1u; // the same maps and weights, probes where ours are, found by the octree's lists
const uint kVolumeSh = 2u;         // spherical harmonics to the second order, on a uniform grid

const uint kVolumeHeaderWords = 2u; // bits of floats, field units: how far a look-up is moved along the normal, and towards the viewer

// A probe of DDGI: octahedral maps without the border of one texel that hardware's bilinear filter needs, which the look-up does without.
const uint kDdgiIrradianceSide = 6u; // texels; two words each: halves r, g | b, kVolumeValid: (irradiance / pi)^(1/5)
const uint kDdgiDistanceSide = 14u;  // texels; a word each: halves of the mean distance and of the mean of its square, field units
const uint kDdgiWords = 268u;        // 2 * 6^2 + 14^2
const float kDdgiGamma = 5.0;

// A probe of harmonics: 27 halves, coefficient by coefficient r, g, b, of irradiance / pi, and then kVolumeValid.
const uint kShWords = 14u;

const float kVolumeValid = 1.0; // 0: the probe stands in a solid

SCONCE_STRUCTS_END
#endif
