#pragma once

#include <string>

#include "runtime/field/field_data.h"
#include "runtime/frame/effect_plan.h"
#include "tools/common.h"

namespace sconce::tools
{

/// What `info` and `bake` say of a light field.
Json fieldJson(const FieldData& field);
void printField(const FieldData& field, const std::string& file);

/// A light field's file as a tracer reads it: "ours", or an opponent's name (bench/opponents/baselines.h), whose maps are made from the
/// file's. The error's sentence says how to bake a field that the tracer can read.
Result<FieldData> loadFieldFor(const std::string& file, const std::string& tracer);

/// Tells what the plan gives up of what the scene calls for.
void noteGivenUp(const Context& context, const EffectPlan& plan);

/// --tracer ours|b0|b0plus|b0plus-octree|wang
void addTracer(CLI::App* command, std::string& tracer);

} // namespace sconce::tools
