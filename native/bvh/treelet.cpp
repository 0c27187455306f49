// Compiles the builders' inner loops for every instruction set, as traverse_simd.cpp does.
#include "bvh/treelet.h"

#include <algorithm>
#include <cstring>

// GCC before 12.3 gets 16-bit high products of this fallback wrong (bug 106322); none is used here.
#define HWY_BROKEN_EMU128 0
#include "bvh/quantise.h"
#include "bvh/simd_targets.h"
#include "bvh/traverse.h"
#include "hwy/cache_control.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bvh/treelet.cpp"
// The order of these matters.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "bvh/treelet_box-inl.h"
#include "bvh/treelet_load-inl.h"
#include "bvh/leaf-inl.h"
#include "bvh/treelet_strips-inl.h"
#include "bvh/treelet_bins-inl.h"
#include "bvh/treelet_few-inl.h"
#include "bvh/treelet_sah-inl.h"
#include "bvh/plan-inl.h"
#include "bvh/quantise-inl.h"
#include "bvh/emit-inl.h"
#include "bvh/treelet_lengths-inl.h"
#include "bvh/treelet_cuts-inl.h"
#include "bvh/treelet_pack-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {

extern const BuildKernel kBuildKernel;
const BuildKernel kBuildKernel = {&HWY_STR(HWY_NAMESPACE)[2],  // N_AVX2: "AVX2"
                                  &code<std::uint32_t>,
                                  &code<std::uint64_t>,
                                  &load,
                                  &load_corners,
                                  &cluster,
                                  &measure,
                                  &split,
                                  &bound,
                                  &quantise_children,
                                  &pack_treelet,
                                  &sah_treelet,
                                  &emit_tree};

}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace komorebi {

const BuildKernel& build_kernel() {
  // The set that rays use, or the next one below that is built here.
  static constexpr const BuildKernel* kKernels[] = {KOMOREBI_KERNELS(kBuildKernel)};
  const char* const set = active_instruction_set();
  for (const BuildKernel* const* kernel = kKernels; *kernel != nullptr; ++kernel) {
    if (std::strcmp((*kernel)->name, set) == 0) return **kernel;
  }
  return HWY_STATIC_DISPATCH(kBuildKernel);
}

}  // namespace komorebi
#endif
