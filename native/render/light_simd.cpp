// Compiles the kernels of light_simd-inl.h for every instruction set: Highway includes this file
// again for each, with other compiler options.
#include "bvh/simd_targets.h"
#include "core/sampler.h"
#include "render/light_kernel.h"

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

const LightKernel* const kSimdLightKernels[] = {KOMOREBI_KERNELS(kLightKernel)};

}  // namespace komorebi
#endif
