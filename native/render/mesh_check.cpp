#include "render/mesh_check.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <stdexcept>

namespace komorebi {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw std::invalid_argument("mesh \"" + name + "\": " + what);
}

std::string counted(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

/// How many i in [0, count) are bad(i), in parallel.
template <class Bad>
std::size_t count_bad(std::size_t count, ThreadPool& pool, const Bad& bad) {
  constexpr std::size_t kGrain = 1 << 15;
  std::atomic<std::size_t> sum{0};
  pool.for_each_chunk(count, kGrain, [&](std::size_t begin, std::size_t end) {
    // A sum of 32 bits without a branch, which the compiler turns into lanes.
    std::uint32_t found = 0;
    for (std::size_t i = begin; i < end; ++i) found += bad(i) ? 1u : 0u;
    if (found) sum += found;
  });
  return sum;
}

std::size_t count_non_finite_rows(std::span<const float> rows, ThreadPool& pool) {
  // Finite floats have an exponent below 255. Rows are counted only when there is something to say.
  const auto bad = [&](std::size_t i) {
    return (std::bit_cast<std::uint32_t>(rows[i]) & 0x7fffffffu) >= 0x7f800000u;
  };
  if (!count_bad(rows.size(), pool, bad)) return 0;
  return count_bad(rows.size() / 3, pool,
                   [&](std::size_t i) { return bad(3 * i) || bad(3 * i + 1) || bad(3 * i + 2); });
}

std::size_t count_outside(std::span<const std::int32_t> indices, std::size_t limit,
                          ThreadPool& pool) {
  const auto unsigned_limit = static_cast<std::uint32_t>(std::min<std::size_t>(limit, 1u << 31));
  return count_bad(indices.size(), pool, [&](std::size_t i) {
    return static_cast<std::uint32_t>(indices[i]) >= unsigned_limit;  // negative ones are large
  });
}

void check_faces(const MeshInput& in, ThreadPool& pool) {
  if (in.face_offsets.empty()) refuse(in.name, "face_offsets needs at least one entry");
  if (in.face_offsets.front() != 0 ||
      static_cast<std::size_t>(in.face_offsets.back()) != in.corner2vtx.size()) {
    refuse(in.name, "face_offsets must run from 0 to the number of corners, " +
                        std::to_string(in.corner2vtx.size()));
  }
  const auto small = count_bad(in.face_offsets.size() - 1, pool, [&](std::size_t f) {
    // In 64 bits: garbage offsets may not overflow the subtraction.
    return std::int64_t{in.face_offsets[f + 1]} - in.face_offsets[f] < 3;
  });
  if (small)
    refuse(in.name, counted(small, "face has", "faces have") + " fewer than three corners");
}

void check_triangles(const MeshInput& in, ThreadPool& pool) {
  const std::size_t faces = in.face_offsets.size() - 1;
  if (in.tri2corner.empty() && in.tri2face.empty()) {
    const auto large = count_bad(faces, pool, [&](std::size_t f) {
      return in.face_offsets[f + 1] - in.face_offsets[f] > 4;
    });
    if (large) {
      refuse(in.name, "a face has more than four corners, so tri2corner is needed");
    }
    return;
  }
  if (in.tri2corner.size() != 3 * in.tri2face.size()) {
    refuse(in.name, "tri2corner and tri2face must have as many triangles");
  }
  if (const auto bad = count_outside(in.tri2corner, in.corner2vtx.size(), pool)) {
    refuse(in.name, counted(bad, "triangle corner is", "triangle corners are") + " out of range");
  }
  if (const auto bad = count_outside(in.tri2face, faces, pool)) {
    refuse(in.name,
           counted(bad, "triangle names a face", "triangles name a face") + " that is not there");
  }
}

}  // namespace

void check_mesh(const MeshInput& in, ThreadPool& pool) {
  const std::size_t faces = in.face_offsets.empty() ? 0 : in.face_offsets.size() - 1;
  if (in.vtx2xyz.size() / 3 >= kNone || in.corner2vtx.size() >= 0x7fffffffu / 3) {
    refuse(in.name, "more vertices or corners than 32-bit indices can count");
  }
  if (const auto bad = count_non_finite_rows(in.vtx2xyz, pool)) {
    refuse(in.name, counted(bad, "vertex is", "vertices are") + " not finite");
  }
  check_faces(in, pool);
  if (const auto bad = count_outside(in.corner2vtx, in.vtx2xyz.size() / 3, pool)) {
    refuse(in.name,
           counted(bad, "corner names a vertex", "corners name a vertex") + " that is not there");
  }
  check_triangles(in, pool);
  if (!in.corner2normal.empty() && in.corner2normal.size() != 3 * in.corner2vtx.size()) {
    refuse(in.name, "corner_normals must have one row a corner");
  }
  if (!in.vtx2normal.empty() && in.vtx2normal.size() != in.vtx2xyz.size()) {
    refuse(in.name, "vertex_normals must have one row a vertex");
  }
  if (!in.vtx2normal.empty() && !in.corner2normal.empty()) {
    refuse(in.name, "normals are either by vertex or by corner, not both");
  }
  const std::size_t positions = in.vtx2xyz.size();
  if (in.motion_positions.size() % std::max<std::size_t>(2 * positions, 1) != 0 ||
      in.set_count() > 4097) {
    refuse(in.name, "motion_positions must have a row a vertex at an even number of times");
  }
  if (const auto bad = count_non_finite_rows(in.motion_positions, pool)) {
    refuse(in.name, counted(bad, "vertex in time is", "vertices in time are") + " not finite");
  }
  if (!in.step_positions.empty() && (in.step_positions.size() != 2 * positions ||  //
                                     !in.motion_positions.empty())) {
    refuse(in.name, "step_positions must have a row a vertex at two times, without others in time");
  }
  if (const auto bad = count_non_finite_rows(in.step_positions, pool)) {
    refuse(in.name, counted(bad, "vertex at a step is", "vertices at a step are") + " not finite");
  }
  const std::size_t normals = std::max(in.vtx2normal.size(), in.corner2normal.size());
  if (!in.motion_normals.empty() && in.motion_normals.size() != (in.set_count() - 1) * normals) {
    refuse(in.name, "motion_normals must have a row a normal at the times of motion_positions");
  }
  if (!in.face2smooth.empty() && in.face2smooth.size() != faces) {
    refuse(in.name, "smooth_faces must have one entry a face");
  }
  if (!in.corner2uv.empty() && in.corner2uv.size() != 2 * in.corner2vtx.size()) {
    refuse(in.name, "corner_uvs must have one row a corner");
  }
  if (!in.face2material.empty() && in.face2material.size() != faces) {
    refuse(in.name, "face_materials must have one entry a face");
  }
  if (const auto bad = count_outside(in.face2material, 1u << 15, pool)) {
    refuse(in.name, counted(bad, "face has a material slot", "faces have a material slot") +
                        " outside 0 to 32767");
  }
}

}  // namespace komorebi
