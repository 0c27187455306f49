#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "core/functions.h"
#include "shader/sky.h"

/// Radiance of skies by direction, from the numbers and table that sky.h makes: linear Rec.709.
/// Directions need not be unit; as in Cycles their z counts as if they were.
namespace komorebi {

/// CIE XYZ (white D65) as linear Rec.709, colours outside of it cut off.
inline Vec3 sky_rgb(float x, float y, float z) {
  const auto shown = [](float v) { return v > 0.0f ? v : 0.0f; };
  return Vec3(shown(3.2404542f * x - 1.5371385f * y - 0.4985314f * z),
              shown(-0.9692660f * x + 1.8760108f * y + 0.0415560f * z),
              shown(0.0556434f * x - 0.2040259f * y + 1.0572252f * z));
}

/// The angle from the zenith.
inline float sky_theta(const Vec3& d) {
  return fn::acos(std::min(std::max(d.z, -1.0f), 1.0f));
}

/// What Preetham's and Hosek's sky depend on: cosines of the angles to the zenith, as at the
/// horizon if it is below, and to the sun.
struct SkyAngles {
  float cos_theta, cos_gamma, gamma;
};
inline SkyAngles sky_angles(const Vec3& d, float sun_theta, float sun_phi) {
  const float theta = sky_theta(d);
  const float phi = fn::atan2(d.x, d.y);
  const float cos_gamma = fn::sin(theta) * fn::sin(sun_theta) * fn::cos(sun_phi - phi) +
                          fn::cos(theta) * fn::cos(sun_theta);
  const float cosine = std::min(std::max(cos_gamma, -1.0f), 1.0f);
  constexpr float kHorizon = 0.5f * kPiFloat - 0.001f;
  return {fn::cos(std::min(theta, kHorizon)), cosine, fn::acos(cosine)};
}

/// Perez' distribution; c are its five coefficients.
inline float perez(const float* c, float cos_theta, float cos_gamma, float gamma) {
  return (1.0f + c[0] * fn::exp(c[1] / cos_theta)) *
         (1.0f + c[2] * fn::exp(c[3] * gamma) + c[4] * cos_gamma * cos_gamma);
}

/// n: the sun's θ and φ, then x, y, Y at the zenith over what Perez' distribution is there, then
/// five coefficients for each.
inline Vec3 preetham_radiance(const float* n, const Vec3& d) {
  const SkyAngles a = sky_angles(d, n[0], n[1]);
  const float x = n[2] * perez(n + 5, a.cos_theta, a.cos_gamma, a.gamma);
  const float y = n[3] * perez(n + 10, a.cos_theta, a.cos_gamma, a.gamma);
  const float luminance = n[4] * perez(n + 15, a.cos_theta, a.cos_gamma, a.gamma);
  if (y == 0.0f) return sky_rgb(0.0f, luminance, 0.0f);
  return sky_rgb(x / y * luminance, luminance, (1.0f - x - y) / y * luminance);
}

/// c: the nine coefficients of the distribution.
inline float hosek_distribution(const float* c, const SkyAngles& a) {
  const float rayleigh = a.cos_gamma * a.cos_gamma;
  const float bend = 1.0f + c[8] * c[8] - 2.0f * c[8] * a.cos_gamma;
  const float mie = (1.0f + rayleigh) / (bend * std::sqrt(bend));
  return (1.0f + c[0] * fn::exp(c[1] / (a.cos_theta + 0.01f))) *
         (c[2] + c[3] * fn::exp(c[4] * a.gamma) + c[5] * rayleigh + c[6] * mie +
          c[7] * std::sqrt(a.cos_theta));
}

/// n: the sun's θ and φ, then X, Y, Z's mean radiances, then nine coefficients for each.
inline Vec3 hosek_radiance(const float* n, const Vec3& d) {
  constexpr float kScale = kTwoPi / 683.0f;  // as Cycles sets its strength
  const SkyAngles a = sky_angles(d, n[0], n[1]);
  return kScale * sky_rgb(n[2] * hosek_distribution(n + 5, a), n[3] * hosek_distribution(n + 14, a),
                          n[4] * hosek_distribution(n + 23, a));
}

/// Filters a sky's table linearly at (x, y) of its whole picture, [0, 1]²; beyond is as at the
/// edge.
inline Vec3 look_up_sky(std::span<const float> table, float x, float y) {
  const auto rows = static_cast<std::int32_t>(table.size() / (3 * kSkyColumns));
  if (rows == 0 || !is_finite(x) || !is_finite(y)) return Vec3(0.0f);
  constexpr auto kHalf = static_cast<std::int32_t>(kSkyColumns);
  const float u = x * (2.0f * kHalf) - 0.5f;
  const float v = y * static_cast<float>(rows) - 0.5f;
  const auto column = [](std::int32_t i) {
    const std::int32_t inside = std::clamp(i, 0, 2 * kHalf - 1);
    return inside < kHalf ? inside : 2 * kHalf - 1 - inside;
  };
  const auto texel = [&](std::int32_t i, std::int32_t j) {
    const float* t =
        &table[3 * static_cast<std::size_t>(std::clamp(j, 0, rows - 1) * kHalf + column(i))];
    return Vec3(t[0], t[1], t[2]);
  };
  const std::int32_t i = floor_to_int(u), j = floor_to_int(v);
  const float s = u - static_cast<float>(i), t = v - static_cast<float>(j);
  return (1.0f - t) * ((1.0f - s) * texel(i, j) + s * texel(i + 1, j)) +
         t * ((1.0f - s) * texel(i, j + 1) + s * texel(i + 1, j + 1));
}

/// A sky of one of the last three models, from the numbers of "sky_scattering": the model, whether
/// the disc is shown, XYZ at the disc's lowest and highest point, the sun's elevation, rotation,
/// size and intensity, and below which elevation the earth hides it.
class ScatteringSky {
 public:
  ScatteringSky(const float* numbers, std::span<const float> table)
      : model_(static_cast<SkyModel>(static_cast<int>(numbers[0]))),
        has_disc_(numbers[1] != 0.0f),
        bottom_(numbers[2], numbers[3], numbers[4]),
        top_(numbers[5], numbers[6], numbers[7]),
        elevation_(numbers[8]),
        rotation_(numbers[9]),
        size_(numbers[10]),
        intensity_(numbers[11]),
        horizon_(numbers[12]),
        table_(table) {
    const float flat = fn::cos(elevation_);
    sun_ = Vec3(flat * fn::sin(rotation_), flat * fn::cos(rotation_), fn::sin(elevation_));
  }

