#pragma once

#include "core/light_texels.h"
#include "core/sampler.h"
#include "core/warp.h"

/// Light from all around: a constant colour or an equirectangular map, with look-up, sampling and
/// density. The map is cut into patches between texel centres, width × (height + 1) of them (the
/// two outermost rows are half as high and end at the poles). Within a patch the radiance is
/// bilinear in (u, v), and the density is bilinear in (u, z = sin latitude): so it is positive
/// wherever radiance is, and the solid angle of a patch, Δφ · Δz, is exact.
namespace komorebi {

/// A committed environment as plain pointers; made by Environment::view (render/environment.h).
struct EnvironmentView {
  Mat3 texture_from_world{1.0f};        ///< orthonormal; its transpose is its inverse
  Vec3 constant{0.0f};                  ///< radiance where there is no map
  float strength = 1.0f;                ///< factor on the map's radiance; no part of the density
  std::uint32_t width = 0, height = 0;  ///< texels; 0: constant
  LightStorage storage = LightStorage::kFloat;
  /// Texels ≥ 0, row 0 at the bottom: [height][width][3], or as `storage` says the words of them.
  const float* texels = nullptr;
  const std::uint32_t* words = nullptr;
  /// Cumulative probabilities from 0 to 2^31, in units of 2^-31. An entry of no weight spans
  /// exactly nothing, any other at least one unit.
  const std::uint32_t* row_cdf = nullptr;     ///< [height + 2]
  const std::uint32_t* column_cdf = nullptr;  ///< [height + 1][width + 1]
  const double* row_z = nullptr;              ///< [height + 2] z at the patch rows' edges
};

struct EnvironmentValue {
  Vec3 radiance;
  float pdf;  ///< of sample_environment choosing the direction, by solid angle
};

struct EnvironmentSample {
  Vec3 direction;  ///< world space, unit length, towards the light
  Vec3 radiance;
  float pdf;  ///< 0 only where the radiance is 0 (or on rounding): such samples carry nothing
};

/// What the density is proportional to: luminance of linear Rec. 709.
inline float luminance(const Vec3& rgb) {
  return 0.2126f * rgb.x + 0.7152f * rgb.y + 0.0722f * rgb.z;
}

/// Where in the map a direction of texture space lies, as Blender and Cycles have it:
/// u = 1/2 − atan2(y, x) / 2π, v = 1/2 + atan2(z, √(x² + y²)) / π.
inline Vec2 equirectangular_from_direction(const Vec3& d) {
  const float r = std::sqrt(d.x * d.x + d.y * d.y);
  return Vec2(0.5f - atan2_radians(d.y, d.x) * kInvTwoPi, 0.5f + atan2_radians(d.z, r) * kInvPi);
}

inline Vec3 direction_from_equirectangular(const Vec2& uv) {
  const auto [sin_phi, cos_phi] = sin_cos_turns(0.5f - uv.x);
  const auto [sin_lat, cos_lat] = sin_cos_turns(0.5f * uv.y - 0.25f);
  return Vec3(cos_lat * cos_phi, cos_lat * sin_phi, sin_lat);
}

namespace detail {

struct EnvironmentPatch {
  std::uint32_t row,
      column;  ///< row 0 starts at the south pole; column c starts at texel c's centre
  Vec3 low_left, low_right, high_left, high_right;  ///< the four texels
};

inline Vec3 environment_texel(const EnvironmentView& e, std::uint32_t column, std::uint32_t row) {
  const std::uint64_t i = static_cast<std::uint64_t>(row) * e.width + column;
  if (e.storage == LightStorage::kRgbe) return rgbe_texel(e.words[i]);
  if (e.storage == LightStorage::kHalf) {
    return Vec3(packed_half(e.words, 3 * i), packed_half(e.words, 3 * i + 1),
                packed_half(e.words, 3 * i + 2));
  }
  const float* p = e.texels + 3 * i;
  return Vec3(p[0], p[1], p[2]);
}

// Patch row r lies between texel rows r − 1 and r, columns c between texels c and c + 1; both
// repeat, as Cycles' look-up does even across the poles.
inline EnvironmentPatch environment_patch(const EnvironmentView& e, std::uint32_t row,
                                          std::uint32_t column) {
  const std::uint32_t low = row == 0 ? e.height - 1 : row - 1;
  const std::uint32_t high = row == e.height ? 0 : row;
  const std::uint32_t right = column + 1 == e.width ? 0 : column + 1;
  return {row,
          column,
          environment_texel(e, column, low),
          environment_texel(e, right, low),
          environment_texel(e, column, high),
          environment_texel(e, right, high)};
}

// The weights of the density at a patch's corners: the luminance there. The pole rows are half
// patches, so their outer corners lie midway between two texels.
struct PatchWeights {
  float low_left, low_right, high_left, high_right;
};
/// Of a patch with the luminances `w` at its corners.
inline PatchWeights patch_weights(bool lowest_row, bool highest_row, PatchWeights w) {
  if (lowest_row) {
    w.low_left = 0.5f * w.low_left + 0.5f * w.high_left;
    w.low_right = 0.5f * w.low_right + 0.5f * w.high_right;
  } else if (highest_row) {
    w.high_left = 0.5f * w.low_left + 0.5f * w.high_left;
    w.high_right = 0.5f * w.low_right + 0.5f * w.high_right;
  }
  return w;
}
inline PatchWeights patch_weights(const EnvironmentView& e, const EnvironmentPatch& p) {
  return patch_weights(p.row == 0, p.row == e.height,
                       {luminance(p.low_left), luminance(p.low_right), luminance(p.high_left),
                        luminance(p.high_right)});
}

inline float mix(float a, float b, float t) {
  return a * (1.0f - t) + b * t;
}
inline Vec3 mix(const Vec3& a, const Vec3& b, float t) {
  return a * (1.0f - t) + b * t;
}

inline Vec3 patch_radiance(const EnvironmentPatch& p, float s, float t) {
  return mix(mix(p.low_left, p.low_right, s), mix(p.high_left, p.high_right, s), t);
}

inline const std::uint32_t* patch_columns(const EnvironmentView& e, std::uint32_t row) {
  return e.column_cdf + static_cast<std::uint64_t>(row) * (e.width + 1);
}

// Where 32 random bits fall among `count` entries: which, and how far into it, 0 ≤ fraction < 1.
struct CdfPosition {
  std::uint32_t entry;
  float fraction;
};
inline CdfPosition find_in_cdf(const std::uint32_t* cdf, std::uint32_t count, std::uint32_t bits) {
  const std::uint32_t units = bits >> 1;
  std::uint32_t first = 0;  // the last entry that starts at or below: never an empty one
  while (count > 1) {
    const std::uint32_t half = count / 2;
    if (cdf[first + half] <= units) first += half;
    count -= half;
  }
  const double offset = 0.5 * (static_cast<double>(bits) + 0.5) - cdf[first];
  const auto fraction = static_cast<float>(offset / (cdf[first + 1] - cdf[first]));
  return {first, fraction < kOneMinusEpsilon ? fraction : kOneMinusEpsilon};
}

// The density at (s, t), t linear in z, of a patch that is chosen with this probability.
inline float density_in_patch(const EnvironmentView& e, const EnvironmentPatch& p,
                              const PatchWeights& w, float s, float t, double probability) {
  const float mean =
      0.25f * w.low_left + 0.25f * w.low_right + 0.25f * w.high_left + 0.25f * w.high_right;
  if (!(mean > 0.0f)) return 0.0f;
  const float shape =
      mix(mix(w.low_left, w.low_right, s), mix(w.high_left, w.high_right, s), t) / mean;
  const double solid_angle = 2.0 * kPi / e.width * (e.row_z[p.row + 1] - e.row_z[p.row]);
  return static_cast<float>(probability / solid_angle * static_cast<double>(shape));
}

// With which probability sample_environment chooses a patch, from the very integers that choose it.
inline double patch_probability(const EnvironmentView& e, std::uint32_t row, std::uint32_t column) {
  const std::uint32_t* columns = patch_columns(e, row);
  const double row_units = e.row_cdf[row + 1] - e.row_cdf[row];
  const double column_units = columns[column + 1] - columns[column];
  return row_units * column_units * 2.1684043449710089e-19;  // 2^-62
}

struct PatchPosition {
  EnvironmentPatch patch;
  float s;           ///< across the patch, 0…1
  float t;           ///< between the texel rows (1/2…1 and 0…1/2 in the pole rows)
  float z_fraction;  ///< up the patch in z, 0…1
};

// x limited to 0…last; 0 for a NaN, so that no direction whatever reads outside the map.
inline float limit(float x, float last) {
  return x > 0.0f ? (x < last ? x : last) : 0.0f;
}

inline PatchPosition locate(const EnvironmentView& e, const Vec3& d) {
  const Vec2 uv = equirectangular_from_direction(d);
  // half a texel up, so that patches start at whole numbers; column 0 of this is the last one's
  const auto columns = static_cast<float>(e.width), rows = static_cast<float>(e.height);
  const float x = limit(uv.x * columns + 0.5f, columns + 0.5f);
  const float y = limit(uv.y * rows + 0.5f, rows + 0.5f);
  const auto right = static_cast<std::uint32_t>(x);
  const auto row = static_cast<std::uint32_t>(y);
  const std::uint32_t column = right == 0 ? e.width - 1 : right - 1;

  // z to double precision next to the poles too: 1 − |z| = r² / (1 + |z|)
  const Vec3d q(d);
  const double r2 = q.x * q.x + q.y * q.y;
  const double length = std::sqrt(r2 + q.z * q.z);
  const double rest = r2 / (length * (length + (q.z < 0.0 ? -q.z : q.z)));
  const double z = q.z < 0.0 ? rest - 1.0 : 1.0 - rest;
  const double z0 = e.row_z[row];
  const double fraction = (z - z0) / (e.row_z[row + 1] - z0);
  const double inside = fraction > 0.0 ? (fraction < 1.0 ? fraction : 1.0) : 0.0;
  return {environment_patch(e, row, column), x - static_cast<float>(right),
          y - static_cast<float>(row), static_cast<float>(inside)};
}

}  // namespace detail

/// Radiance from `direction` (world space; any length but 0) and the density of sampling it.
inline EnvironmentValue evaluate_environment(const EnvironmentView& e, const Vec3& direction) {
  if (e.width == 0) return {e.constant, uniform_sphere_pdf()};
  const auto at = detail::locate(e, e.texture_from_world * direction);
  const auto weights = detail::patch_weights(e, at.patch);
  return {e.strength * detail::patch_radiance(at.patch, at.s, at.t),
          detail::density_in_patch(e, at.patch, weights, at.s, at.z_fraction,
                                   detail::patch_probability(e, at.patch.row, at.patch.column))};
}

inline Vec3 environment_radiance(const EnvironmentView& e, const Vec3& direction) {
  if (e.width == 0) return e.constant;
  const auto at = detail::locate(e, e.texture_from_world * direction);
  return e.strength * detail::patch_radiance(at.patch, at.s, at.t);
}

inline float environment_pdf(const EnvironmentView& e, const Vec3& direction) {
  return evaluate_environment(e, direction).pdf;
}

namespace detail {

// A sample from a patch that was chosen with this probability: bilinear in (u, z), by the inverse
// transform.
inline EnvironmentSample sample_patch(const EnvironmentView& e, std::uint32_t row,
                                      std::uint32_t column, float column_fraction,
                                      float row_fraction, double probability) {
  const EnvironmentPatch patch = environment_patch(e, row, column);
  const PatchWeights w = patch_weights(e, patch);
  const float up = sample_linear(row_fraction, 0.5f * w.low_left + 0.5f * w.low_right,
                                 0.5f * w.high_left + 0.5f * w.high_right);
  const float across = sample_linear(column_fraction, mix(w.low_left, w.high_left, up),
                                     mix(w.low_right, w.high_right, up));

  const double z = e.row_z[row] + static_cast<double>(up) * (e.row_z[row + 1] - e.row_z[row]);
  const auto r = static_cast<float>(std::sqrt((1.0 - z) * (1.0 + z)));
  const float turns =
      0.5f - (static_cast<float>(column) + 0.5f + across) / static_cast<float>(e.width);
  const auto [sin_phi, cos_phi] = sin_cos_turns(turns);
  const Vec3 direction(r * cos_phi, r * sin_phi, static_cast<float>(z));

  const float v = 0.5f + atan2_radians(direction.z, r) * kInvPi;
  const float t = v * static_cast<float>(e.height) - 0.5f - (static_cast<float>(row) - 1.0f);
  const float inside = t > 0.0f ? (t < 1.0f ? t : 1.0f) : 0.0f;
  return {glm::transpose(e.texture_from_world) * direction,
          e.strength * patch_radiance(patch, across, inside),
          density_in_patch(e, patch, w, across, up, probability)};
}

}  // namespace detail

/// A direction with density proportional to the map's luminance: the inverse transform of rows,
/// then of columns within the row, then bilinearly within the patch; monotone in both coordinates
/// from patch to patch. Takes all 32 bits of a sampler's coordinates: patches are chosen by whole
/// numbers, so even those of probability 2^-31 are met exactly as often as their pdf says.
inline EnvironmentSample sample_environment(const EnvironmentView& e, const Bits2& bits) {
  if (e.width == 0) {
    const Vec2 u(to_unit_float(bits.x), to_unit_float(bits.y));
    return {uniform_sphere(u), e.constant, uniform_sphere_pdf()};
  }
  const auto [row, row_fraction] = detail::find_in_cdf(e.row_cdf, e.height + 1, bits.y);
  const auto [column, column_fraction] =
      detail::find_in_cdf(detail::patch_columns(e, row), e.width, bits.x);
  return detail::sample_patch(e, row, column, column_fraction, row_fraction,
                              detail::patch_probability(e, row, column));
}

}  // namespace komorebi
