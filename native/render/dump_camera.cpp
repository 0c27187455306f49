#include <glm/gtc/type_ptr.hpp>

#include "io/array_file.h"
#include "render/camera_fields.h"
#include "render/dump.h"

namespace komorebi {
namespace {

const Mat4d& matrix_of(const CameraDesc& camera) {
  return camera.kind == CameraKind::kPanorama ? camera.world_from_camera : camera.clip_from_world;
}

const char* matrix_name(CameraKind kind) {
  return kind == CameraKind::kPanorama ? "camera/world_from_camera" : "camera/clip_from_world";
}

auto writer(ArrayFile& file, const std::string& prefix) {
  return [&file, prefix](const char* name, const auto& number) {
    file.put_value(prefix + name, number);
  };
}

auto reader(const ArrayFile& file, const std::string& prefix) {
  return [&file, prefix](const char* name, auto& number) {
    number = file.get_value<std::remove_reference_t<decltype(number)>>(prefix + name);
  };
}

constexpr const char* kLens = "camera/lens/";
constexpr const char* kPanorama = "camera/panorama/";
constexpr const char* kStereo = "camera/stereo/";

void put_motion(ArrayFile& file, const CameraDesc& camera) {
  const CameraMotionDesc& motion = camera.motion;
  if (!motion.poses.empty()) {
    const std::span<const double> numbers(glm::value_ptr(motion.poses[0]),
                                          16 * motion.poses.size());
    file.put<double>("camera/motion/poses", numbers, {motion.poses.size(), 4, 4});
    file.put_value<double>("camera/motion/zoom_open", motion.zoom_open);
    file.put_value<double>("camera/motion/zoom_close", motion.zoom_close);
  }
  const ShutterDesc& shutter = camera.shutter;
  if (!shutter.curve.empty()) {
    file.put<float>("camera/shutter/curve", shutter.curve, {shutter.curve.size()});
  }
  if (shutter.still) file.put_value<std::uint32_t>("camera/shutter/still", 1);
  if (shutter.rolling) {
    file.put_value<double>("camera/shutter/rolling_duration", shutter.rolling_duration);
  }
}

void get_motion(const ArrayFile& file, CameraDesc& camera) {
  if (file.has("camera/motion/poses")) {
    const auto numbers = file.get<double>("camera/motion/poses");
    for (std::size_t i = 0; i + 16 <= numbers.size(); i += 16) {
      camera.motion.poses.push_back(glm::make_mat4(&numbers[i]));
    }
    camera.motion.zoom_open = file.get_value<double>("camera/motion/zoom_open");
    camera.motion.zoom_close = file.get_value<double>("camera/motion/zoom_close");
  }
  if (file.has("camera/shutter/curve")) {
    camera.shutter.curve = file.get<float>("camera/shutter/curve");
  }
  camera.shutter.still = file.has("camera/shutter/still");
  camera.shutter.rolling = file.has("camera/shutter/rolling_duration");
  if (camera.shutter.rolling) {
    camera.shutter.rolling_duration = file.get_value<double>("camera/shutter/rolling_duration");
  }
}

}  // namespace

void put_camera(ArrayFile& file, const CameraDesc& camera) {
  const std::uint32_t resolution[2] = {camera.width, camera.height};
  file.put_value<std::uint32_t>("camera/kind", static_cast<std::uint32_t>(camera.kind));
  file.put<double>(matrix_name(camera.kind),
                   std::span<const double>(glm::value_ptr(matrix_of(camera)), 16), {4, 4});
  file.put_value<double>("camera/clip_start", camera.clip_start);
  file.put_value<double>("camera/clip_end", camera.clip_end);
  file.put<std::uint32_t>("camera/resolution", resolution, {2});
  if (camera.lens.radius != 0.0) for_each_lens_number(camera.lens, writer(file, kLens));
  if (camera.stereo.eye != 0.0) for_each_stereo_number(camera.stereo, writer(file, kStereo));
  if (camera.kind == CameraKind::kPanorama) {
    file.put_value<std::uint32_t>("camera/panorama/kind",
                                  static_cast<std::uint32_t>(camera.panorama.kind));
    for_each_panorama_number(camera.panorama, writer(file, kPanorama));
  }
  put_motion(file, camera);
}

CameraDesc get_camera(const ArrayFile& file) {
  CameraDesc camera;
  const auto kind = file.get_value<std::uint32_t>("camera/kind");
  if (kind > 2) throw std::runtime_error("the scene's camera is of an unknown kind");
  camera.kind = static_cast<CameraKind>(kind);
  const Mat4d matrix = glm::make_mat4(file.get<double>(matrix_name(camera.kind), 16).data());
  (camera.kind == CameraKind::kPanorama ? camera.world_from_camera : camera.clip_from_world) =
      matrix;
  camera.clip_start = file.get_value<double>("camera/clip_start");
  camera.clip_end = file.get_value<double>("camera/clip_end");
  const auto resolution = file.get<std::uint32_t>("camera/resolution", 2);
  camera.width = resolution[0];
  camera.height = resolution[1];
  if (file.has("camera/lens/radius")) for_each_lens_number(camera.lens, reader(file, kLens));
  if (file.has("camera/stereo/eye")) for_each_stereo_number(camera.stereo, reader(file, kStereo));
  if (camera.kind == CameraKind::kPanorama) {
    const auto panorama = file.get_value<std::uint32_t>("camera/panorama/kind");
    if (panorama > 6) throw std::runtime_error("the scene's panorama is of an unknown kind");
    camera.panorama.kind = static_cast<PanoramaKind>(panorama);
    for_each_panorama_number(camera.panorama, reader(file, kPanorama));
  }
  get_motion(file, camera);
  return camera;
}

}  // namespace komorebi
