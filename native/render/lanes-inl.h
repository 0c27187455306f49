// What core/ computes for one sample, in lanes: sampler, warps, elementary functions. Included once
// per instruction set (no include guard), in that set's own namespace. Every function does the very
// operations of its namesake in core/, in the same order, so its lanes are equal to it in every
// bit; none calls code of core/ itself, of which the linker could keep a copy with AVX.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// As many lanes of each type as there are of doubles.
using TagD = hn::ScalableTag<double>;
using TagF = hn::Rebind<float, TagD>;
using TagU = hn::Rebind<std::uint32_t, TagD>;
using TagI = hn::Rebind<std::int32_t, TagD>;
using TagU64 = hn::Rebind<std::uint64_t, TagD>;
using Double = hn::Vec<TagD>;
using Float = hn::Vec<TagF>;
using Uint = hn::Vec<TagU>;
using Int = hn::Vec<TagI>;

HWY_INLINE Float f32(float x) {
  return hn::Set(TagF(), x);
}
HWY_INLINE Double f64(double x) {
  return hn::Set(TagD(), x);
}
HWY_INLINE Uint u32(std::uint32_t x) {
  return hn::Set(TagU(), x);
}
HWY_INLINE Double to_double(Float x) {
  return hn::PromoteTo(TagD(), x);
}
/// Any 32 bits: as the low part of 2⁵², which is then taken away.
HWY_INLINE Double to_double(Uint x) {
  const auto low = hn::PromoteTo(TagU64(), x);
  const auto bits = hn::Or(low, hn::Set(TagU64(), 0x4330000000000000ull));
  return hn::Sub(hn::BitCast(TagD(), bits), f64(4503599627370496.0));
}
/// Below 2³¹.
HWY_INLINE Float to_float(Uint x) {
  return hn::ConvertTo(TagF(), hn::BitCast(TagI(), x));
}
HWY_INLINE Float to_float(Double x) {
  return hn::DemoteTo(TagF(), x);
}
HWY_INLINE Uint truncated(Float x) {
  return hn::BitCast(TagU(), hn::ConvertTo(TagI(), x));
}

struct Vec3Lanes {
  Float x, y, z;
};

/// The nine numbers of a matrix, column by column.
HWY_INLINE const float* entries(const Mat3& m) {
  static_assert(sizeof(Mat3) == 9 * sizeof(float));
  return reinterpret_cast<const float*>(&m);
}