  const Vec3& sun() const { return sun_; }

  Vec3 radiance(const Vec3& d) const {
    const float elevation = 0.5f * kPiFloat - sky_theta(d);
    // Of the newer models the disc is added to the sky, of Nishita's it is there instead.
    const bool is_nishita = model_ == SkyModel::kNishita;
    Vec3 disc(0.0f);
    if (has_disc_ && (is_nishita ? d.z >= 0.0f : elevation > horizon_)) {
      const float angle = 2.0f * fn::atan2(glm::length(d - sun_), glm::length(d + sun_));
      if (angle < 0.5f * size_) {
        disc = this->disc(elevation, angle);
        if (is_nishita) return disc;
      }
    }
    return disc + sky(d, elevation);
  }

 private:
  Vec3 disc(float elevation, float angle) const {
    float y = (elevation - elevation_) / size_ + 0.5f;
    // What is left of Nishita's disc at the horizon is stretched over its two colours.
    const float top = elevation_ + 0.5f * size_;
    if (model_ == SkyModel::kNishita && elevation_ - 0.5f * size_ <= 0.0f) y = elevation / top;
    const Vec3 xyz = bottom_ + y * (top_ - bottom_);
    const float edge = angle / (0.5f * size_);
    const float limb = 1.0f - 0.6f * (1.0f - std::sqrt(std::max(1.0f - edge * edge, 0.0f)));
    return intensity_ * limb * sky_rgb(xyz.x, xyz.y, xyz.z);
  }

  Vec3 sky(const Vec3& d, float elevation) const {
    const float x = fn::fract((fn::atan2(d.x, d.y) - kPiFloat - rotation_) / kTwoPi);
    float y = std::sqrt(fn::abs(elevation) / (0.5f * kPiFloat)), fade = 1.0f;
    if (model_ != SkyModel::kNishita) {
      y = (elevation < 0.0f ? -0.5f : 0.5f) * y + 0.5f;
    } else if (d.z < 0.0f) {  // there is no ground, but it is black soon
      if (d.z < -0.4f) return Vec3(0.0f);
      fade = 1.0f + 2.5f * d.z;
      fade *= fade * fade;
      y = 0.0f;
    }
    const Vec3 xyz = fade * look_up_sky(table_, x, y);
    return sky_rgb(xyz.x, xyz.y, xyz.z);
  }

  SkyModel model_;
  bool has_disc_;
  Vec3 bottom_, top_;
  float elevation_, rotation_, size_, intensity_, horizon_;
  std::span<const float> table_;
  Vec3 sun_;
};

}  // namespace komorebi
