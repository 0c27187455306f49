// Curves and points, and many rays: nodes as for triangles, leaves ray by ray. Included once per
// instruction set by traverse_simd.cpp, without a guard.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// The rays of a bundle as curves and points take them.
class RoundRays {
 public:
  HWY_NOINLINE RoundRays(const MeshView& mesh, const LocalBundle& bundle, std::uint32_t rays)
      : deforms_(mesh.position_sets > 1), tree_{mesh.tree, nullptr, mesh.leaves} {
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
      const Vec3 direction(bundle.rays.d[0][i], bundle.rays.d[1][i], bundle.rays.d[2][i]);
      MotionPlace time = kAtRest;
      if (HWY_UNLIKELY(deforms_)) {
        time = round_time(mesh, bundle.time[i]);
        tree_of_[i] = &tree_at(mesh, bundle.time[i]);
      }
      ray_[i] = make_round_ray(bundle.ray(i), direction, time);
      self_[i] = static_cast<std::uint32_t>(bundle.self[i]);
    }
  }

  /// Of `rays`, those of the first one's part of the time, and its tree; of a set that stands
  /// still all.
  HWY_INLINE std::uint32_t same_time(std::uint32_t rays, TimeTree& tree) const {
    if (HWY_LIKELY(!deforms_)) {
      tree = tree_;
      return rays;
    }
    const TimeTree* of_first = tree_of_[__builtin_ctz(rays)];
    tree = *of_first;
    std::uint32_t same = 0;
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
      if (tree_of_[i] == of_first) same |= 1u << i;
    }
    return same;
  }

  /// Of `rays`, those that a leaf's item is met by; `closest(i)` keeps the hit of ray i.
  template <class ClosestOf>
  HWY_INLINE std::uint32_t meet(const MeshView& mesh, std::uint32_t instance, const RoundLeaf& leaf,
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
  bool deforms_;
  TimeTree tree_;                     ///< of a set that stands still
  const TimeTree* tree_of_[kBundle];  ///< of one that deforms
};

/// Where a child of such a tree lies in memory.
HWY_INLINE const void* round_child(const TimeTree& tree, std::uint32_t child) {
  if (child & Waiting::kLeaf) return tree.leaves + (child & ~Waiting::kLeaf);
  return tree.tree.nodes + child;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
