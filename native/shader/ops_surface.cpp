#include "shader/op_lanes.h"
#include "shader/op_table.h"
#include "shader/vector_math.h"

namespace komorebi {
namespace {

// What a dielectric reflects of unpolarised light that comes at this cosine.
float fresnel(float cosine, float eta) {
  const float c = fn::abs(cosine);
  float g = eta * eta - 1.0f + c * c;
  if (!(g > 0.0f)) return 1.0f;
  g = std::sqrt(g);
  const float a = (g - c) / (g + c);
  const float b = ((g + c) * c - 1.0f) / ((g - c) * c + 1.0f);
  return 0.5f * a * a * (1.0f + b * b);
}

// 1 where the surface is seen edge on.
float facing(float cosine, float blend) {
  float c = fn::abs(cosine);
  if (blend != 0.5f) {
    const float b = node::clamp(blend, 0.0f, 1.0f - 1e-5f);
    c = node::power(c, b < 0.5f ? 2.0f * b : 0.5f / (1.0f - b));
  }
  return 1.0f - c;
}

// The normal of a surface that heights raise: in: normal, dx, dy, height, height at dx, height at
// dy, distance, strength, width of the filter.
Vec3 bump(const OpCall& c, std::uint32_t i) {
  const Vec3 n = input_vector(c, 0, i), dx = input_vector(c, 3, i), dy = input_vector(c, 6, i);
  const float height = c.in[9][i], at_dx = c.in[10][i] - height, at_dy = c.in[11][i] - height;
  const float distance = c.in[12][i], strength = node::most(c.in[13][i], 0.0f);
  const Vec3 across_x = cross(dy, n), across_y = cross(n, dx);
  const float area = dot(dx, across_x);
  const Vec3 slope = across_x * at_dx + across_y * at_dy;
  const float side = area < 0.0f ? -1.0f : 1.0f;
  const Vec3 raised =
      node::safe_normalize(n * (c.in[14][i] * fn::abs(area)) - slope * (distance * side));
  if (!(dot(raised, raised) > 0.0f)) return n;
  return node::safe_normalize(raised * strength + n * (1.0f - strength));
}

constexpr OpInfo kOps[] = {
    // in: cosine, index of refraction across the surface
    {"fresnel", run2<fresnel>, 2, 1},
    // in: cosine, blend
    {"facing", run2<facing>, 2, 1},
    {"bump", [](const OpCall& c) { to_vector(c, [&](std::uint32_t i) { return bump(c, i); }); }, 15,
     3},
    // in: what is taken if it is finite and not 0, what otherwise
    {"or_normal",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         const Vec3 n = input_vector(c, 0, i);
         const float size = dot(n, n);
         return size > 0.0f && is_finite(size) ? n : input_vector(c, 3, i);
       });
     },
     6, 3},
};

}  // namespace

std::span<const OpInfo> surface_ops() {
  return kOps;
}

}  // namespace komorebi
