#pragma once

#include "core/ray.h"

namespace komorebi {

/// A hit on an instance of which some of the surface is see-through, and the ray that meets it.
struct HitQuery {
  Hit hit;
  Ray ray;
};

/// Which hits count in a scene with cut-outs. Asked of instances that are `filtered` alone, and
/// there of opaque parts too.
///
/// The answer is a function of the query, and of nothing else: not of other queries, of their
/// order, or of how often it is asked. It does not read the ray's t_min and t_max, and takes a mask
/// and the same mask among shadow catchers (kMaskCatcherShift) for the same. What is drawn by lot
/// is drawn by the ray's path_key, instance and primitive. So the closest hit is the closest of
/// those that count, whatever tree, bundle or instruction set finds it.
struct HitFilter {
  /// Writes to accepted[i], i < count, whether the hit of queries[i] counts; from many threads at
  /// once.
  using Accepts = void(const void* user, const HitQuery* queries, std::uint32_t count,
                       bool* accepted);

  const void* user = nullptr;
  Accepts* accepts = nullptr;  ///< null: all hits count

  bool exists() const { return accepts != nullptr; }
  bool operator()(const HitQuery& query) const {
    bool accepted;
    accepts(user, &query, 1, &accepted);
    return accepted;
  }
};

}  // namespace komorebi
