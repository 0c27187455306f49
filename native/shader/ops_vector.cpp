#include "shader/op_table.h"
#include "shader/vector_math.h"

namespace komorebi {
namespace {

Vec3 vector(const OpCall& c, std::uint32_t first, std::uint32_t lane) {
  return Vec3(c.in[first][lane], c.in[first + 1][lane], c.in[first + 2][lane]);
}

// f(lane) → a vector
template <class F>
void to_vector(const OpCall& c, F f) {
  for (std::uint32_t i = 0; i < c.count; ++i) {
    const Vec3 v = f(i);
    for (int k = 0; k < 3; ++k) c.out[k][i] = v[k];
  }
}

// f(lane) → a number
template <class F>
void to_number(const OpCall& c, F f) {
  for (std::uint32_t i = 0; i < c.count; ++i) c.out[0][i] = f(i);
}

constexpr OpInfo kOps[] = {
    {"normalize",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) { return node::safe_normalize(vector(c, 0, i)); });
     },
     3, 3},
    {"length",
     [](const OpCall& c) {
       to_number(c, [&](std::uint32_t i) { return node::length(vector(c, 0, i)); });
     },
     3, 1},
    {"cross_product",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) { return cross(vector(c, 0, i), vector(c, 3, i)); });
     },
     6, 3},
    // in: a, b; a's part along b
    {"project",
     [](const OpCall& c) {
       to_vector(c,
                 [&](std::uint32_t i) { return node::project(vector(c, 0, i), vector(c, 3, i)); });
     },
     6, 3},
    // in: a, normal
    {"reflect",
     [](const OpCall& c) {
       to_vector(c,
                 [&](std::uint32_t i) { return node::reflect(vector(c, 0, i), vector(c, 3, i)); });
     },
     6, 3},
    // in: a, normal, ratio of the indices of refraction
    {"refract",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         return node::refract(vector(c, 0, i), node::unit(vector(c, 3, i)), c.in[6][i]);
       });
     },
     7, 3},
    // in: a, incident, reference
    {"faceforward",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         const Vec3 a = vector(c, 0, i);
         return dot(vector(c, 6, i), vector(c, 3, i)) < 0.0f ? a : -a;
       });
     },
     9, 3},
    // in: vector, centre, axis, angle
    {"rotate_axis",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         const Vec3 centre = vector(c, 3, i), axis = vector(c, 6, i);
         if (node::length(axis) == 0.0f) return vector(c, 0, i);
         return node::rotate(vector(c, 0, i) - centre, node::unit(axis), c.in[9][i]) + centre;
       });
     },
     10, 3},
    // in: vector, Euler angles; numbers: 1 for the rotation back
    {"rotate_euler",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         return node::rotate_euler(vector(c, 0, i), vector(c, 3, i), c.numbers[0] != 0.0f);
       });
     },
     6, 3, 1},
    // in: vector; numbers: a matrix of 3 rows and 4 columns
    {"transform",
     [](const OpCall& c) {
       const float* m = c.numbers;
       to_vector(c, [&](std::uint32_t i) {
         const Vec3 v = vector(c, 0, i);
         return Vec3(m[0] * v.x + m[1] * v.y + m[2] * v.z + m[3],
                     m[4] * v.x + m[5] * v.y + m[6] * v.z + m[7],
                     m[8] * v.x + m[9] * v.y + m[10] * v.z + m[11]);
       });
     },
     3, 3, 12},
    // in: vector, the object's X, Y and Z axes in the world
    {"from_axes",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         const Vec3 v = vector(c, 0, i);
         return vector(c, 3, i) * v.x + vector(c, 6, i) * v.y + vector(c, 9, i) * v.z;
       });
     },
     12, 3},
    // The way back.
    {"to_axes",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         return node::solve(vector(c, 3, i), vector(c, 6, i), vector(c, 9, i), vector(c, 0, i));
       });
     },
     12, 3},
    // in: a normal of the object, its axes; a normal of the world, not of unit length
    {"normal_from_axes",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         return node::normal_from_axes(vector(c, 3, i), vector(c, 6, i), vector(c, 9, i),
                                       vector(c, 0, i));
       });
     },
     12, 3},
    // in: a normal of the world, the object's axes; a normal of the object, not of unit length
    {"normal_to_axes",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         const Vec3 n = vector(c, 0, i);
         return Vec3(dot(vector(c, 3, i), n), dot(vector(c, 6, i), n), dot(vector(c, 9, i), n));
       });
     },
     12, 3},
};

}  // namespace

std::span<const OpInfo> vector_ops() {
  return kOps;
}

}  // namespace komorebi
