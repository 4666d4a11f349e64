#pragma once

#include <cstdint>
#include <span>

#include "base/result.h"
#include "runtime/field/field_data.h"

namespace sconce
{

/// How a texel of our distance maps could be packed: what fewer bits would save, and what they cost in rays. Ours is the first.
struct DistanceFormat
{
    int bits;     // of a texel
    int q;        // of 1 / W: a half's, without its last 16 - q
    int gradient; // of each of the two gradients of the surfel's plane; 0: texels are flat
};
std::span<const DistanceFormat> distanceFormats();

/// Cube faces as if their texels were of that many bits: level 0 rounded to what the format holds, the chain over it built anew, in words
/// of 32 bits as before. The tracer reads them as its own, so errors and reads are the format's; its time would also depend on the
/// unpacking. Errors: badArgument (there is no such format; names those there are), badInput (not cube faces). Cost: 5 N^2 texels a face,
/// all cores.
Result<FieldData> narrowedField(FieldData faces, int bits);

/// Bytes that a format of fewer bits would take less for the field's distances.
uint64_t bytesSaved(const FieldData& faces, int bits);

} // namespace sconce
