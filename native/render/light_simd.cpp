// Compiles the kernels of light_simd-inl.h for every instruction set: Highway includes this file
// again for each, with other compiler options.
#include "core/sampler.h"
#include "render/light_kernel.h"

// Levels that add nothing to these kernels, and vectors whose length the compiler does not know.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/light_simd.cpp"
// The order of these matters.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "render/lanes-inl.h"
#include "render/product_lanes-inl.h"
#include "render/light_simd-inl.h"
// clang-format on

#if HWY_ONCE
namespace komorebi {

const LightKernel* const kSimdLightKernels[] = {
#if HWY_TARGETS & HWY_AVX3
    &N_AVX3::kLightKernel,
#endif
#if HWY_TARGETS & HWY_AVX2
    &N_AVX2::kLightKernel,
#endif
#if HWY_TARGETS & HWY_SSE4
    &N_SSE4::kLightKernel,
#endif
#if HWY_TARGETS & HWY_NEON
    &N_NEON::kLightKernel,
#endif
    nullptr,
};

}  // namespace komorebi
#endif
