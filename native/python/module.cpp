#include <OpenImageIO/oiioversion.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <mutex>
#include <thread>

#include "bvh/traverse.h"
#include "python/bind.h"
#include "render/film.h"

namespace komorebi::python {
namespace {

std::string dotted(int major, int minor, int patch) {
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

py::dict build_info() {
  py::dict libraries;
  libraries["OpenImageIO"] = OIIO_VERSION_STRING;
  libraries["GLM"] = dotted(GLM_VERSION_MAJOR, GLM_VERSION_MINOR, GLM_VERSION_PATCH);
  libraries["Highway"] = KOMOREBI_HIGHWAY_VERSION;
  libraries["pybind11"] =
      dotted(PYBIND11_VERSION_MAJOR, PYBIND11_VERSION_MINOR, PYBIND11_VERSION_MICRO);
  py::dict info;
  info["version"] = KOMOREBI_VERSION;
  info["compiler"] = __VERSION__;
  info["instruction_sets"] = built_instruction_sets();
  info["active_instruction_set"] = active_instruction_set();
  info["libraries"] = libraries;
  return info;
}

py::dict pass_channels() {
  py::dict channels;
  for (const PassDesc& pass : known_passes()) channels[pass.name] = pass.channels;
  return channels;
}

}  // namespace

std::shared_ptr<ThreadPool> build_pool(unsigned threads) {
  static std::mutex mutex;
  static std::shared_ptr<ThreadPool> kept;
  const unsigned wanted = threads ? threads : std::max(1u, std::thread::hardware_concurrency());
  const std::lock_guard lock(mutex);
  if (!kept || kept->size() != wanted) kept = std::make_shared<ThreadPool>(wanted);
  return kept;
}

const Cancel& cancel_or_never(const std::shared_ptr<Cancel>& cancel) {
  return cancel ? *cancel : Cancel::never();
}

PYBIND11_MODULE(_komorebi, module) {
  check_instruction_set();
  module.doc() = "Komorebi's native core; import komorebi_core, which says what each part does.";
  module.attr("__version__") = KOMOREBI_VERSION;
  module.def("build_info", &build_info,
             "Version, compiler, instruction sets and libraries of this build, as a dict.");
  module.def("known_passes", &pass_channels,
             "Passes that a Session can read, and their channels; a Cryptomatte's parts "
             "(CryptoObject00 and so on) beside them.");
  module.def("force_instruction_set", &force_instruction_set, py::arg("name"),
             "For tests: trace with this instruction set, '' for the best. ValueError if unknown.");
  py::register_exception<Cancelled>(module, "Cancelled", PyExc_RuntimeError);
  py::class_<Cancel, std::shared_ptr<Cancel>>(module, "Cancel",
                                              "A flag that ends long calls within 100 ms.")
      .def(py::init<>())
      .def("request", &Cancel::raise, "Asks every call that was given this flag to end.")
      .def_property_readonly("requested", &Cancel::raised);
  bind_texture(module);
  bind_shader(module);
  bind_sky(module);
  bind_scene(module);
  bind_session(module);
}

}  // namespace komorebi::python
