#pragma once

#include <cmath>
#include <unordered_map>

#include "core/vector.h"
#include "support/mesh_file.h"

namespace komorebi::bench {

using testing::TriangleMesh;

/// Numbers in [0, 1) that are the same everywhere (PCG-RXS-M-XS-32, O'Neill 2014).
class Numbers {
 public:
  float next() {
    state_ = state_ * 747796405u + 2891336453u;
    const std::uint32_t word = ((state_ >> ((state_ >> 28) + 4)) ^ state_) * 277803737u;
    return static_cast<float>(((word >> 22) ^ word) >> 8) * 0x1p-24f;
  }
  std::uint32_t bits() {
    const auto high = static_cast<std::uint32_t>(next() * 65536.0f);
    return high << 16 | static_cast<std::uint32_t>(next() * 65536.0f);
  }

 private:
  std::uint32_t state_ = 1;
};

inline void add_vertex(TriangleMesh& mesh, const Vec3& p) {
  for (int axis = 0; axis < 3; ++axis) mesh.vtx2xyz.push_back(p[axis]);
}

/// A forest, y up: `trees` crowns of 5,000 leaves, each leaf a quad of two triangles somewhere in
/// its crown, over a ground of two triangles.
inline TriangleMesh forest(int trees) {
  constexpr int kLeaves = 5000;
  TriangleMesh mesh;
  Numbers number;
  const auto cube = [&] { return 2.0f * Vec3(number.next(), number.next(), number.next()) - 1.0f; };
  const auto quad = [&](const Vec3& middle, const Vec3& u, const Vec3& v) {
    const auto first = static_cast<std::int64_t>(mesh.vtx2xyz.size() / 3);
    for (const Vec3& corner : {middle - u - v, middle + u - v, middle + u + v, middle - u + v}) {
      add_vertex(mesh, corner);
    }
    mesh.add_polygon({first, first + 1, first + 2, first + 3});
  };
  const float half = 2.5f * std::sqrt(static_cast<float>(trees));
  for (int tree = 0; tree < trees; ++tree) {
    const Vec3 foot(half * (2.0f * number.next() - 1.0f), 0.0f,
                    half * (2.0f * number.next() - 1.0f));
    const Vec3 radius(1.5f + number.next(), 2.0f + 2.0f * number.next(), 1.5f + number.next());
    const Vec3 middle = foot + Vec3(0.0f, 1.5f + radius.y, 0.0f);
    for (int leaf = 0; leaf < kLeaves; ++leaf) {
      Vec3 p = cube();
      while (glm::dot(p, p) > 1.0f) p = cube();
      Vec3 u = cube(), v = cube();
      while (glm::dot(u, u) < 0.01f) u = cube();
      u = glm::normalize(u);
      v = glm::cross(u, v);
      while (glm::dot(v, v) < 0.01f) v = glm::cross(u, cube());
      quad(middle + radius * p, 0.05f * u, 0.03f * glm::normalize(v));
    }
  }
  quad(Vec3(0.0f), Vec3(0.0f, 0.0f, half + 4.0f), Vec3(half + 4.0f, 0.0f, 0.0f));
  return mesh;
}

/// Each triangle becomes three quads between its corners, the middles of its edges and its own
/// middle, six triangles in all: what Blender's Subdivision Surface makes of it once, "Simple".
inline TriangleMesh subdivided(const TriangleMesh& mesh) {
  TriangleMesh fine;
  fine.vtx2xyz = mesh.vtx2xyz;
  std::unordered_map<std::uint64_t, std::int64_t> edges;
  edges.reserve(mesh.tri2vtx.size());
  const auto vertex = [&](std::uint32_t i) {
    const float* p = &mesh.vtx2xyz[3 * std::size_t{i}];
    return Vec3(p[0], p[1], p[2]);
  };
  const auto count = [&] { return static_cast<std::int64_t>(fine.vtx2xyz.size() / 3); };
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint64_t key = std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
    const auto [place, made] = edges.try_emplace(key, count());
    if (made) add_vertex(fine, 0.5f * vertex(a) + 0.5f * vertex(b));
    return place->second;
  };
  for (std::size_t i = 0; i < mesh.tri2vtx.size(); i += 3) {
    const std::uint32_t* c = &mesh.tri2vtx[i];
    const std::int64_t between[3] = {middle(c[0], c[1]), middle(c[1], c[2]), middle(c[2], c[0])};
    const std::int64_t inside = count();
    add_vertex(fine, (vertex(c[0]) + vertex(c[1]) + vertex(c[2])) / 3.0f);
    for (std::size_t k = 0; k < 3; ++k) {
      fine.add_polygon({c[k], between[k], inside, between[(k + 2) % 3]});
    }
  }
  return fine;
}

/// A bumpy sphere of about `triangles` triangles, of which neighbours share vertices: the same
/// shape at any size, for growth.
inline TriangleMesh bumpy_sphere(double triangles) {
  const int rows = std::max(2, static_cast<int>(std::lround(std::sqrt(triangles / 4.0))));
  const int columns = 2 * rows;
  TriangleMesh mesh;
  const auto vertices = static_cast<std::size_t>((rows + 1) * columns);
  mesh.vtx2xyz.reserve(3 * vertices);
  mesh.tri2vtx.reserve(std::size_t{6} * static_cast<std::size_t>(rows * columns));
  for (int j = 0; j <= rows; ++j) {
    const double latitude = 3.14159265358979 * (double(j) / rows - 0.5);
    for (int i = 0; i < columns; ++i) {
      const double longitude = 6.28318530717959 * i / columns;
      const Vec3d d(std::cos(latitude) * std::cos(longitude), std::sin(latitude),
                    std::cos(latitude) * std::sin(longitude));
      double radius = 1.0;
      for (int octave = 1; octave < 5; ++octave) {
        const double f = 3.0 * (1 << octave);
        radius += 0.25 / (1 << octave) * std::sin(f * d.x) * std::sin(f * d.y + octave) *
                  std::sin(f * d.z);
      }
      add_vertex(mesh, Vec3(radius * d));
    }
  }
  const auto at = [&](int j, int i) {
    return static_cast<std::uint32_t>(j * columns + i % columns);
  };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      for (const std::uint32_t corner :
           {at(j, i), at(j, i + 1), at(j + 1, i + 1), at(j, i), at(j + 1, i + 1), at(j + 1, i)}) {
        mesh.tri2vtx.push_back(corner);
      }
    }
  }
  return mesh;
}

}  // namespace komorebi::bench
