// smooth_lift (core/terminator.h) in lanes, to the bit; see lanes-inl.h.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

// As glm::max and glm::min.
HWY_INLINE Float larger(Float x, Float y) {
  return hn::IfThenElse(hn::Lt(x, y), y, x);
}
HWY_INLINE Float smaller(Float x, Float y) {
  return hn::IfThenElse(hn::Lt(y, x), y, x);
}

/// detail::convex_reach
HWY_INLINE Float convex_reach_lanes(const Vec3Lanes (&corner)[3], const Vec3Lanes (&normal)[3],
                                    const Vec3Lanes& at, Float side) {
  const Float zero = f32(0.0f);
  Float least = f32(3.402823466e+38f);
  for (int i = 0; i < 3; ++i) {
    const Vec3Lanes to_next = scaled(side, difference(corner[(i + 1) % 3], corner[i]));
    const Vec3Lanes to_last = scaled(side, difference(corner[(i + 2) % 3], corner[i]));
    Float rise = larger(dot(to_next, normal[i]), dot(to_last, normal[i]));
    rise = larger(rise, zero);
    rise = larger(dot(scaled(side, difference(corner[i], at)), normal[i]) + rise, zero);
    least = smaller(least, rise);
  }
  return least;
}

/// Of corners in local space with their normals there.
HWY_INLINE Vec3Lanes smooth_lift_lanes(const Vec3Lanes (&local_corner)[3],
                                       const Vec3Lanes (&local_normal)[3],
                                       const Mat3Lanes& world_from_local,
                                       const Mat3Lanes& local_from_world, Float v, Float w,
                                       const Vec3Lanes& geometric_normal) {
  Vec3Lanes corner[3], normal[3];
  for (int k = 0; k < 3; ++k) {
    corner[k] = times(world_from_local, local_corner[k]);
    normal[k] = unit_or(transposed_times(local_from_world, local_normal[k]), geometric_normal);
  }
  const Float one = f32(1.0f), half = f32(0.5f), u = (one - v) - w;
  const auto blend = [&](const Vec3Lanes(&of)[3]) HWY_ATTR {
    return sum(sum(scaled(u, of[0]), scaled(v, of[1])), scaled(w, of[2]));
  };
  const Vec3Lanes at = blend(corner), up = blend(normal);
  const Float bend_u = dot(difference(normal[2], normal[0]), difference(corner[0], corner[2]));
  const Float bend_v = dot(difference(normal[2], normal[1]), difference(corner[1], corner[2]));
  const Float bend_uv = dot(difference(normal[1], normal[0]), difference(corner[1], corner[0]));
  const Float height =
      (bend_u * u * (u - one) + ((bend_u + bend_v) + bend_uv) * u * v) + bend_v * v * (v - one);
  const auto outer = hn::Gt(dot(up, geometric_normal), f32(0.0f));
  const Float side = hn::IfThenElse(outer, one, f32(-1.0f));
  const Float reach = convex_reach_lanes(corner, normal, at, side);
  const Float above = larger(reach, half * height), below = smaller(hn::Neg(reach), half * height);
  return scaled(hn::IfThenElse(outer, above, below), up);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
