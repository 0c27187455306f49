// Meshes that deform, and many rays: nodes as for triangles that stand still, in the tree of the
// rays' part of the time; leaves ray by ray. Included once per instruction set by
// traverse_simd.cpp, without a guard.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// The rays of a bundle as triangles that move take them.
class MovingRays {
 public:
  HWY_NOINLINE MovingRays(const MeshView& mesh, const LocalBundle& bundle, std::uint32_t rays) {
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
      ray_[i] = bundle.ray(i);
      place_[i] = set_place(mesh.position_sets, bundle.time[i]);
      tree_[i] = &tree_at(mesh, bundle.time[i]);
      self_[i] = static_cast<std::uint32_t>(bundle.self[i]);
    }
  }

  /// Of `rays`, those of the first one's part of the time.
  HWY_INLINE std::uint32_t same_time(std::uint32_t rays, const TimeTree*& tree) const {
    tree = tree_[__builtin_ctz(rays)];
    std::uint32_t same = 0;
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
      if (tree_[i] == tree) same |= 1u << i;
    }
    return same;
  }

  /// Of `rays`, those that meet a triangle; `closest(i)` keeps the hit of ray i.
  template <class ClosestOf>
  HWY_INLINE std::uint32_t meet(const MeshView& mesh, std::uint32_t instance,
                                std::uint32_t triangle, std::uint32_t rays,
                                const ClosestOf& closest) const {
    std::uint32_t found = 0;
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(rays));
      if (test_moving_triangle(mesh, ray_[i], place_[i], self_[i], instance, triangle,
                               closest(i))) {
        found |= 1u << i;
      }
    }
    return found;
  }

 private:
  LocalRay ray_[kBundle];
  SetPlace place_[kBundle];
  const TimeTree* tree_[kBundle];
  std::uint32_t self_[kBundle];
};

/// Where a child of such a tree lies in memory.
HWY_INLINE const void* moving_child(const TimeTree& tree, std::uint32_t child) {
  if (child & Waiting::kLeaf) return tree.leaf2triangle + (child & ~Waiting::kLeaf);
  return tree.tree.nodes + child;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
