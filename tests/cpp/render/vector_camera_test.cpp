// The Vector pass under cameras that move, of every kind.
#include "support/vectors.h"

namespace komorebi::testing {
namespace {

TEST(VectorPass, KnowsACameraThatMovesTurnsAndZooms) {
  const auto poses = looking({{-0.4, -6, 1}, {0, -6, 1}, {0.3, -5, 1.4}},
                             {{-0.2, 0, 0}, {0, 0, 0}, {0.5, 0, 0.2}});
  for (const bool zooms : {false, true}) {
    CameraDesc camera = still_at(poses[1]);
    camera.motion.poses = poses;
    if (zooms) {
      camera.motion.zoom_open = 1.3;
      camera.motion.zoom_close = 0.8;
    }
    const auto scene = committed(make_scene({{ball_mesh()}}, camera));
    expect_vectors(
        scene, poses,
        [&](const Vec3d& p, int step) {
          return pinhole(p, zooms ? (step == 0 ? 1.3 : step == 2 ? 0.8 : 1.0) : 1.0);
        },
        stays);
  }
  // Parallel rays: pixels are lengths.
  CameraDesc camera = still_at(poses[1]);
  camera.kind = CameraKind::kOrthographic;
  camera.clip_from_world = glm::ortho(-2.0, 2.0, -2.0, 2.0, 0.1, 50.0) * glm::inverse(poses[1]);
  camera.motion.poses = poses;
  expect_vectors(
      committed(make_scene({{ball_mesh()}}, camera)), poses,
      [](const Vec3d& p, int) { return glm::dvec2(p.x, p.y) * (kSize / 4.0); }, stays);
}

PanoramaDesc panorama_of(PanoramaKind kind) {
  PanoramaDesc panorama;
  panorama.kind = kind;
  panorama.fov = 3.0;
  panorama.focal_length = 10.5;
  panorama.sensor_width = 36.0;
  panorama.sensor_height = 24.0;
  return panorama;
}

/// The projections by hand, in pixels of a square picture; angles by libm.
glm::dvec2 by_hand(PanoramaKind kind, const Vec3d& p) {
  const double longitude = std::atan2(p.x, -p.z);
  const double latitude = std::atan2(p.y, std::hypot(p.x, p.z));
  const double angle = std::atan2(std::hypot(p.x, p.y), -p.z), around = std::atan2(p.y, p.x);
  const glm::dvec2 outward(std::cos(around), std::sin(around));
  switch (kind) {
    case PanoramaKind::kEquirectangular:
      return {longitude / 6.283185307179586 * kSize, latitude / 3.141592653589793 * kSize};
    case PanoramaKind::kFisheyeEquidistant:
      return outward * (angle / 3.0 * kSize);
    case PanoramaKind::kFisheyeEquisolid: {
      const double r = 2.0 * 10.5 * std::sin(0.5 * angle);
      return {outward.x * r / 36.0 * kSize, outward.y * r / 24.0 * kSize};
    }
    case PanoramaKind::kMirrorBall: {  // the normal is half way between the ray and +Z
      const Vec3d n = glm::normalize(glm::normalize(p) - Vec3d(0, 0, 1));
      return {n.x * 0.5 * kSize, n.y * 0.5 * kSize};
    }
    case PanoramaKind::kEquiangularCubeFace:
      return {longitude / 1.5707963267948966 * kSize,
              std::atan2(p.y, -p.z) / 1.5707963267948966 * kSize};
    default:
      ADD_FAILURE();
      return {};
  }
}

TEST(VectorPass, KnowsPanoramas) {
  const auto poses = looking({{-0.3, -2, 0.2}, {0, -2, 0.1}, {0.3, -1.9, 0}},
                             {{-0.2, 0, 0}, {0, 0, 0}, {0.5, 0, 0.2}});
  for (const PanoramaKind kind : {PanoramaKind::kEquirectangular, PanoramaKind::kFisheyeEquidistant,
                                  PanoramaKind::kFisheyeEquisolid, PanoramaKind::kMirrorBall,
                                  PanoramaKind::kEquiangularCubeFace}) {
    CameraDesc camera = still_at(poses[1]);
    camera.kind = CameraKind::kPanorama;
    camera.world_from_camera = poses[1];
    camera.clip_start = 0.01;
    camera.panorama = panorama_of(kind);
    camera.panorama.latitude_min = -glm::half_pi<double>();
    camera.motion.poses = poses;
    auto scene = make_scene({}, camera);
    const auto way = [](double t) { return translated(0.2 * t - 0.1, 0.3 * t - 0.15, 0); };
    add_moving(*scene, ball_mesh(), way, 3);
    expect_vectors(
        committed(scene), poses, [&](const Vec3d& p, int) { return by_hand(kind, p); },
        [&](const Vec3d& p, int time) { return p + Vec3d(way(time)[3]); });
  }
}

TEST(VectorPass, AcrossTheVanishingPointIsAsCyclesHasIt) {
  // Before, the wall is behind the camera, mirrored; after, it is where the camera stands.
  const Mat4d pose = looking({{0, -4, 0}}, {{0, 0, 0}})[0];
  CameraDesc camera = still_at(pose);
  auto scene = make_scene({}, camera);
  add_moving(
      *scene, quad({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}).mesh(),
      [](double t) {
        return translated(0, t == 0.0 ? -6.0 : t == 1.0 ? -4.0 : 0.0, 0);
      },
      3);
  Settings settings = with_vector();
  settings.samples = 1;
  const auto vectors = render(committed(scene), settings, "Vector");
  const auto positions = render(scene, settings, "Position");
  for (std::size_t i = 0; i < kSize * kSize; ++i) {
    const glm::dvec2 p(positions[3 * i], positions[3 * i + 2]);
    const glm::dvec2 now = p / 4.0 * kFocal, before = p / -2.0 * kFocal;
    const glm::dvec2 corner(-0.5 * kSize);  // where Cycles puts what has no depth
    ASSERT_NEAR(vectors[4 * i], before.x - now.x, 2e-3);
    ASSERT_NEAR(vectors[4 * i + 1], before.y - now.y, 2e-3);
    ASSERT_NEAR(vectors[4 * i + 2], now.x - corner.x, 2e-3);
    ASSERT_NEAR(vectors[4 * i + 3], now.y - corner.y, 2e-3);
  }
}

}  // namespace
}  // namespace komorebi::testing
