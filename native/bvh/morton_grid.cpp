#include "bvh/morton_grid.h"

#include <algorithm>
#include <vector>

namespace komorebi {
namespace {

constexpr int kNarrowBits = 10, kWideBits = 21;

float longest_side(const Aabb& box) {
  return max_of(max_of(box.hi.x - box.lo.x, box.hi.y - box.lo.y), box.hi.z - box.lo.z);
}

/// The middle 15/16 of the sampled centres on each axis, grown by its own longest side.
Aabb core_of_sample(std::span<const Aabb> sample) {
  Aabb middle;
  std::vector<float> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (const Aabb& box : sample) values.push_back(centre(box)[axis]);
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 32);
    const auto to = values.end() - 1 - (from - values.begin());
    std::nth_element(values.begin(), from, values.end());
    middle.lo[axis] = *from;
    std::nth_element(from, to, values.end());
    middle.hi[axis] = *to;
  }
  return padded(middle, longest_side(middle));
}

}  // namespace

CellGrid::CellGrid(const Aabb& box, int bits) : lo(box.lo) {
  cells = static_cast<float>(1 << bits);
  const float side = longest_side(box);
  cells_per_unit = side > 0.0f ? cells / side : 0.0f;
  if (!(cells_per_unit <= kFloatMax)) cells_per_unit = 0.0f;  // a side of a few denormals
}

std::uint32_t MortonGrid::code_30(const Aabb& box) const {
  const Vec3 p = centre(box);
  const CellGrid& grid = in_core(p) ? core_grid : outer_grid;
  const std::uint32_t code = morton_30(grid.cell(p.x, 0), grid.cell(p.y, 1), grid.cell(p.z, 2));
  return in_core(p) ? code : code | (1u << 30);
}

std::uint64_t MortonGrid::code_63(const Aabb& box) const {
  const Vec3 p = centre(box);
  const CellGrid& grid = in_core(p) ? core_grid : outer_grid;
  const std::uint64_t code = morton_63(grid.cell(p.x, 0), grid.cell(p.y, 1), grid.cell(p.z, 2));
  return in_core(p) ? code : code | (std::uint64_t{1} << 63);
}

MortonGrid choose_morton_grid(const Aabb& all, std::span<const Aabb> sample) {
  MortonGrid grid;
  if (sample.empty()) return grid;
  grid.core = core_of_sample(sample);
  // An ordinary mesh fills its bounds: one grid then, which is the plain linear BVH.
  const float core_side = longest_side(grid.core);
  grid.is_one = !(core_side > 0.0f) || !(longest_side(all) > 2.0f * core_side);
  if (grid.is_one) grid.core = all;

  const float cell = longest_side(grid.core) / static_cast<float>(1 << kNarrowBits);
  std::size_t small = 0;
  for (const Aabb& box : sample) small += longest_side(box) < 0.0625f * cell ? 1u : 0u;
  grid.wide = small * 64 > sample.size();
  const int bits = grid.wide ? kWideBits : kNarrowBits;
  grid.core_grid = CellGrid(grid.core, bits);
  grid.outer_grid = CellGrid(all, bits);
  return grid;
}

}  // namespace komorebi
