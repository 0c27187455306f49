#pragma once

#include "bvh/closest.h"
#include "bvh/time_parts.h"
#include "core/round_leaf.h"

namespace komorebi {

/// Tests one item of a set of curves (CurveItem) or points and keeps the hit if it is the better
/// one; true if anything was hit. A ray that leaves a curve meets none of its segments, as in
/// Cycles: on a bent ribbon a point's neighbours would shadow it at random.
/// @param self   the primitive of this instance that the ray leaves, or kNone
/// @param entry  of a curve's segment2key
bool test_round_item(const MeshView& mesh, const RoundRay& ray, std::uint32_t self,
                     std::uint32_t instance, std::uint32_t item, std::uint32_t entry,
                     Closest* closest);

/// The same without a leaf.
inline bool test_round_item(const MeshView& mesh, const RoundRay& ray, std::uint32_t self,
                            std::uint32_t instance, std::uint32_t item, Closest* closest) {
  const bool is_curve = mesh.kind == PrimitiveKind::kCurve;
  const std::uint32_t entry = is_curve ? mesh.segment2key[item / mesh.segment_parts] : 0;
  return test_round_item(mesh, ray, self, instance, item, entry, closest);
}

/// The same with a leaf of the tree.
inline bool test_round_leaf(const MeshView& mesh, const RoundRay& ray, std::uint32_t self,
                            std::uint32_t instance, const RoundLeaf& leaf, Closest* closest) {
  if (misses_leaf(mesh.leaf_grid, leaf, ray)) return false;
  return test_round_item(mesh, ray, self, instance, leaf.item, leaf.entry, closest);
}

/// The tree of a time.
inline TimeTree round_tree_at(const MeshView& mesh, float time) {
  if (mesh.position_sets == 1) return {mesh.tree, nullptr, mesh.leaves};
  return tree_at(mesh, time);
}

}  // namespace komorebi
