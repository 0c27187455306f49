#include "render/mesh.h"

#include <algorithm>
#include <stdexcept>

#include "render/mesh_check.h"
#include "render/triangulate.h"

namespace komorebi {
namespace {

template <class T>
std::size_t bytes(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}

/// body(i) for every i in [0, count), in parallel; throws Cancelled soon after the flag is raised.
template <class Body>
void for_each_index(std::size_t count, ThreadPool& pool, const Cancel& cancel, const Body& body) {
  constexpr std::size_t kGrain = 1 << 16;
  pool.for_each_chunk(count, kGrain, [&](std::size_t begin, std::size_t end) {
    if (cancel.raised()) throw Cancelled();
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// The point of the bounds nearest to null, axis by axis.
Vec3 nearest_to_null(std::span<const float> vtx2xyz) {
  Vec3 lo(kFloatMax), hi(-kFloatMax);
  for (std::size_t i = 0; i + 2 < vtx2xyz.size(); i += 3) {
    const Vec3 p(vtx2xyz[i], vtx2xyz[i + 1], vtx2xyz[i + 2]);
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
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

}  // namespace

void Mesh::take_positions(std::span<const float> vtx2xyz) {
  const Vec3 candidate = nearest_to_null(vtx2xyz);
  const Vec3 origin = moves_exactly(vtx2xyz, candidate) ? candidate : Vec3(0.0f);
  origin_ = Vec3d(origin);
  vtx2xyz_.resize(vtx2xyz.size());
  for (std::size_t i = 0; i + 2 < vtx2xyz.size(); i += 3) {
    vtx2xyz_[i] = vtx2xyz[i] - origin.x;
    vtx2xyz_[i + 1] = vtx2xyz[i + 1] - origin.y;
    vtx2xyz_[i + 2] = vtx2xyz[i + 2] - origin.z;
  }
}

void Mesh::take_normals(const MeshInput& in, std::span<const std::int32_t> tri2face,
                        ThreadPool& pool, const Cancel& cancel) {
  const auto face = [&](std::size_t tri) { return static_cast<std::size_t>(tri2face[tri]); };
  const std::size_t triangles = tri2face.size();
  const auto smooth = [](std::uint8_t s) { return s != 0; };
  const bool any_smooth =
      in.face2smooth.empty() || std::any_of(in.face2smooth.begin(), in.face2smooth.end(), smooth);
  if (!in.corner2normal.empty() && any_smooth) {
    corner2normal_.resize(9 * triangles);
    for_each_index(3 * triangles, pool, cancel, [&](std::size_t k) {
      const float* normal = &in.corner2normal[3 * static_cast<std::size_t>(tri2corner_[k])];
      std::copy_n(normal, 3, &corner2normal_[3 * k]);
    });
    if (!std::all_of(in.face2smooth.begin(), in.face2smooth.end(), smooth)) {
      tri2smooth_.resize(triangles);
      for_each_index(triangles, pool, cancel,
                     [&](std::size_t t) { tri2smooth_[t] = in.face2smooth[face(t)]; });
    }
  }
  const auto other_slot = [](std::int32_t slot) { return slot != 0; };
  if (std::any_of(in.face2material.begin(), in.face2material.end(), other_slot)) {
    tri2material_.resize(triangles);
    for_each_index(triangles, pool, cancel, [&](std::size_t t) {
      tri2material_[t] = static_cast<std::uint16_t>(in.face2material[face(t)]);
    });
  }
}

std::shared_ptr<const Mesh> Mesh::build(const MeshInput& in, Builder builder, ThreadPool& pool,
                                        const Cancel& cancel) {
  const auto stop_if_cancelled = [&] {
    if (cancel.raised()) throw Cancelled();
  };
  check_mesh(in);
  stop_if_cancelled();
  std::shared_ptr<Mesh> mesh(new Mesh);
  mesh->name_ = in.name;
  mesh->take_positions(in.vtx2xyz);
  stop_if_cancelled();

  std::vector<std::int32_t> tri2face(in.tri2face.begin(), in.tri2face.end());
  mesh->tri2corner_.assign(in.tri2corner.begin(), in.tri2corner.end());
  if (in.tri2corner.empty()) {
    Triangulation t = triangulate(in.vtx2xyz, in.corner2vtx, in.face_offsets);
    mesh->tri2corner_ = std::move(t.tri2corner);
    tri2face = std::move(t.tri2face);
  }
  stop_if_cancelled();
  mesh->tri2vtx_.resize(mesh->tri2corner_.size());
  for_each_index(mesh->tri2corner_.size(), pool, cancel, [&](std::size_t k) {
    const auto corner = static_cast<std::size_t>(mesh->tri2corner_[k]);
    mesh->tri2vtx_[k] = static_cast<std::uint32_t>(in.corner2vtx[corner]);
  });
  mesh->take_normals(in, tri2face, pool, cancel);
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
  mesh->take_positions(moved);
  mesh->tri2vtx_ = tri2vtx_;
  mesh->tri2corner_ = tri2corner_;
  mesh->tri2material_ = tri2material_;  // normals have no image under a flat matrix: flat shading
  mesh->tree_ = build_mesh_tree(mesh->vtx2xyz_, mesh->tri2vtx_, Builder::kLinear, pool, cancel);
  return mesh;
}

MeshView Mesh::view() const {
  MeshView view;
  view.triangle_count = triangle_count();
  view.vertex_count = vertex_count();
  view.vtx2xyz = vtx2xyz_.data();
  view.tri2vtx = tri2vtx_.data();
  view.corner2normal = corner2normal_.empty() ? nullptr : corner2normal_.data();
  view.tri2smooth = tri2smooth_.empty() ? nullptr : tri2smooth_.data();
  view.tri2material = tri2material_.empty() ? nullptr : tri2material_.data();
  view.tree = tree_.view();
  view.blocks = tree_.blocks.data();
  return view;
}

std::size_t Mesh::byte_count() const {
  return sizeof(Mesh) + bytes(vtx2xyz_) + bytes(tri2vtx_) + bytes(tri2corner_) +
         bytes(corner2normal_) + bytes(tri2smooth_) + bytes(tri2material_) + tree_.byte_count();
}

}  // namespace komorebi
