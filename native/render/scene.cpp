#include "render/scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "render/material_filter.h"

namespace komorebi {
namespace {

/// Beyond this ratio of longest to shortest stretch, single precision can no longer take a ray into
/// an object's space and back; the object's triangles are transformed instead.
constexpr double kMaxCondition = 1e7;

bool is_affine(const Mat4d& m) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      // A float must be able to hold it too.
      if (!(std::abs(m[c][r]) <= 1e30)) return false;
    }
  }
  return m[0][3] == 0.0 && m[1][3] == 0.0 && m[2][3] == 0.0 && m[3][3] == 1.0;
}

double frobenius(const Mat3d& m) {
  return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

bool invertible(const Mat3d& m, Mat3d& inverse) {
  inverse = glm::inverse(m);
  const double condition = frobenius(m) * frobenius(inverse);
  return condition <= kMaxCondition;  // false for the NaN of a singular matrix
}

/// Turned, mirrored and scaled alike along all axes, but for roundings.
bool keeps_shapes(const Mat3d& m) {
  const Mat3d gram = glm::transpose(m) * m;
  const double mean = (gram[0][0] + gram[1][1] + gram[2][2]) / 3.0;
  double most = 0.0;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      most = std::max(most, std::abs(gram[c][r] - (c == r ? mean : 0.0)));
    }
  }
  return most <= 1e-5 * mean;
}

void check_world(const Vec3& radiance, const char* what) {
  for (int c = 0; c < 3; ++c) {
    if (!(radiance[c] >= 0.0f && radiance[c] <= 1e30f)) {
      throw std::invalid_argument(std::string(what) + " must be finite and not negative");
    }
  }
}

}  // namespace

Scene::Scene() = default;

void Scene::require_open() const {
  if (committed_) throw std::invalid_argument("the scene is committed and cannot be changed");
}

std::uint32_t Scene::add_mesh(std::shared_ptr<const Mesh> mesh) {
  require_open();
  if (!mesh) throw std::invalid_argument("add_mesh needs a mesh");
  meshes_.push_back(std::move(mesh));
  return static_cast<std::uint32_t>(meshes_.size() - 1);
}

void Scene::add_instances(std::span<const InstanceInput> instances, const std::string& name) {
  require_open();
  std::size_t bad = 0;
  for (const InstanceInput& instance : instances) {
    if (instance.mesh >= meshes_.size()) {
      throw std::invalid_argument("instances of \"" + name + "\": there is no mesh " +
                                  std::to_string(instance.mesh));
    }
    bad += !is_affine(instance.world_from_object);
  }
  if (bad) {
    throw std::invalid_argument("instances of \"" + name + "\": " + std::to_string(bad) +
                                (bad == 1 ? " matrix is" : " matrices are") +
                                " not finite or not affine");
  }
  if (inputs_.size() + instances.size() >= kNone) {
    throw std::invalid_argument("more instances than 32-bit indices can count");
  }
  for (const InstanceInput& i : instances) {
    has_catchers_ |= (i.flags & kInstanceShadowCatcher) != 0;
    splits_light_rays_ |= !(i.mask & kMaskDiffuse) != !(i.mask & kMaskShadow);
  }
  inputs_.insert(inputs_.end(), instances.begin(), instances.end());
}

void Scene::add_moving_instances(std::span<const InstanceInput> instances,
                                 std::span<const Mat4d> poses, const std::string& name) {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument("instances of \"" + name + "\": " + what);
  };
  if (instances.empty()) return require_open();
  const std::size_t count = poses.size() / instances.size();
  if (count * instances.size() != poses.size() || count < 3 || count % 2 == 0 || count > 4097) {
    refuse("their poses in time must be 3 to 4097, an odd number");
  }
  std::vector<MovingInput> moving;
  const std::size_t before = inputs_.size();
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const auto own = poses.subspan(i * count, count);
    for (const Mat4d& pose : own) {
      if (!is_affine(pose)) refuse("a pose is not finite or not affine");
    }
    if (own[count / 2] != instances[i].world_from_object) {
      refuse("the middle one of the poses in time is not that at rest");
    }
    if (std::ranges::count(own, own[0]) == static_cast<std::ptrdiff_t>(count)) continue;
    moving.push_back({static_cast<std::uint32_t>(before + i), static_cast<std::uint32_t>(count),
                      poses_.size() + count * moving.size()});
  }
  add_instances(instances, name);
  for (const MovingInput& input : moving) {
    const auto own = poses.subspan((input.instance - before) * count, count);
    poses_.insert(poses_.end(), own.begin(), own.end());
  }
  moving_inputs_.insert(moving_inputs_.end(), moving.begin(), moving.end());
  if (moving_inputs_.size() >= kNoMotion) refuse("too many instances that move");
}

