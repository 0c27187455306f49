#include "render/lamps.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace komorebi {
namespace {

/// So few are asked one by one, which tells more of each than the balls of a tree.
constexpr std::uint32_t kFewLamps = 8;

constexpr std::pair<const char*, LampKind> kKinds[] = {
    {"SUN", LampKind::kSun},
    {"TANGENT_SUN", LampKind::kTangentSun},
    {"DIRECTION", LampKind::kDirection},
    {"SPHERE", LampKind::kSphere},
    {"DISK", LampKind::kDisk},
    {"POINT", LampKind::kPoint},
    {"RECTANGLE", LampKind::kRectangle},
    {"ELLIPSE", LampKind::kEllipse},
};

Vec3d unit(const Vec3d& v) {
  return v / std::sqrt(glm::dot(v, v));
}

/// Cycles' conversion of an area lamp's spread: the tangent of half of it, and what keeps its light
/// as much as without.
void set_spread(double spread, Lamp& lamp) {
  if (spread >= kPi) return;
  const double half = 0.5 * spread;
  const double tangent = std::tan(half);
  if (!(tangent > 0.0)) {
    lamp.spread_tangent = -1.0f;
    lamp.radiance *= kPiFloat;  // the irradiance of all of it, now that it goes one way
    return;
  }
  lamp.spread_tangent = static_cast<float>(tangent);
  lamp.spread_factor =
      static_cast<float>(half > 0.05 ? 1.0 / (tangent - half) : 3.0 / (half * half * half));
}

void set_spot(const LampInput& input, Lamp& lamp) {
  if (!(input.spot_angle > 0.0)) return;
  Mat3d inverse = glm::inverse(Mat3d(input.world_from_lamp));
  for (int c = 0; c < 3; ++c) inverse[c][2] = -inverse[c][2];
  lamp.spot.local_from_world = Mat3(inverse);
  double squares = 0.0;
  for (int c = 0; c < 3; ++c) squares += glm::dot(inverse[c], inverse[c]);
  lamp.spot.stretch = static_cast<float>(std::sqrt(squares));
  const double cosine = std::cos(0.5 * input.spot_angle);
  lamp.spot.cosine = static_cast<float>(cosine);
  lamp.spot.blend = static_cast<float>((1.0 - cosine) * input.spot_blend);
  lamp.spot.scales_by_cosine = input.spot_scales_by_cosine;
}

Lamp make_lamp(const LampInput& input, const Vec3d& origin) {
  const Mat3d axes(input.world_from_lamp);
  Lamp lamp;
  lamp.kind = input.kind;
  lamp.flags = input.flags;
  lamp.radiance = Vec3(input.radiance);
  lamp.position = Vec3(Vec3d(input.world_from_lamp[3]) - origin);
  lamp.radius = static_cast<float>(input.radius);
  lamp.max_bounces = static_cast<std::uint32_t>(input.max_bounces);
  if (!is_distant(lamp.kind)) {
    lamp.falloff.power = static_cast<std::uint32_t>(input.falloff_power);
    lamp.falloff.smooth = static_cast<float>(input.falloff_smooth);
  }
  if (is_distant(lamp.kind)) {
    lamp.direction = Vec3(unit(axes[2]));
    const double half = std::sin(0.25 * input.angle);
    lamp.one_minus_cos = static_cast<float>(2.0 * half * half);
    lamp.radius = static_cast<float>(std::tan(0.5 * input.angle));
  } else if (is_area(lamp.kind)) {
    const double u = std::sqrt(glm::dot(axes[0], axes[0])),
                 v = std::sqrt(glm::dot(axes[1], axes[1]));
    lamp.half_u = static_cast<float>(0.5 * u * input.size_u);
    lamp.half_v = static_cast<float>(0.5 * v * input.size_v);
    lamp.axis_u = Vec3(axes[0] / u);
    lamp.axis_v = Vec3(axes[1] / v);
    lamp.direction = Vec3(unit(-axes[2]));
    set_spread(input.spread, lamp);
  } else {
    set_spot(input, lamp);
  }
  return lamp;
}

/// The most that is left of a point's light from a distance on.
double most_falling(const Falloff& falloff, double distance) {
  const auto smooth = static_cast<double>(falloff.smooth);
  if (falloff.power == 2) return 1.0;
  if (falloff.power == 0) return 1.0 / (distance * distance + smooth);
  const double at = std::max(distance, std::sqrt(smooth));
  return at / (at * at + smooth);
}

}  // namespace

LampKind lamp_kind_from_name(const std::string& name) {
  for (const auto& [known, kind] : kKinds) {
    if (name == known) return kind;
  }
  throw std::invalid_argument("there is no kind of lamp \"" + name + "\"");
}

