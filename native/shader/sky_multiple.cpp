#include <algorithm>
#include <array>
#include <cmath>

#include "parallel/thread_pool.h"
#include "shader/sky_lanes.h"
#include "shader/sky_radiance.h"

/// Light scattered any number of times, by Fernando García Liñán's fit for four wavelengths
/// (https://fgarlin.com/posts/2024-12-06-spectral_sky/), with the tables and steps of Cycles. What
/// comes after the first scattering is a fit of the sun's elevation, and light from the ground.
/// Lengths are in kilometres.
namespace komorebi {
namespace {

using Spectrum = std::array<float, 4>;  // at 630, 560, 490 and 430 nm

constexpr double kEarth = 6371.0, kAirHeight = 100.0, kAtmosphere = kEarth + kAirHeight;
constexpr int kSteps = 64, kLutColumns = 256, kLutRows = 64;
constexpr auto kRadius = static_cast<float>(kEarth);
constexpr float kGroundAlbedo = 0.3f;
constexpr float kDustG = 0.8f;  // of Henyey and Greenstein's phase function
constexpr Spectrum kSunIrradiance = {1.679f, 1.828f, 1.986f, 1.307f};
// Scattering (and of dust absorption) of a kilometre of the air at the sea, dust's by cross
// section; ozone's absorption by cross section times the mean thickness of its layer.
constexpr Spectrum kMolecules = {6.605e-3f, 1.067e-2f, 1.842e-2f, 3.156e-2f};
constexpr Spectrum kDustScattering = {1.5908e-22f, 1.7711e-22f, 2.0942e-22f, 2.4033e-22f};
constexpr Spectrum kDustAbsorption = {2.8722e-24f, 4.6168e-24f, 7.9706e-24f, 1.3578e-23f};
constexpr float kDobson = 334.5f;
constexpr Spectrum kOzone = {kDobson * 3.472e-25f, kDobson * 3.914e-25f, kDobson * 1.349e-25f,
                             kDobson * 1.103e-26f};
constexpr Spectrum kLaterLight = {0.02f * 0.217f, 0.02f * 0.347f, 0.02f * 0.594f, 0.02f};
constexpr double kToXyz[4][3] = {{53.386917738564668, 22.981337506691025, 0.0},
                                 {43.904844466369358, 71.347795700053394, 0.10250686796574131},
                                 {1.6137278251608962, 18.422960591455485, 31.742921188390806},
                                 {20.762668673810577, 2.3614213523314369, 110.48009643252140}};

template <class F>
Spectrum each(F f) {
  return {f(0), f(1), f(2), f(3)};
}

Vec3d to_xyz(const Spectrum& spectrum) {
  Vec3d xyz(0.0);
  for (std::size_t i = 0; i < 4; ++i) {
    for (int c = 0; c < 3; ++c) xyz[c] += kToXyz[i][c] * double{spectrum[i]};
  }
  return xyz;
}

/// The distance to the end of the air, from r away from the earth's centre; `up` is the cosine of
/// the angle to the zenith.
double air_ahead(double r, double up) {
  const double along = r * up;
  return std::sqrt(std::max(along * along + kAtmosphere * kAtmosphere - r * r, 0.0)) - along;
}

/// Of molecules, dust and ozone: how dense they are, or this integrated along a ray.
struct Amounts {
  float molecules, dust, ozone;
};

inline Amounts densities(float height) {
  const float h = above_zero(height - 1e-4f) + 1e-4f;
  const float log_h = log_lane(h), from_middle = log_h - 3.22261f;
  return {exp_lane(-0.07771971f * exp_lane(1.16364243f * log_h)),
          1.3681e20f * exp_lane(h * (-1.0f / 0.73f)) + 2e6f,
          3.78547397e20f * exp_lane(-from_middle * from_middle * 5.55555555f - log_h)};
}

class Atmosphere {
 public:
  explicit Atmosphere(const SkyDesc& sky) : sky_(sky) {}

  Amounts at(float height) const { return scaled(densities(height)); }

  static float extinction(const Amounts& a, std::size_t k) {
    return kMolecules[k] * a.molecules + (kDustScattering[k] + kDustAbsorption[k]) * a.dust +
           kOzone[k] * a.ozone;
  }

