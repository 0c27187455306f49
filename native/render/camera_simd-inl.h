// start_ray (one_ray.h) for many samples, a lane a sample, to the bit; see lanes-inl.h.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// sample_filter (core/filter.h) for one coordinate.
HWY_INLINE Float sample_filter_lanes(const FilterView& filter, Float u) {
  const Float s = (f32(2.0f) * u - f32(1.0f)) + f32(5.9604644775390625e-8f);
  const Float radius = f32(filter.radius);
  if (filter.cells == 0) return radius * s;
  const Float target = hn::Abs(s);
  const auto gather = [](const float* table, Int i)
                          HWY_ATTR { return hn::GatherIndex(TagF(), table, i); };
  Int first = hn::Zero(TagI());
  for (std::uint32_t count = filter.cells; count > 1;) {
    const std::uint32_t half = count / 2;
    const Int middle = hn::Add(first, hn::Set(TagI(), static_cast<std::int32_t>(half)));
    const auto below = hn::RebindMask(TagI(), hn::Le(gather(filter.cdf, middle), target));
    first = hn::IfThenElse(below, middle, first);
    count -= half;
  }
  const Int next = hn::Add(first, hn::Set(TagI(), 1));
  const Float begin = gather(filter.cdf, first);
  const Float mass = gather(filter.cdf, next) - begin;
  const Float rest = target - begin;
  const Float inside = hn::IfThenElse(hn::Gt(mass, rest), rest / mass, f32(kOneMinusEpsilon));
  const Float t =
      sample_linear_lanes(inside, gather(filter.density, first), gather(filter.density, next));
  const Float x =
      radius * ((hn::ConvertTo(TagF(), first) + t) / f32(static_cast<float>(filter.cells)));
  return hn::IfThenElse(hn::Lt(s, f32(0.0f)), hn::Neg(x), x);
}

struct PointLanes {
  Float x, y;
};

/// aperture_point (core/lens.h).
HWY_INLINE PointLanes aperture_point_lanes(const ApertureView& aperture, Float ux, Float uy) {
  if (aperture.blades == 0) {
    const Vec3Lanes lifted = cosine_hemisphere_disk_lanes(ux, uy);
    return {lifted.x, lifted.y};
  }
  const float blades = static_cast<float>(aperture.blades);
  const Float count = f32(blades), last = f32(blades - 1.0f);
  const Float place = ux * count;
  Float side = hn::ConvertTo(TagF(), hn::ConvertTo(TagI(), place));
  side = hn::IfThenElse(hn::Gt(side, last), last, side);
  const Float r = hn::Sqrt(place - side);
  const Float x = r * f32(aperture.cos_half);
  const Float y = r * ((f32(2.0f) * uy - f32(1.0f)) * f32(aperture.sin_half));
  const SinCosLanes turn = sin_cos_turns_lanes(f32(aperture.rotation) + side / count);
  return {turn.cos * x - turn.sin * y, turn.sin * x + turn.cos * y};
}

HWY_INLINE Vec3dLanes spread(const double* v) {
  return {f64(v[0]), f64(v[1]), f64(v[2])};
}

HWY_INLINE void store(Float v, float* to) {
  hn::StoreU(v, TagF(), to);
}

HWY_INLINE Double length_of(const Vec3dLanes& v) {
  return hn::Sqrt(dot(v, v));
}

/// detail::lens_ray (core/camera.h) without stereo: moves `eye` to the lens and on to the near
/// clip, and bends `along`, which becomes a unit vector.
HWY_INLINE void bend(const CameraView& camera, const PairSampler& lens, Uint sample,
                     Vec3dLanes& eye, Vec3dLanes& along) {
  Uint u, v;
  lens.bits(sample, u, v);
  const PointLanes p =
      aperture_point_lanes(camera.aperture, to_unit_float_lanes(u), to_unit_float_lanes(v));
  const Vec3dLanes on_lens = sum(scaled(to_double(p.x), spread(&camera.lens_x.x)),
                                 scaled(to_double(p.y), spread(&camera.lens_y.x)));
  const Double length = length_of(along);
  const Vec3dLanes bent = difference(along, scaled(f64(camera.inverse_focus), on_lens));
  const Double bent_length = length_of(bent);
  along = {bent.x / bent_length, bent.y / bent_length, bent.z / bent_length};
  const bool orthographic = camera.kind == CameraKind::kOrthographic;
  const Double reach = f64(camera.clip_start) * (orthographic ? bent_length : length);
  eye = sum(sum(eye, on_lens), scaled(reach, along));
}

