// Highway includes this file again for each instruction set, with other compiler options.
#include "shader/voronoi_kernel.h"

#include "bvh/simd_targets.h"
#include "core/functions.h"
#include "shader/lane_kernels.h"
#include "shader/voronoi_features.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shader/voronoi_kernel.cpp"
// The order of these matters.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// clang-format on

// What each instruction set has of its own.
#define KOMOREBI_VORONOI_FIND(name)                                                \
  template <std::size_t N>                                                         \
  void name(const VoronoiKind& kind, const VoronoiRows& rows, std::uint32_t count, \
            VoronoiFound& found) {                                                 \
    voronoi_##name<N>(kind, rows, count, found);                                   \
  }
#define KOMOREBI_VORONOI_MEASURE(name)                                                           \
  template <std::size_t N>                                                                       \
  void name(const VoronoiKind& kind, const VoronoiRows& rows, std::uint32_t count, float* out) { \
    voronoi_##name<N>(kind, rows, count, out);                                                   \
  }
#define KOMOREBI_VORONOI_OF(name) \
  { &name<1>, &name<2>, &name<3>, &name<4> }  // NOLINT(bugprone-macro-parentheses)
#define KOMOREBI_VORONOI_FUNCTIONS        \
  KOMOREBI_VORONOI_FIND(nearest)          \
  KOMOREBI_VORONOI_FIND(second)           \
  KOMOREBI_VORONOI_FIND(smooth)           \
  KOMOREBI_VORONOI_MEASURE(edge_distance) \
  KOMOREBI_VORONOI_MEASURE(sphere_radius)
#define KOMOREBI_VORONOI_TABLE                                                              \
  {                                                                                         \
    KOMOREBI_VORONOI_OF(nearest), KOMOREBI_VORONOI_OF(second), KOMOREBI_VORONOI_OF(smooth), \
        KOMOREBI_VORONOI_OF(edge_distance), KOMOREBI_VORONOI_OF(sphere_radius)              \
  }

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

KOMOREBI_VORONOI_FUNCTIONS

}  // namespace

extern const VoronoiKernel kVoronoiKernel;
constexpr VoronoiKernel kVoronoiKernel = KOMOREBI_VORONOI_TABLE;

}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace komorebi {
namespace {

constexpr const VoronoiKernel* kKernels[] = {KOMOREBI_KERNELS(kVoronoiKernel)};

namespace plain {

KOMOREBI_VORONOI_FUNCTIONS

constexpr VoronoiKernel kKernel = KOMOREBI_VORONOI_TABLE;

}  // namespace plain

// x^e of x ≥ 0, quick for the exponents that are met most.
float power(float x, float e) {
  if (e == 0.5f) return __builtin_sqrtf(x);
  if (e == 1.0f) return x;
  if (e == 2.0f) return x * x;
  return fn::pow(x, e);
}

}  // namespace

const VoronoiKernel& voronoi_kernel() {
  return lane_kernel(kKernels, plain::kKernel);
}

void add_powers(const float* a, const float* b, const float* exponent, std::uint32_t count,
                bool first, float* out) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const float term = power(absolute(a[i] - b[i]), exponent[i]);
    out[i] = first ? term : out[i] + term;
  }
}

void take_roots(const float* exponent, std::uint32_t count, float* x) {
  for (std::uint32_t i = 0; i < count; ++i) x[i] = power(x[i], 1.0f / exponent[i]);
}

float voronoi_reach(VoronoiMetric metric, std::uint32_t dimensions, float side, float exponent) {
  const auto n = static_cast<float>(dimensions);
  if (dimensions == 1 || metric == VoronoiMetric::kChebychev) return side;
  if (metric == VoronoiMetric::kManhattan) return side * n;
  if (metric == VoronoiMetric::kEuclidean) return __builtin_sqrtf(side * side * n);
  return power(power(side, exponent) * n, 1.0f / exponent);
}

}  // namespace komorebi
#endif
