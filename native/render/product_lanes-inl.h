// sample_product (core/environment_product.h) in lanes, to the bit; see lanes-inl.h.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

HWY_INLINE Uint gather(const std::uint32_t* base, Uint index) {
  return hn::GatherIndex(TagU(), base, hn::BitCast(TagI(), index));
}
HWY_INLINE Float gather(const float* base, Uint index) {
  return hn::GatherIndex(TagF(), base, hn::BitCast(TagI(), index));
}
HWY_INLINE Double gather(const double* base, Uint index) {
  const hn::Rebind<std::int64_t, TagD> d;
  return hn::GatherIndex(TagD(), base, hn::BitCast(d, hn::PromoteTo(TagU64(), index)));
}

/// Asks for base[index], which will be read soon.
template <class T>
HWY_INLINE void fetch_soon(const T* base, Uint index) {
  HWY_ALIGN std::uint32_t at[hn::MaxLanes(TagU())];
  hn::Store(index, TagU(), at);
  for (const std::uint32_t i : at) __builtin_prefetch(base + i);
}

struct SelectionLanes {
  Uint entry;  ///< from `first` on
  Double fraction, probability;
};

/// detail::select among the `count` entries from cdf[first] on; `most` is the largest count.
HWY_INLINE SelectionLanes select_lanes(const std::uint32_t* cdf, Uint first, Uint count,
                                       Double position) {
  const Uint start = gather(cdf, first);
  const Double total = to_double(hn::Sub(gather(cdf, hn::Add(first, count)), start));
  const Double offset = position * total;
  const Double last = total - f64(1.0);
  const Double whole = hn::IfThenElse(hn::Lt(offset, last), offset, last);
  const Uint target = hn::Add(start, hn::BitCast(TagU(), hn::DemoteTo(TagI(), whole)));
  Uint at = first, left = count;
  while (!hn::AllFalse(TagU(), hn::Gt(left, u32(1)))) {
    const Uint half = hn::ShiftRight<1>(left);
    const Uint middle = hn::Add(at, half);
    at = hn::IfThenElse(hn::Gt(gather(cdf, middle), target), at, middle);
    left = hn::Sub(left, half);
  }
  const Uint begin = gather(cdf, at);
  const Double width = to_double(hn::Sub(gather(cdf, hn::Add(at, u32(1))), begin));
  return {hn::Sub(at, first), (offset - to_double(hn::Sub(begin, start))) / width, width / total};
}

HWY_INLINE Float below_one_lanes(Double fraction) {
  const Float f = to_float(fraction);
  const Float most = f32(kOneMinusEpsilon);
  return hn::IfThenElse(hn::Lt(f, most), f, most);
}

struct OctahedralLanes {
  Float x, y;
};

/// octahedral_from_direction
HWY_INLINE OctahedralLanes octahedral_lanes(const Vec3Lanes& d) {
  const Float ax = hn::Abs(d.x), ay = hn::Abs(d.y), az = hn::Abs(d.z);
  const Float sum = (ax + ay) + az;
  const Float zero = f32(0.0f), one = f32(1.0f);
  const Float folded_x = one - ay / sum, folded_y = one - ax / sum;
  const auto lower = hn::Lt(d.z, zero);
  return {hn::IfThenElse(lower, hn::IfThenElse(hn::Lt(d.x, zero), hn::Neg(folded_x), folded_x),
                         d.x / sum),
          hn::IfThenElse(lower, hn::IfThenElse(hn::Lt(d.y, zero), hn::Neg(folded_y), folded_y),
                         d.y / sum)};
}

/// octahedral_cell
HWY_INLINE Uint octahedral_cell_lanes(const OctahedralLanes& p, std::uint32_t n) {
  const Float zero = f32(0.0f);
  const Float half = f32(0.5f * static_cast<float>(n));
  const Float last = f32(static_cast<float>(n - 1));
  const auto limited = [&](Float x) HWY_ATTR {
    return hn::IfThenElse(hn::Gt(x, zero), hn::IfThenElse(hn::Lt(x, last), x, last), zero);
  };
  const Uint column = truncated(limited(half + half * p.x));
  const Uint row = truncated(limited(half + half * p.y));
  return hn::Add(hn::Mul(row, u32(n)), column);
}