  /// How much light comes to a height from the end of the air. The earth does not stand in the way:
  /// below its surface the air is as on it.
  Spectrum transmittance(double up, double height) const {
    const double r = kEarth + height;
    const auto excess = static_cast<float>(height * (2.0 * kEarth + height));
    const auto twice = static_cast<float>(2.0 * r * up);
    const float step = static_cast<float>(air_ahead(r, up)) / kSteps;
    float molecules[kSteps], dust[kSteps], ozone[kSteps];
    for (int i = 0; i < kSteps; ++i) {
      const float t = (static_cast<float>(i) + 0.5f) * step;
      const Amounts there = densities(height_over(kRadius, excess + t * (twice + t)));
      molecules[i] = there.molecules;
      dust[i] = there.dust;
      ozone[i] = there.ozone;
    }
    Amounts sum = {};
    for (int i = 0; i < kSteps; ++i) {
      sum.molecules += molecules[i];
      sum.dust += dust[i];
      sum.ozone += ozone[i];
    }
    sum = scaled(sum);
    return each([&](std::size_t k) { return exp_lane(-extinction(sum, k) * step); });
  }

 private:
  Amounts scaled(const Amounts& a) const {
    return {a.molecules * sky_.air, a.dust * sky_.aerosol, a.ozone * sky_.ozone};
  }

  const SkyDesc& sky_;
};

/// Transmittance by the cosine of the sun's angle to the zenith, and height.
class Transmittances {
 public:
  Transmittances(const Atmosphere& atmosphere, ThreadPool& pool)
      : table_(std::size_t{kLutColumns} * kLutRows) {
    pool.for_each_chunk(kLutRows, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) {
        const double height = kAirHeight * static_cast<double>(y) / (kLutRows - 1);
        for (std::size_t x = 0; x < kLutColumns; ++x) {
          const double up = 2.0 * static_cast<double>(x) / (kLutColumns - 1) - 1.0;
          table_[y * kLutColumns + x] = atmosphere.transmittance(up, height);
        }
      }
    });
  }

  Spectrum on_ground(float up) const {
    const float x = (kLutColumns - 1) * std::clamp(0.5f * up + 0.5f, 0.0f, 1.0f);
    const auto i = static_cast<std::size_t>(x);
    const Spectrum &a = table_[i], &b = table_[std::min<std::size_t>(i + 1, kLutColumns - 1)];
    return each([&](std::size_t k) { return a[k] + (x - static_cast<float>(i)) * (b[k] - a[k]); });
  }

  /// @param height  0 on the ground, 1 at the end of the air
  Spectrum at(float up, float height) const {
    const float x = (kLutColumns - 1) * std::clamp(0.5f * up + 0.5f, 0.0f, 1.0f);
    const float y = (kLutRows - 1) * std::clamp(height, 0.0f, 1.0f);
    const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
    const std::size_t i2 = std::min<std::size_t>(i + 1, kLutColumns - 1);
    const std::size_t j2 = std::min<std::size_t>(j + 1, kLutRows - 1);
    const float s = x - static_cast<float>(i), t = y - static_cast<float>(j);
    return each([&](std::size_t k) {
      const auto row = [&](std::size_t r) {
        const float a = table_[r * kLutColumns + i][k], b = table_[r * kLutColumns + i2][k];
        return a + s * (b - a);
      };
      return row(j) + t * (row(j2) - row(j));
    });
  }

 private:
  std::vector<Spectrum> table_;
};

/// A step along all rays of one elevation.
struct Step {
  double t, r;
  float height;  ///< 0 to 1
  float ground;  ///< the part of the sphere around that the earth takes, times its albedo / 4π²
  Spectrum molecules, dust;  ///< scattering of a kilometre
  Spectrum from_ground;      ///< transmittance from the ground up to here
  Spectrum reach;            ///< how much of what is scattered here arrives, times the step
};

class Marcher {
 public:
  Marcher(const SkyDesc& sky, const Atmosphere& atmosphere, const Transmittances& transmittances)
      : atmosphere_(atmosphere), transmittances_(transmittances) {
    eye_ = kEarth + std::clamp(sky.altitude, 1.0f, 99999.0f) / 1000.0;
    const auto turn = sin_cos_turns(sky.sun_elevation / (2.0 * kPi));
    sun_up_ = turn.sin;
    sun_flat_ = turn.cos;
  }

  /// out: [kSkyColumns][3]
  void row(double elevation, float* out) {
    const auto [up, flat] = sin_cos_turns(elevation / (2.0 * kPi));
    set_steps(up);
    for (std::uint32_t i = 0; i < kSkyColumns; ++i) {
      const double azimuth = (i + 0.5) / (2.0 * kSkyColumns) - 0.5;  // in turns from the sun
      const Vec3d xyz = march(flat * sin_cos_turns(azimuth).cos * sun_flat_ + up * sun_up_);
      for (int c = 0; c < 3; ++c) *out++ = static_cast<float>(xyz[c]);
    }
  }

