#include "shader/voronoi.h"

#include "shader/lane.h"
#include "shader/voronoi_kernel.h"

namespace komorebi {
namespace {

/// Clamped parameters, and coordinates and amplitude of the octave that comes next.
struct Octaves {
  Octaves(const VoronoiKind& kind, const VoronoiRows& given, std::uint32_t n)
      : dimensions(kind.dimensions), count(n), rows_(given), octave_rows(given) {
    for (std::uint32_t i = 0; i < count; ++i) {
      detail[i] = clamp(given.detail[i], 0.0f, 15.0f);
      roughness[i] = clamp01(given.roughness[i]);
      randomness[i] = clamp01(given.randomness[i]);
      // Half of it: as much as rounds off a cell's own neighbours.
      smoothness[i] = clamp(given.smoothness[i] * 0.5f, 0.0f, 0.5f);
      amplitude[i] = scale[i] = 1.0f;
      is_single[i] = detail[i] == 0.0f || roughness[i] == 0.0f ? 1.0f : 0.0f;
      const float below = static_cast<float>(floor_lane(detail[i]));
      rest[i] = detail[i] - below;
      const float octaves = rest[i] > 0.0f ? below + 2.0f : below + 1.0f;
      end = larger(end, is_single[i] != 0.0f ? 1.0f : octaves);
    }
    octave_rows.randomness = randomness;
    octave_rows.smoothness = smoothness;
    for (std::uint32_t d = 0; d < dimensions; ++d) octave_rows.p[d] = at_[d];
  }

  bool next() {
    octave += 1.0f;
    if (octave >= end) return false;
    for (std::uint32_t i = 0; octave > 0.0f && i < count; ++i) {
      scale[i] *= rows_.lacunarity[i];
      amplitude[i] *= roughness[i];
    }
    for (std::uint32_t d = 0; d < dimensions; ++d) {
      for (std::uint32_t i = 0; i < count; ++i) at_[d][i] = rows_.p[d][i] * scale[i];
    }
    return true;
  }

  /// How much of this octave point i takes: all, what is left of its detail, or nothing.
  float share(std::uint32_t i) const {
    if (is_single[i] != 0.0f) return octave == 0.0f ? 1.0f : 0.0f;
    if (octave <= detail[i]) return 1.0f;
    return octave - detail[i] < 1.0f ? rest[i] : 0.0f;
  }

  std::uint32_t dimensions, count;
  float octave = -1.0f, end = 1.0f;
  VoronoiRow detail, roughness, randomness, smoothness, amplitude, scale, is_single, rest;

 private:
  const VoronoiRows& rows_;
  VoronoiRow at_[4];

 public:
  VoronoiRows octave_rows;
};

/// Smooth where it has a width to be smooth over.
void find_smooth(const VoronoiKernel& kernel, const VoronoiKind& kind, const VoronoiRows& rows,
                 std::uint32_t count, VoronoiFound& found) {
  bool any_sharp = false, any_smooth = false;
  for (std::uint32_t i = 0; i < count; ++i) {
    any_sharp = any_sharp || rows.smoothness[i] == 0.0f;
    any_smooth = any_smooth || rows.smoothness[i] != 0.0f;
  }
  const std::uint32_t n = kind.dimensions - 1;
  if (any_smooth) kernel.smooth[n](kind, rows, count, found);
  if (!any_sharp) return;
  VoronoiFound sharp;
  kernel.nearest[n](kind, rows, count, sharp);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (rows.smoothness[i] != 0.0f) continue;
    found.distance[i] = sharp.distance[i];
    for (std::uint32_t k = 0; k < 3; ++k) found.color[k][i] = sharp.color[k][i];
    for (std::uint32_t d = 0; d <= n; ++d) found.position[d][i] = sharp.position[d][i];
  }
}

void find(const VoronoiKind& kind, const VoronoiRows& rows, std::uint32_t count,
          VoronoiFound& found) {
  const VoronoiKernel& kernel = voronoi_kernel();
  const std::uint32_t n = kind.dimensions - 1;
  switch (kind.feature) {
    case VoronoiFeature::kF1:
      return kernel.nearest[n](kind, rows, count, found);
    case VoronoiFeature::kF2:
      return kernel.second[n](kind, rows, count, found);
    case VoronoiFeature::kSmoothF1:
      return find_smooth(kernel, kind, rows, count, found);
  }
}

}  // namespace

