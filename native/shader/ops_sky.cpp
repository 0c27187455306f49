#include "shader/op_table.h"
#include "shader/sky_radiance.h"

namespace komorebi {
namespace {

template <class F>
void map_directions(const OpCall& c, F f) {
  for (std::uint32_t i = 0; i < c.count; ++i) {
    const Vec3 color = f(Vec3(c.in[0][i], c.in[1][i], c.in[2][i]));
    for (int k = 0; k < 3; ++k) c.out[k][i] = color[k];
  }
}

// in: direction; out: linear Rec.709. sky.h makes numbers and table.
constexpr OpInfo kOps[] = {
    {"sky_preetham",
     [](const OpCall& c) {
       map_directions(c, [&](const Vec3& d) { return preetham_radiance(c.numbers, d); });
     },
     3, 3, kPreethamNumbers},
    {"sky_hosek",
     [](const OpCall& c) {
       map_directions(c, [&](const Vec3& d) { return hosek_radiance(c.numbers, d); });
     },
     3, 3, kHosekNumbers},
    {"sky_scattering",
     [](const OpCall& c) {
       const ScatteringSky sky(c.numbers, c.table);
       map_directions(c, [&](const Vec3& d) { return sky.radiance(d); });
     },
     3, 3, kScatteringNumbers, true},
};

}  // namespace

std::span<const OpInfo> sky_ops() {
  return kOps;
}

}  // namespace komorebi