 private:
  void set_steps(double up) {
    const double along = eye_ * up, to_ground = along * along + kEarth * kEarth - eye_ * eye_;
    const bool meets_ground = up <= 0.0 && to_ground >= 0.0;
    const double length = meets_ground ? -along - std::sqrt(to_ground) : air_ahead(eye_, up);
    const double size = length / kSteps;
    Spectrum through = {1.0f, 1.0f, 1.0f, 1.0f};
    const Spectrum whole = transmittances_.at(1.0f, 0.0f);
    for (int i = 0; i < kSteps; ++i) {
      Step& step = steps_[i];
      step.t = (i + 0.5) * size;
      step.r = std::sqrt(eye_ * eye_ + step.t * (2.0 * along + step.t));
      const double height = std::max(step.r - kEarth, 0.0);
      step.height = static_cast<float>(height / kAirHeight);
      const Amounts air = atmosphere_.at(static_cast<float>(height));
      const double sine = std::min(kEarth / step.r, 1.0);
      step.ground = static_cast<float>(0.5 * (1.0 - std::sqrt(1.0 - sine * sine)) *
                                       double{kGroundAlbedo} / kPi);
      const Spectrum above = transmittances_.at(1.0f, step.height);
      for (std::size_t k = 0; k < 4; ++k) {
        step.from_ground[k] = whole[k] / above[k];
        const float extinction = Atmosphere::extinction(air, k);
        step.molecules[k] = kMolecules[k] * air.molecules;
        step.dust[k] = kDustScattering[k] * air.dust;
        const float passed = exp_lane(-static_cast<float>(size) * extinction);
        step.reach[k] = through[k] * (1.0f - passed) / std::max(extinction, 1e-7f);
        through[k] *= passed;
      }
    }
  }

  Vec3d march(double cosine) const {
    const auto mu = static_cast<float>(cosine);
    const float bend = 1.0f + kDustG * kDustG - 2.0f * kDustG * mu;
    const float molecules_phase = 3.0f / (16.0f * kPiFloat) * (1.0f + mu * mu);
    const float dust_phase = kInvFourPi * (1.0f - kDustG * kDustG) / (bend * std::sqrt(bend));
    Spectrum sum = {};
    for (const Step& step : steps_) {
      const auto up = static_cast<float>((eye_ * sun_up_ + step.t * cosine) / step.r);
      const Spectrum sun = transmittances_.at(up, step.height);
      const Spectrum on_ground = transmittances_.on_ground(up);
      const float lit = 1.0f / (1.0f + 5.0f * exp_lane(-17.92f * up));
      for (std::size_t k = 0; k < 4; ++k) {
        const float later =
            kLaterLight[k] * lit + step.ground * on_ground[k] * step.from_ground[k] * up;
        const float scattered = step.molecules[k] * (molecules_phase * sun[k] + later) +
                                step.dust[k] * (dust_phase * sun[k] + later);
        sum[k] += kSunIrradiance[k] * scattered * step.reach[k];
      }
    }
    return to_xyz(sum);
  }

  const Atmosphere& atmosphere_;
  const Transmittances& transmittances_;
  double eye_, sun_up_, sun_flat_;
  Step steps_[kSteps];
};

}  // namespace

std::vector<float> multiple_scattering_table(const SkyDesc& sky, ThreadPool& pool) {
  constexpr std::size_t kRows = 256;
  const Atmosphere atmosphere(sky);
  const Transmittances transmittances(atmosphere, pool);
  std::vector<float> table(3 * kSkyColumns * kRows);
  pool.for_each_chunk(kRows, 2, [&](std::size_t begin, std::size_t end) {
    Marcher marcher(sky, atmosphere, transmittances);
    for (std::size_t y = begin; y < end; ++y) {
      const double up = (static_cast<double>(y) + 0.5) / (0.5 * kRows) - 1.0;
      const double elevation = 0.5 * kPi * up * up;
      marcher.row(up < 0.0 ? -elevation : elevation, &table[3 * kSkyColumns * y]);
    }
  });
  return table;
}

SunEdges multiple_scattering_sun(const SkyDesc& sky) {
  const Atmosphere atmosphere(sky);
  const double height = std::clamp(sky.altitude, 1.0f, 99999.0f) / 1000.0,
               half = 0.5 * sky.sun_size;
  const double quarter = sin_cos_turns(half / (4.0 * kPi)).sin;  // 1 − cos a = 2 sin²(a / 2)
  const auto solid_angle = static_cast<float>(4.0 * kPi * quarter * quarter);
  const auto at = [&](double elevation) {
    const double up = sin_cos_turns(elevation / (2.0 * kPi)).sin;
    const Spectrum through = atmosphere.transmittance(up, height);
    return to_xyz(
        each([&](std::size_t k) { return kSunIrradiance[k] * through[k] / solid_angle; }));
  };
  return {at(sky.sun_elevation - half), at(sky.sun_elevation + half)};
}

}  // namespace komorebi
