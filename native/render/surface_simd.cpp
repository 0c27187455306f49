// Compiles the kernels of surface_simd-inl.h for every instruction set: Highway includes this file
// again for each, with other compiler options.
#include "bvh/simd_targets.h"
#include "core/sampler.h"
#include "render/surface_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/surface_simd.cpp"
// The order of these matters.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "render/lanes-inl.h"
#include "render/vector_lanes-inl.h"
#include "render/terminator_lanes-inl.h"
#include "render/surface_simd-inl.h"
// clang-format on

#if HWY_ONCE
namespace komorebi {

const SurfaceKernel* const kSimdSurfaceKernels[] = {KOMOREBI_KERNELS(kSurfaceKernel)};

}  // namespace komorebi
#endif
