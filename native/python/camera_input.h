#pragma once

#include <pybind11/pybind11.h>

#include "render/camera.h"

namespace komorebi::python {

/// A camera from what Python hands over: `matrix` is clip_from_world, or of kind PANORAMA
/// world_from_camera, float64 [4, 4]; lens, panorama and stereo are dicts of numbers by the names
/// in camera_fields.h (and the panorama's kind), or None. So are shutter ("curve": float32 [N],
/// "rolling_duration") and motion ("matrices": world from camera, float64 [2k + 1, 4, 4],
/// "zoom_open", "zoom_close"). std::invalid_argument with a sentence.
CameraDesc camera_input(const std::string& kind, const pybind11::object& matrix,
                        const pybind11::object& lens, const pybind11::object& panorama,
                        const pybind11::object& stereo, const pybind11::object& shutter,
                        const pybind11::object& motion);

}  // namespace komorebi::python
