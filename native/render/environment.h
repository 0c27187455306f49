#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/environment.h"
#include "io/light_map.h"
#include "parallel/array.h"
#include "parallel/thread_pool.h"
#include "render/product_table.h"

namespace komorebi {

/// An equirectangular map with its sampling tables; immutable, to be shared and counted. The tables
/// belong to the texels alone: strength and rotation are set per view.
class Environment {
 public:
  /// The tables are worked out on the pool, equal for any number of threads. Throws Cancelled.
  Environment(LightMap map, ThreadPool& pool, const Cancel& cancel = Cancel::never());
  /// `texels` is [height][width][3], linear Rec. 709 radiance, row 0 at the bottom, as
  /// LightMap::put takes them. std::invalid_argument, naming `name`, when sizes do not fit.
  Environment(std::string name, std::uint32_t width, std::uint32_t height,
              const std::vector<float>& texels);

  /// Valid while the environment lives. `texture_from_world` must be a rotation (or a reflection):
  /// std::invalid_argument otherwise, or when `strength` is negative or not finite.
  EnvironmentView view(double strength = 1.0, const Mat3d& texture_from_world = Mat3d(1.0)) const;

  /// The tables of product importance sampling, made at the first call. Not for a black map. Safe
  /// from any thread. Throws Cancelled; the next call then makes them.
  const ProductTable& product_table(const Cancel& cancel = Cancel::never()) const;

  /// ∫ (red + green + blue) / 3 over all directions, by solid angle, at strength 1: what Cycles
  /// normalises its importance map by. Worked out at the first call. Safe from any thread. Throws
  /// Cancelled.
  double mean_flux(const Cancel& cancel = Cancel::never()) const;

  const std::string& name() const { return map_.name(); }
  std::uint32_t width() const { return map_.width(); }
  std::uint32_t height() const { return map_.height(); }
  std::uint64_t nonfinite_texels() const { return map_.nonfinite_texels(); }
  std::uint64_t negative_texels() const { return map_.negative_texels(); }
  const LightMap& map() const { return map_; }
  float max_radiance() const { return map_.max_radiance(); }  ///< of any channel of any texel
  std::size_t byte_count() const;
  bool black() const { return row_cdf_.empty(); }  ///< no texel shines: no tables, constant 0

 private:
  EnvironmentView texel_view() const;
  void build_tables(ThreadPool& pool, const Cancel& cancel);

  LightMap map_;
  std::vector<std::uint32_t> row_cdf_;
  Array<std::uint32_t> column_cdf_;
  std::vector<double> row_z_;
  mutable std::once_flag product_once_, flux_once_;
  mutable std::unique_ptr<const ProductTable> product_table_;
  mutable double mean_flux_ = 0.0;
};

/// The same radiance from everywhere; the caller has multiplied the strength in.
EnvironmentView constant_environment(const Vec3& radiance);

}  // namespace komorebi
