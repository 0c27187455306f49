// surface_point (core/surface_point.h) and terminator (light.h) for many hits, a lane a hit, to the
// bit; see lanes-inl.h.

HWY_BEFORE_NAMESPACE();
namespace komorebi {
namespace HWY_NAMESPACE {
namespace {

/// What the points of some hits are worked out from, fetched hit by hit.
struct HitLanes {
  static constexpr std::size_t kLanes = HWY_MAX_BYTES / sizeof(double);
  enum {
    kCorners = 0,  // nine floats each
    kNormals = 9,
    kLocalFromWorld = 18,
    kWorldFromLocal = 27,
    kPosition = 36,  // three
    kOrigin = 39,
    kDirection = 42,
    kU = 45,
    kV = 46,
    kCutoff = 47,  // of the object's terminator; 0 where the triangle is flat
    kFrequency = 48,
    kFields = 49
  };
  alignas(64) float fields[kFields][kLanes];
  alignas(64) std::uint32_t smooth[kLanes];
  alignas(64) std::uint32_t stretched[kLanes];

  HWY_INLINE void put(int field, const float* values, std::size_t count, std::size_t lane) {
    for (std::size_t i = 0; i < count; ++i) {
      fields[static_cast<std::size_t>(field) + i][lane] = values[i];
    }
  }

  /// Corners and, if there are any, normals of a triangle that moves.
  HWY_NOINLINE void put_moving(const MeshView& mesh, std::uint32_t triangle, float time,
                               std::size_t lane) {
    const Corners at = detail::triangle_corners(mesh, triangle, time);
    const Corners normals = mesh.normals ? corner_normals(mesh, triangle, time) : Corners{};
    for (int k = 0; k < 3; ++k) {
      put(kCorners + 3 * k, &at.corner[k].x, 3, lane);
      put(kNormals + 3 * k, &normals.corner[k].x, 3, lane);
    }
  }

  /// False for a curve, a sphere or a mesh that is stretched and deforms: nothing is fetched.
  HWY_INLINE bool fetch(const RenderContext& context, const SurfaceBlock& block, std::uint32_t path,
                        std::size_t lane) {
    const Hit& hit = block.hits[path];
    InstanceView room;
    const InstanceView& instance =
        instance_at(context.scene, hit.instance, block.rays.time[path], room);
    const MeshView& mesh = context.scene.meshes[instance.mesh];
    const bool moves = mesh.kind == PrimitiveKind::kMovingTriangle;
    if (is_round(mesh.kind) || (moves && mesh.stretched)) return false;
    const std::size_t first = 3 * std::size_t{hit.primitive};
    if (HWY_UNLIKELY(moves)) put_moving(mesh, hit.primitive, block.rays.time[path], lane);
    const bool is_smooth = mesh.normals && (!mesh.tri2smooth || mesh.tri2smooth[hit.primitive]);
    for (std::size_t k = 0; k < 3 && !moves; ++k) {
      const int corner = 3 * static_cast<int>(k);
      put(kCorners + corner, mesh.vtx2xyz + 3 * std::size_t{mesh.tri2vtx[first + k]}, 3, lane);
      if (is_smooth) {
        put(kNormals + corner, mesh.normals + 3 * std::size_t{mesh.tri2normal[first + k]}, 3, lane);
      }
    }
    smooth[lane] = is_smooth;
    stretched[lane] = is_smooth ? mesh.stretched : 0;
    if (context.has_terminators) {
      const ObjectInfo object = context.tables->object(instance.object_index);
      fields[kCutoff][lane] = is_smooth ? object.terminator_cutoff : 0.0f;
      fields[kFrequency][lane] = object.terminator_frequency;
    }
    put(kLocalFromWorld, entries(instance.local_from_world), 9, lane);
    put(kWorldFromLocal, entries(instance.world_from_local), 9, lane);
    put(kPosition, &instance.position.x, 3, lane);
    const RaySpan& rays = block.rays;
    const float ray[8] = {rays.origin_x[path],
                          rays.origin_y[path],
                          rays.origin_z[path],
                          rays.direction_x[path],
                          rays.direction_y[path],
                          rays.direction_z[path],
                          hit.u,
                          hit.v};
    put(kOrigin, ray, 8, lane);
    return true;
  }

