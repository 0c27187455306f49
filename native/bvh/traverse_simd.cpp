// Compiles the kernels of traverse_simd-inl.h for every instruction set: Highway includes this
// file again for each, with other compiler options.
#include <new>

#include "bvh/closest.h"
#include "bvh/kernel.h"
#include "bvh/moving_leaf.h"
#include "bvh/pack_table.h"
#include "bvh/round_leaf.h"
#include "bvh/simd_targets.h"
#include "bvh/traverse_scalar.h"
#include "core/instance_motion.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bvh/traverse_simd.cpp"
// The order of these matters.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "bvh/traverse_simd-inl.h"
#include "bvh/bundle_rays-inl.h"
#include "bvh/bundle_boxes-inl.h"
#include "bvh/bundle_nodes-inl.h"
#include "bvh/bundle_leaves-inl.h"
#include "bvh/bundle_cluster-inl.h"
#include "bvh/bundle_round-inl.h"
#include "bvh/bundle_moving-inl.h"
#include "bvh/bundle_world-inl.h"
#include "bvh/bundle_walk-inl.h"
#include "bvh/bundle_filter-inl.h"
#include "bvh/bundle_sort-inl.h"
#include "bvh/bundle_closest-inl.h"
#include "bvh/kernel-inl.h"
// clang-format on

#if HWY_ONCE
namespace komorebi {

const Kernel* const kSimdKernels[] = {KOMOREBI_KERNELS(kKernel)};

}  // namespace komorebi
#endif
