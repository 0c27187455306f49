// Rays that walk together, made ready for a tree: one array entry a ray. Included once per
// instruction set by traverse_simd.cpp, without a guard.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

inline constexpr std::uint32_t kBundle = 32;  ///< rays walked together; one bit each
using RayTag = hn::ScalableTag<float>;
inline constexpr std::uint32_t kRayLanes = static_cast<std::uint32_t>(hn::MaxLanes(RayTag()));
using RayVec = hn::Vec<RayTag>;
using RayIndexTag = hn::RebindToSigned<RayTag>;

/// Up to kBundle rays, in the world or in an instance.
struct Bundle {
  HWY_ALIGN float o[3][kBundle];
  HWY_ALIGN float d[3][kBundle];
  HWY_ALIGN float t_min[kBundle];
  HWY_ALIGN float t_max[kBundle];
};

/// Their slab rays (core/slab.h). All meet a box's lower planes from `from_lower` and its upper
/// ones from `from_upper`, whether near or far: for a direction of either sign that is where
/// make_slab_ray puts them.
struct BundleSlab {
  HWY_ALIGN float minus_from_lower[3][kBundle];
  HWY_ALIGN float from_upper[3][kBundle];
  HWY_ALIGN float inverse[3][kBundle];      ///< |1 / direction|
  HWY_ALIGN std::int32_t side[3][kBundle];  ///< of a box met first: 0 lower, 1 upper
  HWY_ALIGN float begin[kBundle];           ///< of the part of the ray that matters
  HWY_ALIGN float minus_end[kBundle];       ///< the end of it, negative
  std::uint32_t backward[3] = {};           ///< rays of `side` 1, a bit each
};

/// That of ray i.
inline SlabRay slab_ray(const BundleSlab& slab, std::uint32_t i) {
  SlabRay ray;
  for (int axis = 0; axis < 3; ++axis) {
    const bool backward = slab.side[axis][i] != 0;
    const float lower = -slab.minus_from_lower[axis][i], upper = slab.from_upper[axis][i];
    ray.near_origin[axis] = backward ? upper : lower;
    ray.far_origin[axis] = backward ? lower : upper;
    ray.inverse[axis] = backward ? -slab.inverse[axis][i] : slab.inverse[axis][i];
  }
  return ray;
}

template <class Mask>
HWY_INLINE std::uint32_t lane_bits(const Mask& mask, std::uint32_t first) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(RayTag(), mask, bytes);
  return (static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8)
         << first;
}

/// The lanes of bits that are set, as lane_bits(mask, 0) gives them.
HWY_INLINE hn::Mask<RayTag> lanes_of(std::uint32_t bits) {
  if constexpr (kRayLanes == 16) {
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits),
                                   static_cast<std::uint8_t>(bits >> 8)};
    return hn::LoadMaskBits(RayTag(), bytes);
  } else {
    const RayIndexTag di;
    const auto bit = hn::Shl(hn::Set(di, 1), hn::Iota(di, 0));
    return hn::RebindMask(RayTag(), hn::TestBit(hn::Set(di, static_cast<std::int32_t>(bits)), bit));
  }
}

