#include <stdexcept>

#include "io/array_file.h"
#include "render/dump.h"

namespace komorebi {
namespace {

/// Rows that an array has in a mesh (MeshAttributes).
std::size_t kept_rows(const Mesh& mesh, AttributeDomain domain) {
  const std::size_t primitives = mesh.primitive_count();
  if (domain == AttributeDomain::kFace) return primitives;
  if (mesh.round()) return mesh.round()->point_count();
  return domain == AttributeDomain::kCorner ? 3 * primitives : mesh.vertex_count();
}

/// Rows of segments → of curves; one without segments has no row of its own anywhere.
std::vector<float> of_curves(const float* rows, std::size_t width,
                             const std::vector<std::int32_t>& offsets) {
  std::vector<float> out;
  std::size_t segment = 0;
  for (std::size_t c = 0; c + 1 < offsets.size(); ++c) {
    const auto keys = static_cast<std::size_t>(offsets[c + 1] - offsets[c]);
    for (std::size_t k = 0; k < width; ++k) {
      out.push_back(keys > 1 ? rows[width * segment + k] : 0.0f);
    }
    segment += keys > 0 ? keys - 1 : 0;
  }
  return out;
}

}  // namespace

void put_attributes(ArrayFile& file, const std::string& mesh_key, const Mesh& mesh) {
  if (mesh.attributes() == nullptr) return;
  std::size_t index = 0;
  for (const AttributeView& view : mesh.attributes()->views()) {
    const std::string key = mesh_key + "attribute/" + std::to_string(index++) + "/";
    const std::size_t width = view.components;
    std::vector<float> rows;
    const RoundGeometry* const round = mesh.round();
    if (round != nullptr && round->kind == PrimitiveKind::kCurve &&
        view.domain == AttributeDomain::kFace) {
      rows = of_curves(view.data, width, round->curve_offsets());
    } else {
      rows.assign(view.data, view.data + width * kept_rows(mesh, view.domain));
    }
    file.put_text(key + "name", view.name);
    file.put_value<std::uint32_t>(key + "domain", static_cast<std::uint32_t>(view.domain));
    file.put<float>(key + "rows", rows, {rows.size() / width, width});
  }
}

DumpedAttributes::DumpedAttributes(const ArrayFile& file, const std::string& mesh_key) {
  for (std::size_t index = 0;; ++index) {
    const std::string key = mesh_key + "attribute/" + std::to_string(index) + "/";
    if (!file.has(key + "name")) break;
    const auto& shape = file.array(key + "rows").shape;
    AttributeInput input;
    input.name = file.get_text(key + "name");
    const auto domain = file.get_value<std::uint32_t>(key + "domain");
    if (shape.size() != 2 || shape[1] < 1 || shape[1] > 4 || domain > 2) {
      throw std::runtime_error("the scene's attribute \"" + input.name + "\" has a wrong shape");
    }
    input.domain = static_cast<AttributeDomain>(domain);
    input.components = static_cast<std::uint32_t>(shape[1]);
    rows_.push_back(file.get<float>(key + "rows"));
    inputs_.push_back(std::move(input));
  }
  for (std::size_t i = 0; i < inputs_.size(); ++i) inputs_[i].data = rows_[i];
}

}  // namespace komorebi
