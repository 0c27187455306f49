#include "render/material_filter.h"

#include "core/path_key.h"
#include "render/shade.h"

namespace komorebi {
namespace {

/// Whether a program needs to know more of a hit than which attributes are there; cones have no
/// part in what lets rays through.
bool asks_for_point(const Program& program) {
  for (std::uint32_t i = 0; i < kPointInputs; ++i) {
    const auto input = static_cast<PointInput>(i);
    if (input == PointInput::kConeX || input == PointInput::kConeY) continue;
    if (program.asks(input)) return true;
  }
  for (const std::string& name : program.attributes()) {
    if (asks_for_step(name)) return true;
  }
  return false;
}

}  // namespace

void MaterialFilter::bind(const Scene& scene, ThreadPool& pool, const Cancel& cancel,
                          bool has_map) {
  context_.scene = scene.view();
  context_.camera = scene.camera();
  context_.tables = &scene.tables();
  context_.origin = scene.origin();
  context_.frame_width = static_cast<float>(scene.camera_desc().width);
  context_.frame_height = static_cast<float>(scene.camera_desc().height);
  for (const Material& material : scene.tables().surfaces) clear_.emplace_back(material);
  if (!has_map) return;
  map_ = std::make_unique<const OpacityMap>(context_.scene, scene.tables(), clear_, pool, cancel);
}

namespace {

/// Hits that the same program decides on, until there are enough of them or another follows.
class PendingHits {
 public:
  void add(const RenderContext& context, const Program& program, const ShadeTask& task,
           const Ray& ray, std::uint32_t lot, bool* accepted) {
    if (&program != program_ || count_ == Program::kLanes) decide(context);
    if (count_ == 0) {
      program_ = &program;
      asks_ = asks_for_point(program);
    }
    ShadeTask& own = tasks_[count_];
    own = task;
    if (asks_) own.point = surface_point(context.scene, task.hit, ray);
    lots_[count_] = lot;
    accepted_[count_++] = accepted;
  }

  void decide(const RenderContext& context) {
    if (count_ == 0) return;
    float shares[Program::kLanes];
    shader_.clear_shares(context, *program_, tasks_, count_, shares);
    for (std::uint32_t i = 0; i < count_; ++i) {
      *accepted_[i] = to_unit_float(lots_[i]) >= shares[i];
    }
    count_ = 0;
  }

 private:
  MaterialShader shader_;
  const Program* program_ = nullptr;
  std::uint32_t count_ = 0;
  bool asks_ = false;
  ShadeTask tasks_[Program::kLanes];
  std::uint32_t lots_[Program::kLanes];
  bool* accepted_[Program::kLanes];
};

}  // namespace

void MaterialFilter::accepts(const void* user, const HitQuery* queries, std::uint32_t count,
                             bool* accepted) {
  const auto& self = *static_cast<const MaterialFilter*>(user);
  const RenderContext& context = self.context_;
  thread_local PendingHits pending;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto& [hit, ray] = queries[i];
    const std::uint32_t lot = hash_combine(hash_combine(ray.path_key, hit.instance), hit.primitive);
    if (self.map_) {
      const float drawn = to_unit_float(lot);
      const OpacityMap::Cell cell = self.map_->at(context.scene.instances[hit.instance], hit);
      accepted[i] = cell == OpacityMap::Cell::kSolid;
      if (accepted[i] && drawn >= OpacityMap::kSure) continue;
      if (cell == OpacityMap::Cell::kClear && drawn < 1.0f - OpacityMap::kSure) continue;
    }
    const PathKind kind = path_kind(ray.path_key);
    const std::uint32_t vertex = kind == PathKind::kCamera ? 0 : 1;
    const ShadeTask task =
        shade_task(context, hit, SurfacePoint{}, ray.direction, ray.time, 0, 0, vertex);
    accepted[i] = true;
    if (task.material >= self.clear_.size() || !self.clear_[task.material].exist()) continue;
    pending.add(context, self.clear_[task.material].of(kind), task, ray, lot, &accepted[i]);
  }
  pending.decide(context);
}

}  // namespace komorebi
