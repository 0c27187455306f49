// Compiles the builders' inner loops for every instruction set, as traverse_simd.cpp does.
#include "bvh/treelet.h"

#include <cstring>

#include "bvh/quantise.h"
#include "bvh/traverse.h"
#include "hwy/cache_control.h"

// GCC before 12.3 gets 16-bit high products of this fallback wrong (bug 106322); none is used here.
#define HWY_BROKEN_EMU128 0
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bvh/treelet.cpp"
// The order of these matters.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "bvh/treelet_box-inl.h"
#include "bvh/treelet_load-inl.h"
#include "bvh/treelet_linear-inl.h"
#include "bvh/treelet_sah-inl.h"
#include "bvh/emit-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {

extern const BuildKernel kBuildKernel;
const BuildKernel kBuildKernel = {&code, &load, &linear, &sah, &measure, &split, &emit};

}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace komorebi {

const BuildKernel& build_kernel() {
  // The set that rays use, or the next one below that is built here.
  const char* const set = active_instruction_set();
#if HWY_TARGETS & HWY_AVX2
  if (std::strncmp(set, "AVX", 3) == 0) return N_AVX2::kBuildKernel;
#endif
#if HWY_TARGETS & HWY_SSE4
  if (std::strcmp(set, "SSE4") == 0) return N_SSE4::kBuildKernel;
#endif
  static_cast<void>(set);
  return HWY_STATIC_DISPATCH(kBuildKernel);
}

}  // namespace komorebi
#endif
