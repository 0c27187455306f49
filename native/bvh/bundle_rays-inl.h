// Rays of one point, made ready for a tree: what they share is a plain number, what they have of
// their own is an array. Included once per instruction set by traverse_simd.cpp, without a guard.

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

/// Directions and lengths, up to kBundle.
struct Directions {
  HWY_ALIGN float d[3][kBundle];
  HWY_ALIGN float t_max[kBundle];
};

/// The slab rays (core/slab.h) of one origin. All meet a box's lower planes from `from_lower` and
/// its upper ones from `from_upper`, whether near or far: for a direction of either sign that is
/// where make_slab_ray puts them.
struct BundleSlab {
  Vec3 from_lower, from_upper;
  HWY_ALIGN float inverse[3][kBundle];  ///< |1 / direction|
  HWY_ALIGN float signed_inverse[3][kBundle];
  HWY_ALIGN std::int32_t side[3][kBundle];  ///< of a box met first: 0 lower, 1 upper
  HWY_ALIGN float begin[kBundle];           ///< of the part of the ray that matters
  HWY_ALIGN float minus_end[kBundle];       ///< the end of it, negative
};

/// Which of the first `count` bits are set in lanes first…first + lanes − 1 of a mask.
template <class Mask>
HWY_INLINE std::uint32_t lane_bits(const Mask& mask, std::uint32_t first) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(RayTag(), mask, bytes);
  return (static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8)
         << first;
}

HWY_INLINE bool is_in_reach(const Vec3& origin) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(origin[axis] > -1e37f && origin[axis] < 1e37f)) return false;
  }
  return true;
}