HWY_INLINE RayVec largest_of(const RayVec& x, const RayVec& y, const RayVec& z) {
  return hn::Max(hn::Max(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
}

/// make_slab_ray and is_usable of rays first…first + kRayLanes − 1 with `shift` per axis; a bit for
/// each that is usable.
HWY_INLINE std::uint32_t make_slabs(const Bundle& rays, std::uint32_t first, const RayVec* shift,
                                    BundleSlab& slab) {
  const RayTag d;
  const RayIndexTag di;
  const RayVec part[3] = {hn::Load(d, rays.d[0] + first), hn::Load(d, rays.d[1] + first),
                          hn::Load(d, rays.d[2] + first)};
  const RayVec largest = largest_of(part[0], part[1], part[2]);
  const RayVec tiniest = hn::Max(hn::Mul(largest, hn::Set(d, 1e-20f)), hn::Set(d, 1e-37f));
  const RayVec reach = hn::Set(d, 1e37f);
  auto fine = hn::Eq(part[0], part[0]);
  for (int axis = 0; axis < 3; ++axis) {
    const RayVec o = hn::Load(d, rays.o[axis] + first);
    const RayVec from_lower = hn::Add(o, shift[axis]), from_upper = hn::Sub(o, shift[axis]);
    const RayVec magnitude = hn::Abs(part[axis]);
    const auto backward = hn::Lt(part[axis], hn::Zero(d));
    const RayVec usual = hn::IfThenElse(hn::Lt(magnitude, tiniest), tiniest, magnitude);
    const RayVec inverse = hn::Div(hn::Set(d, 1.0f), usual);
    fine = hn::And(fine,
                   hn::And(hn::Gt(inverse, hn::Zero(d)), hn::Le(inverse, hn::Set(d, kFloatMax))));
    fine = hn::And(fine,
                   hn::And(hn::Lt(hn::Abs(from_lower), reach), hn::Lt(hn::Abs(from_upper), reach)));
    hn::Store(hn::Neg(from_lower), d, slab.minus_from_lower[axis] + first);
    hn::Store(from_upper, d, slab.from_upper[axis] + first);
    hn::Store(inverse, d, slab.inverse[axis] + first);
    hn::Store(hn::IfThenElseZero(hn::RebindMask(di, backward), hn::Set(di, 1)), di,
              slab.side[axis] + first);
    slab.backward[axis] |= lane_bits(backward, first);
  }
  return lane_bits(fine, first);
}

/// What a box leaves of (t_min, t_max) of each ray, as slab_interval: into begin and minus_end of
/// `range`; a bit for each that it leaves anything of.
HWY_INLINE std::uint32_t clip(const BundleSlab& slab, const Aabb& box, const Bundle& rays,
                              std::uint32_t first, BundleSlab& range) {
  const RayTag d;
  const RayIndexTag di;
  RayVec begin = hn::Load(d, rays.t_min + first);
  RayVec minus_end = hn::Neg(hn::Load(d, rays.t_max + first));
  for (int axis = 0; axis < 3; ++axis) {
    const RayVec inverse = hn::Load(d, slab.inverse[axis] + first);
    const auto backward =
        hn::RebindMask(d, hn::Ne(hn::Load(di, slab.side[axis] + first), hn::Zero(di)));
    const RayVec lower =
        hn::Add(hn::Set(d, box.lo[axis]), hn::Load(d, slab.minus_from_lower[axis] + first));
    const RayVec minus_upper =
        hn::Sub(hn::Load(d, slab.from_upper[axis] + first), hn::Set(d, box.hi[axis]));
    const RayVec at_lower = hn::Mul(lower, inverse);
    const RayVec minus_at_upper = hn::Mul(minus_upper, inverse);
    begin = hn::Max(begin, hn::IfThenElse(backward, minus_at_upper, at_lower));
    minus_end = hn::Max(minus_end, hn::IfThenElse(backward, at_lower, minus_at_upper));
  }
  hn::Store(begin, d, range.begin + first);
  hn::Store(minus_end, d, range.minus_end + first);
  return lane_bits(hn::Le(begin, hn::Neg(minus_end)), first);
}

/// Their shear rays (core/triangle.h).
struct BundleShear {
  HWY_ALIGN std::int32_t x[kBundle];
  HWY_ALIGN std::int32_t y[kBundle];
  HWY_ALIGN std::int32_t z[kBundle];
  HWY_ALIGN float sx[kBundle];
  HWY_ALIGN float sy[kBundle];
  HWY_ALIGN float sz[kBundle];
  HWY_ALIGN float o[3][kBundle];  ///< the origin's components along x, y, z
};

/// make_shear_ray of rays first…first + kRayLanes − 1.
HWY_INLINE void make_shears(const Bundle& rays, std::uint32_t first, BundleShear& shear) {
  const RayTag d;
  const RayIndexTag di;
  const RayVec x = hn::Load(d, rays.d[0] + first), y = hn::Load(d, rays.d[1] + first),
               z = hn::Load(d, rays.d[2] + first);
  const RayVec ax = hn::Abs(x), ay = hn::Abs(y), az = hn::Abs(z);
  const auto x_over_y = hn::Gt(ax, ay), x_over_z = hn::Gt(ax, az), y_over_z = hn::Gt(ay, az);
  const auto is_x = hn::And(x_over_y, x_over_z);
  const auto is_y = hn::AndNot(x_over_y, y_over_z);
  const auto choose = [&](const RayVec& if_x, const RayVec& if_y, const RayVec& if_z) HWY_ATTR {
    return hn::IfThenElse(is_x, if_x, hn::IfThenElse(is_y, if_y, if_z));
  };
  const auto choose_axis = [&](std::int32_t if_x, std::int32_t if_y, std::int32_t if_z) HWY_ATTR {
    return hn::IfThenElse(
        hn::RebindMask(di, is_x), hn::Set(di, if_x),
        hn::IfThenElse(hn::RebindMask(di, is_y), hn::Set(di, if_y), hn::Set(di, if_z)));
  };
  const RayVec along = choose(x, y, z);
  hn::Store(hn::Div(choose(y, z, x), along), d, shear.sx + first);
  hn::Store(hn::Div(choose(z, x, y), along), d, shear.sy + first);
  hn::Store(hn::Div(hn::Set(d, 1.0f), along), d, shear.sz + first);
  hn::Store(choose_axis(1, 2, 0), di, shear.x + first);
  hn::Store(choose_axis(2, 0, 1), di, shear.y + first);
  hn::Store(choose_axis(0, 1, 2), di, shear.z + first);
  const RayVec ox = hn::Load(d, rays.o[0] + first), oy = hn::Load(d, rays.o[1] + first),
               oz = hn::Load(d, rays.o[2] + first);
  hn::Store(choose(oy, oz, ox), d, shear.o[0] + first);
  hn::Store(choose(oz, ox, oy), d, shear.o[1] + first);
  hn::Store(choose(ox, oy, oz), d, shear.o[2] + first);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
