#include "python/camera_input.h"

#include "python/arrays.h"
#include "render/camera_fields.h"

namespace komorebi::python {
namespace {

/// Takes numbers out of a dict by name; what is left at the end nobody knows.
class Numbers {
 public:
  Numbers(const py::object& object, std::string what) : what_(std::move(what)) {
    if (!py::isinstance<py::dict>(object)) throw std::invalid_argument(what_ + " must be a dict");
    left_ = py::dict(object.attr("copy")());
  }

  bool has(const char* name) const { return left_.contains(name); }
  py::object take(const char* name) { return left_.attr("pop")(name); }

  template <class T>
  void operator()(const char* name, T& number) {
    if (!has(name)) return;
    try {
      number = take(name).cast<T>();
    } catch (const py::cast_error&) {
      throw std::invalid_argument(what_ + "[\"" + name + "\"] is no number of its kind");
    }
  }

  void finish() const {
    for (const auto& item : left_) {
      throw std::invalid_argument(what_ + " has no \"" + std::string(py::str(item.first)) + "\"");
    }
  }

 private:
  std::string what_;
  py::dict left_;
};

}  // namespace

CameraDesc camera_input(const std::string& kind, const py::object& matrix, const py::object& lens,
                        const py::object& panorama, const py::object& stereo,
                        const py::object& shutter, const py::object& motion) {
  CameraDesc camera;
  if (kind == "ORTHOGRAPHIC") {
    camera.kind = CameraKind::kOrthographic;
  } else if (kind == "PANORAMA") {
    camera.kind = CameraKind::kPanorama;
  } else if (kind != "PERSPECTIVE") {
    throw std::invalid_argument("camera kind must be PERSPECTIVE, ORTHOGRAPHIC or PANORAMA, not " +
                                kind);
  }
  if (panorama.is_none() == (camera.kind == CameraKind::kPanorama)) {
    throw std::invalid_argument("a camera of kind PANORAMA, and no other, needs a panorama");
  }
  const auto rows = view<double>(matrix, "the camera's matrix", {4, 4});
  (panorama.is_none() ? camera.clip_from_world : camera.world_from_camera) = matrix4(rows.data());
  if (!lens.is_none()) {
    Numbers numbers(lens, "lens");
    for_each_lens_number(camera.lens, [&](const char* n, auto& x) { numbers(n, x); });
    numbers.finish();
  }
  if (!panorama.is_none()) {
    Numbers numbers(panorama, "panorama");
    if (!numbers.has("kind")) throw std::invalid_argument("a panorama needs a kind");
    camera.panorama.kind = panorama_kind_from_name(py::str(numbers.take("kind")));
    for_each_panorama_number(camera.panorama, [&](const char* n, auto& x) { numbers(n, x); });
    numbers.finish();
  }
  if (!stereo.is_none()) {
    Numbers numbers(stereo, "stereo");
    for_each_stereo_number(camera.stereo, [&](const char* n, auto& x) { numbers(n, x); });
    numbers.finish();
  }
  if (!shutter.is_none()) {
    Numbers numbers(shutter, "shutter");
    if (numbers.has("curve")) {
      const py::object weights = numbers.take("curve");
      const auto curve = view<float>(weights, "the shutter's curve", {-1});
      camera.shutter.curve.assign(curve.begin(), curve.end());
    }
    camera.shutter.rolling = numbers.has("rolling_duration");
    numbers("rolling_duration", camera.shutter.rolling_duration);
    numbers("still", camera.shutter.still);
    numbers.finish();
  }
  if (!motion.is_none()) {
    Numbers numbers(motion, "motion");
    if (!numbers.has("matrices")) throw std::invalid_argument("a camera's motion needs matrices");
    const py::object matrices = numbers.take("matrices");
    const auto values = view<double>(matrices, "the camera's motion matrices", {-1, 4, 4});
    for (std::size_t i = 0; i < values.size(); i += 16) {
      camera.motion.poses.push_back(matrix4(&values[i]));
    }
    numbers("zoom_open", camera.motion.zoom_open);
    numbers("zoom_close", camera.motion.zoom_close);
    numbers.finish();
  }
  return camera;
}

}  // namespace komorebi::python