/// cell_of_place (core/sky_places.h)
HWY_INLINE Uint cell_of_place_lanes(const SkyPlacesView& v, const Vec3Lanes& at) {
  const Float scale = f32(v.cells_per_length), zero = f32(0.0f);
  const Float x = (at.x - f32(v.origin.x)) * scale, y = (at.y - f32(v.origin.y)) * scale,
              z = (at.z - f32(v.origin.z)) * scale;
  const auto within = [&](Float cell, std::uint32_t size) HWY_ATTR {
    return hn::And(hn::Ge(cell, zero), hn::Lt(cell, f32(static_cast<float>(size))));
  };
  const auto inside =
      hn::And(hn::And(within(x, v.size[0]), within(y, v.size[1])), within(z, v.size[2]));
  const Uint row = hn::Add(hn::Mul(truncated(z), u32(v.size[1])), truncated(y));
  const Uint cell = hn::Add(hn::Mul(row, u32(v.size[0])), truncated(x));
  return hn::IfThenElse(hn::RebindMask(TagU(), inside), cell, u32(kNoTable));
}

/// product_bin, `local` being the normal in the map's space. What is looked up, in halves of words,
/// is so one lane after another.
HWY_INLINE Uint product_bin_lanes(const ProductView& p, const Vec3Lanes& local,
                                  const Vec3Lanes& at) {
  const OctahedralLanes normal = octahedral_lanes(local);
  const Uint of_scene = octahedral_cell_lanes(normal, p.bins);
  const SkyPlacesView& v = p.places;
  if (!v.exists()) return of_scene;
  constexpr std::uint32_t kBins = SkyPlacesView::kBins;
  constexpr std::size_t kLanes = hn::MaxLanes(TagU());
  HWY_ALIGN std::uint32_t cells[kLanes], normals[kLanes], bins[kLanes];
  hn::Store(cell_of_place_lanes(v, at), TagU(), cells);
  hn::Store(octahedral_cell_lanes(normal, kBins), TagU(), normals);
  hn::Store(of_scene, TagU(), bins);
  for (std::size_t l = 0; l < hn::Lanes(TagU()); ++l) {
    const std::uint32_t place = cells[l] == kNoTable ? 0 : v.place[cells[l]];
    if (place == 0) continue;
    const std::uint32_t table = v.table[(place - 1) * kBins * kBins + normals[l]];
    if (table != 0) bins[l] = p.bins * p.bins + table - 1;
  }
  return hn::Load(TagU(), bins);
}

/// The rows of texels that a patch row lies between; below the lowest and above the highest, which
/// are half a row at one pole, the map begins anew.
struct TexelRows {
  HWY_INLINE TexelRows(const EnvironmentView& e, Uint patch_row)
      : lowest(hn::Eq(patch_row, u32(0))),
        highest(hn::Eq(patch_row, u32(e.height))),
        low(hn::IfThenElse(lowest, u32(e.height - 1), hn::Sub(patch_row, u32(1)))),
        high(hn::IfThenElse(highest, u32(0), patch_row)) {}
  hn::Mask<TagU> lowest, highest;
  Uint low, high;
};

struct EnvironmentSampleLanes {
  Vec3Lanes direction, radiance;
  Float pdf;
};

/// rgbe_texel
HWY_INLINE Vec3Lanes rgbe_lanes(Uint word) {
  const Uint exponent = hn::Sub(hn::ShiftRight<24>(word), u32(9));
  const Float scale = hn::BitCast(TagF(), hn::ShiftLeft<23>(exponent));
  const Uint byte = u32(255);
  return {to_float(hn::And(word, byte)) * scale,
          to_float(hn::And(hn::ShiftRight<8>(word), byte)) * scale,
          to_float(hn::And(hn::ShiftRight<16>(word), byte)) * scale};
}

/// packed_half of a number that is finite and not negative: exact, denormal ones too.
HWY_INLINE Float gather_half(const std::uint32_t* words, Uint i) {
  const Uint word = gather(words, hn::ShiftRight<1>(i));
  const auto odd = hn::Eq(hn::And(i, u32(1)), u32(1));
  const Uint half = hn::And(hn::IfThenElse(odd, hn::ShiftRight<16>(word), word), u32(0xffff));
  return hn::BitCast(TagF(), hn::ShiftLeft<13>(half)) * f32(5.192296858534828e33f);  // 2^112
}

