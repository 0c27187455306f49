#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <utility>

#include "parallel/cancel.h"
#include "parallel/thread_pool.h"
#include "texture/sampling.h"

namespace komorebi {
class Mesh;
class Scene;
}  // namespace komorebi

namespace komorebi::python {

namespace py = pybind11;

// One function a part of the module, each in a file of its own.
void bind_environment(py::module_& module);
void bind_scene(py::module_& module);
void bind_session(py::module_& module);
void bind_shader(py::module_& module);
void bind_sky(py::module_& module);
void bind_texture(py::module_& module);

/// Curves and points, which Mesh holds too.
void bind_round(py::class_<Mesh, std::shared_ptr<Mesh>>& mesh);

/// The named arrays of a mesh.
void bind_attributes(py::class_<Mesh, std::shared_ptr<Mesh>>& mesh);
/// Blender's names of a node's interpolation and extension; std::invalid_argument.
Interpolation interpolation_from_name(const std::string& name);
Extension extension_from_name(const std::string& name);
/// What Scene has of lamps.
void bind_lamps(py::class_<Scene, std::shared_ptr<Scene>>& scene);

/// A pool for a build: `threads` of Blender's scene, 0 for one a core. One pool is kept from call
/// to call, because starting threads costs more than a small mesh's build.
std::shared_ptr<ThreadPool> build_pool(unsigned threads);

/// None gives a flag that nobody raises.
const Cancel& cancel_or_never(const std::shared_ptr<Cancel>& cancel);

/// What _image's function `reader` gives for these arguments: a capsule with a `T`, which stays
/// its own. Throws Cancelled.
template <class T, class... Arguments>
std::pair<py::capsule, T*> read_image_file(const char* reader, const Cancel& cancel,
                                           const Arguments&... arguments) {
  const py::object read =
      py::module_::import("komorebi_core._image").attr(reader)(arguments..., py::capsule(&cancel));
  if (read.is_none()) throw Cancelled();
  auto owner = read.cast<py::capsule>();
  T* const content = owner.get_pointer<T>();
  return {std::move(owner), content};
}

}  // namespace komorebi::python