void voronoi(const VoronoiKind& kind, const VoronoiRows& rows, std::uint32_t count,
             VoronoiFound& found) {
  Octaves o(kind, rows, count);
  VoronoiFound octave;
  VoronoiRow most;
  const std::uint32_t n = kind.dimensions;
  for (std::uint32_t i = 0; i < count; ++i) {
    most[i] = found.distance[i] = 0.0f;
    for (auto& channel : found.color) channel[i] = 0.0f;
    for (auto& axis : found.position) axis[i] = 0.0f;
  }
  while (o.next()) {
    find(kind, o.octave_rows, count, octave);
    for (std::uint32_t i = 0; i < count; ++i) {
      const float share = o.share(i), amplitude = o.amplitude[i], part = share * amplitude;
      if (share == 0.0f) continue;
      most[i] += part;
      found.distance[i] += part * octave.distance[i];
      for (std::uint32_t k = 0; k < 3; ++k) found.color[k][i] += part * octave.color[k][i];
      for (std::uint32_t d = 0; d < n; ++d) {
        found.position[d][i] = mix(found.position[d][i], octave.position[d][i] / o.scale[i], part);
      }
    }
  }
  const float times = kind.feature == VoronoiFeature::kF2 ? 2.0f : 1.0f;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (kind.normalize) {
      const float side = 0.5f + 0.5f * o.randomness[i];
      found.distance[i] /=
          most[i] * (voronoi_reach(kind.metric, n, side, rows.exponent[i]) * times);
      for (auto& channel : found.color) channel[i] /= most[i];
    }
    for (std::uint32_t d = 0; d < n; ++d) {
      float& place = found.position[d][i];
      place = rows.scale[i] != 0.0f ? place / rows.scale[i] : 0.0f;
    }
  }
}

void voronoi_edge(const VoronoiKind& kind, const VoronoiRows& rows, std::uint32_t count,
                  float* distance) {
  Octaves o(kind, rows, count);
  VoronoiRow octave, most;
  for (std::uint32_t i = 0; i < count; ++i) {
    distance[i] = 8.0f;  // more than any
    most[i] = 0.5f + 0.5f * o.randomness[i];
  }
  while (o.next()) {
    voronoi_kernel().edge[kind.dimensions - 1](kind, o.octave_rows, count, octave);
    for (std::uint32_t i = 0; i < count; ++i) {
      const float share = o.share(i);
      if (share == 0.0f) continue;
      if (o.is_single[i] != 0.0f) {
        distance[i] = octave[i];
        continue;
      }
      const float reach = 0.5f + 0.5f * o.randomness[i];
      const float next_most = mix(most[i], reach / o.scale[i], o.amplitude[i]);
      const float next =
          mix(distance[i], smaller(distance[i], octave[i] / o.scale[i]), o.amplitude[i]);
      if (share == 1.0f) {
        most[i] = next_most;
        distance[i] = next;
      } else {
        most[i] = mix(most[i], next_most, share);
        distance[i] = mix(distance[i], smaller(distance[i], next), share);
      }
    }
  }
  for (std::uint32_t i = 0; kind.normalize && i < count; ++i) distance[i] /= most[i];
}

void voronoi_radius(const VoronoiKind& kind, const VoronoiRows& rows, std::uint32_t count,
                    float* radius) {
  VoronoiRow randomness;
  for (std::uint32_t i = 0; i < count; ++i) randomness[i] = clamp01(rows.randomness[i]);
  VoronoiRows clamped = rows;
  clamped.randomness = randomness;
  voronoi_kernel().radius[kind.dimensions - 1](kind, clamped, count, radius);
}

}  // namespace komorebi
