#pragma once

#include <cstdint>

#include "bvh/kernel.h"

namespace komorebi {

/// Which of a null-terminated table of kernels in the order of KOMOREBI_KERNELS
/// (bvh/simd_targets.h) is for the active instruction set, or the one for any processor. Loops over
/// lanes are the same code in all of them, compiled again, and so equal in every bit.
template <class Kernel>
const Kernel& lane_kernel(const Kernel* const* kernels, const Kernel& plain) {
  const int index = active_kernel_index();
  return index < 0 ? plain : *kernels[index];
}

}  // namespace komorebi
