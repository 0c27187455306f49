#include "bvh/choose_builder.h"

namespace komorebi {

Builder choose_builder(std::size_t triangle_count, double expected_rays) {
  const double break_even = kRaysPerTriangle * static_cast<double>(triangle_count);
  return expected_rays > break_even ? Builder::kSah : Builder::kLinear;
}

}  // namespace komorebi
