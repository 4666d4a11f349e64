#pragma once

#include "runtime/field/field_data.h"

namespace sconce
{

/// Fills `prefiltered` from `radiance`; on any number of threads the same bytes. Cost: about 40 ms a probe and core.
void prefilterRadiance(FieldData& field);

} // namespace sconce
