#include "shader/op_table.h"
#include "shader/scalar_math.h"

namespace komorebi {
namespace {

// A column of a table of `width` columns at x from 0 (its first row) to 1 (its last).
struct Column {
  std::span<const float> table;
  std::uint32_t width, column, last;

  float at(std::uint32_t row) const { return table[std::size_t{row} * width + column]; }

  float operator()(float x, bool interpolate, bool extrapolate) const {
    if (last == 0) return at(0);
    const auto rows = static_cast<float>(last);
    if (extrapolate && x < 0.0f) return at(0) - (at(0) - at(1)) * x * rows;
    if (extrapolate && x > 1.0f) return at(last) + (at(last) - at(last - 1)) * (x - 1.0f) * rows;
    const float place = node::clamp01(x) * rows;  // of NaN 0
    const auto row = static_cast<std::uint32_t>(place);
    const float t = place - static_cast<float>(row);
    if (!interpolate || !(t > 0.0f)) return at(row);
    return (1.0f - t) * at(row) + t * at(row + 1);
  }
};

// in: factor; numbers: 1 to interpolate; table: rows of red, green, blue, alpha
void ramp(const OpCall& c) {
  const auto last = static_cast<std::uint32_t>(c.table.size() / 4 - 1);
  for (std::uint32_t channel = 0; channel < 4; ++channel) {
    const Column column{c.table, 4, channel, last};
    for (std::uint32_t i = 0; i < c.count; ++i) {
      c.out[channel][i] = column(c.in[0][i], c.numbers[0] != 0.0f, false);
    }
  }
}

// in: factor, value; numbers: where the table begins and ends, 1 to go on beyond
void curve(const OpCall& c) {
  const Column column{c.table, 1, 0, static_cast<std::uint32_t>(c.table.size() - 1)};
  const float first = c.numbers[0], range = c.numbers[1] - first;
  const bool extrapolate = c.numbers[2] != 0.0f;
  for (std::uint32_t i = 0; i < c.count; ++i) {
    const float factor = c.in[0][i], x = c.in[1][i];
    const float y = column(node::divide(x - first, range), true, extrapolate);
    c.out[0][i] = (1.0f - factor) * x + factor * y;
  }
}

constexpr OpInfo kOps[] = {
    {"ramp", ramp, 1, 4, 1, true},
    {"curve", curve, 2, 1, 3, true},
};

}  // namespace

std::span<const OpInfo> table_ops() {
  return kOps;
}

}  // namespace komorebi
