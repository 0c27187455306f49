#include <algorithm>
#include <stdexcept>

#include "render/material_filter.h"
#include "render/scene.h"

namespace komorebi {

void Scene::set_hit_filter(const HitFilter& filter, std::vector<std::uint8_t> see_through) {
  require_open();
  hit_filter_ = filter;
  see_through_ = std::move(see_through);
}

void Scene::filter_by_materials() {
  std::vector<std::uint8_t> see_through;
  bool any = false;
  for (const Material& material : tables_.surfaces) {
    see_through.push_back(material.clear ? 1 : 0);
    any = any || material.clear;
  }
  if (!any) return;
  material_filter_ = std::make_shared<MaterialFilter>();
  hit_filter_ = material_filter_->hit_filter();
  see_through_ = std::move(see_through);
}

void Scene::mark_filtered() {
  if (!hit_filter_.exists()) return;
  if (see_through_.size() != tables_.materials.size()) {
    throw std::invalid_argument("which materials are see-through is said of " +
                                std::to_string(see_through_.size()) + " of " +
                                std::to_string(tables_.materials.size()));
  }
  std::vector<std::uint8_t> of_list;  // of slots
  for (std::size_t l = 0; l + 1 < tables_.slot_begin.size(); ++l) {
    const auto slots =
        std::span(tables_.slots)
            .subspan(tables_.slot_begin[l], tables_.slot_begin[l + 1] - tables_.slot_begin[l]);
    of_list.push_back(std::ranges::any_of(
        slots, [&](std::uint32_t material) { return see_through_[material] != 0; }));
  }
  for (InstanceView& instance : instances_) {
    if (instance.material_slots >= of_list.size() || !of_list[instance.material_slots]) continue;
    instance.filtered = 1;
    view_.filter = hit_filter_;
  }
}

}  // namespace komorebi
