// Curves and points, and many rays: nodes as for triangles, leaves ray by ray. Included once per
// instruction set by traverse_simd.cpp, without a guard.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// The rays of a bundle as curves and points take them.
class RoundRays {
 public:
  HWY_NOINLINE RoundRays(const LocalBundle& bundle, std::uint32_t rays) {
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
      const Vec3 direction(bundle.rays.d[0][i], bundle.rays.d[1][i], bundle.rays.d[2][i]);
      ray_[i] = make_round_ray(bundle.ray(i), direction);
      self_[i] = static_cast<std::uint32_t>(bundle.self[i]);
    }
  }

  /// Of `rays`, those that a leaf's item is met by; `closest(i)` keeps the hit of ray i.
  template <class ClosestOf>
  HWY_INLINE std::uint32_t meet(const MeshView& mesh, std::uint32_t instance, std::uint32_t leaf,
                                std::uint32_t rays, const ClosestOf& closest) const {
    std::uint32_t found = 0;
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
      if (test_round_leaf(mesh, ray_[i], self_[i], instance, leaf, closest(i))) found |= 1u << i;
    }
    return found;
  }

 private:
  RoundRay ray_[kBundle];
  std::uint32_t self_[kBundle];
};

/// Where a child of a tree over curves or points lies in memory.
HWY_INLINE const void* round_child(const MeshView& mesh, std::uint32_t child) {
  if (child & Waiting::kLeaf) return mesh.leaves + (child & ~Waiting::kLeaf);
  return mesh.tree.nodes + child;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