HWY_INLINE Float dot(const Vec3Lanes& a, const Vec3Lanes& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

/// m · v, m stored by columns.
HWY_INLINE Vec3Lanes times(const float* m, const Vec3Lanes& v) {
  return {(f32(m[0]) * v.x + f32(m[3]) * v.y) + f32(m[6]) * v.z,
          (f32(m[1]) * v.x + f32(m[4]) * v.y) + f32(m[7]) * v.z,
          (f32(m[2]) * v.x + f32(m[5]) * v.y) + f32(m[8]) * v.z};
}

/// transpose(m) · v
HWY_INLINE Vec3Lanes transposed_times(const float* m, const Vec3Lanes& v) {
  return {(f32(m[0]) * v.x + f32(m[1]) * v.y) + f32(m[2]) * v.z,
          (f32(m[3]) * v.x + f32(m[4]) * v.y) + f32(m[5]) * v.z,
          (f32(m[6]) * v.x + f32(m[7]) * v.y) + f32(m[8]) * v.z};
}

HWY_INLINE Float mix(Float a, Float b, Float t) {
  return a * (f32(1.0f) - t) + b * t;
}

// ------------------------------------------------------------------ core/sampler.h, core/sobol.h

HWY_INLINE Uint hash_bits_lanes(Uint x) {
  x = hn::Xor(x, hn::ShiftRight<16>(x));
  x = hn::Mul(x, u32(0x21f0aaadu));
  x = hn::Xor(x, hn::ShiftRight<15>(x));
  x = hn::Mul(x, u32(0xd35a2d97u));
  return hn::Xor(x, hn::ShiftRight<15>(x));
}

HWY_INLINE Uint reverse_bits_lanes(Uint x) {
  const auto swap = [](Uint v, auto shift, std::uint32_t mask) HWY_ATTR {
    constexpr int kShift = decltype(shift)::value;
    return hn::Or(hn::ShiftLeft<kShift>(hn::And(v, u32(mask))),
                  hn::And(hn::ShiftRight<kShift>(v), u32(mask)));
  };
  x = hn::Or(hn::ShiftRight<16>(x), hn::ShiftLeft<16>(x));
  x = swap(x, std::integral_constant<int, 8>(), 0x00ff00ffu);
  x = swap(x, std::integral_constant<int, 4>(), 0x0f0f0f0fu);
  x = swap(x, std::integral_constant<int, 2>(), 0x33333333u);
  return swap(x, std::integral_constant<int, 1>(), 0x55555555u);
}

HWY_INLINE Uint owen_scramble_lanes(Uint x, Uint seed) {
  x = hn::Xor(x, hn::Mul(x, u32(0x3d20adeau)));
  x = hn::Add(x, seed);
  x = hn::Mul(x, hn::Or(hn::ShiftRight<16>(seed), u32(1)));
  x = hn::Xor(x, hn::Mul(x, u32(0x05526c56u)));
  return hn::Xor(x, hn::Mul(x, u32(0x53a22864u)));
}

HWY_INLINE Uint sobol_1_lanes(Uint v) {
  v = hn::Xor(v, hn::ShiftRight<16>(v));
  v = hn::Xor(v, hn::And(hn::ShiftRight<8>(v), u32(0x00ff00ffu)));
  v = hn::Xor(v, hn::And(hn::ShiftRight<4>(v), u32(0x0f0f0f0fu)));
  v = hn::Xor(v, hn::And(hn::ShiftRight<2>(v), u32(0x33333333u)));
  return hn::Xor(v, hn::And(hn::ShiftRight<1>(v), u32(0x55555555u)));
}

/// hash_bits(dimension + 0x9e3779b9), what Sampler makes of a dimension alone.
HWY_INLINE std::uint32_t dimension_hash(std::uint32_t dimension) {
  std::uint32_t x = dimension + 0x9e3779b9u;
  x ^= x >> 16;
  x *= 0x21f0aaadu;
  x ^= x >> 15;
  x *= 0xd35a2d97u;
  return x ^ (x >> 15);
}

/// One pair of dimensions of the sampler of each lane's pixel; the seeds are worked out once.
struct PairSampler {
  HWY_INLINE PairSampler(Uint pixel_seed, std::uint32_t hash) {
    const Uint sum =
        hn::Add(hn::Add(u32(hash), hn::ShiftLeft<6>(pixel_seed)), hn::ShiftRight<2>(pixel_seed));
    order = hash_bits_lanes(hn::Xor(pixel_seed, sum));
    x = hash_bits_lanes(hn::Add(order, u32(1)));
    y = hash_bits_lanes(hn::Add(order, u32(2)));
  }
  HWY_INLINE void bits(Uint index, Uint& bits_x, Uint& bits_y) const {
    const Uint i = reverse_bits_lanes(owen_scramble_lanes(reverse_bits_lanes(index), order));
    bits_x = reverse_bits_lanes(owen_scramble_lanes(i, x));
    bits_y = reverse_bits_lanes(owen_scramble_lanes(sobol_1_lanes(i), y));
  }
  Uint order, x, y;
};

HWY_INLINE Float to_unit_float_lanes(Uint bits) {
  return to_float(hn::ShiftRight<8>(bits)) * f32(5.9604644775390625e-8f);
}

// -------------------------------------------------------------------- core/math.h, core/warp.h

template <std::size_t N>
HWY_INLINE Float polynomial_lanes(Float x, const float (&c)[N]) {
  Float sum = f32(c[N - 1]);
  for (std::size_t i = N - 1; i > 0; --i) sum = sum * x + f32(c[i - 1]);
  return sum;
}

struct SinCosLanes {
  Float sin, cos;
};

HWY_INLINE SinCosLanes sin_cos_turns_lanes(Float u) {
  constexpr float kSin[] = {1.570796327f, -0.6459640961f, 0.07969258273f, -0.004681266257f,
                            0.0001582063036f};
  constexpr float kCos[] = {1.0f, -1.233700541f, 0.2536692037f, -0.0208600695f, 0.0009036280664f};
  const Float x = f32(4.0f) * u + f32(0.5f);
  const Int cut = hn::ConvertTo(TagI(), x);
  const Float whole = hn::ConvertTo(TagF(), cut);
  const Int below = hn::Sub(cut, hn::Set(TagI(), 1));
  const auto too_high = hn::RebindMask(TagI(), hn::Gt(whole, x));
  const Int quarter = hn::IfThenElse(too_high, below, cut);
  const Float r = f32(4.0f) * u - hn::ConvertTo(TagF(), quarter);
  const Float s = r * polynomial_lanes(r * r, kSin);
  const Float c = polynomial_lanes(r * r, kCos);
  const Uint q = hn::BitCast(TagU(), quarter);
  const auto odd = hn::RebindMask(TagF(), hn::Eq(hn::And(q, u32(1)), u32(1)));
  const Float sin = hn::IfThenElse(odd, c, s);
  const Float cos = hn::IfThenElse(odd, s, c);
  // sin is negative in quarters 2 and 3, cos in 1 and 2: bit 1 of q, and of q + 1
  const Uint sin_sign = hn::ShiftLeft<30>(hn::And(q, u32(2)));
  const Uint cos_sign = hn::ShiftLeft<30>(hn::And(hn::Add(q, u32(1)), u32(2)));
  return {hn::Xor(sin, hn::BitCast(TagF(), sin_sign)), hn::Xor(cos, hn::BitCast(TagF(), cos_sign))};
}

/// atan2_radians for x ≥ 0, not both 0.
HWY_INLINE Float atan2_right_lanes(Float y, Float x) {
  constexpr float kAtan[] = {0.9999999994f,  -0.3333330689f, 0.1999818304f,
                             -0.1423953267f, 0.1056982881f,  -0.06026305228f};
  const Float ay = hn::Abs(y);
  const auto steep = hn::Lt(x, ay);
  const Float large = hn::IfThenElse(steep, ay, x);
  const Float small = hn::IfThenElse(steep, x, ay);
  const auto wide = hn::Gt(small, f32(0.41421356237309504880f) * large);
  const Float r =
      hn::IfThenElse(wide, small - large, small) / hn::IfThenElse(wide, small + large, large);
  const Float part = r * polynomial_lanes(r * r, kAtan);
  Float angle = hn::IfThenElse(wide, f32(static_cast<float>(kPi / 4)) + part, part);
  angle = hn::IfThenElse(steep, f32(static_cast<float>(kPi / 2)) - angle, angle);
  return hn::IfThenElse(hn::Lt(y, f32(0.0f)), hn::Neg(angle), angle);
}

HWY_INLINE Vec3Lanes cosine_hemisphere_disk_lanes(Float ux, Float uy) {
  const Float a = f32(2.0f) * ux - f32(1.0f);
  const Float b = f32(2.0f) * uy - f32(1.0f);
  const auto wide = hn::Gt(a * a, b * b);
  const Float r = hn::IfThenElse(wide, a, b);
  const Float part = f32(0.125f) * (hn::IfThenElse(wide, b, a) / r);
  const Float turns = hn::IfThenElse(wide, part, f32(0.25f) - part);
  const auto middle = hn::Eq(r, f32(0.0f));
  const SinCosLanes phi = sin_cos_turns_lanes(hn::IfThenElse(middle, f32(0.0f), turns));
  const Float zero = f32(0.0f);
  return {hn::IfThenElse(middle, zero, r * phi.cos), hn::IfThenElse(middle, zero, r * phi.sin),
          hn::Sqrt((f32(1.0f) - r) * (f32(1.0f) + r))};
}

struct FrameLanes {
  HWY_INLINE explicit FrameLanes(const Vec3Lanes& n) : normal(n) {
    const Float one = f32(1.0f);
    const Float sign = hn::IfThenElse(hn::Lt(n.z, f32(0.0f)), f32(-1.0f), one);
    const Float a = f32(-1.0f) / (sign + n.z);
    const Float b = n.x * n.y * a;
    tangent = {one + sign * n.x * n.x * a, sign * b, hn::Neg(sign) * n.x};
    bitangent = {b, sign + n.y * n.y * a, hn::Neg(n.y)};
  }
  HWY_INLINE Vec3Lanes to_world(const Vec3Lanes& v) const {
    return {(v.x * tangent.x + v.y * bitangent.x) + v.z * normal.x,
            (v.x * tangent.y + v.y * bitangent.y) + v.z * normal.y,
            (v.x * tangent.z + v.y * bitangent.z) + v.z * normal.z};
  }
  Vec3Lanes tangent, bitangent, normal;
};

HWY_INLINE Float sample_linear_lanes(Float u, Float a, Float b) {
  const Float largest = hn::IfThenElse(hn::Lt(a, b), b, a);
  const auto flat = hn::Not(hn::And(hn::Gt(largest, f32(0.0f)), hn::Gt(u, f32(0.0f))));
  a = a / largest;
  b = b / largest;
  const Float x = u * (a + b) / (a + hn::Sqrt(a * a * (f32(1.0f) - u) + b * b * u));
  const Float most = f32(kOneMinusEpsilon);
  return hn::IfThenElse(flat, u, hn::IfThenElse(hn::Lt(x, most), x, most));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
