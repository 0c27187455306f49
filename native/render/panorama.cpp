#include "render/panorama.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace komorebi {
namespace {

/// What an angle in radians, or a shift in pictures, may be at most: sin_cos_turns takes 2^20
/// turns.
constexpr double kMost = 1000.0;

void check(bool good, const char* sentence) {
  if (!good) throw std::invalid_argument(std::string("camera: the panorama's ") + sentence);
}

bool small(double x) {
  return std::abs(x) <= kMost;  // false for a NaN
}

bool is_length(double x) {
  return x > 0.0 && x <= 1e30;
}

/// One axis of the linear map: from `low` at the first edge of the picture to `high` at the last.
struct Axis {
  double middle, per_pixel;
};
Axis axis(double low, double high, double shift, std::uint32_t pixels) {
  const double span = high - low;
  return {0.5 * (low + high) + shift * span, span / pixels};
}

void check_sensor(const PanoramaDesc& desc) {
  check(is_length(desc.sensor_width) && is_length(desc.sensor_height),
        "sensor must have a width and a height");
}

void check_fov(const PanoramaDesc& desc) {
  check(small(desc.fov), "field of view must be finite, and not hundreds of turns");
}

}  // namespace

PanoramaKind panorama_kind_from_name(const std::string& name) {
  constexpr std::pair<const char*, PanoramaKind> kNames[] = {
      {"EQUIRECTANGULAR", PanoramaKind::kEquirectangular},
      {"FISHEYE_EQUIDISTANT", PanoramaKind::kFisheyeEquidistant},
      {"FISHEYE_EQUISOLID", PanoramaKind::kFisheyeEquisolid},
      {"MIRRORBALL", PanoramaKind::kMirrorBall},
      {"FISHEYE_LENS_POLYNOMIAL", PanoramaKind::kFisheyePolynomial},
      {"EQUIANGULAR_CUBEMAP_FACE", PanoramaKind::kEquiangularCubeFace},
      {"CENTRAL_CYLINDRICAL", PanoramaKind::kCentralCylindrical},
  };
  for (const auto& [known, kind] : kNames) {
    if (name == known) return kind;
  }
  throw std::invalid_argument("camera: there is no panorama of kind " + name);
}

PanoramaView make_panorama(const PanoramaDesc& desc, std::uint32_t width, std::uint32_t height) {
  check(small(desc.shift_x) && small(desc.shift_y),
        "shift must be finite, and less than a thousand pictures");
  constexpr double kTurn = 0.5 / kPi;
  double low_a = -1.0, high_a = 1.0, low_b = -1.0, high_b = 1.0;
  PanoramaView view;
  view.kind = desc.kind;
  switch (desc.kind) {
    case PanoramaKind::kEquirectangular:
    case PanoramaKind::kCentralCylindrical:
      check(small(desc.longitude_min) && small(desc.longitude_max),
            "longitudes must be finite, and not hundreds of turns");
      low_a = desc.longitude_min * kTurn, high_a = desc.longitude_max * kTurn;
      if (desc.kind == PanoramaKind::kEquirectangular) {
        check(small(desc.latitude_min) && small(desc.latitude_max),
              "latitudes must be finite, and not hundreds of turns");
        low_b = desc.latitude_min * kTurn, high_b = desc.latitude_max * kTurn;
      } else {
        check(std::abs(desc.height_min) <= 1e30 && std::abs(desc.height_max) <= 1e30,
              "heights must be finite");
        low_b = desc.height_min, high_b = desc.height_max;
      }
      break;
    case PanoramaKind::kEquiangularCubeFace:
      low_a = low_b = -0.125, high_a = high_b = 0.125;
      break;
    case PanoramaKind::kMirrorBall:
      break;
    case PanoramaKind::kFisheyeEquidistant:
      check_fov(desc);
      view.limit = 1.0;
      view.scale = 0.5 * desc.fov * kTurn;
      break;
    case PanoramaKind::kFisheyeEquisolid:
      check_fov(desc);
      check(is_length(desc.focal_length), "lens must have a focal length of more than 0 mm");
      view.limit = 2.0 * desc.focal_length * sin_cos_turns(0.25 * desc.fov * kTurn).sin;
      view.scale = 0.5 / desc.focal_length;
      break;
    case PanoramaKind::kFisheyePolynomial:
      check_fov(desc);
      for (const double k : desc.polynomial) {
        check(std::isfinite(k), "polynomial must have finite coefficients");
      }
      view.limit = 0.5 * desc.fov;
      std::copy_n(desc.polynomial, 5, view.polynomial);
      break;
  }
  if (desc.kind == PanoramaKind::kFisheyeEquisolid ||
      desc.kind == PanoramaKind::kFisheyePolynomial) {
    check_sensor(desc);
    low_a = -0.5 * desc.sensor_width, high_a = 0.5 * desc.sensor_width;
    low_b = -0.5 * desc.sensor_height, high_b = 0.5 * desc.sensor_height;
  }
  const Axis a = axis(low_a, high_a, desc.shift_x, width);
  const Axis b = axis(low_b, high_b, desc.shift_y, height);
  view.middle_a = a.middle, view.a_per_pixel = a.per_pixel;
  view.middle_b = b.middle, view.b_per_pixel = b.per_pixel;
  return view;
}

}  // namespace komorebi
