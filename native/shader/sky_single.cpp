#include <algorithm>
#include <cmath>

#include "parallel/thread_pool.h"
#include "shader/sky_lanes.h"
#include "shader/sky_radiance.h"

/// Light that the air and its dust scatter once, for 21 wavelengths, marched along each direction:
/// after Nishita et al., "Display of the Earth Taking into Account Atmospheric Scattering", 1993,
/// with the atmosphere, steps and quadrature of Cycles. Lengths are in metres.
namespace komorebi {
namespace {

constexpr double kEarth = 6360e3, kAtmosphere = 6420e3;  // radii
constexpr auto kRadius = static_cast<float>(kEarth);
constexpr float kRayleighHeight = 8000.0f;  // where density has fallen to 1 / e
constexpr float kDustScattering = 2e-5f, kDustExtinction = 1.11f * kDustScattering;
constexpr float kDustG = 0.76f;  // of Cornette and Shanks' phase function
constexpr int kSteps = 32;

// At 380, 400 … 780 nm; the rest are zeros that fill up vectors.
constexpr int kWavelengths = 24, kMeasured = 21;
constexpr float kSunIrradiance[kWavelengths] = {  // above the air, W / (m² nm)
    1.457568299f, 1.565963056f, 1.651484491f, 1.714962427f, 1.757979838f, 1.782564079f,
    1.790951085f, 1.785415501f, 1.768155549f, 1.741220696f, 1.706471272f, 1.665560875f,
    1.619934372f, 1.570835974f, 1.519323351f, 1.46628495f,  1.412458527f, 1.35844962f,
    1.304749138f, 1.251749633f, 1.199759988f};
constexpr float kRayleigh[kWavelengths] = {  // scattering at the sea, 1 / m
    5.424820088e-05f, 4.418549867e-05f, 3.63515191e-05f,  3.017929012e-05f, 2.526320227e-05f,
    2.130859311e-05f, 1.809838025e-05f, 1.547057129e-05f, 1.330284977e-05f, 1.150184784e-05f,
    9.9955743e-06f,   8.727999736e-06f, 7.65513701e-06f,  6.742172038e-06f, 5.961341258e-06f,
    5.290345981e-06f, 4.711156876e-06f, 4.209104811e-06f, 3.772183813e-06f, 3.390512555e-06f,
    3.055915317e-06f};
constexpr float kOzone[kWavelengths] = {  // absorption where it is densest, 1 / m
    3.251268499e-09f, 5.85395365e-09f,  1.977191155e-08f, 7.309568763e-08f, 2.008456151e-07f,
    4.03839581e-07f,  6.355133591e-07f, 9.670704118e-07f, 1.547974004e-06f, 2.090386472e-06f,
    2.461280562e-06f, 2.735512995e-06f, 2.151258631e-06f, 1.590518408e-06f, 1.12356198e-06f,
    7.352755149e-07f, 4.645013036e-07f, 3.309607992e-07f, 2.251261229e-07f, 1.487912927e-07f,
    1.682862336e-07f};
// CIE 1931
constexpr float kMatching[3][kMeasured] = {
    {0.001368f,      0.01431f,       0.13438f,      0.34828f, 0.2908f,     0.09564f,
     0.0049f,        0.06327f,       0.2904f,       0.5945f,  0.9163f,     1.0622f,
     0.8544499f,     0.4479f,        0.1649f,       0.04677f, 0.01135916f, 0.002899327f,
     0.00069007860f, 0.00016615050f, 0.00004150994f},
    {0.000039f, 0.000396f, 0.004f,    0.023f,    0.06f,      0.13902f, 0.323f,
     0.71f,     0.954f,    0.995f,    0.87f,     0.631f,     0.381f,   0.175f,
     0.061f,    0.017f,    0.004102f, 0.001047f, 0.0002492f, 0.00006f, 0.00001499f},
    {0.006450001f, 0.06785001f, 0.6456f, 1.74706f, 1.6692f, 0.8129501f, 0.272f, 0.07824999f,
     0.0203f, 0.0039f, 0.001650001f, 0.0008f, 0.00019f, 0.00002f},
};
constexpr double kWavelengthStep = 20.0;  // nm

// Gauss and Laguerre's quadrature of 8 nodes for what falls off like e^(−25 x) in [0, 1].
constexpr int kNodes = 8;
constexpr float kNode[kNodes] = {0.006811185292f, 0.03614807107f, 0.09004346519f, 0.1706680068f,
                                 0.2818362161f,   0.4303406404f,  0.6296271457f,  0.9145252695f};
constexpr float kWeight[kNodes] = {0.01750893642f, 0.04135477391f, 0.06678839063f, 0.09507698807f,
                                   0.1283416365f,  0.1707430204f,  0.2327233347f,  0.3562490486f};

/// Of air, dust and ozone: densities, or these integrated along a ray.
struct Amounts {
  float air = 0.0f, dust = 0.0f, ozone = 0.0f;
};

inline Amounts densities(float height) {
  // Dust falls off in 1200 m, so that both are powers of one exponential.
  const float e = exp_lane(height * (-1.0f / (3.0f * kRayleighHeight)));
  const float e2 = e * e, e4 = e2 * e2, e5 = e4 * e, e10 = e5 * e5;
  const float ozone = 1.0f - fn::abs(height - 25000.0f) * (1.0f / 15000.0f);
  return {e2 * e, e10 * e10, above_zero(ozone)};
}

/// What lies between a point and the end of the air.
/// @param excess  r² less the earth's radius squared, r the distance from its centre
/// @param along   r times the cosine of the angle between the ray and the point's zenith
Amounts optical_depth(double excess, double along) {
  constexpr double kAir = kAtmosphere * kAtmosphere - kEarth * kEarth;
  const double length = std::sqrt(std::max(along * along + kAir - excess, 0.0)) - along;
  const auto c = static_cast<float>(excess), twice = static_cast<float>(2.0 * along),
             end = static_cast<float>(length);
  float air[kNodes], dust[kNodes], ozone[kNodes];
  for (int i = 0; i < kNodes; ++i) {
    const float t = kNode[i] * end;
    const Amounts there = densities(height_over(kRadius, c + t * (twice + t)));
    air[i] = there.air * kWeight[i];
    dust[i] = there.dust * kWeight[i];
    ozone[i] = there.ozone * kWeight[i];
  }
  Amounts sum;
  for (int i = 0; i < kNodes; ++i) {
    sum.air += air[i];
    sum.dust += dust[i];
    sum.ozone += ozone[i];
  }
  return {sum.air * end, sum.dust * end, sum.ozone * end};
}

Vec3d to_xyz(const float* spectrum) {
  Vec3d xyz(0.0);
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < kMeasured; ++i) xyz[c] += double{kMatching[c][i]} * spectrum[i];
  }
  return xyz * kWavelengthStep;
}

