#include "render/mesh.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <stdexcept>

#include "render/mesh_check.h"
#include "render/triangulate.h"

namespace komorebi {
namespace {

constexpr std::size_t kGrain = 1 << 15;

template <class T>
std::size_t bytes(const Array<T>& v) {
  return v.capacity() * sizeof(T);
}

/// body(i) for every i in [0, count), in parallel; throws Cancelled soon after the flag is raised.
template <class Body>
void for_each_index(std::size_t count, ThreadPool& pool, const Cancel& cancel, const Body& body) {
  pool.for_each_chunk(count, kGrain, [&](std::size_t begin, std::size_t end) {
    check(cancel);
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

Vec3 row(std::span<const float> rows, std::size_t i) {
  return Vec3(rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]);
}

/// The point of the bounds nearest to null, axis by axis.
Vec3 nearest_to_null(std::span<const float> vtx2xyz, ThreadPool& pool) {
  Vec3 lo(kFloatMax), hi(-kFloatMax);
  std::mutex mutex;
  pool.for_each_chunk(vtx2xyz.size() / 3, kGrain, [&](std::size_t begin, std::size_t end) {
    Vec3 chunk_lo(kFloatMax), chunk_hi(-kFloatMax);
    for (std::size_t i = begin; i < end; ++i) {
      chunk_lo = glm::min(chunk_lo, row(vtx2xyz, i));
      chunk_hi = glm::max(chunk_hi, row(vtx2xyz, i));
    }
    const std::lock_guard lock(mutex);
    lo = glm::min(lo, chunk_lo);
    hi = glm::max(hi, chunk_hi);
  });
  return vtx2xyz.empty() ? Vec3(0.0f) : glm::clamp(Vec3(0.0f), lo, hi);
}

/// True when no vertex loses a bit by moving to `origin`.
bool moves_exactly(std::span<const float> vtx2xyz, const Vec3& origin) {
  const auto exact = [](float value, float by) {
    const double moved = double{value} - double{by};
    return moved == double{static_cast<float>(moved)};
  };
  for (std::size_t i = 0; i + 2 < vtx2xyz.size(); i += 3) {
    if (!(exact(vtx2xyz[i], origin.x) && exact(vtx2xyz[i + 1], origin.y) &&
          exact(vtx2xyz[i + 2], origin.z))) {
      return false;
    }
  }
  return true;
}

/// Fills `tri2value` with value(face) of each triangle's face.
template <class T, class Value>
void spread(const MeshInput& in, Array<T>& tri2value, ThreadPool& pool, const Cancel& cancel,
            const Value& value) {
  if (!in.tri2face.empty()) {
    for_each_index(tri2value.size(), pool, cancel, [&](std::size_t t) {
      tri2value[t] = value(static_cast<std::size_t>(in.tri2face[t]));
    });
    return;
  }
  for_each_index(in.face_offsets.size() - 1, pool, cancel, [&](std::size_t f) {
    const auto begin = static_cast<std::size_t>(in.face_offsets[f]) - 2 * f;
    const auto end = static_cast<std::size_t>(in.face_offsets[f + 1]) - 2 * (f + 1);
    for (std::size_t t = begin; t < end; ++t) tri2value[t] = value(f);
  });
}

}  // namespace

void Mesh::take_positions(std::span<const float> vtx2xyz, ThreadPool& pool) {
  Vec3 origin = nearest_to_null(vtx2xyz, pool);
  if (origin != Vec3(0.0f) && !moves_exactly(vtx2xyz, origin)) origin = Vec3(0.0f);
  origin_ = Vec3d(origin);
  vtx2xyz_.resize(vtx2xyz.size());
  pool.for_each_chunk(vtx2xyz.size() / 3, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (int c = 0; c < 3; ++c) {
        const std::size_t k = 3 * i + static_cast<std::size_t>(c);
        vtx2xyz_[k] = vtx2xyz[k] - origin[c];
      }
    }
  });
}

void Mesh::take_triangles(const MeshInput& in, ThreadPool& pool, const Cancel& cancel) {
  const std::size_t faces = in.face_offsets.size() - 1;
  if (!in.tri2corner.empty()) {
    tri2corner_.assign(in.tri2corner.begin(), in.tri2corner.end());
  } else if (in.corner2vtx.size() != 3 * faces) {
    tri2corner_.resize(3 * triangle_count_of(in.face_offsets));
    triangulate(in.vtx2xyz, in.corner2vtx, in.face_offsets, tri2corner_, pool, cancel);
  }
  tri2vtx_.resize(tri2corner_.empty() ? in.corner2vtx.size() : tri2corner_.size());
  for_each_index(tri2vtx_.size(), pool, cancel, [&](std::size_t k) {
    const std::size_t corner = tri2corner_.empty() ? k : tri2corner_[k];
    tri2vtx_[k] = static_cast<std::uint32_t>(in.corner2vtx[corner]);
  });
}

void Mesh::take_normals(const MeshInput& in, ThreadPool& pool, const Cancel& cancel) {
  const auto smooth = [](std::uint8_t s) { return s != 0; };
  const auto normals = in.vtx2normal.empty() ? in.corner2normal : in.vtx2normal;
  const bool any_smooth =
      in.face2smooth.empty() || std::any_of(in.face2smooth.begin(), in.face2smooth.end(), smooth);
  if (normals.empty() || !any_smooth) return;
  normals_.resize(normals.size());
  for_each_index(normals.size() / 3, pool, cancel, [&](std::size_t i) {
    // Custom normals may hold anything: a null normal makes the shading use the triangle's own.
    const Vec3 n = row(normals, i);
    const bool finite = std::isfinite(n.x) && std::isfinite(n.y) && std::isfinite(n.z);
    for (std::size_t c = 0; c < 3; ++c) normals_[3 * i + c] = finite ? normals[3 * i + c] : 0.0f;
  });
  normals_by_corner_ = in.vtx2normal.empty();
  if (normals_by_corner_ && tri2corner_.empty()) {  // now someone reads it
    tri2corner_.resize(tri2vtx_.size());
    std::iota(tri2corner_.begin(), tri2corner_.end(), 0u);
  }
  if (std::all_of(in.face2smooth.begin(), in.face2smooth.end(), smooth)) return;
  tri2smooth_.resize(triangle_count());
  spread(in, tri2smooth_, pool, cancel, [&](std::size_t face) { return in.face2smooth[face]; });
}

void Mesh::take_materials(const MeshInput& in, ThreadPool& pool, const Cancel& cancel) {
  const auto other_slot = [](std::int32_t slot) { return slot != 0; };
  if (std::none_of(in.face2material.begin(), in.face2material.end(), other_slot)) return;
  tri2material_.resize(triangle_count());
  spread(in, tri2material_, pool, cancel,
         [&](std::size_t face) { return static_cast<std::uint16_t>(in.face2material[face]); });
}

std::shared_ptr<const Mesh> Mesh::build(const MeshInput& in, Builder builder, ThreadPool& pool,
                                        const Cancel& cancel) {
  check_mesh(in, pool);
  check(cancel);
  std::shared_ptr<Mesh> mesh(new Mesh);
  mesh->name_ = in.name;
  mesh->take_positions(in.vtx2xyz, pool);
  mesh->take_triangles(in, pool, cancel);
  mesh->take_normals(in, pool, cancel);
  mesh->take_materials(in, pool, cancel);
  mesh->tree_ = build_mesh_tree(mesh->vtx2xyz_, mesh->tri2vtx_, builder, pool, cancel);
  return mesh;
}

std::shared_ptr<const Mesh> Mesh::flattened(const Mat4d& matrix, ThreadPool& pool,
                                            const Cancel& cancel) const {
  std::vector<float> moved(vtx2xyz_.size());
  for (std::size_t i = 0; i + 2 < moved.size(); i += 3) {
    const Vec3d local = Vec3d(vtx2xyz_[i], vtx2xyz_[i + 1], vtx2xyz_[i + 2]) + origin_;
    const glm::dvec4 p = matrix * glm::dvec4(local, 1.0);
    for (int c = 0; c < 3; ++c) moved[i + static_cast<std::size_t>(c)] = static_cast<float>(p[c]);
  }
  std::shared_ptr<Mesh> mesh(new Mesh);
  mesh->name_ = name_;
  mesh->take_positions(moved, pool);
  mesh->tri2vtx_ = tri2vtx_;
  mesh->tri2corner_ = tri2corner_;
  mesh->tri2material_ = tri2material_;  // normals have no image under a flat matrix: flat shading
  mesh->tree_ = build_mesh_tree(mesh->vtx2xyz_, mesh->tri2vtx_, Builder::kLinear, pool, cancel);
  return mesh;
}

std::vector<std::int32_t> Mesh::tri2corner() const {
  if (!tri2corner_.empty()) return {tri2corner_.begin(), tri2corner_.end()};
  std::vector<std::int32_t> corners(tri2vtx_.size());
  std::iota(corners.begin(), corners.end(), 0);
  return corners;
}

MeshView Mesh::view() const {
  MeshView view;
  view.triangle_count = triangle_count();
  view.vertex_count = vertex_count();
  view.vtx2xyz = vtx2xyz_.data();
  view.tri2vtx = tri2vtx_.data();
  view.normals = normals_.empty() ? nullptr : normals_.data();
  view.tri2normal = normals_by_corner_ ? tri2corner_.data() : tri2vtx_.data();
  view.tri2smooth = tri2smooth_.empty() ? nullptr : tri2smooth_.data();
  view.tri2material = tri2material_.empty() ? nullptr : tri2material_.data();
  view.tree = tree_.view();
  view.clusters = tree_.clusters.data();
  return view;
}

std::size_t Mesh::byte_count() const {
  return sizeof(Mesh) + bytes(vtx2xyz_) + bytes(tri2vtx_) + bytes(tri2corner_) + bytes(normals_) +
         bytes(tri2smooth_) + bytes(tri2material_) + tree_.byte_count();
}

}  // namespace komorebi
