#pragma once

#include <algorithm>
#include <vector>

#include "core/aabb.h"
#include "core/motion.h"
#include "core/scene_view.h"

namespace komorebi {

/// One of some even parts of the shutter's time, which a tree stands for, of something of which
/// there are positions in sets at even times.
struct TimePart {
  /// Both its ends and the sets between: what is linear between sets has its extremes there.
  std::vector<MotionPlace> times;
  std::uint32_t first_set = 0, last_set = 0;  ///< of those that positions in it are made of
};

inline TimePart time_part(std::uint32_t sets, std::uint32_t k, std::uint32_t parts) {
  const std::uint32_t last = sets - 1;
  TimePart part;
  part.first_set = k * last / parts;
  part.last_set = ((k + 1) * last + parts - 1) / parts;
  part.times.push_back(motion_place(sets, double(k) / parts));
  for (std::uint32_t set = part.first_set; set <= part.last_set; ++set) {
    if (set * parts <= k * last || set * parts >= (k + 1) * last) continue;
    part.times.push_back({set, 0.0});  // never the last set
  }
  part.times.push_back(motion_place(sets, double(k + 1) / parts));
  return part;
}

/// As many parts (1, 2, 4 … 16) as it takes for boxes over a part of the time to have on average no
/// more than twice the area of those at one time.
/// @param box  box(i, part) holds primitive i of `count` all over a part
/// @param own  own(i, place) is its box at a time
template <class Box, class Own>
std::uint32_t count_time_parts(std::size_t count, std::uint32_t sets, const Box& box,
                               const Own& own) {
  constexpr std::uint32_t kMostParts = 16;
  constexpr double kWorthGrowth = 2.0;
  constexpr std::size_t kSampled = 1 << 13;
  const std::size_t step = count / kSampled + 1;
  std::uint32_t parts = 1;
  for (; parts < kMostParts; parts *= 2) {
    double swept = 0.0, alone = 0.0;
    for (std::uint32_t k = 0; k < parts; ++k) {
      const TimePart part = time_part(sets, k, parts);
      for (std::size_t i = 0; i < count; i += step) {
        swept += double(half_area(box(i, part)));
        alone += double(half_area(own(i, part.times.front())));
      }
    }
    if (!(alone > 0.0 && swept > kWorthGrowth * alone)) break;
  }
  return parts;
}

/// Of something that deforms, the tree of a ray's time.
inline const TimeTree& tree_at(const MeshView& mesh, float time) {
  const MotionPlace place = motion_place(mesh.time_tree_count + 1, static_cast<double>(time));
  return mesh.time_trees[place.step];
}

}  // namespace komorebi
