#include "python/arrays.h"
#include "python/attribute_input.h"
#include "python/bind.h"
#include "render/mesh.h"

namespace komorebi::python {
namespace {

CurveShape shape_from_name(const std::string& name) {
  if (name == "RIBBONS") return CurveShape::kRibbon;
  if (name == "THICK") return CurveShape::kThick;
  if (name == "THICK_LINEAR") return CurveShape::kThickLinear;
  throw std::invalid_argument("the shape of curves must be RIBBONS, THICK or THICK_LINEAR, not " +
                              name);
}

/// What stands of the other times; `what` names the object, `rows` counts its keys or points.
RoundMotion motion_of(const std::string& what, std::size_t rows, const py::object& positions,
                      const py::object& radii, const py::object& steps) {
  const auto count = static_cast<py::ssize_t>(rows);
  return {optional_view<float>(positions, what + "motion_positions", {-1, count, 3}),
          optional_view<float>(radii, what + "motion_radii", {-1, count}),
          optional_view<float>(steps, what + "step_positions", {2, count, 3})};
}

std::shared_ptr<Mesh> from_curves(const std::string& name, const py::object& positions,
                                  const py::object& radii, const py::object& curve_offsets,
                                  const std::string& shape, std::uint32_t subdivisions,
                                  const py::object& curve_materials, const py::object& curve_uvs,
                                  const py::object& motion_positions,
                                  const py::object& motion_radii, const py::object& step_positions,
                                  const std::string& builder, unsigned threads,
                                  const std::shared_ptr<Cancel>& cancel,
                                  const py::object& attributes) {
  const std::string curves = "curves \"" + name + "\": ";
  CurvesInput input;
  input.name = name;
  input.key2xyz = view<float>(positions, curves + "positions", {-1, 3});
  input.key2radius = view<float>(radii, curves + "radii", {-1});
  input.curve_offsets = view<std::int32_t>(curve_offsets, curves + "curve_offsets", {-1});
  input.shape = shape_from_name(shape);
  input.subdivisions = subdivisions;
  input.curve2material =
      optional_view<std::int32_t>(curve_materials, curves + "curve_materials", {-1});
  input.curve2uv = optional_view<float>(curve_uvs, curves + "curve_uvs", {-1, 2});
  input.motion =
      motion_of(curves, input.key2xyz.size() / 3, motion_positions, motion_radii, step_positions);
  input.attributes = attributes_of(attributes, curves);
  const Builder kind = builder_from_name(builder);
  const py::gil_scoped_release release;
  return std::const_pointer_cast<Mesh>(
      Mesh::build(input, kind, *build_pool(threads), cancel_or_never(cancel)));
}

std::shared_ptr<Mesh> from_points(const std::string& name, const py::object& positions,
                                  const py::object& radii, const py::object& motion_positions,
                                  const py::object& motion_radii, const py::object& step_positions,
                                  const std::string& builder, unsigned threads,
                                  const std::shared_ptr<Cancel>& cancel,
                                  const py::object& attributes) {
  const std::string points = "points \"" + name + "\": ";
  PointsInput input;
  input.name = name;
  input.point2xyz = view<float>(positions, points + "positions", {-1, 3});
  input.point2radius = view<float>(radii, points + "radii", {-1});
  input.motion =
      motion_of(points, input.point2xyz.size() / 3, motion_positions, motion_radii, step_positions);
  input.attributes = attributes_of(attributes, points);
  const Builder kind = builder_from_name(builder);
  const py::gil_scoped_release release;
  return std::const_pointer_cast<Mesh>(
      Mesh::build(input, kind, *build_pool(threads), cancel_or_never(cancel)));
}

}  // namespace

void bind_round(py::class_<Mesh, std::shared_ptr<Mesh>>& mesh) {
  mesh.def_static("from_curves", &from_curves,
                  R"(Hair and other curves, Catmull–Rom splines through their keys.

positions: float32 [K, 3], object space, metres. radii: float32 [K], not negative. curve_offsets:
int32 [C + 1], first key of each curve. shape: RIBBONS, flat and turned to every ray, of
2**subdivisions + 1 pieces a segment, THICK, round, or THICK_LINEAR, round and straight from key to
key. curve_materials: int32 [C], material slots; None: all the first. curve_uvs: float32 [C, 2],
where each grows, for the UV pass.
motion_positions: float32 [2k, K, 3], positions at the other times of the shutter in their order; all
with `positions` in the middle are at even times from its opening to its closing. motion_radii:
float32 [2k, K] likewise; None if radii do not change. step_positions: float32 [2, K, 3], positions a
step of time before and after, which the Vector pass of a shutter that stays shut compares; the
curves themselves stand still. attributes: {name: (domain, float32 [rows, 1 to 4])}, domain POINT or
CURVE with a row a key or curve; what is not finite counts as 0 (see warnings). Raises ValueError naming the curves and how many entries are wrong,
Cancelled.)",
                  py::arg("name"), py::arg("positions"), py::arg("radii"), py::arg("curve_offsets"),
                  py::kw_only(), py::arg("shape") = "RIBBONS", py::arg("subdivisions") = 2,
                  py::arg("curve_materials") = py::none(), py::arg("curve_uvs") = py::none(),
                  py::arg("motion_positions") = py::none(), py::arg("motion_radii") = py::none(),
                  py::arg("step_positions") = py::none(), py::arg("builder") = "LINEAR",
                  py::arg("threads") = 0, py::arg("cancel") = std::shared_ptr<Cancel>(),
                  py::arg("attributes") = py::none());
  mesh.def_static("from_points", &from_points,
                  "Spheres. positions: float32 [N, 3], object space, metres; radii: float32 [N], "
                  "not negative. motion_positions, motion_radii, step_positions and attributes "
                  "(of domain POINT) are as those of from_curves, and so is what it raises.",
                  py::arg("name"), py::arg("positions"), py::arg("radii"), py::kw_only(),
                  py::arg("motion_positions") = py::none(), py::arg("motion_radii") = py::none(),
                  py::arg("step_positions") = py::none(), py::arg("builder") = "LINEAR",
                  py::arg("threads") = 0, py::arg("cancel") = std::shared_ptr<Cancel>(),
                  py::arg("attributes") = py::none());
}

}  // namespace komorebi::python
