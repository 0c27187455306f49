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

/// Calls sample(shared, first point, bits x, bits y, where the result goes) for all rays of all
/// points; `prepare` works out what the rays of points share.
template <class Prepare, class Sample>
HWY_INLINE void for_each_ray(const RenderContext& context, const LightBlock& block,
                             const Prepare& prepare, const Sample& sample) {
  const TagU du;
  const std::uint32_t light_hash = dimension_hash(context.light_dimension);
  for (std::size_t p = 0; p < block.point_count; p += hn::Lanes(du)) {
    const PairSampler sampler(hn::LoadU(du, block.pixel_seed + p), light_hash);
    const Uint first = hn::LoadU(du, block.first_index + p);
    const auto shared = prepare(p);
    for (std::uint32_t j = 0; j < block.rays_per_point; ++j) {
      Uint x, y;
      sampler.bits(hn::Add(first, u32(j)), x, y);
      sample(shared, p, x, y, std::size_t{j} * block.stride + p);
    }
  }
}

void ambient(const RenderContext& context, const LightBlock& block) {
  for_each_ray(
      context, block, [&](std::size_t p) HWY_ATTR { return FrameLanes(load(block.normal, p)); },
      [&](const FrameLanes& frame, std::size_t p, Uint x, Uint y, std::size_t to) HWY_ATTR {
        const Vec3Lanes direction = frame.to_world(
            cosine_hemisphere_disk_lanes(to_unit_float_lanes(x), to_unit_float_lanes(y)));
        const auto above = hn::Gt(dot(direction, load(block.geometric_normal, p)), f32(0.0f));
        const Float weight = hn::IfThenElseZero(above, f32(1.0f));
        store(direction, block.direction, to);
        store({weight, weight, weight}, block.contribution, to);
      });
}

/// Under a sky that is the same everywhere: what the cosine and its density leave of each other is
/// exactly 1 wherever the density is above 0.
void even(const RenderContext& context, const LightBlock& block) {
  const Vec3 light = context.albedo * context.sky.constant;
  for_each_ray(
      context, block, [&](std::size_t p) HWY_ATTR { return FrameLanes(load(block.normal, p)); },
      [&](const FrameLanes& frame, std::size_t p, Uint x, Uint y, std::size_t to) HWY_ATTR {
        const Float zero = f32(0.0f);
        const Vec3Lanes direction = frame.to_world(
            cosine_hemisphere_disk_lanes(to_unit_float_lanes(x), to_unit_float_lanes(y)));
        const Float cosine = dot(direction, load(block.normal, p));
        const auto lit = hn::And(hn::And(hn::Gt(cosine, zero), hn::Gt(cosine * f32(kInvPi), zero)),
                                 hn::Gt(dot(direction, load(block.geometric_normal, p)), zero));
        store(direction, block.direction, to);
        store({hn::IfThenElseZero(lit, f32(light.x)), hn::IfThenElseZero(lit, f32(light.y)),
               hn::IfThenElseZero(lit, f32(light.z))},
              block.contribution, to);
      });
}

void product(const RenderContext& context, const LightBlock& block) {
  const ProductView& product = context.product;
  const float* const m = entries(context.sky.texture_from_world);
  const float albedo[3] = {context.albedo.x, context.albedo.y, context.albedo.z};
  ProductSteps steps(context.sky, product);
  std::size_t points[ProductSteps::kMost], places[ProductSteps::kMost];
  const auto finish = [&]() HWY_ATTR {
    steps.choose();
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const Vec3Lanes normal = load(block.normal, points[i]);
      const EnvironmentSampleLanes s = steps.sample(i);
      const Float zero = f32(0.0f);
      const Float cosine = dot(s.direction, normal);
      const auto lit =
          hn::And(hn::And(hn::Gt(cosine, zero), hn::Gt(s.pdf, zero)),
                  hn::Gt(dot(s.direction, load(block.geometric_normal, points[i])), zero));
      const Float weight = f32(kInvPi) * cosine / s.pdf;
      store(s.direction, block.direction, places[i]);
      store({hn::IfThenElseZero(lit, f32(albedo[0]) * s.radiance.x * weight),
             hn::IfThenElseZero(lit, f32(albedo[1]) * s.radiance.y * weight),
             hn::IfThenElseZero(lit, f32(albedo[2]) * s.radiance.z * weight)},
            block.contribution, places[i]);
    }
    steps.begin();
  };
  for_each_ray(
      context, block,
      [&](std::size_t p) HWY_ATTR {
        return product_bin_lanes(product, times(m, load(block.normal, p)), load(block.origin, p));
      },
      [&](Uint bin, std::size_t p, Uint x, Uint y, std::size_t to) HWY_ATTR {
        points[steps.size()] = p;
        places[steps.size()] = to;
        steps.push(bin, x, y);
        if (steps.size() == ProductSteps::kMost) finish();
      });
  finish();
}

}  // namespace

extern const LightKernel kLightKernel;
constexpr LightKernel kLightKernel = {&ambient, &even, &product};

}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