void check_lamp(const LampInput& lamp) {
  const auto require = [&](bool good, const char* what) {
    if (!good) throw std::invalid_argument("lamp \"" + lamp.name + "\": " + what);
  };
  for (int c = 0; c < 3; ++c) {
    require(std::abs(lamp.radiance[c]) <= 1e30, "its light is not finite or beyond 1e30");
  }
  const Mat4d& m = lamp.world_from_lamp;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 3; ++r) require(std::abs(m[c][r]) <= 1e30, "its matrix is not finite");
  }
  const bool has_axes = is_distant(lamp.kind) || is_area(lamp.kind) || lamp.spot_angle > 0.0;
  for (int c = 0; has_axes && c < 3; ++c) {
    require(glm::dot(Vec3d(m[c]), Vec3d(m[c])) > 0.0, "its matrix is flat");
  }
  if (lamp.spot_angle > 0.0) {
    require(std::abs(glm::determinant(Mat3d(m))) > 0.0, "its matrix is flat");
  }
  require(lamp.radius >= 0.0 && lamp.radius <= 1e30, "its radius is negative or not finite");
  const bool has_radius = lamp.kind == LampKind::kSphere || lamp.kind == LampKind::kDisk;
  require(!has_radius || lamp.radius > 0.0, "its radius must be positive");
  const bool is_sun = lamp.kind == LampKind::kSun || lamp.kind == LampKind::kTangentSun;
  require(!is_sun || (lamp.angle > 0.0 && lamp.angle <= kPi), "its angle must be in (0, π]");
  if (is_area(lamp.kind)) {
    require(lamp.size_u > 0.0 && lamp.size_v > 0.0 && lamp.size_u <= 1e30 && lamp.size_v <= 1e30,
            "its sizes must be positive");
    require(lamp.spread >= 0.0 && lamp.spread <= kPi + 1e-6, "its spread must be in [0, π]");
  }
  require(lamp.spot_angle >= 0.0 && lamp.spot_angle <= kPi + 1e-6,
          "its spot's angle must be in [0, π]");
  require(lamp.falloff_power == 0.0 || lamp.falloff_power == 1.0 || lamp.falloff_power == 2.0,
          "its falloff's power must be 0, 1 or 2");
  require(lamp.falloff_smooth >= 0.0 && lamp.falloff_smooth <= 1e30,
          "its falloff's smooth must be finite and not negative");
  require(lamp.max_bounces >= 0.0 && lamp.max_bounces <= kMostBounces,
          "its max_bounces must be 0 to 1024");
  require(lamp.spot_blend >= 0.0 && lamp.spot_blend <= 1.0, "its spot's blend must be in [0, 1]");
}

LampTable::LampTable(const std::vector<LampInput>& inputs, const Vec3d& origin) {
  lamps_.reserve(inputs.size());
  for (const LampInput& input : inputs) lamps_.push_back(make_lamp(input, origin));
  const auto placed = std::stable_partition(lamps_.begin(), lamps_.end(),
                                            [](const Lamp& lamp) { return is_distant(lamp.kind); });
  const auto count = static_cast<std::uint32_t>(lamps_.size());
  single_count_ = static_cast<std::uint32_t>(placed - lamps_.begin());
  if (count - single_count_ <= kFewLamps) {
    single_count_ = count;
    return;
  }
  nodes_.reserve(2 * std::size_t{count - single_count_});
  nodes_.emplace_back();
  grow(0, single_count_, count);
}

/// Halves the lamps where they are spread most; all of it depends on them and their order alone.
void LampTable::grow(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
  Aabb box;
  LampNode made;
  float power = 0.0f;
  for (std::uint32_t i = begin; i < end; ++i) {
    box = united(box, {lamps_[i].position, lamps_[i].position});
    power += power_of(lamps_[i]);
    made.max_bounces = std::max(made.max_bounces, lamps_[i].max_bounces);
  }
  made.centre = centre(box);
  made.power = power;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Vec3 to = lamps_[i].position - made.centre;
    made.radius = max_of(made.radius, std::sqrt(glm::dot(to, to)) + reach_of(lamps_[i]));
  }
  made.radius *= 1.00001f;  // roundings
  if (end - begin == 1) {
    made.first = begin;
    made.is_leaf = 1;
    nodes_[node] = made;
    return;
  }
  const Vec3 extent = box.hi - box.lo;
  const int axis =
      extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
  std::stable_sort(
      lamps_.begin() + begin, lamps_.begin() + end,
      [axis](const Lamp& a, const Lamp& b) { return a.position[axis] < b.position[axis]; });
  made.first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node] = made;
  nodes_.resize(nodes_.size() + 2);
  const std::uint32_t middle = begin + (end - begin) / 2;
  grow(made.first, begin, middle);
  grow(made.first + 1, middle, end);
}

LampsView LampTable::view() const {
  return {lamps_.data(), nodes_.empty() ? nullptr : nodes_.data(),
          static_cast<std::uint32_t>(lamps_.size()), single_count_};
}

float LampTable::max_radiance(float distance, float length) const {
  double sum = 0.0;
  for (const Lamp& lamp : lamps_) {
    auto most = static_cast<double>(power_of(lamp));
    if (!is_distant(lamp.kind)) {
      const double there = most * most_falling(lamp.falloff, double{distance});
      // Of a lamp with a size no more comes than fills the hemisphere.
      const double all_over =
          4.0 * static_cast<double>(max_abs(lamp.radiance)) *
          static_cast<double>(is_area(lamp.kind) ? spread_share(lamp, 1.0f) : 1.0f) *
          static_cast<double>(
              lamp.falloff.at(std::sqrt(glm::dot(lamp.position, lamp.position)) + length));
      most = lamp.kind == LampKind::kPoint ? there : std::min(there, all_over);
    }
    sum += most;
  }
  return static_cast<float>(std::min(sum, 1e25));
}

std::size_t LampTable::byte_count() const {
  return lamps_.capacity() * sizeof(Lamp) + nodes_.capacity() * sizeof(LampNode);
}

}  // namespace komorebi
