#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <vector>

#include "render/scene.h"
#include "render/session.h"

namespace komorebi::testing {

inline ThreadPool& shared_pool() {
  static ThreadPool pool(2);
  return pool;
}

/// A polygon mesh that owns its arrays; every face has `corners_per_face` corners.
struct Polygons {
  std::vector<float> vtx2xyz;
  std::vector<std::int32_t> corner2vtx;
  std::vector<std::int32_t> face_offsets{0};
  std::vector<float> corner2normal;

  std::int32_t vertex(const Vec3d& p) {
    for (int c = 0; c < 3; ++c) vtx2xyz.push_back(static_cast<float>(p[c]));
    return static_cast<std::int32_t>(vtx2xyz.size() / 3 - 1);
  }
  void face(std::initializer_list<std::int32_t> vertices) {
    corner2vtx.insert(corner2vtx.end(), vertices);
    face_offsets.push_back(static_cast<std::int32_t>(corner2vtx.size()));
  }
  MeshInput input(const std::string& name = "test") const {
    MeshInput in;
    in.name = name;
    in.vtx2xyz = vtx2xyz;
    in.corner2vtx = corner2vtx;
    in.face_offsets = face_offsets;
    in.corner2normal = corner2normal;
    return in;
  }
  std::shared_ptr<const Mesh> mesh(Builder builder = Builder::kLinear) const {
    return Mesh::build(input(), builder, shared_pool(), Cancel());
  }
};

/// A mesh that deforms: `move(position, time)` at 2 k + 1 times, the middle one at rest; smooth
/// ones with normals in time.
template <class Move>
std::shared_ptr<const Mesh> deforming(const Polygons& rest, int others, const Move& move,
                                      Builder builder = Builder::kLinear) {
  Polygons middle = rest;
  std::vector<float> positions, normals;
  for (int i = 0; i <= others; ++i) {
    const double time = double(i) / others;
    std::vector<float> moved;
    for (std::size_t v = 0; v < rest.vtx2xyz.size(); v += 3) {
      const Vec3d p = move(Vec3d(rest.vtx2xyz[v], rest.vtx2xyz[v + 1], rest.vtx2xyz[v + 2]), time);
      for (int c = 0; c < 3; ++c) moved.push_back(static_cast<float>(p[c]));
    }
    std::vector<float> turned;
    for (std::size_t n = 0; n < rest.corner2normal.size(); n += 3) {
      const Vec3d tilted(rest.corner2normal[n], rest.corner2normal[n + 1] + 0.5 * time,
                         rest.corner2normal[n + 2]);
      for (int c = 0; c < 3; ++c) turned.push_back(static_cast<float>(glm::normalize(tilted)[c]));
    }
    if (2 * i == others) {
      middle.vtx2xyz = moved;
      middle.corner2normal = turned;
      continue;
    }
    positions.insert(positions.end(), moved.begin(), moved.end());
    normals.insert(normals.end(), turned.begin(), turned.end());
  }
  MeshInput input = middle.input("deforming");
  input.motion_positions = positions;
  input.motion_normals = normals;
  return Mesh::build(input, builder, shared_pool(), Cancel());
}

/// One parallelogram: corner, and the two edges from it.
inline Polygons quad(const Vec3d& corner, const Vec3d& a, const Vec3d& b) {
  Polygons p;
  const auto v = p.vertex(corner);
  p.vertex(corner + a);
  p.vertex(corner + a + b);
  p.vertex(corner + b);
  p.face({v, v + 1, v + 2, v + 3});
  return p;
}

/// A sphere of n rings and 2n segments, of quads; the poles are fans of degenerate quads, as they
/// come from careless exporters. Smooth: corner normals are the sphere's own.
inline Polygons sphere(int n, const Vec3d& centre, double radius, bool smooth) {
  Polygons p;
  const auto normal = [&](int ring, int segment) {
    const double theta = glm::pi<double>() * ring / n, phi = glm::pi<double>() * segment / n;
    return Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  for (int ring = 0; ring <= n; ++ring) {
    for (int segment = 0; segment < 2 * n; ++segment) {
      p.vertex(centre + radius * normal(ring, segment));
    }
  }
  const auto id = [&](int ring, int segment) { return ring * 2 * n + segment % (2 * n); };
  for (int ring = 0; ring < n; ++ring) {
    for (int segment = 0; segment < 2 * n; ++segment) {
      p.face({id(ring, segment), id(ring + 1, segment), id(ring + 1, segment + 1),
              id(ring, segment + 1)});
    }
  }
  if (smooth) {
    for (const std::int32_t v : p.corner2vtx) {
      const Vec3d n_v = normal(v / (2 * n), v % (2 * n));
      for (int c = 0; c < 3; ++c) p.corner2normal.push_back(static_cast<float>(n_v[c]));
    }
  }
  return p;
}

/// A closed box, faces outward.
inline Polygons box(const Vec3d& lo, const Vec3d& hi) {
  Polygons p;
  for (int i = 0; i < 8; ++i) {
    p.vertex({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z});
  }
  p.face({0, 2, 3, 1});
  p.face({4, 5, 7, 6});
  p.face({0, 1, 5, 4});
  p.face({2, 6, 7, 3});
  p.face({0, 4, 6, 2});
  p.face({1, 3, 7, 5});
  return p;
}

/// A camera at `eye` that looks at `target`, 50 mm on 36 mm.
inline CameraDesc camera_at(const Vec3d& eye, const Vec3d& target, std::uint32_t width,
                            std::uint32_t height, double scale = 1.0) {
  CameraDesc camera;
  const Vec3d along = glm::normalize(target - eye);
  const Vec3d up = std::abs(along.z) > 0.99 ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
  camera.clip_start = 0.01 * scale;
  camera.clip_end = 1000.0 * scale;
  camera.width = width;
  camera.height = height;
  const double aspect = static_cast<double>(width) / height;
  const double fov_y = 2.0 * std::atan(18.0 / 50.0 / aspect);
  camera.clip_from_world = glm::perspective(fov_y, aspect, camera.clip_start, camera.clip_end) *
                           glm::lookAt(eye, target, up);
  return camera;
}

/// A camera that sees nothing but a tiny patch around `target`: the mean of its picture is the
/// value at that point. The patch's half width is `size`.
inline CameraDesc probe_at(const Vec3d& target, const Vec3d& normal, double size) {
  CameraDesc camera = camera_at(target + normal, target, 16, 16);
  camera.kind = CameraKind::kOrthographic;
  const Vec3d up = std::abs(normal.z) > 0.9 ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
  camera.clip_start = 0.5;
  camera.clip_end = 1.5;
  camera.clip_from_world =
      glm::ortho(-size, size, -size, size, 0.5, 1.5) * glm::lookAt(target + normal, target, up);
  return camera;
}

struct Placed {
  std::shared_ptr<const Mesh> mesh;
  Mat4d world_from_object{1.0};
};

inline std::shared_ptr<Scene> make_scene(const std::vector<Placed>& parts, const CameraDesc& camera,
                                         const Vec3& world = Vec3(1.0f)) {
  auto scene = std::make_shared<Scene>();
  for (const Placed& part : parts) {
    const InstanceInput instance{scene->add_mesh(part.mesh), part.world_from_object, 0, kMaskAll,
                                 0};
    scene->add_instances({&instance, 1}, "test");
  }
  scene->set_world_color(world);
  scene->set_camera(camera);
  return scene;
}

inline std::shared_ptr<Scene> committed(std::shared_ptr<Scene> scene) {
  scene->commit(shared_pool(), Cancel());
  return scene;
}

/// Renders to the end and returns a pass.
inline std::vector<float> render(const std::shared_ptr<const Scene>& scene,
                                 const Settings& settings, const std::string& pass = "Combined") {
  Session session(scene, settings);
  while (!session.wait(10.0)) {
  }
  if (!session.error().empty()) throw std::runtime_error(session.error());
  const Rect region = session.settings().region;
  std::vector<float> picture(find_pass(pass).channels * region.area());
  session.film().read(pass, region, picture.data());
  return picture;
}

/// The Combined pass of a render that was cancelled and resumed on its way, at least once.
inline std::vector<float> render_with_breaks(const std::shared_ptr<const Scene>& scene,
                                             const Settings& settings) {
  Session session(scene, settings);
  int breaks = 0;
  // Longer and longer: a cancel drops what is half done, so on a busy machine short ones get
  // nowhere.
  for (double seconds = 0.002; !session.wait(seconds); seconds *= 1.5) {
    session.cancel();
    const bool ended = session.wait(10.0);
    EXPECT_TRUE(ended);
    if (!ended) return {};
    breaks += session.progress().fraction < 1.0;
    session.resume();
  }
  EXPECT_GT(breaks, 0);
  const Rect region = session.settings().region;
  std::vector<float> picture(find_pass("Combined").channels * region.area());
  session.film().read("Combined", region, picture.data());
  return picture;
}

/// Mean and standard error of a picture's first channel over its pixels, which are independent.
struct Estimate {
  double mean = 0.0, error = 0.0;
};
inline Estimate estimate(const std::vector<float>& rgba) {
  double sum = 0.0, squares = 0.0;
  const double n = static_cast<double>(rgba.size()) / 4.0;
  for (std::size_t i = 0; i < rgba.size(); i += 4) sum += rgba[i];
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    squares += (rgba[i] - sum / n) * (rgba[i] - sum / n);
  }
  return {sum / n, std::sqrt(squares / (n - 1.0) / n)};
}

}  // namespace komorebi::testing
