#pragma once

#include "core/math.h"

namespace komorebi {

/// One eye of a pair that turns with the direction looked in, so that panoramas are stereoscopic
/// all around (Ishiguro, Yamamoto and Tsuji, "Omni-Directional Stereo", PAMI 1992).
struct SphericalStereoView {
  double eye = 0.0;  ///< metres to the right of the camera, negative: to the left; 0: no stereo
  double inverse_convergence = 0.0;         ///< 1 / distance at which both eyes meet; 0: parallel
  double merge_from = 0.0, merge_to = 0.0;  ///< altitudes between which the eyes unite; 0: never
};

/// Moves a ray to the eye: its origin aside, its unit direction to the point of convergence. `up`
/// is the axis that the eyes turn about, a unit vector. Towards the poles the eyes may unite by a
/// cosine, as in Cycles; exactly at a pole there is no side, and the ray stays.
inline void turn_to_eye(const SphericalStereoView& stereo, const Vec3d& up, Vec3d& origin,
                        Vec3d& direction) {
  const Vec3d across = glm::cross(direction, up);
  const double cosine = std::sqrt(glm::dot(across, across));
  if (!(cosine > 0.0)) return;
  double eye = stereo.eye;
  if (stereo.merge_to > 0.0) {
    const double sine = glm::dot(direction, up);
    const double altitude = atan2_radians(sine < 0.0 ? -sine : sine, cosine);
    if (altitude > stereo.merge_to) return;
    if (altitude > stereo.merge_from) {
      const double part = (altitude - stereo.merge_from) / (stereo.merge_to - stereo.merge_from);
      eye *= sin_cos_turns(0.25 * part).cos;
    }
  }
  const Vec3d offset = across * (eye / cosine);
  origin += offset;
  const Vec3d to_meeting = direction - stereo.inverse_convergence * offset;
  direction = to_meeting / std::sqrt(glm::dot(to_meeting, to_meeting));
}

}  // namespace komorebi