double eye_height(const SkyDesc& sky) {
  return std::clamp(sky.altitude, 1.0f, 59999.0f);
}

/// A step along all rays of one elevation.
struct Step {
  double t, excess;
  Amounts density, depth;  ///< there; and from the eye to there
};

class Marcher {
 public:
  explicit Marcher(const SkyDesc& sky) : sky_(sky), eye_(kEarth + eye_height(sky)) {
    const auto turn = sin_cos_turns(sky.sun_elevation / (2.0 * kPi));
    sun_up_ = turn.sin;
    sun_flat_ = turn.cos;
  }

  /// out: [kSkyColumns][3]
  void row(double elevation, float* out) {
    const auto [up, flat] = sin_cos_turns(elevation / (2.0 * kPi));
    set_steps(up);
    for (std::uint32_t i = 0; i < kSkyColumns; ++i) {
      const double azimuth = i * (1.0 / (2.0 * kSkyColumns)) - 0.5;  // in turns from the sun
      const double cosine = flat * sin_cos_turns(azimuth).cos * sun_flat_ + up * sun_up_;
      const Vec3d xyz = march(cosine);
      for (int c = 0; c < 3; ++c) *out++ = static_cast<float>(xyz[c]);
    }
  }

 private:
  void set_steps(double up) {
    const double excess = eye_ * eye_ - kEarth * kEarth, along = eye_ * up;
    const double air = kAtmosphere * kAtmosphere - kEarth * kEarth;
    const double length = std::sqrt(std::max(along * along + air - excess, 0.0)) - along;
    const double size = length / kSteps;
    const auto segment = static_cast<float>(size);
    Amounts depth;
    for (int i = 0; i < kSteps; ++i) {
      const double t = (i + 0.5) * size;
      const double there = excess + t * (2.0 * along + t);
      Amounts density = densities(height_over(kRadius, static_cast<float>(there)));
      density = {density.air * sky_.air, density.dust * sky_.aerosol, density.ozone * sky_.ozone};
      depth = {depth.air + density.air * segment, depth.dust + density.dust * segment,
               depth.ozone + density.ozone * segment};
      steps_[i] = {t, there, density, depth};
    }
    segment_ = segment;
  }

