#pragma once

#include <string>

#include "runtime/field_data.h"
#include "tools/common.h"

namespace sconce::tools
{

/// What `info` and `bake` say of a light field.
Json fieldJson(const FieldData& field);
void printField(const FieldData& field, const std::string& file);

/// Whether a tracer ("ours", "b0plus") can read the field; the sentence says how to bake one that it can.
Status fitsTracer(const FieldData& field, const std::string& file, const std::string& tracer);

} // namespace sconce::tools
