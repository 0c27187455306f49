// scatter (scatter.h) for many vertices, a lane a vertex, to the bit; see lanes-inl.h.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

template <class T>  // float or const float
HWY_INLINE Vec3Lanes load(T* const (&columns)[3], std::size_t i) {
  const TagF d;
  return {hn::LoadU(d, columns[0] + i), hn::LoadU(d, columns[1] + i), hn::LoadU(d, columns[2] + i)};
}

HWY_INLINE void store(const Vec3Lanes& v, float* const (&columns)[3], std::size_t i) {
  const TagF d;
  hn::StoreU(v.x, d, columns[0] + i);
  hn::StoreU(v.y, d, columns[1] + i);
  hn::StoreU(v.z, d, columns[2] + i);
}

/// As glm::max.
HWY_INLINE Float larger(Float x, Float y) {
  return hn::IfThenElse(hn::Lt(x, y), y, x);
}

/// path_key of a scattered ray, given PairSampler::order of its dimension.
HWY_INLINE Uint scattered_key(Uint order, Uint sample) {
  const Uint hash = hash_bits_lanes(hn::Add(sample, u32(0x9e3779b9u)));
  const Uint sum = hn::Add(hn::Add(hash, hn::ShiftLeft<6>(order)), hn::ShiftRight<2>(order));
  const Uint key = hash_bits_lanes(hn::Xor(order, sum));
  return hn::Or(hn::And(key, u32(~3u)), u32(static_cast<std::uint32_t>(PathKind::kScatter)));
}

void scatter_lanes(std::uint32_t vertex, const ScatterBlock& block) {
  const TagU du;
  const Float zero = f32(0.0f), one = f32(1.0f);
  const std::uint32_t base = kDimensionVertex + vertex * kDimensionsPerVertex;  // vertex_dimension
  const std::uint32_t roulette_hash = dimension_hash(base + kVertexRoulette);
  const std::uint32_t scatter_hash = dimension_hash(base + kVertexScatter);
  for (std::size_t i = 0; i < block.count; i += hn::Lanes(du)) {
    Vec3Lanes throughput = load(block.throughput, i);
    const Uint seed = hn::LoadU(du, block.pixel_seed + i);
    const Uint sample = hn::LoadU(du, block.sample + i);
    Uint x, y;
    const Float most = larger(larger(throughput.x, throughput.y), throughput.z);
    auto goes_on = hn::Gt(most, zero);
    if (vertex >= kSureScatters) {
      const Float root = hn::Sqrt(most);
      const Float survival = hn::IfThenElse(hn::Lt(one, root), one, root);  // glm::min
      PairSampler(seed, roulette_hash).bits(sample, x, y);
      goes_on = hn::And(goes_on, hn::Lt(to_unit_float_lanes(x), survival));
      throughput = {throughput.x / survival, throughput.y / survival, throughput.z / survival};
      store(throughput, block.throughput, i);
    }
    const PairSampler sampler(seed, scatter_hash);
    sampler.bits(sample, x, y);
    const Vec3Lanes direction =
        FrameLanes(load(block.normal, i))
            .to_world(cosine_hemisphere_disk_lanes(to_unit_float_lanes(x), to_unit_float_lanes(y)));
    goes_on = hn::And(goes_on, hn::Gt(dot(direction, load(block.geometric_normal, i)), zero));
    store(direction, block.direction, i);
    const auto goes_on_u = hn::RebindMask(du, goes_on);
    hn::StoreU(hn::IfThenElseZero(goes_on_u, u32(1)), du, block.goes_on + i);
    hn::StoreU(scattered_key(sampler.order, sample), du, block.path_key + i);
  }
}

}  // namespace

extern const ScatterKernel kScatterKernel;
constexpr ScatterKernel kScatterKernel = {&scatter_lanes};

}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
