#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "core/hit_filter.h"
#include "core/path_key.h"

namespace komorebi::testing {

/// A filter that lets a share of all hits through, by lot: of all that a filter may read.
class Lottery {
 public:
  explicit Lottery(double accepted_share) : share_(accepted_share) {}
  Lottery(const Lottery&) = delete;

  HitFilter filter() const { return {this, &accepts}; }
  std::uint64_t asked() const { return asked_; }

  bool accepted(const HitQuery& query) const {
    const Hit& hit = query.hit;
    std::uint32_t hash = hash_combine(query.ray.path_key, hit.instance);
    const auto place = [](float x) { return static_cast<std::uint32_t>(std::floor(x * 64.0f)); };
    for (const std::uint32_t part :
         {hit.primitive, place(hit.u), place(hit.v), std::bit_cast<std::uint32_t>(query.ray.time),
          std::bit_cast<std::uint32_t>(query.ray.direction.x),
          std::bit_cast<std::uint32_t>(query.ray.direction.y),
          std::bit_cast<std::uint32_t>(query.ray.origin.z), query.ray.self_primitive}) {
      hash = hash_combine(hash, part);
    }
    return static_cast<double>(hash) < share_ * 4294967296.0;
  }

 private:
  static void accepts(const void* user, const HitQuery* queries, std::uint32_t count,
                      bool* accepted) {
    const auto* self = static_cast<const Lottery*>(user);
    for (std::uint32_t i = 0; i < count; ++i) accepted[i] = self->accepted(queries[i]);
    self->asked_.fetch_add(count, std::memory_order_relaxed);
  }

  double share_;
  mutable std::atomic<std::uint64_t> asked_{0};
};

/// One that refuses everything and keeps what it was asked: all that a ray meets.
class Collector {
 public:
  HitFilter filter() const { return {this, &accepts}; }
  std::vector<HitQuery> take() { return std::exchange(queries_, {}); }

 private:
  static void accepts(const void* user, const HitQuery* queries, std::uint32_t count,
                      bool* accepted) {
    const auto* self = static_cast<const Collector*>(user);
    self->queries_.insert(self->queries_.end(), queries, queries + count);
    std::fill_n(accepted, count, false);
  }
  mutable std::vector<HitQuery> queries_;
};

}  // namespace komorebi::testing
