#include "render/mesh.h"

#include <algorithm>
#include <cmath>
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

/// Row i of [n][3].
Vec3 row(std::span<const float> rows, std::size_t i) {
  return Vec3(rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]);
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

std::size_t triangles(const MeshInput& in) {
  return in.tri2corner.empty() ? triangle_count_of(in.face_offsets) : in.tri2corner.size() / 3;
}

}  // namespace

void Mesh::take_normals(const MeshInput& in, ThreadPool& pool, const Cancel& cancel) {
  const auto smooth = [](std::uint8_t s) { return s != 0; };
  const auto normals = in.vtx2normal.empty() ? in.corner2normal : in.vtx2normal;
  const bool any_smooth =
      in.face2smooth.empty() || std::any_of(in.face2smooth.begin(), in.face2smooth.end(), smooth);
  if (normals.empty() || !any_smooth) return;
  normals_.resize(normals.size() + in.motion_normals.size());
  normal_sets_ = static_cast<std::uint32_t>(normals_.size() / normals.size());
  const auto take = [&](std::span<const float> rows, std::size_t to) {
    for_each_index(rows.size() / 3, pool, cancel, [&](std::size_t i) {
      // Custom normals may hold anything: a null normal makes the shading use the triangle's own.
      const Vec3 n = row(rows, i);
      const bool finite = std::isfinite(n.x) && std::isfinite(n.y) && std::isfinite(n.z);
      for (std::size_t c = 0; c < 3; ++c)
        normals_[to + 3 * i + c] = finite ? rows[3 * i + c] : 0.0f;
    });
  };
  const std::size_t before = in.motion_normals.size() / 2;
  take(in.motion_normals.first(before), 0);
  take(normals, before);
  take(in.motion_normals.subspan(before), before + normals.size());
  tri2normal_ = geometry_->tri2vtx.data();
  if (in.vtx2normal.empty()) {
    tri2normal_ = geometry_->tri2corner.data();
    if (geometry_->tri2corner.empty()) {
      every_corner_.resize(geometry_->tri2vtx.size());
      std::iota(every_corner_.begin(), every_corner_.end(), 0u);
      tri2normal_ = every_corner_.data();
    }
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

void Mesh::take_uvs(const MeshInput& in, ThreadPool& pool, const Cancel& cancel) {
  if (in.corner2uv.empty()) return;
  tri2uv_.resize(6 * std::size_t{triangle_count()});
  const auto& corners = geometry_->tri2corner;
  for_each_index(tri2uv_.size() / 2, pool, cancel, [&](std::size_t i) {
    const std::size_t corner = corners.empty() ? i : corners[i];
    for (std::size_t k = 0; k < 2; ++k) {
      const float value = in.corner2uv[2 * corner + k];
      tri2uv_[2 * i + k] = std::isfinite(value) ? value : 0.0f;
    }
  });
}

void Mesh::take_attributes(const MeshInput& in, ThreadPool& pool, const Cancel& cancel) {
  if (in.attributes.empty()) return;
  const auto& corners = geometry_->tri2corner;
  Array<std::uint32_t> tri2face(triangle_count());
  spread(in, tri2face, pool, cancel,
         [](std::size_t face) { return static_cast<std::uint32_t>(face); });
  const AttributeRows rows[] = {
      {AttributeDomain::kVertex, "vertex", vertex_count(), {}, vertex_count()},
      {AttributeDomain::kCorner, "corner", in.corner2vtx.size(), corners,
       3 * std::size_t{triangle_count()}},
      {AttributeDomain::kFace, "face", in.face_offsets.size() - 1, tri2face, triangle_count()}};
  attributes_ = std::make_shared<const MeshAttributes>("mesh \"" + name_ + "\"", in.attributes,
                                                       rows, pool, cancel);
}

void Mesh::take_attributes(const CurvesInput& in, ThreadPool& pool, const Cancel& cancel) {
  if (in.attributes.empty()) return;
  std::vector<std::uint32_t> segment2curve;
  for (std::size_t c = 0; c + 1 < in.curve_offsets.size(); ++c) {
    const auto keys = static_cast<std::size_t>(in.curve_offsets[c + 1] - in.curve_offsets[c]);
    segment2curve.insert(segment2curve.end(), keys > 0 ? keys - 1 : 0,
                         static_cast<std::uint32_t>(c));
  }
  const std::size_t keys = in.key2radius.size();
  const AttributeRows rows[] = {{AttributeDomain::kVertex, "key", keys, {}, keys},
                                {AttributeDomain::kFace, "curve", in.curve_offsets.size() - 1,
                                 segment2curve, segment2curve.size()}};
  attributes_ = std::make_shared<const MeshAttributes>("curves \"" + name_ + "\"", in.attributes,
                                                       rows, pool, cancel);
}

void Mesh::take_attributes(const PointsInput& in, ThreadPool& pool, const Cancel& cancel) {
  if (in.attributes.empty()) return;
  const std::size_t points = in.point2radius.size();
  const AttributeRows rows[] = {{AttributeDomain::kVertex, "point", points, {}, points}};
  attributes_ = std::make_shared<const MeshAttributes>("points \"" + name_ + "\"", in.attributes,
                                                       rows, pool, cancel);
}

void Mesh::take_steps(std::span<const float> positions, ThreadPool& pool, const Cancel& cancel) {
  step_xyz_.resize(positions.size());
  const Vec3 shift(origin());  // exact: see MeshGeometry
  for_each_index(step_xyz_.size() / 3, pool, cancel, [&](std::size_t i) {
    const Vec3 local = row(positions, i) - shift;
    for (std::size_t c = 0; c < 3; ++c) step_xyz_[3 * i + c] = local[static_cast<int>(c)];
  });
}

std::shared_ptr<const Mesh> Mesh::build(const MeshInput& in, Builder builder, ThreadPool& pool,
                                        const Cancel& cancel, const Mesh* same_geometry) {
  check_mesh(in, pool);
  check(cancel);
  std::shared_ptr<Mesh> mesh(new Mesh);
  mesh->name_ = in.name;
  if (same_geometry) {
    mesh->geometry_ = same_geometry->geometry_;
    if (mesh->vertex_count() != in.vtx2xyz.size() / 3 || mesh->triangle_count() != triangles(in) ||
        mesh->geometry_->sets != in.set_count()) {
      throw std::invalid_argument("mesh \"" + in.name + "\": it has not the geometry of \"" +
                                  same_geometry->name() + "\"");
    }
  } else {
    mesh->geometry_ =
        std::make_shared<const MeshGeometry>(build_geometry(in, builder, pool, cancel));
  }
  mesh->take_normals(in, pool, cancel);
  mesh->take_materials(in, pool, cancel);
  mesh->take_uvs(in, pool, cancel);
  mesh->take_attributes(in, pool, cancel);
  mesh->take_steps(in.step_positions, pool, cancel);
  return mesh;
}

/// A strand is the same all along.
void Mesh::take_shading(const CurvesInput& in) {
  const auto other_slot = [](std::int32_t slot) { return slot != 0; };
  if (std::ranges::any_of(in.curve2material, other_slot)) {
    tri2material_.resize(primitive_count());
  }
  if (!in.curve2uv.empty()) tri2uv_.resize(2 * std::size_t{primitive_count()});
  std::size_t segment = 0;
  for (std::size_t c = 0; c + 1 < in.curve_offsets.size(); ++c) {
    for (std::int32_t key = in.curve_offsets[c]; key + 1 < in.curve_offsets[c + 1]; ++key) {
      if (!tri2material_.empty()) {
        tri2material_[segment] = static_cast<std::uint16_t>(in.curve2material[c]);
      }
      for (std::size_t k = 0; k < 2 && !tri2uv_.empty(); ++k) {
        const float value = in.curve2uv[2 * c + k];
        tri2uv_[2 * segment + k] = std::isfinite(value) ? value : 0.0f;
      }
      ++segment;
    }
  }
}

std::shared_ptr<const Mesh> Mesh::build(const CurvesInput& in, Builder builder, ThreadPool& pool,
                                        const Cancel& cancel) {
  std::shared_ptr<Mesh> mesh(new Mesh(in.name, build_curves(in, builder, pool, cancel)));
  mesh->take_shading(in);
  mesh->take_attributes(in, pool, cancel);
  mesh->take_steps(in.motion.steps, pool, cancel);
  return mesh;
}

std::shared_ptr<const Mesh> Mesh::build(const PointsInput& in, Builder builder, ThreadPool& pool,
                                        const Cancel& cancel) {
  std::shared_ptr<Mesh> mesh(new Mesh(in.name, build_points(in, builder, pool, cancel)));
  mesh->take_attributes(in, pool, cancel);
  mesh->take_steps(in.motion.steps, pool, cancel);
  return mesh;
}

std::shared_ptr<const Mesh> Mesh::flattened(const Mat4d& matrix, ThreadPool& pool,
                                            const Cancel& cancel) const {
  if (round_) {
    RoundGeometry moved = round_->transformed(matrix, Builder::kLinear, pool, cancel);
    std::shared_ptr<Mesh> mesh(new Mesh(name_, std::move(moved)));
    mesh->take_shading(*this);
    for (std::size_t i = 0; i + 2 < step_xyz_.size(); i += 3) {
      const Vec3d from = Vec3d(step_xyz_[i], step_xyz_[i + 1], step_xyz_[i + 2]) + origin();
      const Vec3d to = Vec3d(matrix * glm::dvec4(from, 1.0)) - mesh->origin();
      for (int c = 0; c < 3; ++c) mesh->step_xyz_[i + std::size_t(c)] = static_cast<float>(to[c]);
    }
    return mesh;
  }
  const Array<float>& positions = geometry_->vtx2xyz;
  std::vector<float> moved(positions.size());
  for (std::size_t i = 0; i + 2 < moved.size(); i += 3) {
    const Vec3d local = Vec3d(positions[i], positions[i + 1], positions[i + 2]) + origin();
    const glm::dvec4 p = matrix * glm::dvec4(local, 1.0);
    for (int c = 0; c < 3; ++c) moved[i + static_cast<std::size_t>(c)] = static_cast<float>(p[c]);
  }
  const auto geometry = std::make_shared<MeshGeometry>();
  geometry->sets = geometry_->sets;
  geometry->take_positions(moved, pool);
  geometry->tri2vtx = geometry_->tri2vtx;
  geometry->tri2corner = geometry_->tri2corner;
  geometry->build_tree(Builder::kLinear, pool, cancel);
  std::shared_ptr<Mesh> mesh(new Mesh);
  mesh->name_ = name_;
  mesh->geometry_ = geometry;
  mesh->tri2uv_ = tri2uv_;
  mesh->attributes_ = attributes_;
  mesh->tri2material_ = tri2material_;  // normals have no image under a flat matrix: flat shading
  return mesh;
}

void Mesh::take_shading(const Mesh& other) {
  normals_ = other.normals_;
  normal_sets_ = other.normal_sets_;
  every_corner_ = other.every_corner_;
  tri2smooth_ = other.tri2smooth_;
  tri2material_ = other.tri2material_;
  tri2uv_ = other.tri2uv_;
  attributes_ = other.attributes_;
  step_xyz_ = other.step_xyz_;
  if (normals_.empty()) return;
  if (other.tri2normal_ == other.geometry_->tri2vtx.data()) {
    tri2normal_ = geometry_->tri2vtx.data();
  } else if (!every_corner_.empty()) {
    tri2normal_ = every_corner_.data();
  } else if (other.tri2normal_) {
    tri2normal_ = geometry_->tri2corner.data();
  }
}

std::shared_ptr<const Mesh> Mesh::rebuilt(Builder builder, ThreadPool& pool,
                                          const Cancel& cancel) const {
  if (round_) {
    RoundGeometry same = round_->transformed(Mat4d(1.0), builder, pool, cancel);
    std::shared_ptr<Mesh> mesh(new Mesh(name_, std::move(same)));
    mesh->take_shading(*this);
    return mesh;
  }
  const auto geometry = std::make_shared<MeshGeometry>();
  geometry->origin = geometry_->origin;
  geometry->sets = geometry_->sets;
  geometry->vtx2xyz = geometry_->vtx2xyz;
  geometry->tri2vtx = geometry_->tri2vtx;
  geometry->tri2corner = geometry_->tri2corner;
  geometry->build_tree(builder, pool, cancel);
  std::shared_ptr<Mesh> mesh(new Mesh);
  mesh->name_ = name_;
  mesh->geometry_ = geometry;
  mesh->take_shading(*this);
  return mesh;
}

std::vector<std::int32_t> Mesh::tri2corner() const {
  const auto& corners = geometry_->tri2corner;
  if (!corners.empty()) return {corners.begin(), corners.end()};
  std::vector<std::int32_t> every(geometry_->tri2vtx.size());
  std::iota(every.begin(), every.end(), 0);
  return every;
}

MeshView Mesh::view() const {
  MeshView view;
  view.object_origin = origin();
  view.triangle_count = triangle_count();
  view.vertex_count = vertex_count();
  view.vtx2xyz = geometry_->vtx2xyz.data();
  view.tri2vtx = geometry_->tri2vtx.data();
  view.position_sets = geometry_->sets;
  if (geometry_->sets > 1) {
    view.kind = PrimitiveKind::kMovingTriangle;
    view.time_trees = geometry_->moving_tree.views.data();
    view.time_tree_count = static_cast<std::uint32_t>(geometry_->moving_tree.views.size());
  }
  view.normal_sets = normal_sets_;
  view.normal_count = static_cast<std::uint32_t>(normals_.size() / 3 / normal_sets_);
  view.normals = normals_.empty() ? nullptr : normals_.data();
  view.tri2normal = tri2normal_;
  view.tri2smooth = tri2smooth_.empty() ? nullptr : tri2smooth_.data();
  view.tri2material = tri2material_.empty() ? nullptr : tri2material_.data();
  view.tri2uv = tri2uv_.empty() ? nullptr : tri2uv_.data();
  if (attributes_) {
    view.attributes = attributes_->views().data();
    view.attribute_count = static_cast<std::uint32_t>(attributes_->views().size());
  }
  view.tree = tree().view();
  view.clusters = tree().clusters.data();
  if (round_) round_->fill(view);
  return view;
}

std::size_t Mesh::byte_count() const {
  const std::size_t geometry = round_ ? round_->byte_count() : geometry_->byte_count();
  return sizeof(Mesh) + geometry + bytes(normals_) + bytes(every_corner_) + bytes(tri2smooth_) +
         bytes(tri2material_) + bytes(tri2uv_) + bytes(step_xyz_) +
         (attributes_ ? attributes_->byte_count() : 0);
}

}  // namespace komorebi
