#pragma once

#include <vector>

#include "core/ray.h"

namespace komorebi {

/// Owns the arrays behind a RaySpan; grows once and is then reused from batch to batch.
class RayBatch {
 public:
  void clear() { count_ = 0; }
  std::uint32_t size() const { return count_; }

  void reserve(std::size_t n) {
    for (auto& column : floats_) column.resize(n);
    for (auto& column : words_) column.resize(n);
  }

  void push(const Ray& ray) {
    if (count_ == floats_[0].size())
      reserve(count_ < 64 ? 64 : 2 * static_cast<std::size_t>(count_));
    const float f[9] = {ray.origin.x,    ray.origin.y,    ray.origin.z,
                        ray.direction.x, ray.direction.y, ray.direction.z,
                        ray.t_min,       ray.t_max,       ray.time};
    for (std::size_t c = 0; c < 9; ++c) floats_[c][count_] = f[c];
    words_[0][count_] = ray.mask;
    words_[1][count_] = ray.self_instance;
    words_[2][count_] = ray.self_primitive;
    words_[3][count_] = ray.path_key;
    ++count_;
  }

  /// Makes room for `count` rays that are then written into the columns: nine of floats (origin,
  /// direction, t_min, t_max, time) and four of words (mask, self_instance, self_primitive,
  /// path_key). The columns are `padding` longer.
  void resize(std::uint32_t count, std::uint32_t padding) {
    if (floats_[0].size() < count + padding) reserve(std::size_t{count} + padding);
    count_ = count;
  }
  float* floats(std::size_t column) { return floats_[column].data(); }
  std::uint32_t* words(std::size_t column) { return words_[column].data(); }

  RaySpan span() const {
    return {floats_[0].data(),
            floats_[1].data(),
            floats_[2].data(),
            floats_[3].data(),
            floats_[4].data(),
            floats_[5].data(),
            floats_[6].data(),
            floats_[7].data(),
            floats_[8].data(),
            words_[0].data(),
            words_[1].data(),
            words_[2].data(),
            count_,
            words_[3].data()};
  }

 private:
  std::vector<float> floats_[9];         // origin xyz, direction xyz, t_min, t_max, time
  std::vector<std::uint32_t> words_[4];  // mask, self_instance, self_primitive, path_key
  std::uint32_t count_ = 0;
};

}  // namespace komorebi
