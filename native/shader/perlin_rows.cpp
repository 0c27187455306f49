// Highway includes this file again for each instruction set, with other compiler options.
#include "shader/perlin_rows.h"

#include "bvh/simd_targets.h"
#include "core/functions.h"
#include "shader/lane_kernels.h"
#include "shader/perlin.h"
#include "shader/program.h"

#ifndef KOMOREBI_SHADER_PERLIN_KERNEL
#define KOMOREBI_SHADER_PERLIN_KERNEL
namespace komorebi {

/// perlin_loop of 1 to 4 dimensions.
struct PerlinKernel {
  void (*of[4])(const float* const* p, std::uint32_t count, float* out);
};

}  // namespace komorebi
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shader/perlin_rows.cpp"
// The order of these matters.
// clang-format off
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

template <std::size_t N>
void rows(const float* const* p, std::uint32_t count, float* out) {
  perlin_loop<N>(p, count, out);
}

}  // namespace

extern const PerlinKernel kPerlinKernel;
constexpr PerlinKernel kPerlinKernel = {{&rows<1>, &rows<2>, &rows<3>, &rows<4>}};

}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace komorebi {
namespace {

constexpr const PerlinKernel* kKernels[] = {KOMOREBI_KERNELS(kPerlinKernel)};

template <std::size_t N>
void plain_rows(const float* const* p, std::uint32_t count, float* out) {
  perlin_loop<N>(p, count, out);
}
constexpr PerlinKernel kPlain = {{&plain_rows<1>, &plain_rows<2>, &plain_rows<3>, &plain_rows<4>}};

constexpr float kPeriod = 100000.0f;

bool any_beyond_period(const float* p, std::uint32_t count) {
  std::uint32_t beyond = 0;
  for (std::uint32_t i = 0; i < count; ++i) beyond |= !(absolute(p[i]) < kPeriod);
  return beyond != 0;
}

}  // namespace

void perlin_rows(std::uint32_t dimensions, const float* const* p, std::uint32_t count,
                 NoiseRepeat repeat, float* out) {
  float inside[4][Program::kLanes];
  const float* at[4];
  for (std::uint32_t d = 0; d < dimensions; ++d) {
    at[d] = p[d];
    if (repeat == NoiseRepeat::kNever || !any_beyond_period(p[d], count)) continue;
    for (std::uint32_t i = 0; i < count; ++i) {
      inside[d][i] = fn::fmod(p[d][i], kPeriod) + (absolute(p[d][i]) < 1000000.0f ? 0.0f : 0.5f);
    }
    at[d] = inside[d];
  }
  lane_kernel(kKernels, kPlain).of[dimensions - 1](at, count, out);
}

}  // namespace komorebi
#endif
