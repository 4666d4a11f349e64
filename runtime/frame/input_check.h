#pragma once

#include "runtime/sconce.h"

namespace sconce
{

/// validateInputs() on a device of ours.
Result<std::vector<std::string>> checkInputs(Gpu& gpu, const LightField& field, const FrameInputs& inputs, const gpu::FrameView& view);

} // namespace sconce
