#pragma once

#include "bench/ray_sets.h"
#include "bvh/traverse.h"

namespace komorebi::bench {

/// What our tracer answers to a set of rays. Chunks need not be whole words of bits, so each chunk
/// has words of its own.
class Answers {
 public:
  Answers(const RaySet& set, bool closest) {
    for (std::uint32_t k = 0; k < set.chunk_count(); ++k) {
      first_.push_back(words_.size());
      words_.resize(words_.size() + (set.end_ray(k) - set.first_ray(k) + 31) / 32);
    }
    a_chunk_ = set.end_ray(0);
    if (closest) hits_.resize(set.list.size());
  }

  std::uint32_t* bits(std::uint32_t chunk) { return words_.data() + first_[chunk]; }
  Hit* hits(std::uint32_t first_ray) { return hits_.data() + first_ray; }

  bool met(std::uint32_t ray) const {
    if (!hits_.empty()) return hits_[ray].valid();
    const std::uint32_t bit = ray % a_chunk_;
    return (words_[first_[ray / a_chunk_] + bit / 32] >> (bit % 32)) & 1u;
  }

 private:
  std::vector<std::uint32_t> words_;
  std::vector<Hit> hits_;
  std::vector<std::size_t> first_;
  std::uint32_t a_chunk_ = 1;
};

}  // namespace komorebi::bench