  Vec3d march(double cosine) const {
    const auto mu = static_cast<float>(cosine);
    constexpr float kG2 = kDustG * kDustG;
    const float bend = 1.0f + kG2 - 2.0f * kDustG * mu;
    const float air_phase = 3.0f / (16.0f * kPiFloat) * (1.0f + mu * mu);
    const float dust_phase = 3.0f * (1.0f - kG2) * (1.0f + mu * mu) /
                             (8.0f * kPiFloat * (2.0f + kG2) * bend * std::sqrt(bend));
    float spectrum[kWavelengths] = {};
    for (const Step& step : steps_) {
      const double along = eye_ * sun_up_ + step.t * cosine;
      if (sun_up_ < 0.0 && along * along >= step.excess) continue;  // in the earth's shadow
      const Amounts light = optical_depth(step.excess, along);
      const float air = step.depth.air + sky_.air * light.air;
      const float dust = (step.depth.dust + sky_.aerosol * light.dust) * kDustExtinction;
      const float ozone = step.depth.ozone + sky_.ozone * light.ozone;
      const float from_air = segment_ * air_phase * step.density.air;
      const float from_dust = segment_ * dust_phase * step.density.dust * kDustScattering;
      for (int i = 0; i < kWavelengths; ++i) {
        const float through = exp_lane(-(air * kRayleigh[i] + dust + ozone * kOzone[i]));
        spectrum[i] += through * (from_air * kRayleigh[i] + from_dust) * kSunIrradiance[i];
      }
    }
    return to_xyz(spectrum);
  }

  const SkyDesc& sky_;
  double eye_, sun_up_, sun_flat_;
  float segment_ = 0.0f;
  Step steps_[kSteps];
};

/// The sun's radiance through the air, at an elevation from 0 on; without ozone, as in Cycles.
Vec3d sun_at(const SkyDesc& sky, double elevation, double solid_angle) {
  const double eye = kEarth + eye_height(sky);
  const double up = sin_cos_turns(elevation / (2.0 * kPi)).sin;
  const Amounts depth = optical_depth(eye * eye - kEarth * kEarth, eye * up);
  float spectrum[kWavelengths];
  for (int i = 0; i < kWavelengths; ++i) {
    const float through = exp_lane(
        -(kRayleigh[i] * depth.air * sky.air + kDustExtinction * depth.dust * sky.aerosol));
    spectrum[i] = kSunIrradiance[i] * through / static_cast<float>(solid_angle);
  }
  return to_xyz(spectrum);
}

}  // namespace

std::vector<float> single_scattering_table(const SkyDesc& sky, ThreadPool& pool) {
  constexpr std::size_t kRows = 128, kRow = 3 * kSkyColumns;
  const bool is_nishita = sky.model == SkyModel::kNishita;
  const std::size_t below = is_nishita ? 0 : kRows;  // rows under the horizon
  const double most = is_nishita ? 0.5 * kPi * (1.0 + 1.0 / 256.0) : 0.5 * kPi;
  const auto elevation = [&](std::size_t y) {
    const double up = static_cast<double>(y) / kRows;
    return most * up * up;
  };
  std::vector<float> table(kRow * (below + kRows));
  pool.for_each_chunk(kRows, 2, [&](std::size_t begin, std::size_t end) {
    Marcher marcher(sky);
    for (std::size_t y = begin; y < end; ++y) {
      marcher.row(elevation(y), &table[kRow * (below + y)]);
    }
  });
  // There is no ground: the horizon goes on, and is black soon.
  for (std::size_t y = 0; y < below; ++y) {
    const double down = sin_cos_turns(elevation(kRows - y) / (2.0 * kPi)).sin;
    const auto left = static_cast<float>(std::max(1.0 - 2.5 * down, 0.0));
    for (std::size_t i = 0; i < kRow; ++i) {
      table[kRow * y + i] = table[kRow * below + i] * (left * left * left);
    }
  }
  return table;
}

SunEdges single_scattering_sun(const SkyDesc& sky) {
  const double half = 0.5 * sky.sun_size;
  const double quarter = sin_cos_turns(half / (4.0 * kPi)).sin;  // 1 − cos a = 2 sin²(a / 2)
  const double solid_angle = 4.0 * kPi * quarter * quarter;
  const double low = std::max(sky.sun_elevation - half, 0.0);
  const double high = std::max(sky.sun_elevation + half, 0.0);
  if (high == 0.0 && sky.model != SkyModel::kNishita) return {Vec3d(0.0), Vec3d(0.0)};
  return {sun_at(sky, low, solid_angle), sun_at(sky, high, solid_angle)};
}

}  // namespace komorebi
