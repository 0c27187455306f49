#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/environment.h"
#include "render/product_table.h"

namespace komorebi {

/// An equirectangular map with its sampling tables; immutable, to be shared and counted. The tables
/// belong to the texels alone: strength and rotation are set per view.
class Environment {
 public:
  /// `texels` is [height][width][3], linear Rec. 709 radiance, row 0 at the bottom; moved in.
  /// A texel with a non-finite channel becomes black, as in Cycles; a negative channel becomes 0;
  /// both are counted. std::invalid_argument, naming `name`, when sizes do not fit.
  Environment(std::string name, std::uint32_t width, std::uint32_t height,
              std::vector<float> texels);

  /// Valid while the environment lives. `texture_from_world` must be a rotation (or a reflection):
  /// std::invalid_argument otherwise, or when `strength` is negative or not finite.
  EnvironmentView view(double strength = 1.0, const Mat3d& texture_from_world = Mat3d(1.0)) const;

  /// The tables of product importance sampling, made at the first call. Not for a black map. Safe
  /// from any thread.
  const ProductTable& product_table() const;

  /// ∫ (red + green + blue) / 3 over all directions, by solid angle, at strength 1: what Cycles
  /// normalises its importance map by. Worked out at the first call. Safe from any thread.
  double mean_flux() const;

  const std::string& name() const { return name_; }
  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  std::uint64_t nonfinite_texels() const { return nonfinite_texels_; }
  std::uint64_t negative_texels() const { return negative_texels_; }
  const std::vector<float>& texels() const { return texels_; }
  float max_radiance() const { return max_radiance_; }  ///< of any channel of any texel
  std::size_t byte_count() const;
  bool black() const { return row_cdf_.empty(); }  ///< no texel shines: no tables, constant 0

 private:
  void clean_texels();
  void build_tables();

  std::string name_;
  std::uint32_t width_, height_;
  std::vector<float> texels_;
  std::vector<std::uint32_t> row_cdf_, column_cdf_;
  std::vector<double> row_z_;
  mutable std::once_flag product_once_, flux_once_;
  mutable std::unique_ptr<const ProductTable> product_table_;
  mutable double mean_flux_ = 0.0;
  float max_radiance_ = 0.0f;
  std::uint64_t nonfinite_texels_ = 0, negative_texels_ = 0;
};

/// The same radiance from everywhere; the caller has multiplied the strength in.
EnvironmentView constant_environment(const Vec3& radiance);

}  // namespace komorebi