const std::vector<InstanceInput>& Scene::inputs() const {
  if (inputs_gone_) {
    throw std::invalid_argument("the scene was committed without keeping what was added to it");
  }
  return inputs_;
}

void Scene::set_world_color(const Vec3& radiance) {
  require_open();
  check_world(radiance, "the world's colour times its strength");
  world_color_ = radiance;
  environment_.reset();
}

void Scene::set_world_environment(std::shared_ptr<const Environment> environment, double strength,
                                  const Mat3d& texture_from_world) {
  require_open();
  if (!environment) throw std::invalid_argument("set_world_environment needs an environment");
  environment->view(strength, texture_from_world);  // refuses what is no rotation
  environment_ = std::move(environment);
  strength_ = strength;
  texture_from_world_ = texture_from_world;
}

void Scene::set_camera(const CameraDesc& camera) {
  require_open();
  // Refuses what cannot be inverted.
  [[maybe_unused]] const CameraTables refused(camera, Vec3d(0.0), make_camera(camera, Vec3d(0.0)));
  camera_desc_ = camera;
  has_camera_ = true;
}

void Scene::set_eye(const CameraDesc& camera) {
  require_open();
  eye_ = make_camera(camera, Vec3d(0.0)).origin;
}

void Scene::add_lamp(LampInput lamp) {
  require_open();
  check_lamp(lamp);
  lamp_inputs_.push_back(std::move(lamp));
}

void Scene::set_tables(SceneTables tables) {
  require_open();
  const auto& begin = tables.slot_begin;
  const bool covers = begin.empty() ? tables.slots.empty()
                                    : begin.front() == 0 && begin.back() == tables.slots.size();
  if (!covers || !std::is_sorted(begin.begin(), begin.end())) {
    throw std::invalid_argument("the lists of material slots do not cover the slots in order");
  }
  if (tables.values.size() != tables.materials.size() * tables.value_count) {
    throw std::invalid_argument("material values must have a row a material");
  }
  for (const float value : tables.values) {
    if (!(value >= -1e30f && value <= 1e30f)) {
      throw std::invalid_argument("a material value is not finite or beyond 1e30");
    }
  }
  for (const std::uint32_t material : tables.slots) {
    if (material >= tables.materials.size()) {
      throw std::invalid_argument("a material slot names material " + std::to_string(material) +
                                  " of " + std::to_string(tables.materials.size()));
    }
  }
  tables_ = std::move(tables);
}

EnvironmentView Scene::environment() const {
  return environment_ ? environment_->view(strength_, texture_from_world_)
                      : constant_environment(world_color_);
}

StepsView Scene::steps() const {
  return {steps_.data(), instance2steps_.empty() ? nullptr : instance2steps_.data(),
          mesh_steps_.empty() ? nullptr : mesh_steps_.data()};
}