/// Where samples [i, i + lanes) of a block lie on the film; writes their times.
struct FilmPoints {
  HWY_INLINE FilmPoints(const RenderContext& context, const CameraBlock& block, std::size_t i)
      : seed(hn::LoadU(TagU(), block.pixel_seed + i)), sample(hn::LoadU(TagU(), block.sample + i)) {
    const PairSampler pixel(seed, dimension_hash(kDimensionPixel));
    const PairSampler shutter(seed, dimension_hash(kDimensionTime));
    Uint u, v, time, unused;
    pixel.bits(sample, u, v);
    shutter.bits(sample, time, unused);
    const Float half = f32(0.5f);
    x = (to_float(hn::LoadU(TagU(), block.x + i)) + half) +
        sample_filter_lanes(context.filter, to_unit_float_lanes(u));
    y = (to_float(hn::LoadU(TagU(), block.y + i)) + half) +
        sample_filter_lanes(context.filter, to_unit_float_lanes(v));
    store(to_unit_float_lanes(time), block.time + i);
  }
  HWY_INLINE PairSampler lens() const { return PairSampler(seed, dimension_hash(kDimensionLens)); }
  Uint seed, sample;
  Float x, y;
};

void start_rays(const RenderContext& context, const CameraBlock& block) {
  const CameraView& camera = context.camera;
  const Vec3dLanes origin = spread(&camera.origin.x), direction = spread(&camera.direction.x);
  const Vec3dLanes per_x = spread(&camera.per_x.x), per_y = spread(&camera.per_y.x);
  const bool orthographic = camera.kind == CameraKind::kOrthographic;
  for (std::size_t i = 0; i < block.count; i += hn::Lanes(TagU())) {
    const FilmPoints film(context, block, i);
    const Double x = to_double(film.x) - f64(camera.film_center_x);
    const Double y = to_double(film.y) - f64(camera.film_center_y);
    const Vec3dLanes shift = sum(scaled(x, per_x), scaled(y, per_y));
    Vec3dLanes eye = orthographic ? sum(origin, shift) : origin;
    Vec3dLanes along = orthographic ? direction : sum(direction, shift);
    const Double length = length_of(along);
    if (camera.has_lens) {
      bend(camera, film.lens(), film.sample, eye, along);
    } else {
      eye = sum(eye, scaled(f64(camera.clip_start), along));
      along = {along.x / length, along.y / length, along.z / length};
    }
    store(to_float(eye.x), block.origin[0] + i);
    store(to_float(eye.y), block.origin[1] + i);
    store(to_float(eye.z), block.origin[2] + i);
    store(to_float(along.x), block.direction[0] + i);
    store(to_float(along.y), block.direction[1] + i);
    store(to_float(along.z), block.direction[2] + i);
    store(to_float(f64(camera.clip_end - camera.clip_start) * length), block.t_max + i);
  }
}

void draw_points(const RenderContext& context, const CameraBlock& block) {
  for (std::size_t i = 0; i < block.count; i += hn::Lanes(TagU())) {
    const FilmPoints film(context, block, i);
    store(film.x, block.origin[0] + i);
    store(film.y, block.origin[1] + i);
    Uint u, v;
    film.lens().bits(film.sample, u, v);
    store(to_unit_float_lanes(u), block.direction[0] + i);
    store(to_unit_float_lanes(v), block.direction[1] + i);
  }
}

}  // namespace

extern const CameraKernel kCameraKernel;
constexpr CameraKernel kCameraKernel = {&start_rays, &draw_points};

}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
