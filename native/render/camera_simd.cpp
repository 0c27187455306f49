// Compiles the kernels of camera_simd-inl.h for every instruction set: Highway includes this file
// again for each, with other compiler options.
#include "core/sampler.h"
#include "render/camera_kernel.h"

// Levels that add nothing to these kernels, and vectors whose length the compiler does not know.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/camera_simd.cpp"
// The order of these matters.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "render/lanes-inl.h"
#include "render/camera_simd-inl.h"
// clang-format on

#if HWY_ONCE
namespace komorebi {

const CameraKernel* const kSimdCameraKernels[] = {
#if HWY_TARGETS & HWY_AVX3
    &N_AVX3::kCameraKernel,
#endif
#if HWY_TARGETS & HWY_AVX2
    &N_AVX2::kCameraKernel,
#endif
#if HWY_TARGETS & HWY_SSE4
    &N_SSE4::kCameraKernel,
#endif
#if HWY_TARGETS & HWY_NEON
    &N_NEON::kCameraKernel,
#endif
    nullptr,
};

}  // namespace komorebi
#endif
