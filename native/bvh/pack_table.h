#pragma once

#include <array>
#include <cstdint>

namespace komorebi {

/// kPackTable[bits]: the numbers of the bits that are set, lowest first, then zeros. What moves the
/// chosen lanes of a vector to its front, where the processor has no instruction for it.
inline constexpr auto kPackTable = [] {
  std::array<std::array<std::uint8_t, 8>, 256> table{};
  for (unsigned bits = 0; bits < 256; ++bits) {
    std::size_t place = 0;
    for (unsigned i = 0; i < 8; ++i) {
      if ((bits >> i) & 1u) table[bits][place++] = static_cast<std::uint8_t>(i);
    }
  }
  return table;
}();

}  // namespace komorebi
