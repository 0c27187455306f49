#include <algorithm>
#include <array>
#include <cmath>

#include "parallel/thread_pool.h"
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
constexpr float kGroundAlbedo = 0.3f;
constexpr float kDustG = 0.8f;  // of Henyey and Greenstein's phase function
constexpr Spectrum kSunIrradiance = {1.679f, 1.828f, 1.986f, 1.307f};
constexpr Spectrum kMolecules = {6.605e-3f, 1.067e-2f, 1.842e-2f, 3.156e-2f};  // scattering, 1 / km
constexpr std::array<double, 4> kOzone = {3.472e-25, 3.914e-25, 1.349e-25, 11.03e-27};
constexpr double kDobson = 334.5;  // mean of a year
constexpr std::array<double, 4> kDustAbsorption = {2.8722e-24, 4.6168e-24, 7.9706e-24, 1.3578e-23};
constexpr std::array<double, 4> kDustScattering = {1.5908e-22, 1.7711e-22, 2.0942e-22, 2.4033e-22};
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

/// What a kilometre of air scatters and takes away.
struct Air {
  Spectrum molecules, dust, extinction;
};

class Atmosphere {
 public:
  explicit Atmosphere(const SkyDesc& sky) : sky_(sky) {}

  Air at(double height) const {
    const double h = std::max(height, 0.0);
    const double log_h = log_double(std::max(h, 1e-4));
    const double fall =
        h > 0.0 ? exp_double(-0.07771971 * exp_double(1.16364243 * log_double(h))) : 1.0;
    const double from_middle = log_h - 3.22261;
    const double fall_of_ozone = -from_middle * from_middle * 5.55555555 - log_h;
    const double ozone =
        3.78547397e20 * kDobson * sky_.ozone * exp_double(std::max(fall_of_ozone, -700.0));
    const double dust = (1.3681e20 * exp_double(-h / 0.73) + 2e6) * sky_.aerosol;
    Air air;
    for (std::size_t i = 0; i < 4; ++i) {
      air.molecules[i] = kMolecules[i] * static_cast<float>(fall * sky_.air);
      air.dust[i] = static_cast<float>(kDustScattering[i] * dust);
      air.extinction[i] = air.molecules[i] + air.dust[i] +
                          static_cast<float>(kDustAbsorption[i] * dust + kOzone[i] * ozone);
    }
    return air;
  }

  /// How much light comes to a height from the end of the air. The earth does not stand in the way:
  /// below its surface the air is as on it.
  Spectrum transmittance(double up, double height) const {
    const double r = kEarth + height, step = air_ahead(r, up) / kSteps;
    Spectrum depth = {};
    for (int i = 0; i < kSteps; ++i) {
      const double t = (i + 0.5) * step;
      const Air air = at(std::sqrt(r * r + t * (2.0 * r * up + t)) - kEarth);
      for (std::size_t k = 0; k < 4; ++k) depth[k] += air.extinction[k] * static_cast<float>(step);
    }
    return each([&](std::size_t k) { return fn::exp(-depth[k]); });
  }

 private:
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
  Air air;
  Spectrum from_ground;  ///< transmittance from the ground up to here
  Spectrum reach;        ///< how much of what is scattered here arrives, times the step
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
      step.air = atmosphere_.at(height);
      const double sine = std::min(kEarth / step.r, 1.0);
      step.ground = static_cast<float>(0.5 * (1.0 - std::sqrt(1.0 - sine * sine)) *
                                       double{kGroundAlbedo} / kPi);
      const Spectrum above = transmittances_.at(1.0f, step.height);
      for (std::size_t k = 0; k < 4; ++k) {
        step.from_ground[k] = whole[k] / above[k];
        const float extinction = step.air.extinction[k];
        const float passed = fn::exp(-static_cast<float>(size) * extinction);
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
      const Spectrum on_ground = transmittances_.at(up, 0.0f);
      const float lit = 1.0f / (1.0f + 5.0f * fn::exp(-17.92f * up));
      for (std::size_t k = 0; k < 4; ++k) {
        const float later =
            kLaterLight[k] * lit + step.ground * on_ground[k] * step.from_ground[k] * up;
        const float scattered = step.air.molecules[k] * (molecules_phase * sun[k] + later) +
                                step.air.dust[k] * (dust_phase * sun[k] + later);
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
      const double up = (static_cast<double>(y) + 0.5) / (kRows / 2) - 1.0;
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
