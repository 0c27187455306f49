#include "python/arrays.h"
#include "python/bind.h"
#include "render/scene.h"

namespace komorebi::python {
namespace {

void add_lamp(Scene& scene, const std::string& kind, const py::object& radiance,
              const py::object& matrix, const std::string& name, bool casts_shadow,
              bool lights_catchers, bool spot_scales_by_cosine, const py::kwargs& numbers) {
  const std::string what = "lamp \"" + name + "\": ";
  LampInput lamp;
  lamp.name = name;
  lamp.kind = lamp_kind_from_name(kind);
  const auto rgb = view<double>(radiance, what + "radiance", {3});
  lamp.radiance = Vec3d(rgb[0], rgb[1], rgb[2]);
  lamp.world_from_lamp = matrix4(view<double>(matrix, what + "matrix", {4, 4}).data());
  if (!casts_shadow) lamp.flags |= kLampNoShadow;
  if (!lights_catchers) lamp.flags |= kLampSkipsCatcher;
  lamp.spot_scales_by_cosine = spot_scales_by_cosine;
  std::size_t known = 0;
  for_each_lamp_number(lamp, [&](const char* number, double& value) {
    if (!numbers.contains(number)) return;
    value = py::float_(numbers[number]);
    ++known;
  });
  if (known != numbers.size()) {
    throw std::invalid_argument(what + "it was given a number that no lamp has");
  }
  scene.add_lamp(std::move(lamp));
}

}  // namespace

void bind_lamps(py::class_<Scene, std::shared_ptr<Scene>>& scene) {
  scene
      .def("add_lamp", &add_lamp, py::arg("kind"), py::arg("radiance"), py::arg("matrix"),
           py::kw_only(), py::arg("name") = "", py::arg("casts_shadow") = true,
           py::arg("lights_catchers") = true, py::arg("spot_scales_by_cosine") = false,
           R"(Light that World Light has besides the world.

kind: SUN (even over a cone of directions), TANGENT_SUN (even over a disk on the plane that touches
the directions), DIRECTION (parallel; radiance is irradiance across the rays), SPHERE, DISK (turned
to what it lights), POINT (radiance is radiant intensity), RECTANGLE, ELLIPSE (both shine along −z).
radiance: float64 [3], linear Rec. 709, may be negative. matrix: world from lamp, float64 [4, 4],
M @ p; a sun stands along +z. By name, float: radius (metres, not scaled by the matrix), angle
(radians across a sun), size_u and size_v (metres along x and y before the matrix), spread (radians
across, of an area; 0: parallel rays), spot_angle (radians across a cone around −z; 0: none),
spot_blend (0 to 1), falloff_power (0, 1 or 2) and falloff_smooth (square metres): light is
multiplied by d^power · d² / (d² + smooth) at a distance d; max_bounces (after more of them it
lights nothing). lights_catchers: whether it is there where shadow catchers are lit alone.
Raises ValueError naming the lamp.)")
      .def_property_readonly("lamp_count", [](const Scene& s) { return s.lamp_inputs().size(); });
}

}  // namespace komorebi::python
