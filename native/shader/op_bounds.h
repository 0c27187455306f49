#pragma once

#include <string_view>

#include "core/float_range.h"

namespace komorebi {

class TextureBounds;

/// An operation on intervals: its outputs' bounds, given those of its inputs.
struct BoundsCall {
  const FloatRange* in = nullptr;
  FloatRange* out = nullptr;
  const float* numbers = nullptr;
  const TextureBounds* texture = nullptr;
};
using OpBounds = void(const BoundsCall& call);

/// Of the operations that say where pictures let light through: arithmetic, steps and images.
/// @returns null for any other
OpBounds* find_op_bounds(std::string_view name);

}  // namespace komorebi
