#pragma once

#include <string>

#include "core/panorama.h"

namespace komorebi {

/// What a host knows of a panorama, by Blender's names. Angles in radians; each kind reads only
/// what it needs.
struct PanoramaDesc {
  PanoramaKind kind = PanoramaKind::kEquirectangular;
  double shift_x = 0.0, shift_y = 0.0;               ///< of the picture, in its widths and heights
  double longitude_min = -kPi, longitude_max = kPi;  ///< equirectangular, cylindrical
  double latitude_min = -0.5 * kPi, latitude_max = 0.5 * kPi;  ///< equirectangular
  double height_min = -1.0, height_max = 1.0;        ///< cylindrical, in radii of the cylinder
  double fov = kPi;                                  ///< fisheye: from rim to rim
  double focal_length = 10.5;                        ///< equisolid, mm
  double sensor_width = 36.0, sensor_height = 24.0;  ///< equisolid, polynomial: of the frame, mm
  double polynomial[5] = {};  ///< fisheye_polynomial_k0…k4: radius in mm, angle in radians, negated
};

/// The name of a kind as Blender's `panorama_type` has it, and back; std::invalid_argument when
/// there is none.
PanoramaKind panorama_kind_from_name(const std::string& name);

/// The projection of a picture of width × height pixels. std::invalid_argument with a sentence when
/// a number that the kind needs is not finite, beyond a thousand turns or so, or no length.
PanoramaView make_panorama(const PanoramaDesc& desc, std::uint32_t width, std::uint32_t height);

}  // namespace komorebi
