#include "shader/color_math.h"
#include "shader/op_lanes.h"
#include "shader/op_table.h"

namespace komorebi {
namespace {

template <Vec3 (*f)(const Vec3&)>
void run_color(const OpCall& c) {
  to_vector(c, [&](std::uint32_t i) { return f(input_vector(c, 0, i)); });
}

template <Vec3 (*f)(float, const Vec3&, const Vec3&)>
void run_blend(const OpCall& c) {
  to_vector(c, [&](std::uint32_t i) {
    return f(c.in[0][i], input_vector(c, 1, i), input_vector(c, 4, i));
  });
}

// Blends are named after Blender's types. in: factor, a, b; of HSV's the colours a and b.
constexpr OpInfo kOps[] = {
    {"rgb_to_hsv", run_color<node::rgb_to_hsv>, 3, 3},
    {"hsv_to_rgb", run_color<node::hsv_to_rgb>, 3, 3},
    {"rgb_to_hsl", run_color<node::rgb_to_hsl>, 3, 3},
    {"hsl_to_rgb", run_color<node::hsl_to_rgb>, 3, 3},
    // in: colour, hue, saturation, value, factor
    {"hue_saturation",
     [](const OpCall& c) {
       to_vector(c, [&](std::uint32_t i) {
         return node::hue_saturation(input_vector(c, 0, i), c.in[3][i], c.in[4][i], c.in[5][i],
                                     c.in[6][i]);
       });
     },
     7, 3},
    {"gamma", run2<node::gamma>, 2, 1},
    {"blend_screen", run3<node::blend_screen>, 3, 1},
    {"blend_overlay", run3<node::blend_overlay>, 3, 1},
    {"blend_divide", run3<node::blend_divide>, 3, 1},
    {"blend_dodge", run3<node::blend_dodge>, 3, 1},
    {"blend_burn", run3<node::blend_burn>, 3, 1},
    {"blend_soft_light", run3<node::blend_soft_light>, 3, 1},
    {"blend_linear_light", run3<node::blend_linear_light>, 3, 1},
    {"blend_exclusion", run3<node::blend_exclusion>, 3, 1},
    {"blend_hue", run_blend<node::blend_hue>, 7, 3},
    {"blend_saturation", run_blend<node::blend_saturation>, 7, 3},
    {"blend_value", run_blend<node::blend_value>, 7, 3},
    {"blend_color", run_blend<node::blend_color>, 7, 3},
};

}  // namespace

std::span<const OpInfo> color_ops() {
  return kOps;
}

}  // namespace komorebi
