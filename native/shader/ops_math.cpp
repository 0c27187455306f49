#include "shader/op_lanes.h"
#include "shader/op_table.h"
#include "shader/scalar_math.h"

namespace komorebi {
namespace {

// Named after the operations of Blender's Math node.
constexpr OpInfo kOps[] = {
    {"power", run2<node::power>, 2, 1},
    {"logarithm", run2<node::logarithm>, 2, 1},
    {"sqrt", run1<node::square_root>, 1, 1},
    {"inverse_sqrt", run1<node::inverse_sqrt>, 1, 1},
    {"absolute", run1<fn::abs>, 1, 1},
    {"exponent", run1<fn::exp>, 1, 1},
    {"minimum", run2<node::least>, 2, 1},
    {"maximum", run2<node::most>, 2, 1},
    {"less_than",
     [](const OpCall& c) { map2(c, [](float a, float b) { return a < b ? 1.0f : 0.0f; }); }, 2, 1},
    {"greater_than",
     [](const OpCall& c) { map2(c, [](float a, float b) { return a > b ? 1.0f : 0.0f; }); }, 2, 1},
    {"sign", run1<node::sign>, 1, 1},
    {"compare", run3<node::compare>, 3, 1},
    {"smooth_min", run3<node::smooth_min>, 3, 1},
    {"smooth_max", run3<node::smooth_max>, 3, 1},
    {"multiply_add",
     [](const OpCall& c) { map3(c, [](float a, float b, float x) { return a * b + x; }); }, 3, 1},
    {"round", [](const OpCall& c) { map1(c, [](float x) { return fn::floor(x + 0.5f); }); }, 1, 1},
    {"floor", run1<fn::floor>, 1, 1},
    {"ceil", run1<fn::ceil>, 1, 1},
    {"trunc", run1<fn::trunc>, 1, 1},
    {"truncate", run1<fn::trunc>, 1, 1},
    {"fract", run1<fn::fract>, 1, 1},
    {"modulo", run2<node::modulo>, 2, 1},
    {"floored_modulo", run2<node::floored_modulo>, 2, 1},
    {"snap", run2<node::snap>, 2, 1},
    {"wrap", run3<node::wrap>, 3, 1},
    {"pingpong", run2<node::ping_pong>, 2, 1},
    {"sine", run1<fn::sin>, 1, 1},
    {"cosine", run1<fn::cos>, 1, 1},
    {"tangent", run1<fn::tan>, 1, 1},
    {"arcsine", run1<node::arcsine>, 1, 1},
    {"arccosine", run1<node::arccosine>, 1, 1},
    {"arctangent", run1<fn::atan>, 1, 1},
    {"arctan2", run2<fn::atan2>, 2, 1},
    {"sinh", run1<fn::sinh>, 1, 1},
    {"cosh", run1<fn::cosh>, 1, 1},
    {"tanh", run1<fn::tanh>, 1, 1},
    // in: x, lowest, highest
    {"clamp", run3<node::clamp>, 3, 1},
    {"smoothstep", run1<node::smoothstep>, 1, 1},
    {"smootherstep", run1<node::smootherstep>, 1, 1},
};

}  // namespace

std::span<const OpInfo> math_ops() {
  return kOps;
}

}  // namespace komorebi
