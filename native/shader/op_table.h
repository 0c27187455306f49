#pragma once

#include <span>
#include <string_view>

#include "shader/op.h"

namespace komorebi {

/// @returns null if there is no such operation
const OpInfo* find_op(std::string_view name);

// The families of operations, each in a file of its own (ops_*.cpp).
std::span<const OpInfo> arithmetic_ops();
std::span<const OpInfo> math_ops();
std::span<const OpInfo> vector_ops();
std::span<const OpInfo> color_ops();
std::span<const OpInfo> noise_ops();
std::span<const OpInfo> pattern_ops();
std::span<const OpInfo> spectrum_ops();
std::span<const OpInfo> surface_ops();
std::span<const OpInfo> table_ops();
std::span<const OpInfo> voronoi_ops();
std::span<const OpInfo> sky_ops();
std::span<const OpInfo> texture_ops();

}  // namespace komorebi