void Scene::place(const InstanceInput& input, std::span<const Mat4d> poses, ThreadPool& pool,
                  const Cancel& cancel) {
  std::shared_ptr<const Mesh> mesh = meshes_[input.mesh];
  InstanceView instance;
  instance.mesh = input.mesh;
  instance.mask = input.mask & kMaskRays;
  if (input.flags & kInstanceShadowCatcher) {
    instance.mask |= (input.mask & kMaskRays) << kMaskCatcherShift;
  }
  instance.flags = input.flags & 3u;
  instance.object_index = input.object_index;
  instance.material_slots = input.material_slots & 0x7fffffffu;
  Mat3d linear(input.world_from_object);
  Mat3d inverse;
  Vec3d position = Vec3d(input.world_from_object[3]);
  if (invertible(linear, inverse)) {
    position += linear * mesh->origin();
  } else {
    poses = {};
    mesh = mesh->flattened(input.world_from_object, pool, cancel);
    invisible_count_ += mesh->bounds().is_empty();
    instance.mesh = static_cast<std::uint32_t>(traced_meshes_.size());
    traced_meshes_.push_back(mesh);
    linear = inverse = Mat3d(1.0);
    position = mesh->origin();
  }
  instance.world_from_local = Mat3(linear);
  instance.local_from_world = Mat3(inverse);
  instance.position = Vec3(position - origin_);
  place_instance(instance, mesh->bounds());
  if (!poses.empty() && is_still()) {
    add_steps(poses, mesh->origin());
  } else if (!poses.empty()) {
    motion_.add(static_cast<std::uint32_t>(instances_.size()), instance, poses, mesh->origin(),
                mesh->bounds(), origin_);
  }
  instances_.push_back(instance);
}

void Scene::add_steps(std::span<const Mat4d> poses, const Vec3d& mesh_origin) {
  const auto map = [&](const Mat4d& pose) {
    const Mat3d linear(pose);
    return AffineMap{linear, Vec3d(pose[3]) - origin_ + linear * mesh_origin};
  };
  instance2steps_.resize(inputs_.size(), kNone);
  instance2steps_[instances_.size()] = static_cast<std::uint32_t>(steps_.size());
  steps_.push_back({map(poses.front()), map(poses[poses.size() / 2]), map(poses.back())});
}

void Scene::choose_origin() {
  Vec3d lo(1e300), hi(-1e300);
  const auto include = [&](const Mesh& mesh, const Mat4d& matrix) {
    const Aabb& box = mesh.bounds();
    if (box.is_empty()) return;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3d local(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                        corner & 4 ? box.hi.z : box.lo.z);
      const Vec3d world(matrix * glm::dvec4(local + mesh.origin(), 1.0));
      lo = glm::min(lo, world);
      hi = glm::max(hi, world);
    }
  };
  for (const InstanceInput& input : inputs_) include(*meshes_[input.mesh], input.world_from_object);
  for (const MovingInput& input : moving_inputs_) {
    if (is_still()) break;
    for (std::uint32_t i = 0; i < input.pose_count; ++i) {
      include(*meshes_[inputs_[input.instance].mesh], poses_[input.first_pose + i]);
    }
  }
  if (!(lo.x <= hi.x)) return;  // nothing to see: the origin stays
  origin_ = 0.5 * (lo + hi);
  const Vec3d extent = hi - lo;
  const double longest = std::max({extent.x, extent.y, extent.z});
  if (!(longest > 0.0)) return;
  length_ = longest;
  origins_ = OriginGrid(lo, hi);
  if (has_camera_) eye_ = make_camera(camera_desc_, Vec3d(0.0)).origin;
  if (eye_) origin_ = origins_.nearest(*eye_);
}

bool Scene::is_far_from_origin(const CameraDesc& camera) const {
  return origins_.is_far(make_camera(camera, Vec3d(0.0)).origin, origin_);
}

void Scene::build_tree(ThreadPool& pool, const Cancel& cancel) {
  std::vector<Aabb> boxes;
  boxes.reserve(instances_.size() + motion_.groups.size());
  for (const InstanceView& instance : instances_) {
    boxes.push_back(instance.motion == kNoMotion ? instance.world_bounds : Aabb{});
  }
  boxes.insert(boxes.end(), motion_.group_boxes.begin(), motion_.group_boxes.end());
  // Behind each leaf stands a whole tree: the better builder pays from the first rays on.
  tree_ = build_instance_tree(boxes, Builder::kSah, pool, cancel);
  std::vector<Aabb>().swap(motion_.group_boxes);
}

