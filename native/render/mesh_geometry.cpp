#include "render/mesh_geometry.h"

#include <algorithm>
#include <mutex>
#include <vector>

#include "render/triangulate.h"

namespace komorebi {
namespace {

constexpr std::size_t kGrain = 1 << 15;

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

}  // namespace

void MeshGeometry::take_positions(std::span<const float> positions, ThreadPool& pool) {
  Vec3 shift = nearest_to_null(positions, pool);
  if (shift != Vec3(0.0f) && !moves_exactly(positions, shift)) shift = Vec3(0.0f);
  origin = Vec3d(shift);
  vtx2xyz.resize(positions.size());
  pool.for_each_chunk(positions.size() / 3, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (int c = 0; c < 3; ++c) {
        const std::size_t k = 3 * i + static_cast<std::size_t>(c);
        vtx2xyz[k] = positions[k] - shift[c];
      }
    }
  });
}

void MeshGeometry::take_triangles(const MeshInput& in, ThreadPool& pool, const Cancel& cancel) {
  const std::size_t faces = in.face_offsets.size() - 1;
  if (!in.tri2corner.empty()) {
    tri2corner.resize(in.tri2corner.size());
    std::transform(in.tri2corner.begin(), in.tri2corner.end(), tri2corner.begin(),
                   [](std::int32_t corner) { return static_cast<std::uint32_t>(corner); });
  } else if (in.corner2vtx.size() != 3 * faces) {
    tri2corner.resize(3 * triangle_count_of(in.face_offsets));
    triangulate(in.vtx2xyz, in.corner2vtx, in.face_offsets, tri2corner, pool, cancel);
  }
  tri2vtx.resize(tri2corner.empty() ? in.corner2vtx.size() : tri2corner.size());
  pool.for_each_chunk(tri2vtx.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    check(cancel);
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t corner = tri2corner.empty() ? k : tri2corner[k];
      tri2vtx[k] = static_cast<std::uint32_t>(in.corner2vtx[corner]);
    }
  });
}

void MeshGeometry::build_tree(Builder builder, ThreadPool& pool, const Cancel& cancel) {
  if (sets == 1) {
    tree = build_mesh_tree(vtx2xyz, tri2vtx, builder, pool, cancel);
    return;
  }
  moving_tree = build_moving_tree(vtx2xyz, sets, tri2vtx, builder, pool, cancel);
  tree.bounds = moving_tree.bounds;
}

std::size_t MeshGeometry::byte_count() const {
  return sizeof(MeshGeometry) + vtx2xyz.capacity() * sizeof(float) +
         (tri2vtx.capacity() + tri2corner.capacity()) * sizeof(std::uint32_t) + tree.byte_count() +
         moving_tree.byte_count();
}

std::vector<float> in_order(std::span<const float> others, std::span<const float> rest) {
  const auto middle = others.begin() + std::ptrdiff_t(others.size() / 2);
  std::vector<float> all(others.begin(), middle);
  all.insert(all.end(), rest.begin(), rest.end());
  all.insert(all.end(), middle, others.end());
  return all;
}

MeshGeometry build_geometry(const MeshInput& in, Builder builder, ThreadPool& pool,
                            const Cancel& cancel) {
  MeshGeometry geometry;
  geometry.sets = in.set_count();
  if (geometry.sets == 1) {
    geometry.take_positions(in.vtx2xyz, pool);
  } else {
    geometry.take_positions(in_order(in.motion_positions, in.vtx2xyz), pool);
  }
  geometry.take_triangles(in, pool, cancel);
  geometry.build_tree(builder, pool, cancel);
  return geometry;
}

}  // namespace komorebi
