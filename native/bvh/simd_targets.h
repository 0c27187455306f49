#pragma once

// Which instruction sets kernels are compiled for. To be included before Highway's headers, by
// every file that Highway includes again for each set.

// Levels that add nothing to these kernels, and vectors whose length the compiler does not know.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include "hwy/detect_targets.h"

#if HWY_TARGETS & HWY_AVX3
#define KOMOREBI_AVX3_KERNEL(name) &N_AVX3::name,
#else
#define KOMOREBI_AVX3_KERNEL(name)
#endif
#if HWY_TARGETS & HWY_AVX2
#define KOMOREBI_AVX2_KERNEL(name) &N_AVX2::name,
#else
#define KOMOREBI_AVX2_KERNEL(name)
#endif
#if HWY_TARGETS & HWY_SSE4
#define KOMOREBI_SSE4_KERNEL(name) &N_SSE4::name,
#else
#define KOMOREBI_SSE4_KERNEL(name)
#endif
#if HWY_TARGETS & HWY_NEON
#define KOMOREBI_NEON_KERNEL(name) &N_NEON::name,
#else
#define KOMOREBI_NEON_KERNEL(name)
#endif

/// The kernels `name` of all sets, best first, and null: what stands between the braces of a table.
#define KOMOREBI_KERNELS(name) \
  KOMOREBI_AVX3_KERNEL(name)   \
  KOMOREBI_AVX2_KERNEL(name) KOMOREBI_SSE4_KERNEL(name) KOMOREBI_NEON_KERNEL(name) nullptr