void Scene::view_meshes() {
  for (const auto& mesh : traced_meshes_) mesh_views_.push_back(mesh->view());
  // What no ray sees does not count, as in Cycles.
  std::vector<std::uint8_t> users(mesh_views_.size(), 0);
  for (const InstanceView& instance : instances_) {
    std::uint8_t& count = users[instance.mesh];
    if (instance.mask != 0 && count < 2) ++count;
  }
  for (const InstanceView& instance : instances_) {
    if (instance.mask == 0 || instance.motion != kNoMotion || users[instance.mesh] != 1) continue;
    mesh_views_[instance.mesh].stretched = !keeps_shapes(Mat3d(instance.world_from_local));
  }
}

void Scene::commit(ThreadPool& pool, const Cancel& cancel, bool keep_inputs) {
  require_open();
  committed_ = true;
  choose_origin();
  lamps_ = LampTable(lamp_inputs_, origin_);

  traced_meshes_ = meshes_;
  instances_.reserve(inputs_.size());
  auto moving = moving_inputs_.begin();
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (i % 4096 == 0 && cancel.raised()) throw Cancelled();
    std::span<const Mat4d> poses;
    if (moving != moving_inputs_.end() && moving->instance == i) {
      poses = std::span(poses_).subspan(moving->first_pose, moving->pose_count);
      ++moving;
    }
    place(inputs_[i], poses, pool, cancel);
  }
  if (!keep_inputs) {
    std::vector<InstanceInput>().swap(inputs_);
    std::vector<MovingInput>().swap(moving_inputs_);
    std::vector<Mat4d>().swap(poses_);
    inputs_gone_ = true;
  }
  filter_by_materials();
  mark_filtered();
  view_meshes();
  build_tree(pool, cancel);
  if (has_camera_) {
    camera_ = make_camera(camera_desc_, origin_);
    camera_tables_ = CameraTables(camera_desc_, origin_, camera_);
    camera_tables_.lend(camera_);
    film_steps_ = make_film_steps(camera_desc_, origin_, camera_);
  }

  view_.meshes = mesh_views_.data();
  view_.mesh_count = static_cast<std::uint32_t>(mesh_views_.size());
  view_.instances = instances_.data();
  view_.instance_count = static_cast<std::uint32_t>(instances_.size());
  view_.tree = tree_.view();
  view_.leaf2instance = tree_.leaf2instance.data();
  view_.motions = motion_.motions.data();
  view_.motion_keys = motion_.keys.data();
  view_.motion_groups = motion_.groups.data();
  view_.motion_group_count = static_cast<std::uint32_t>(motion_.groups.size());
  view_.moves = !motion_.groups.empty();
  for (const auto& mesh : traced_meshes_) view_.moves = view_.moves || mesh->deforms();
  if (material_filter_) material_filter_->bind(*this, pool, cancel);
  if (!is_still()) return;
  for (const auto& mesh : traced_meshes_) mesh_steps_.push_back(mesh->step_positions());
}

std::uint64_t Scene::triangle_count() const {
  std::uint64_t sum = 0;
  for (const InstanceInput& input : inputs_) sum += meshes_[input.mesh]->triangle_count();
  if (!inputs_gone_) return sum;
  for (const InstanceView& instance : instances_) {
    sum += traced_meshes_[instance.mesh]->triangle_count();
  }
  return sum;
}

std::size_t Scene::byte_count() const {
  std::size_t sum =
      sizeof(Scene) + tree_.byte_count() + instances_.capacity() * sizeof(InstanceView) +
      inputs_.capacity() * sizeof(InstanceInput) + mesh_views_.capacity() * sizeof(MeshView) +
      poses_.capacity() * sizeof(Mat4d) + moving_inputs_.capacity() * sizeof(MovingInput) +
      motion_.byte_count() + steps_.capacity() * sizeof(InstanceSteps) +
      instance2steps_.capacity() * sizeof(std::uint32_t) +
      lamp_inputs_.capacity() * sizeof(LampInput) + lamps_.byte_count();
  for (const auto& mesh : traced_meshes_.empty() ? meshes_ : traced_meshes_) {
    sum += mesh->byte_count();
  }
  if (material_filter_) sum += material_filter_->byte_count();
  return sum + (environment_ ? environment_->byte_count() : 0);
}

}  // namespace komorebi
