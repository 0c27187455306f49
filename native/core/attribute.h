#pragma once

#include "core/curve.h"

namespace komorebi {

/// What a named array is at a hit, as Cycles has it: of a triangle by the weights of its corners,
/// of a curve's keys straight from key to key, else one row. One component counts as three, and the
/// fourth (alpha, or a tangent's sign) is 1 unless there are four.
inline glm::vec4 attribute_at(const MeshView& mesh, const AttributeView& attribute,
                              std::uint32_t primitive, float u, float v) {
  const std::uint32_t width = attribute.components;
  float sum[4] = {0.0f, 0.0f, 0.0f, 1.0f};
  const auto row = [&](std::size_t i) { return attribute.data + i * width; };
  const auto between = [&](const float* a, const float* b, const float* c, float of_b, float of_c) {
    const float of_a = (1.0f - of_b) - of_c;
    for (std::uint32_t k = 0; k < width; ++k) {
      sum[k] = (of_a * a[k] + of_b * b[k]) + of_c * c[k];
    }
  };
  const std::size_t first = 3 * std::size_t{primitive};
  if (attribute.domain == AttributeDomain::kCorner) {
    between(row(first), row(first + 1), row(first + 2), u, v);
  } else if (attribute.domain == AttributeDomain::kVertex && mesh.kind == PrimitiveKind::kCurve) {
    const std::size_t key = mesh.segment2key[primitive] & kKeyMask;
    between(row(key), row(key + 1), row(key + 1), u, 0.0f);
  } else if (attribute.domain == AttributeDomain::kVertex && !is_round(mesh.kind)) {
    const std::uint32_t* three = mesh.tri2vtx + first;
    between(row(three[0]), row(three[1]), row(three[2]), u, v);
  } else {
    const float* own = row(primitive);
    for (std::uint32_t k = 0; k < width; ++k) sum[k] = own[k];
  }
  if (width == 1) sum[1] = sum[2] = sum[0];
  return {sum[0], sum[1], sum[2], sum[3]};
}

/// The attribute of that name, or null.
inline const AttributeView* find_attribute(const MeshView& mesh, const char* name) {
  for (std::uint32_t i = 0; i < mesh.attribute_count; ++i) {
    const char *a = mesh.attributes[i].name, *b = name;
    while (*a != '\0' && *a == *b) ++a, ++b;
    if (*a == *b) return mesh.attributes + i;
  }
  return nullptr;
}

}  // namespace komorebi
