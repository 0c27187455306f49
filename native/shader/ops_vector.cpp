#include "shader/op_lanes.h"
#include "shader/op_table.h"
#include "shader/vector_math.h"

namespace komorebi {
namespace {

constexpr OpInfo kOps[] = {
    {"normalize",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) { return node::safe_normalize(input_vector(c, 0, i)); });
     },
     3, 3},
    {"length",
     [](const OpCall& c) {
       to_number(c, [&](std::uint32_t i) { return node::length(input_vector(c, 0, i)); });
     },
     3, 1},
    {"cross_product",
     [](const OpCall& c) {
       to_vector(
           c, [&](std::uint32_t i) { return cross(input_vector(c, 0, i), input_vector(c, 3, i)); });
     },
     6, 3},
    // in: a, b; a's part along b
    {"project",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         return node::project(input_vector(c, 0, i), input_vector(c, 3, i));
       });
     },
     6, 3},
    // in: a, normal
    {"reflect",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         return node::reflect(input_vector(c, 0, i), input_vector(c, 3, i));
       });
     },
     6, 3},
    // in: a, normal, ratio of the indices of refraction
    {"refract",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         return node::refract(input_vector(c, 0, i), node::unit(input_vector(c, 3, i)), c.in[6][i]);
       });
     },
     7, 3},
    // in: a, incident, reference
    {"faceforward",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         const Vec3 a = input_vector(c, 0, i);
         return dot(input_vector(c, 6, i), input_vector(c, 3, i)) < 0.0f ? a : -a;
       });
     },
     9, 3},
    // in: vector, centre, axis, angle
    {"rotate_axis",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         const Vec3 centre = input_vector(c, 3, i), axis = input_vector(c, 6, i);
         if (node::length(axis) == 0.0f) return input_vector(c, 0, i);
         return node::rotate(input_vector(c, 0, i) - centre, node::unit(axis), c.in[9][i]) + centre;
       });
     },
     10, 3},
    // in: vector, Euler angles; numbers: 1 for the rotation back
    {"rotate_euler",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         return node::rotate_euler(input_vector(c, 0, i), input_vector(c, 3, i),
                                   c.numbers[0] != 0.0f);
       });
     },
     6, 3, 1},
    // in: vector; numbers: a matrix of 3 rows and 4 columns
    {"transform",
     [](const OpCall& c) {
       const float* m = c.numbers;
       to_vector(c, [&](std::uint32_t i) {
         const Vec3 v = input_vector(c, 0, i);
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
         const Vec3 v = input_vector(c, 0, i);
         return input_vector(c, 3, i) * v.x + input_vector(c, 6, i) * v.y +
                input_vector(c, 9, i) * v.z;
       });
     },
     12, 3},
    // The way back.
    {"to_axes",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         return node::solve(input_vector(c, 3, i), input_vector(c, 6, i), input_vector(c, 9, i),
                            input_vector(c, 0, i));
       });
     },
     12, 3},
    // in: a normal of the object, its axes; a normal of the world, not of unit length
    {"normal_from_axes",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         return node::normal_from_axes(input_vector(c, 3, i), input_vector(c, 6, i),
                                       input_vector(c, 9, i), input_vector(c, 0, i));
       });
     },
     12, 3},
    // in: a normal of the world, the object's axes; a normal of the object, not of unit length
    {"normal_to_axes",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         const Vec3 n = input_vector(c, 0, i);
         return Vec3(dot(input_vector(c, 3, i), n), dot(input_vector(c, 6, i), n),
                     dot(input_vector(c, 9, i), n));
       });
     },
     12, 3},
};

}  // namespace

std::span<const OpInfo> vector_ops() {
  return kOps;
}

}  // namespace komorebi
