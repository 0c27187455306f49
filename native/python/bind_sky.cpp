#include <pybind11/stl.h>

#include <algorithm>
#include <array>

#include "python/arrays.h"
#include "python/bind.h"
#include "shader/sky.h"

namespace komorebi::python {
namespace {

constexpr std::pair<const char*, SkyModel> kModels[] = {
    {"PREETHAM", SkyModel::kPreetham},
    {"HOSEK_WILKIE", SkyModel::kHosek},
    {"NISHITA", SkyModel::kNishita},
    {"SINGLE_SCATTERING", SkyModel::kSingleScattering},
    {"MULTIPLE_SCATTERING", SkyModel::kMultipleScattering},
};

SkyDesc sky_from(const py::object& object) {
  SkyDesc sky;
  const auto name = object.attr("model").cast<std::string>();
  const auto* model = std::find_if(std::begin(kModels), std::end(kModels),
                                   [&](const auto& known) { return known.first == name; });
  if (model == std::end(kModels)) {
    throw std::invalid_argument("sky: the model \"" + name + "\" is not known");
  }
  sky.model = model->second;
  const auto sun = object.attr("sun_direction").cast<std::array<float, 3>>();
  sky.sun_direction = Vec3(sun[0], sun[1], sun[2]);
  const auto read = [&](const char* of, float& to) { to = object.attr(of).cast<float>(); };
  read("turbidity", sky.turbidity);
  read("ground_albedo", sky.ground_albedo);
  sky.sun_disc = object.attr("sun_disc").cast<bool>();
  read("sun_size", sky.sun_size);
  read("sun_intensity", sky.sun_intensity);
  read("sun_elevation", sky.sun_elevation);
  read("sun_rotation", sky.sun_rotation);
  read("altitude", sky.altitude);
  read("air", sky.air);
  read("aerosol", sky.aerosol);
  read("ozone", sky.ozone);
  return sky;
}

py::array_t<float> table_of(const py::object& object, unsigned threads) {
  const SkyDesc sky = sky_from(object);
  std::vector<float> table;
  {
    const py::gil_scoped_release release;
    table = sky_table(sky, *build_pool(threads));
  }
  return py::array_t<float>(static_cast<py::ssize_t>(table.size()), table.data());
}

py::tuple sun_of(const py::object& object, const py::object& table) {
  const SkySun sun = sky_sun(sky_from(object), view<float>(table, "the sky's table", {-1}));
  const auto tuple = [](const Vec3& v) { return py::make_tuple(v.x, v.y, v.z); };
  return py::make_tuple(tuple(sun.direction), sun.radius, tuple(sun.radiance));
}

}  // namespace

void bind_sky(py::module_& module) {
  module.def(
      "sky_numbers", [](const py::object& sky) { return sky_numbers(sky_from(sky)); },
      py::arg("sky"),
      R"(The numbers that the op of the sky's model takes: "sky_preetham", "sky_hosek", else
"sky_scattering". sky: an object with the fields of SkyDesc in native/shader/sky.h, its model being
PREETHAM, HOSEK_WILKIE, NISHITA, SINGLE_SCATTERING or MULTIPLE_SCATTERING.
Raises ValueError naming what is not finite.)");
  module.def(
      "sky_table", &table_of, py::arg("sky"), py::arg("threads") = 0,
      R"(The table that "sky_scattering" takes, float32 [rows · 256 · 3]. It depends on nothing
but model, sun_elevation, altitude, air, aerosol and ozone. Releases the GIL.)");
  module.def(
      "sky_sun", &sun_of, py::arg("sky"), py::arg("table"),
      R"((direction towards the sun, angular radius, radiance (r, g, b) in linear Rec.709) of an
even disc that lights as the sun's disc does; table: that of the sky.)");
}

}  // namespace komorebi::python