struct TexelLanes {
  HWY_INLINE TexelLanes(const EnvironmentView& e, Uint row, Uint column) {
    const Uint texel = hn::Add(hn::Mul(row, u32(e.width)), column);
    if (e.storage == LightStorage::kRgbe) {
      rgb = rgbe_lanes(gather(e.words, texel));
    } else {
      const Uint i = hn::Mul(u32(3), texel);
      const Uint green = hn::Add(i, u32(1)), blue = hn::Add(i, u32(2));
      rgb = e.storage == LightStorage::kHalf
                ? Vec3Lanes{gather_half(e.words, i), gather_half(e.words, green),
                            gather_half(e.words, blue)}
                : Vec3Lanes{gather(e.texels, i), gather(e.texels, green), gather(e.texels, blue)};
    }
    luminance = (f32(0.2126f) * rgb.x + f32(0.7152f) * rgb.y) + f32(0.0722f) * rgb.z;
  }
  Vec3Lanes rgb;
  Float luminance;
};

/// detail::sample_patch
HWY_INLINE EnvironmentSampleLanes sample_patch_lanes(const EnvironmentView& e, Uint row,
                                                     Uint column, Float column_fraction,
                                                     Float row_fraction, Double probability) {
  const Uint one = u32(1);
  const TexelRows rows(e, row);
  const Uint next = hn::Add(column, one);
  const Uint right = hn::IfThenElse(hn::Eq(next, u32(e.width)), u32(0), next);
  const TexelLanes low_left(e, rows.low, column), low_right(e, rows.low, right);
  const TexelLanes high_left(e, rows.high, column), high_right(e, rows.high, right);

  const Float half = f32(0.5f);
  const auto lowest_f = hn::RebindMask(TagF(), rows.lowest);
  const auto highest_f = hn::RebindMask(TagF(), rows.highest);
  const Float middle_left = half * low_left.luminance + half * high_left.luminance;
  const Float middle_right = half * low_right.luminance + half * high_right.luminance;
  const Float ll = hn::IfThenElse(lowest_f, middle_left, low_left.luminance);
  const Float lr = hn::IfThenElse(lowest_f, middle_right, low_right.luminance);
  const Float hl = hn::IfThenElse(highest_f, middle_left, high_left.luminance);
  const Float hr = hn::IfThenElse(highest_f, middle_right, high_right.luminance);

  const Float up = sample_linear_lanes(row_fraction, half * ll + half * lr, half * hl + half * hr);
  const Float across = sample_linear_lanes(column_fraction, mix(ll, hl, up), mix(lr, hr, up));

  const Double z0 = gather(e.row_z, row);
  const Double height = gather(e.row_z, hn::Add(row, one)) - z0;
  const Double z = z0 + to_double(up) * height;
  const Float r = to_float(hn::Sqrt((f64(1.0) - z) * (f64(1.0) + z)));
  const Float turns =
      half - ((to_float(column) + half) + across) / f32(static_cast<float>(e.width));
  const SinCosLanes phi = sin_cos_turns_lanes(turns);
  const Vec3Lanes local = {r * phi.cos, r * phi.sin, to_float(z)};

  const Float v = half + atan2_right_lanes(local.z, r) * f32(kInvPi);
  const Float t = (v * f32(static_cast<float>(e.height)) - half) - (to_float(row) - f32(1.0f));
  const Float inside = hn::IfThenElse(
      hn::Gt(t, f32(0.0f)), hn::IfThenElse(hn::Lt(t, f32(1.0f)), t, f32(1.0f)), f32(0.0f));
  const Float strength = f32(e.strength);
  const auto channel = [&](Float a, Float b, Float c, Float d) HWY_ATTR {
    return strength * mix(mix(a, b, across), mix(c, d, across), inside);
  };
  EnvironmentSampleLanes sample;
  sample.direction = transposed_times(entries(e.texture_from_world), local);
  sample.radiance = {channel(low_left.rgb.x, low_right.rgb.x, high_left.rgb.x, high_right.rgb.x),
                     channel(low_left.rgb.y, low_right.rgb.y, high_left.rgb.y, high_right.rgb.y),
                     channel(low_left.rgb.z, low_right.rgb.z, high_left.rgb.z, high_right.rgb.z)};

  const Float quarter = f32(0.25f);
  const Float mean = ((quarter * ll + quarter * lr) + quarter * hl) + quarter * hr;
  const Float shape = mix(mix(ll, lr, across), mix(hl, hr, across), up) / mean;
  const Double solid_angle = f64(2.0 * kPi / e.width) * height;
  const Float pdf = to_float(probability / solid_angle * to_double(shape));
  sample.pdf = hn::IfThenElseZero(hn::Gt(mean, f32(0.0f)), pdf);
  return sample;
}