/// make_slab_ray and is_usable for `count` rays; a bit for each that is usable.
HWY_INLINE std::uint32_t make_slabs(const Vec3& origin, const Vec3& shift, const Directions& rays,
                                    std::uint32_t count, BundleSlab& slab) {
  const RayTag d;
  const RayIndexTag di;
  slab.from_lower = origin + shift;
  slab.from_upper = origin - shift;
  if (!is_in_reach(slab.from_lower) || !is_in_reach(slab.from_upper)) return 0;
  std::uint32_t usable = 0;
  for (std::uint32_t i = 0; i < count; i += kRayLanes) {
    const RayVec x = hn::Load(d, rays.d[0] + i), y = hn::Load(d, rays.d[1] + i),
                 z = hn::Load(d, rays.d[2] + i);
    const RayVec largest = hn::Max(hn::Max(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
    const RayVec tiniest = hn::Max(hn::Mul(largest, hn::Set(d, 1e-20f)), hn::Set(d, 1e-37f));
    auto fine = hn::Eq(x, x);
    const RayVec part[3] = {x, y, z};
    for (int axis = 0; axis < 3; ++axis) {
      const RayVec magnitude = hn::Abs(part[axis]);
      const auto backward = hn::Lt(part[axis], hn::Zero(d));
      const RayVec usual = hn::IfThenElse(hn::Lt(magnitude, tiniest), tiniest, magnitude);
      const RayVec inverse = hn::Div(hn::Set(d, 1.0f), usual);
      fine = hn::And(fine,
                     hn::And(hn::Gt(inverse, hn::Zero(d)), hn::Le(inverse, hn::Set(d, kFloatMax))));
      hn::Store(inverse, d, slab.inverse[axis] + i);
      hn::Store(hn::IfThenElse(backward, hn::Neg(inverse), inverse), d,
                slab.signed_inverse[axis] + i);
      hn::Store(hn::IfThenElseZero(hn::RebindMask(di, backward), hn::Set(di, 1)), di,
                slab.side[axis] + i);
    }
    usable |= lane_bits(fine, i);
  }
  return usable;
}

/// What a box leaves of (0, t_max) of each ray, as slab_interval: into begin and minus_end of
/// `range`; a bit for each that it leaves anything of.
HWY_INLINE std::uint32_t clip(const BundleSlab& slab, const Aabb& box, const Directions& rays,
                              std::uint32_t count, BundleSlab& range) {
  const RayTag d;
  const RayIndexTag di;
  const Vec3 lower = box.lo - slab.from_lower, upper = box.hi - slab.from_upper;
  std::uint32_t left = 0;
  for (std::uint32_t i = 0; i < count; i += kRayLanes) {
    RayVec begin = hn::Zero(d), minus_end = hn::Neg(hn::Load(d, rays.t_max + i));
    for (int axis = 0; axis < 3; ++axis) {
      const RayVec inverse = hn::Load(d, slab.inverse[axis] + i);
      const auto backward =
          hn::RebindMask(d, hn::Ne(hn::Load(di, slab.side[axis] + i), hn::Zero(di)));
      const RayVec at_lower = hn::Mul(hn::Set(d, lower[axis]), inverse);
      const RayVec minus_at_upper = hn::Mul(hn::Set(d, -upper[axis]), inverse);
      begin = hn::Max(begin, hn::IfThenElse(backward, minus_at_upper, at_lower));
      minus_end = hn::Max(minus_end, hn::IfThenElse(backward, at_lower, minus_at_upper));
    }
    hn::Store(begin, d, range.begin + i);
    hn::Store(minus_end, d, range.minus_end + i);
    left |= lane_bits(hn::Le(begin, hn::Neg(minus_end)), i);
  }
  return left;
}

/// The shear rays (core/triangle.h) of one origin, for the vertices of a cluster that stand in
/// arrays of kClusterVertices per axis.
struct BundleShear {
  HWY_ALIGN std::int32_t x[kBundle];  ///< kClusterVertices · axis
  HWY_ALIGN std::int32_t y[kBundle];
  HWY_ALIGN std::int32_t z[kBundle];
  HWY_ALIGN float sx[kBundle];
  HWY_ALIGN float sy[kBundle];
  HWY_ALIGN float sz[kBundle];
};

/// make_shear_ray for `count` rays.
HWY_INLINE void make_shears(const Directions& rays, std::uint32_t count, BundleShear& shear) {
  const RayTag d;
  const RayIndexTag di;
  const auto stride = [&](std::int32_t axis) HWY_ATTR {
    return hn::Set(di, axis * static_cast<std::int32_t>(kClusterVertices));
  };
  for (std::uint32_t i = 0; i < count; i += kRayLanes) {
    const RayVec x = hn::Load(d, rays.d[0] + i), y = hn::Load(d, rays.d[1] + i),
                 z = hn::Load(d, rays.d[2] + i);
    const RayVec ax = hn::Abs(x), ay = hn::Abs(y), az = hn::Abs(z);
    const auto x_over_y = hn::Gt(ax, ay), x_over_z = hn::Gt(ax, az), y_over_z = hn::Gt(ay, az);
    const auto is_x = hn::And(x_over_y, x_over_z);
    const auto is_y = hn::AndNot(x_over_y, y_over_z);
    const auto choose = [&](const RayVec& if_x, const RayVec& if_y, const RayVec& if_z) HWY_ATTR {
      return hn::IfThenElse(is_x, if_x, hn::IfThenElse(is_y, if_y, if_z));
    };
    const auto choose_axis = [&](std::int32_t if_x, std::int32_t if_y, std::int32_t if_z) HWY_ATTR {
      return hn::IfThenElse(hn::RebindMask(di, is_x), stride(if_x),
                            hn::IfThenElse(hn::RebindMask(di, is_y), stride(if_y), stride(if_z)));
    };
    const RayVec along = choose(x, y, z);
    hn::Store(hn::Div(choose(y, z, x), along), d, shear.sx + i);
    hn::Store(hn::Div(choose(z, x, y), along), d, shear.sy + i);
    hn::Store(hn::Div(hn::Set(d, 1.0f), along), d, shear.sz + i);
    hn::Store(choose_axis(1, 2, 0), di, shear.x + i);
    hn::Store(choose_axis(2, 0, 1), di, shear.y + i);
    hn::Store(choose_axis(0, 1, 2), di, shear.z + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
