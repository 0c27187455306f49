// Compiles the kernels of traverse_simd-inl.h for every instruction set: Highway includes this
// file again for each, with other compiler options.
#include "bvh/closest.h"
#include "bvh/kernel.h"
#include "bvh/pack_table.h"
#include "bvh/traverse_scalar.h"

// Levels that add nothing to these kernels, and vectors whose length the compiler does not know.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bvh/traverse_simd.cpp"
// The order of these matters.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "bvh/traverse_simd-inl.h"
#include "bvh/bundle_rays-inl.h"
#include "bvh/bundle_nodes-inl.h"
#include "bvh/bundle_leaves-inl.h"
#include "bvh/bundle_walk-inl.h"
#include "bvh/kernel-inl.h"
// clang-format on

#if HWY_ONCE
namespace komorebi {

const Kernel* const kSimdKernels[] = {
#if HWY_TARGETS & HWY_AVX3
    &N_AVX3::kKernel,
#endif
#if HWY_TARGETS & HWY_AVX2
    &N_AVX2::kKernel,
#endif
#if HWY_TARGETS & HWY_SSE4
    &N_SSE4::kKernel,
#endif
#if HWY_TARGETS & HWY_NEON
    &N_NEON::kKernel,
#endif
    nullptr,
};

}  // namespace komorebi
#endif
