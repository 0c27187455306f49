// Compiles the kernels of scatter_simd-inl.h for every instruction set: Highway includes this file
// again for each, with other compiler options.
#include "bvh/simd_targets.h"
#include "core/path_key.h"
#include "render/scatter.h"
#include "render/scatter_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/scatter_simd.cpp"
// The order of these matters.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "render/lanes-inl.h"
#include "render/scatter_simd-inl.h"
// clang-format on

#if HWY_ONCE
namespace komorebi {

const ScatterKernel* const kSimdScatterKernels[] = {KOMOREBI_KERNELS(kScatterKernel)};

}  // namespace komorebi
#endif
