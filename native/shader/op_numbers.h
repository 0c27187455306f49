#pragma once

#include <cstdint>

#include "shader/lane.h"

namespace komorebi {

/// Numbers of an operation that stand for choices, whatever is in them: 0 to `most`.
KOMOREBI_LANE std::uint32_t choice(float x, std::uint32_t most) {
  return x > 0.0f ? static_cast<std::uint32_t>(smaller(x, static_cast<float>(most))) : 0u;
}

/// 1 to 4
KOMOREBI_LANE std::uint32_t dimension_count(float x) {
  return 1u + choice(x - 1.0f, 3);
}

}  // namespace komorebi
