#include <cmath>

#include "core/environment.h"
#include "shader/op_sampling.h"
#include "shader/op_table.h"
#include "texture/texture.h"

namespace komorebi {
namespace {

void put(const OpCall& c, std::uint32_t i, const Vec4& value) {
  for (int k = 0; k < 4; ++k) c.out[k][i] = value[k];
}

/// in: u, v, footprint
void image(const OpCall& c) {
  const TextureSampling how = sampling_of(c.numbers);
  for (std::uint32_t i = 0; i < c.count; ++i) {
    put(c, i, c.texture->lookup(how, c.in[0][i], c.in[1][i], c.in[2][i]));
  }
}

/// What may be averaged around a place, given two places at the ends of what a ray's cone covers:
/// the shorter half axis of the ellipse between them, so that nothing is blurred more than it is
/// hidden between samples, and a seam that one of them lies beyond does not show.
/// in: place, place, place
void footprint(const OpCall& c) {
  for (std::uint32_t i = 0; i < c.count; ++i) {
    const Vec3 at(c.in[0][i], c.in[1][i], c.in[2][i]);
    const Vec3 p = Vec3(c.in[3][i], c.in[4][i], c.in[5][i]) - at;
    const Vec3 q = Vec3(c.in[6][i], c.in[7][i], c.in[8][i]) - at;
    const Vec3 area = glm::cross(p, q);
    const float half = 0.5f * (glm::dot(p, p) + glm::dot(q, q));
    const float less = 0.5f * (glm::dot(p, p) - glm::dot(q, q)), along = glm::dot(p, q);
    const float longest = half + std::sqrt(less * less + along * along);
    c.out[0][i] = longest > 0.0f ? std::sqrt(glm::dot(area, area) / longest) : 0.0f;
  }
}

/// How much each side of a box shows to a normal of which the coordinates are not negative and add
/// up to 1; sides are blended near the edges (Image Texture, projection Box).
Vec3 box_weights(const Vec3& n, float blend) {
  const float limit = 0.5f * (1.0f + blend);
  const auto share = [&](float a, float b) {
    const float w = (a / (a + b) - 0.5f * (1.0f - blend)) / blend;
    return w > 0.0f ? (w < 1.0f ? w : 1.0f) : 0.0f;
  };
  if (n.x > limit * (n.x + n.y) && n.x > limit * (n.x + n.z)) return Vec3(1.0f, 0.0f, 0.0f);
  if (n.y > limit * (n.x + n.y) && n.y > limit * (n.y + n.z)) return Vec3(0.0f, 1.0f, 0.0f);
  if (n.z > limit * (n.x + n.z) && n.z > limit * (n.y + n.z)) return Vec3(0.0f, 0.0f, 1.0f);
  if (!(blend > 0.0f)) return Vec3(1.0f, 0.0f, 0.0f);
  if (n.z < (1.0f - limit) * (n.y + n.x)) {
    const float x = share(n.x, n.y);
    return Vec3(x, 1.0f - x, 0.0f);
  }
  if (n.x < (1.0f - limit) * (n.y + n.z)) {
    const float y = share(n.y, n.z);
    return Vec3(0.0f, y, 1.0f - y);
  }
  if (n.y < (1.0f - limit) * (n.x + n.z)) {
    const float x = share(n.x, n.z);
    return Vec3(x, 0.0f, 1.0f - x);
  }
  return ((2.0f - limit) * n + Vec3(limit - 1.0f)) / (2.0f * limit - 1.0f);
}

/// in: position, normal in the object's space, footprint; numbers: sampling, blend
void image_box(const OpCall& c) {
  const TextureSampling how = sampling_of(c.numbers);
  for (std::uint32_t i = 0; i < c.count; ++i) {
    const Vec3 p(c.in[0][i], c.in[1][i], c.in[2][i]);
    const Vec3 sides(c.in[3][i], c.in[4][i], c.in[5][i]);
    const Vec3 size = glm::abs(sides);
    const float sum = size.x + size.y + size.z;
    const Vec3 w = box_weights(sum > 0.0f ? size / sum : Vec3(1.0f, 0.0f, 0.0f), c.numbers[3]);
    Vec4 value(0.0f);
    // As seen from a side the cone is narrower.
    const float width = c.in[6][i] / (sum > 0.0f ? std::sqrt(glm::dot(sides, sides)) : 1.0f);
    if (w.x > 0.0f) {
      value += w.x * c.texture->lookup(how, sides.x < 0.0f ? 1.0f - p.y : p.y, p.z, width * size.x);
    }
    if (w.y > 0.0f) {
      value += w.y * c.texture->lookup(how, sides.y > 0.0f ? 1.0f - p.x : p.x, p.z, width * size.y);
    }
    if (w.z > 0.0f) {
      value += w.z * c.texture->lookup(how, sides.z > 0.0f ? 1.0f - p.y : p.y, p.x, width * size.z);
    }
    put(c, i, value);
  }
}

/// Onto a sphere or a tube around the middle of generated coordinates; numbers: 1 for the tube.
void wrap_around(const OpCall& c) {
  for (std::uint32_t i = 0; i < c.count; ++i) {
    const Vec3 p = 2.0f * (Vec3(c.in[0][i], c.in[1][i], c.in[2][i]) - Vec3(0.5f));
    const float around = p.x * p.x + p.y * p.y;
    const float u = around > 0.0f ? 0.5f * (1.0f - atan2_radians(p.x, p.y) * kInvPi) : 0.0f;
    float v = 0.5f * (p.z + 1.0f);
    if (c.numbers[0] == 0.0f) {
      const float length = std::sqrt(around + p.z * p.z);
      v = length > 0.0f ? 1.0f - atan2_radians(std::sqrt(around), p.z) * kInvPi : 0.0f;
    }
    c.out[0][i] = u;
    c.out[1][i] = v;
  }
}

/// Where a direction lies in a picture of a mirror ball, as Cycles has it.
Vec2 mirror_ball_from_direction(const Vec3& d) {
  const float half = std::sqrt(0.5f * (1.0f - d.y) > 0.0f ? 0.5f * (1.0f - d.y) : 0.0f);
  if (!(half > 0.0f)) return Vec2(0.5f);
  return Vec2(0.5f * (d.x / (2.0f * half) + 1.0f), 0.5f * (d.z / (2.0f * half) + 1.0f));
}

/// in: direction; numbers: sampling, 1 for a mirror ball
void environment(const OpCall& c) {
  const TextureSampling how = sampling_of(c.numbers);
  for (std::uint32_t i = 0; i < c.count; ++i) {
    const Vec3 given(c.in[0][i], c.in[1][i], c.in[2][i]);
    const float length = std::sqrt(glm::dot(given, given));
    const Vec3 d = length > 0.0f ? given / length : Vec3(0.0f);
    Vec2 at(0.0f);
    if (c.numbers[3] != 0.0f) {
      at = mirror_ball_from_direction(d);
    } else if (length > 0.0f) {
      at = equirectangular_from_direction(d);
    }
    put(c, i, c.texture->lookup(how, at.x, at.y));
  }
}

constexpr OpInfo kOps[] = {
    {"footprint", footprint, 9, 1},
    {"image", image, 3, 4, 3, false, true},
    {"image_box", image_box, 7, 4, 4, false, true},
    {"wrap_around", wrap_around, 3, 2, 1},
    {"environment", environment, 3, 4, 4, false, true},
};

}  // namespace

std::span<const OpInfo> texture_ops() {
  return kOps;
}

}  // namespace komorebi
