#pragma once

#include <string>

#include "runtime/field_data.h"
#include "tools/common.h"

namespace sconce::tools
{

/// What `info` and `bake` say of a light field.
Json fieldJson(const FieldData& field);
void printField(const FieldData& field, const std::string& file);

} // namespace sconce::tools
