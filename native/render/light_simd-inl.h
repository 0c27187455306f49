// sample_light (light.h) for many points, a lane a point, to the bit; see lanes-inl.h.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

HWY_INLINE Vec3Lanes load(const float* const (&columns)[3], std::size_t i) {
  const TagF d;
  return {hn::LoadU(d, columns[0] + i), hn::LoadU(d, columns[1] + i), hn::LoadU(d, columns[2] + i)};
}

HWY_INLINE void store(const Vec3Lanes& v, float* const (&columns)[3], std::size_t i) {
  const TagF d;
  hn::StoreU(v.x, d, columns[0] + i);
  hn::StoreU(v.y, d, columns[1] + i);
  hn::StoreU(v.z, d, columns[2] + i);
}

/// Calls sample(normal, geometric normal, bits x, bits y, where the result goes) for all rays of
/// all points; `prepare` works out what the rays of a point share from its normal.
template <class Prepare, class Sample>
HWY_INLINE void for_each_ray(const LightBlock& block, const Prepare& prepare,
                             const Sample& sample) {
  const TagU du;
  const std::uint32_t light_hash =
      dimension_hash(static_cast<std::uint32_t>(kDimensionVertex) +
                     static_cast<std::uint32_t>(kVertexLightDirection));
  for (std::size_t p = 0; p < block.point_count; p += hn::Lanes(du)) {
    const Vec3Lanes normal = load(block.normal, p);
    const Vec3Lanes geometric = load(block.geometric_normal, p);
    const PairSampler sampler(hn::LoadU(du, block.pixel_seed + p), light_hash);
    const Uint first = hn::LoadU(du, block.first_index + p);
    const auto shared = prepare(normal);
    for (std::uint32_t j = 0; j < block.rays_per_point; ++j) {
      Uint x, y;
      sampler.bits(hn::Add(first, u32(j)), x, y);
      sample(shared, normal, geometric, x, y, std::size_t{j} * block.stride + p);
    }
  }
}

void ambient(const RenderContext&, const LightBlock& block) {
  for_each_ray(
      block, [](const Vec3Lanes& normal) HWY_ATTR { return FrameLanes(normal); },
      [&](const FrameLanes& frame, const Vec3Lanes&, const Vec3Lanes& geometric, Uint x, Uint y,
          std::size_t to) HWY_ATTR {
        const Vec3Lanes direction = frame.to_world(
            cosine_hemisphere_disk_lanes(to_unit_float_lanes(x), to_unit_float_lanes(y)));
        const auto above = hn::Gt(dot(direction, geometric), f32(0.0f));
        const Float weight = hn::IfThenElseZero(above, f32(1.0f));
        store(direction, block.direction, to);
        store({weight, weight, weight}, block.contribution, to);
      });
}

void product(const RenderContext& context, const LightBlock& block) {
  const EnvironmentView& e = context.environment;
  const ProductView& p = context.product;
  const float* const m = entries(e.texture_from_world);
  const float albedo[3] = {context.albedo.x, context.albedo.y, context.albedo.z};
  for_each_ray(
      block,
      [&](const Vec3Lanes& normal)
          HWY_ATTR { return octahedral_cell_lanes(times(m, normal), p.bins); },
      [&](Uint bin, const Vec3Lanes& normal, const Vec3Lanes& geometric, Uint x, Uint y,
          std::size_t to) HWY_ATTR {
        const EnvironmentSampleLanes s = sample_product_lanes(e, p, bin, x, y);
        const Float zero = f32(0.0f);
        const Float cosine = dot(s.direction, normal);
        const auto lit = hn::And(hn::And(hn::Gt(cosine, zero), hn::Gt(s.pdf, zero)),
                                 hn::Gt(dot(s.direction, geometric), zero));
        const Float weight = f32(kInvPi) * cosine / s.pdf;
        store(s.direction, block.direction, to);
        store({hn::IfThenElseZero(lit, f32(albedo[0]) * s.radiance.x * weight),
               hn::IfThenElseZero(lit, f32(albedo[1]) * s.radiance.y * weight),
               hn::IfThenElseZero(lit, f32(albedo[2]) * s.radiance.z * weight)},
              block.contribution, to);
      });
}

}  // namespace

extern const LightKernel kLightKernel;
constexpr LightKernel kLightKernel = {&HWY_STR(HWY_NAMESPACE)[2], &ambient,
                                      &product};  // N_AVX2: "AVX2"

}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
