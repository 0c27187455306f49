#include "shader/fractal_noise.h"

#include "shader/lane.h"
#include "shader/program.h"

namespace komorebi {
namespace {

using Row = float[Program::kLanes];

constexpr float kMostDetail = 15.0f;

/// What is known of all points between two octaves.
struct Octaves {
  Octaves(const FractalKind& kind, const FractalRows& rows, std::uint32_t n)
      : kind_(kind), rows_(rows), count(n) {
    const bool has_first =
        kind.type == FractalType::kRidged || kind.type == FractalType::kHeteroTerrain;
    for (std::uint32_t i = 0; i < count; ++i) {
      const float detail = clamp(rows.detail[i], 0.0f, kMostDetail);
      const float below = static_cast<float>(floor_lane(detail));
      const float octaves = kind.counts_first ? below : below + 1.0f;
      whole[i] = has_first ? larger(octaves, 1.0f) : octaves;
      rest[i] = kind.type == FractalType::kRidged ? 0.0f : detail - below;
      roughness[i] = larger(rows.roughness[i], 0.0f);
      amplitude[i] = has_first ? roughness[i] : 1.0f;
      scale[i] = 1.0f;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      end_ = larger(end_, rest[i] > 0.0f ? whole[i] + 1.0f : whole[i]);
    }
  }

  /// Works out the noise of the next octave; false when no point has one.
  bool next() {
    octave += 1.0f;
    if (octave >= end_) return false;
    const float* columns[4];
    for (std::uint32_t d = 0; d < kind_.dimensions; ++d) {
      const float* const p = rows_.p[d];
      float* const q = at_[d];
      if (kind_.type == FractalType::kFbm && !kind_.counts_first) {
        for (std::uint32_t i = 0; i < count; ++i) q[i] = scale[i] * p[i];
      } else if (octave == 0.0f) {
        for (std::uint32_t i = 0; i < count; ++i) q[i] = p[i];
      } else {
        for (std::uint32_t i = 0; i < count; ++i) q[i] *= rows_.lacunarity[i];
      }
      columns[d] = q;
    }
    for (std::uint32_t i = 0; i < count; ++i) scale[i] *= rows_.lacunarity[i];
    perlin_rows(kind_.dimensions, columns, count, kind_.repeat, noise);
    return true;
  }

  /// How much of this octave point i takes: all, what is left of its detail, or nothing.
  KOMOREBI_LANE float share(std::uint32_t i) const {
    return octave < whole[i] ? 1.0f : (octave == whole[i] ? rest[i] : 0.0f);
  }

  const FractalKind& kind_;
  const FractalRows& rows_;
  std::uint32_t count;
  float octave = -1.0f;
  Row whole, rest, roughness, amplitude, scale, noise;

 private:
  float end_ = 0.0f;
  Row at_[4];
};

void fbm(Octaves& o, bool normalize, float* out) {
  Row sum, most, sum_after, most_after;
  for (std::uint32_t i = 0; i < o.count; ++i) {
    sum[i] = most[i] = sum_after[i] = most_after[i] = 0.0f;
  }
  while (o.next()) {
    for (std::uint32_t i = 0; i < o.count; ++i) {
      const bool all = o.octave < o.whole[i], last = o.octave == o.whole[i];
      const float with = sum[i] + o.noise[i] * o.amplitude[i], most_with = most[i] + o.amplitude[i];
      sum_after[i] = last ? with : sum_after[i];
      most_after[i] = last ? most_with : most_after[i];
      sum[i] = all ? with : sum[i];
      most[i] = all ? most_with : most[i];
      o.amplitude[i] *= o.roughness[i];
    }
  }
  for (std::uint32_t i = 0; i < o.count; ++i) {
    float low = sum[i], high = sum_after[i];
    if (normalize) {
      low = 0.5f * low / most[i] + 0.5f;
      high = 0.5f * high / most_after[i] + 0.5f;
    }
    out[i] = o.rest[i] > 0.0f ? mix(low, high, o.rest[i]) : low;
  }
}

void multifractal(Octaves& o, float* out) {
  for (std::uint32_t i = 0; i < o.count; ++i) out[i] = 1.0f;
  while (o.next()) {
    for (std::uint32_t i = 0; i < o.count; ++i) {
      out[i] *= o.share(i) * o.amplitude[i] * o.noise[i] + 1.0f;
      o.amplitude[i] *= o.roughness[i];
    }
  }
}

void hetero_terrain(Octaves& o, const float* offset, float* out) {
  o.next();
  for (std::uint32_t i = 0; i < o.count; ++i) out[i] = offset[i] + o.noise[i];
  while (o.next()) {
    for (std::uint32_t i = 0; i < o.count; ++i) {
      out[i] += o.share(i) * ((o.noise[i] + offset[i]) * o.amplitude[i] * out[i]);
      o.amplitude[i] *= o.roughness[i];
    }
  }
}

void hybrid(Octaves& o, const float* offset, const float* gain, float* out) {
  Row weight;
  for (std::uint32_t i = 0; i < o.count; ++i) {
    out[i] = 0.0f;
    weight[i] = 1.0f;
  }
  while (o.next()) {
    for (std::uint32_t i = 0; i < o.count; ++i) {
      const bool counts = weight[i] > 0.001f;
      const float now = counts ? smaller(weight[i], 1.0f) : 0.0f;
      const float signal = (o.noise[i] + offset[i]) * o.amplitude[i];
      out[i] += o.share(i) * (now * signal);
      weight[i] = now * (gain[i] * signal);
      o.amplitude[i] *= o.roughness[i];
    }
  }
}

void ridged(Octaves& o, const float* offset, const float* gain, float* out) {
  Row signal;
  o.next();
  for (std::uint32_t i = 0; i < o.count; ++i) {
    const float ridge = offset[i] - absolute(o.noise[i]);
    out[i] = signal[i] = ridge * ridge;
  }
  while (o.next()) {
    for (std::uint32_t i = 0; i < o.count; ++i) {
      const float ridge = offset[i] - absolute(o.noise[i]);
      signal[i] = ridge * ridge * clamp01(signal[i] * gain[i]);
      out[i] += o.share(i) * (signal[i] * o.amplitude[i]);
      o.amplitude[i] *= o.roughness[i];
    }
  }
}

}  // namespace

void fractal_noise(const FractalKind& kind, const FractalRows& rows, std::uint32_t count,
                   float* out) {
  Octaves octaves(kind, rows, count);
  switch (kind.type) {
    case FractalType::kMultifractal:
      return multifractal(octaves, out);
    case FractalType::kRidged:
      return ridged(octaves, rows.offset, rows.gain, out);
    case FractalType::kHybrid:
      return hybrid(octaves, rows.offset, rows.gain, out);
    case FractalType::kHeteroTerrain:
      return hetero_terrain(octaves, rows.offset, out);
    case FractalType::kFbm:
      break;
  }
  fbm(octaves, kind.normalize, out);
}

}  // namespace komorebi
