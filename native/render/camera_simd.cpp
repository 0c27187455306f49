// Compiles the kernels of camera_simd-inl.h for every instruction set: Highway includes this file
// again for each, with other compiler options.
#include "bvh/simd_targets.h"
#include "core/sampler.h"
#include "render/camera_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/camera_simd.cpp"
// The order of these matters.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "render/lanes-inl.h"
#include "render/vector_lanes-inl.h"
#include "render/camera_simd-inl.h"
// clang-format on

#if HWY_ONCE
namespace komorebi {

const CameraKernel* const kSimdCameraKernels[] = {KOMOREBI_KERNELS(kCameraKernel)};

}  // namespace komorebi
#endif
