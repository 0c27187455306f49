// Vectors and matrices in lanes, with GLM's and core/'s order of operations; see lanes-inl.h.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

struct Vec3dLanes {
  Double x, y, z;
};

HWY_INLINE Vec3dLanes to_double(const Vec3Lanes& v) {
  return {to_double(v.x), to_double(v.y), to_double(v.z)};
}
HWY_INLINE Vec3Lanes to_float(const Vec3dLanes& v) {
  return {to_float(v.x), to_float(v.y), to_float(v.z)};
}

template <class V>
HWY_INLINE V sum(const V& a, const V& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
HWY_INLINE V difference(const V& a, const V& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE Vec3Lanes scaled(Float s, const Vec3Lanes& v) {
  return {s * v.x, s * v.y, s * v.z};
}
HWY_INLINE Vec3dLanes scaled(Double s, const Vec3dLanes& v) {
  return {s * v.x, s * v.y, s * v.z};
}
HWY_INLINE Double dot(const Vec3dLanes& a, const Vec3dLanes& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
template <class V>
HWY_INLINE V cross(const V& a, const V& b) {
  return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
HWY_INLINE Vec3Lanes negated(const Vec3Lanes& v) {
  return {hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)};
}
template <class M>
HWY_INLINE Vec3Lanes if_then_else(M mask, const Vec3Lanes& yes, const Vec3Lanes& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}
template <class M>
HWY_INLINE Vec3dLanes if_then_else(M mask, const Vec3dLanes& yes, const Vec3dLanes& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

HWY_INLINE Float absolute(Float x) {  // as core/local_ray.h: −0 stays
  return hn::IfThenElse(hn::Lt(x, f32(0.0f)), hn::Neg(x), x);
}
HWY_INLINE Vec3Lanes absolute(const Vec3Lanes& v) {
  return {absolute(v.x), absolute(v.y), absolute(v.z)};
}
HWY_INLINE Float max_abs(const Vec3Lanes& v) {
  const Float x = absolute(v.x), y = absolute(v.y), z = absolute(v.z);
  const Float xy = hn::IfThenElse(hn::Lt(x, y), y, x);
  return hn::IfThenElse(hn::Lt(xy, z), z, xy);
}

/// detail::unit_or (core/surface_point.h)
HWY_INLINE Vec3Lanes unit_or(const Vec3Lanes& v, const Vec3Lanes& fallback) {
  const Float scale = max_abs(v);
  const auto usable = hn::And(hn::Gt(scale, f32(0.0f)), hn::Le(scale, f32(3.402823466e+38f)));
  const Vec3Lanes s = {v.x / scale, v.y / scale, v.z / scale};
  const Float length = hn::Sqrt((s.x * s.x + s.y * s.y) + s.z * s.z);
  return if_then_else(usable, Vec3Lanes{s.x / length, s.y / length, s.z / length}, fallback);
}

/// A matrix a lane, by columns.
struct Mat3Lanes {
  Vec3Lanes column[3];
};
HWY_INLINE Mat3Lanes absolute(const Mat3Lanes& m) {
  return {{absolute(m.column[0]), absolute(m.column[1]), absolute(m.column[2])}};
}
/// m · v
HWY_INLINE Vec3Lanes times(const Mat3Lanes& m, const Vec3Lanes& v) {
  return sum(sum(scaled(v.x, m.column[0]), scaled(v.y, m.column[1])), scaled(v.z, m.column[2]));
}
HWY_INLINE Vec3dLanes times(const Mat3Lanes& m, const Vec3dLanes& v) {
  return sum(sum(scaled(v.x, to_double(m.column[0])), scaled(v.y, to_double(m.column[1]))),
             scaled(v.z, to_double(m.column[2])));
}
/// transpose(m) · v
HWY_INLINE Vec3Lanes transposed_times(const Mat3Lanes& m, const Vec3Lanes& v) {
  return {dot(m.column[0], v), dot(m.column[1], v), dot(m.column[2], v)};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
