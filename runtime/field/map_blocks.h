#pragma once

#include "base/result.h"
#include "runtime/field/field_data.h"

namespace sconce
{

/// Puts the maps of a field of cube faces in blocks (see inBlocks()): half of the finest distances, and a quarter of the radiance. The
/// chain of distances is built anew over what the blocks hold. Radiance of the sky, which no ray reads, counts for nothing. The same bytes
/// on any number of cores. A field in blocks stays as it is. Errors: badArgument, and the field stays as it was: octahedral maps, light
/// groups, live links.
Status putInBlocks(FieldData& field);

} // namespace sconce