  HWY_INLINE Float load(int field) const { return hn::Load(TagF(), fields[field]); }
  HWY_INLINE Vec3Lanes vector(int field) const {
    return {load(field), load(field + 1), load(field + 2)};
  }
  HWY_INLINE Mat3Lanes matrix(int field) const {
    return {{vector(field), vector(field + 3), vector(field + 6)}};
  }
};

/// x where 0 < x < most, `most` above, 0 below and for a NaN.
HWY_INLINE Double limited(Double x, Double most) {
  return hn::IfThenElseZero(hn::Gt(x, f64(0.0)), hn::IfThenElse(hn::Lt(x, most), x, most));
}

/// detail::meet_triangle; where it is false, null barycentrics and false.
HWY_INLINE hn::Mask<TagD> meet_triangle_lanes(const Vec3dLanes& origin, const Vec3dLanes& direction,
                                              const Vec3dLanes& a, const Vec3dLanes& ab,
                                              const Vec3dLanes& ac, Double& u, Double& v) {
  const Double one = f64(1.0);
  const Vec3dLanes p = cross(direction, ac);
  const Double determinant = dot(ab, p);
  const Vec3dLanes from_a = difference(origin, a);
  u = limited(dot(from_a, p) / determinant, one);
  v = limited(dot(direction, cross(from_a, ab)) / determinant, one - u);
  return hn::Ne(determinant, f64(0.0));
}

HWY_INLINE Double edge_margin_lanes(const Vec3dLanes& ab, const Vec3dLanes& ac, Double error) {
  const auto larger = [](Double x, Double y)
                          HWY_ATTR { return hn::IfThenElse(hn::Lt(x, y), y, x); };
  const Vec3dLanes bc = difference(ac, ab);
  const Double longest = hn::Sqrt(larger(dot(ab, ab), larger(dot(ac, ac), dot(bc, bc))));
  const Vec3dLanes normal = cross(ab, ac);
  const Double margin = f64(2.0) * error * longest / hn::Sqrt(dot(normal, normal));
  return hn::IfThenElse(hn::Lt(margin, f64(0.125)), margin, f64(0.125));
}

HWY_INLINE hn::Mask<TagF> nonzero(const std::uint32_t (&words)[HitLanes::kLanes]) {
  return hn::RebindMask(TagF(), hn::Gt(hn::Load(TagU(), words), hn::Zero(TagU())));
}

/// The interpolated normal in world space, of any length.
HWY_INLINE Vec3Lanes blended_normal(const HitLanes& hit, const Mat3Lanes& local_from_world,
                                    Float hit_u, Float hit_v) {
  const Float w = (f32(1.0f) - hit_u) - hit_v;
  const auto blend = [&](const Vec3Lanes& a, const Vec3Lanes& b, const Vec3Lanes& c) HWY_ATTR {
    return sum(sum(scaled(w, a), scaled(hit_u, b)), scaled(hit_v, c));
  };
  const Vec3Lanes a = hit.vector(HitLanes::kNormals), b = hit.vector(HitLanes::kNormals + 3),
                  c = hit.vector(HitLanes::kNormals + 6);
  const Vec3Lanes normal = transposed_times(local_from_world, blend(a, b, c));
  const auto stretched = nonzero(hit.stretched);
  if (hn::AllFalse(TagF(), stretched)) return normal;
  const auto turned = [&](const Vec3Lanes& n) HWY_ATTR {
    const Float zero = f32(0.0f);
    return unit_or(transposed_times(local_from_world, n), {zero, zero, zero});
  };
  return if_then_else(stretched, blend(turned(a), turned(b), turned(c)), normal);
}

HWY_INLINE void store(const Vec3Lanes& v, float* const (&columns)[3], std::size_t i) {
  hn::StoreU(v.x, TagF(), columns[0] + i);
  hn::StoreU(v.y, TagF(), columns[1] + i);
  hn::StoreU(v.z, TagF(), columns[2] + i);
}

HWY_INLINE void finish_terminators(const HitLanes& hit, const Mat3Lanes& world_from_local,
                                   const Mat3Lanes& local_from_world, const Vec3Lanes& geometric,
                                   const SurfaceBlock& block, std::size_t to) {
  const Float zero = f32(0.0f);
  Float cutoff = hit.load(HitLanes::kCutoff);
  Vec3Lanes lift{zero, zero, zero};
  if (!hn::AllFalse(TagF(), hn::Gt(cutoff, zero))) {
    const Vec3Lanes corner[3] = {hit.vector(HitLanes::kCorners), hit.vector(HitLanes::kCorners + 3),
                                 hit.vector(HitLanes::kCorners + 6)};
    const Vec3Lanes normal[3] = {hit.vector(HitLanes::kNormals), hit.vector(HitLanes::kNormals + 3),
                                 hit.vector(HitLanes::kNormals + 6)};
    const Vec3Lanes smooth =
        smooth_lift_lanes(corner, normal, world_from_local, local_from_world,
                          hit.load(HitLanes::kU), hit.load(HitLanes::kV), geometric);
    lift = if_then_else(hn::Gt(cutoff, zero), smooth, lift);
    const auto none =
        hn::And(hn::And(hn::Eq(lift.x, zero), hn::Eq(lift.y, zero)), hn::Eq(lift.z, zero));
    cutoff = hn::IfThenElse(hn::Or(none, hn::Not(hn::Gt(cutoff, zero))), zero, cutoff);
  }
  store(lift, block.lift, to);
  hn::StoreU(cutoff, TagF(), block.cutoff + to);
  hn::StoreU(hit.load(HitLanes::kFrequency), TagF(), block.frequency + to);
}

constexpr float kGamma2 = detail::gamma(2), kGamma6 = detail::gamma(6);

HWY_INLINE void finish_points(const RenderContext& context, const HitLanes& hit,
                              const SurfaceBlock& block, std::size_t to) {
  const Mat3Lanes local_from_world = hit.matrix(HitLanes::kLocalFromWorld);
  const Mat3Lanes world_from_local = hit.matrix(HitLanes::kWorldFromLocal);
  const Vec3dLanes place = to_double(hit.vector(HitLanes::kPosition));
  const Vec3Lanes direction = hit.vector(HitLanes::kDirection);
  const Vec3dLanes a = to_double(hit.vector(HitLanes::kCorners));
  const Vec3dLanes ab = difference(to_double(hit.vector(HitLanes::kCorners + 3)), a);
  const Vec3dLanes ac = difference(to_double(hit.vector(HitLanes::kCorners + 6)), a);
  const Float hit_u = hit.load(HitLanes::kU), hit_v = hit.load(HitLanes::kV);

  const Vec3dLanes from_place = difference(to_double(hit.vector(HitLanes::kOrigin)), place);
  Double u = to_double(hit_u), v = to_double(hit_v), exact_u, exact_v;
  const auto met = meet_triangle_lanes(times(local_from_world, from_place),
                                       times(local_from_world, to_double(direction)), a, ab, ac,
                                       exact_u, exact_v);
  const Double borne_out = f64(1e-5);
  const auto exact = hn::And(met, hn::And(hn::Lt(hn::Abs(exact_u - u), borne_out),
                                          hn::Lt(hn::Abs(exact_v - v), borne_out)));
  u = hn::IfThenElse(exact, exact_u, u);
  v = hn::IfThenElse(exact, exact_v, v);
  const auto at = [&](Double s, Double t)
                      HWY_ATTR { return sum(sum(a, scaled(s, ab)), scaled(t, ac)); };
  Vec3dLanes local = at(u, v);
  Vec3dLanes relative = times(world_from_local, local);

  const Float gamma_2 = f32(kGamma2), gamma_6 = f32(kGamma6);
  const Vec3Lanes local_size = to_float(local);
  const Float largest = max_abs(local_size);
  Vec3Lanes local_error =
      scaled(gamma_2, sum(absolute(local_size), Vec3Lanes{largest, largest, largest}));
  local_error =
      sum(local_error, times(absolute(local_from_world),
                             sum(scaled(gamma_6, absolute(to_float(relative))),
                                 scaled(gamma_2, absolute(to_float(sum(relative, place)))))));

  const Double one = f64(1.0);
  const Double margin = edge_margin_lanes(ab, ac, to_double(max_abs(local_error)));
  const auto near_edge =
      hn::Or(hn::Or(hn::Lt(u, margin), hn::Lt(v, margin)), hn::Lt((one - u) - v, margin));
  const Double rest = one - f64(3.0) * margin;
  const Vec3dLanes inner = at(margin + rest * u, margin + rest * v);
  local = if_then_else(near_edge, inner, local);
  relative = times(world_from_local, local);
  const Vec3Lanes position = to_float(sum(relative, place));
  const Vec3Lanes error =
      sum(times(absolute(world_from_local), local_error), scaled(gamma_2, absolute(position)));

  const Float zero = f32(0.0f), unit = f32(1.0f);
  const Vec3Lanes along_ab = to_float(ab), along_ac = to_float(ac);
  const Vec3Lanes local_cross =
      unit_or(cross(unit_or(along_ab, along_ab), unit_or(along_ac, along_ac)), {zero, zero, unit});
  Vec3Lanes geometric =
      unit_or(transposed_times(local_from_world, local_cross), negated(direction));
  const Vec3Lanes blend = blended_normal(hit, local_from_world, hit_u, hit_v);
  Vec3Lanes normal = if_then_else(nonzero(hit.smooth), unit_or(blend, geometric), geometric);
  const auto behind = hn::Gt(dot(geometric, direction), zero);
  geometric = if_then_else(behind, negated(geometric), geometric);
  normal = if_then_else(behind, negated(normal), normal);
  const Float offset = dot(absolute(geometric), error);

  store(normal, block.normal, to);
  store(geometric, block.geometric_normal, to);
  store(sum(position, scaled(offset, geometric)), block.leaving_origin, to);
  const CameraView& camera = context.camera;
  const Vec3dLanes eye = {f64(camera.origin.x), f64(camera.origin.y), f64(camera.origin.z)};
  const Vec3dLanes gradient = {f64(camera.depth_gradient.x), f64(camera.depth_gradient.y),
                               f64(camera.depth_gradient.z)};
  const Vec3dLanes from_eye = difference(to_double(position), eye);
  const Double depth = camera.kind == CameraKind::kPanorama ? hn::Sqrt(dot(from_eye, from_eye))
                                                            : dot(from_eye, gradient);
  hn::StoreU(to_float(depth), TagF(), block.depth + to);
  if (context.has_materials) {
    store(position, block.position, to);
    hn::StoreU(offset, TagF(), block.offset + to);
  }
  if (context.has_terminators) {
    finish_terminators(hit, world_from_local, local_from_world, geometric, block, to);
  }
}

void surface_points(const RenderContext& context, const SurfaceBlock& block) {
  HitLanes hit{};
  constexpr std::size_t kLanes = HitLanes::kLanes;
  for (std::size_t i = 0; i < block.count; i += kLanes) {
    std::uint32_t others = 0;  // curves and spheres: one by one
    for (std::size_t lane = 0; lane < kLanes && i + lane < block.count; ++lane) {
      if (!hit.fetch(context, block, block.path[i + lane], lane)) others |= 1u << lane;
    }
    if (others != (1u << kLanes) - 1) finish_points(context, hit, block, i);
    for (; others != 0; others &= others - 1) {
      const auto lane = static_cast<std::uint32_t>(__builtin_ctz(others));
      surface_point_at(context, block, static_cast<std::uint32_t>(i) + lane);
    }
  }
}

}  // namespace

extern const SurfaceKernel kSurfaceKernel;
constexpr SurfaceKernel kSurfaceKernel = {&HWY_STR(HWY_NAMESPACE)[2],
                                          &surface_points};  // N_AVX2: "AVX2"

}  // namespace HWY_NAMESPACE
}  // namespace komorebi
HWY_AFTER_NAMESPACE();