/// sample_product of some vectors of rays, step by step: a step of one vector waits for what it
/// gathers, and those of the others fill that time. pdf = 0 where there is no light.
class ProductSteps {
 public:
  static constexpr std::size_t kMost = 32;

  HWY_INLINE ProductSteps(const EnvironmentView& e, const ProductView& p) : e_(e), p_(p) {}

  HWY_INLINE void begin() { count_ = 0; }
  HWY_INLINE std::size_t size() const { return count_; }

  HWY_INLINE void push(Uint bin, Uint bits_x, Uint bits_y) {
    Draw& d = draws_[count_++];
    d.bin = bin;
    const Double unit = f64(2.3283064365386963e-10);  // 2^-32
    d.across.fraction = (to_double(bits_x) + f64(0.5)) * unit;
    d.up.fraction = (to_double(bits_y) + f64(0.5)) * unit;
  }

  /// Chooses the patches of all.
  HWY_INLINE void choose() {
    const Uint one = u32(1);
    for (std::size_t i = 0; i < count_; ++i) {
      Draw& d = draws_[i];
      d.up =
          select_lanes(p_.row_cdf, hn::Mul(d.bin, u32(p_.rows + 1)), u32(p_.rows), d.up.fraction);
    }
    for (std::size_t i = 0; i < count_; ++i) {
      Draw& d = draws_[i];
      const Uint base =
          hn::Mul(hn::Add(hn::Mul(d.bin, u32(p_.rows)), d.up.entry), u32(p_.columns + 1));
      d.across = select_lanes(p_.column_cdf, base, u32(p_.columns), d.across.fraction);
      d.probability = d.up.probability * d.across.probability;
    }
    for (std::size_t i = 0; i < count_; ++i) {
      Draw& d = draws_[i];
      const Uint first = gather(p_.patch_row, d.up.entry);
      const Uint end = gather(p_.patch_row, hn::Add(d.up.entry, one));
      const Uint in_cell = hn::Add(hn::Mul(d.across.entry, u32(e_.height + 1 + p_.rows)),
                                   hn::Add(first, d.up.entry));
      d.up = select_lanes(p_.patch_row_cdf, in_cell, hn::Sub(end, first), d.up.fraction);
      d.up.entry = hn::Add(first, d.up.entry);
    }
    for (std::size_t i = 0; i < count_; ++i) {
      Draw& d = draws_[i];
      const Uint first = gather(p_.patch_column, d.across.entry);
      const Uint end = gather(p_.patch_column, hn::Add(d.across.entry, one));
      const Uint in_row = hn::Add(hn::Mul(d.up.entry, u32(e_.width + 1)), first);
      d.across = select_lanes(e_.column_cdf, in_row, hn::Sub(end, first), d.across.fraction);
      d.across.entry = hn::Add(first, d.across.entry);
      d.probability = d.probability * (d.up.probability * d.across.probability);
      const TexelRows rows(e_, d.up.entry);
      for (const Uint& row : {rows.low, rows.high}) {
        const Uint texel = hn::Add(hn::Mul(row, u32(e_.width)), d.across.entry);
        switch (e_.storage) {
          case LightStorage::kRgbe:
            fetch_soon(e_.words, texel);
            break;
          case LightStorage::kHalf:
            fetch_soon(e_.words, hn::ShiftRight<1>(hn::Mul(u32(3), texel)));
            break;
          default:
            fetch_soon(e_.texels, hn::Mul(u32(3), texel));
        }
      }
    }
  }

  HWY_INLINE EnvironmentSampleLanes sample(std::size_t i) const {
    const Draw& d = draws_[i];
    EnvironmentSampleLanes sample =
        sample_patch_lanes(e_, d.up.entry, d.across.entry, below_one_lanes(d.across.fraction),
                           below_one_lanes(d.up.fraction), d.probability);
    const Uint all = gather(p_.row_cdf, hn::Add(hn::Mul(d.bin, u32(p_.rows + 1)), u32(p_.rows)));
    const auto dark = hn::RebindMask(TagF(), hn::Eq(all, u32(0)));
    sample.pdf = hn::IfThenZeroElse(dark, sample.pdf);
    return sample;
  }

 private:
  struct Draw {
    Uint bin;
    SelectionLanes up, across;  // the fractions are the positions still to be spent
    Double probability;
  };

  const EnvironmentView& e_;
  const ProductView& p_;
  std::size_t count_ = 0;
  Draw draws_[kMost];
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
