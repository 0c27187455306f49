#pragma once

#include "render/camera.h"

namespace komorebi {

/// The numbers of a camera's parts with their names, for whoever carries them from one form to
/// another (scene files, Python): visit(name, number) for each. `Desc` may be const.
template <class Desc, class Visit>
void for_each_lens_number(Desc& lens, const Visit& visit) {
  visit("radius", lens.radius);
  visit("blades", lens.blades);
  visit("rotation", lens.rotation);
  visit("ratio", lens.ratio);
  visit("focus_distance", lens.focus_distance);
}

template <class Desc, class Visit>
void for_each_panorama_number(Desc& panorama, const Visit& visit) {
  visit("shift_x", panorama.shift_x);
  visit("shift_y", panorama.shift_y);
  visit("longitude_min", panorama.longitude_min);
  visit("longitude_max", panorama.longitude_max);
  visit("latitude_min", panorama.latitude_min);
  visit("latitude_max", panorama.latitude_max);
  visit("height_min", panorama.height_min);
  visit("height_max", panorama.height_max);
  visit("fov", panorama.fov);
  visit("focal_length", panorama.focal_length);
  visit("sensor_width", panorama.sensor_width);
  visit("sensor_height", panorama.sensor_height);
  visit("k0", panorama.polynomial[0]);
  visit("k1", panorama.polynomial[1]);
  visit("k2", panorama.polynomial[2]);
  visit("k3", panorama.polynomial[3]);
  visit("k4", panorama.polynomial[4]);
}

template <class Desc, class Visit>
void for_each_stereo_number(Desc& stereo, const Visit& visit) {
  visit("eye", stereo.eye);
  visit("convergence_distance", stereo.convergence_distance);
  visit("pole_merge_angle_from", stereo.pole_merge_angle_from);
  visit("pole_merge_angle_to", stereo.pole_merge_angle_to);
}

}  // namespace komorebi
