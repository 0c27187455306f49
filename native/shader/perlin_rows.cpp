#include "shader/perlin_rows.h"

#include "shader/perlin.h"
#include "shader/program.h"

namespace komorebi {
namespace {

constexpr float kPeriod = 100000.0f;

template <std::size_t N>
void rows(const float* const* p, std::uint32_t count, float* __restrict out) {
  for (std::uint32_t i = 0; i < count; ++i) {
    float at[N];
    for (std::size_t d = 0; d < N; ++d) at[d] = p[d][i];
    out[i] = perlin<N>(at);
  }
}

// The rest of a division by the period, of the sign of x. Both are whole multiples of the same
// power of two, so that doubles hold all of it.
float repeated(float x) {
  constexpr float kMostExact = 9.0e15f;  // about 2^53; beyond it nothing is left to tell apart
  const float size = absolute(x);
  if (!(size >= kPeriod)) return x;
  if (!(size < kMostExact)) return 0.5f;
  constexpr double kWide = kPeriod;
  const auto times = static_cast<double>(static_cast<std::int64_t>(size / kWide));
  double rest = static_cast<double>(size) - times * kWide;
  if (rest < 0.0) rest += kWide;
  if (rest >= kWide) rest -= kWide;
  const auto signed_rest = static_cast<float>(x < 0.0f ? -rest : rest);
  return size >= 1000000.0f ? signed_rest + 0.5f : signed_rest;
}

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
    for (std::uint32_t i = 0; i < count; ++i) inside[d][i] = repeated(p[d][i]);
    at[d] = inside[d];
  }
  switch (dimensions) {
    case 1:
      return rows<1>(at, count, out);
    case 2:
      return rows<2>(at, count, out);
    case 3:
      return rows<3>(at, count, out);
    default:
      return rows<4>(at, count, out);
  }
}

}  // namespace komorebi
