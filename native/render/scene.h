#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bvh/instance_tree.h"
#include "core/camera.h"
#include "core/environment.h"
#include "core/motion_vector.h"
#include "render/camera.h"
#include "render/environment.h"
#include "render/instance_motion.h"
#include "render/lamps.h"
#include "render/mesh.h"
#include "render/origin.h"
#include "render/scene_tables.h"
#include "shader/program.h"

namespace komorebi {

class MaterialFilter;  // render/material_filter.h

/// One placement of a mesh. `world_from_object` is in metres from Blender's world origin.
struct InstanceInput {
  std::uint32_t mesh = 0;
  Mat4d world_from_object{1.0};
  std::uint32_t object_index = 0;
  std::uint32_t mask = kMaskAll;
  std::uint32_t flags = 0;
  std::uint32_t material_slots = 0;  ///< which list of SceneTables
};

/// Meshes, instances, world and camera; filled, then committed once, then read only.
///
/// Commit moves world space (in double), so that floats are fine where the picture is, wherever in
/// the world the artist has put it: to the point of the scene's bounds nearest to the camera, on a
/// grid of 1/256 of their length, so that a camera that moves a little does not move the world.
/// Without a camera, to their middle.
class Scene {
 public:
  Scene();

  std::uint32_t add_mesh(std::shared_ptr<const Mesh> mesh);
  /// Throws std::invalid_argument when a matrix is not finite or no affine map, naming `name`.
  void add_instances(std::span<const InstanceInput> instances, const std::string& name);
  /// The same for instances that move while the shutter is open: world_from_object is that at rest.
  /// Between poses they go Cycles' way (core/motion.h). One that is flat at rest stays there.
  /// @param poses  world from object, of each instance as many (an odd number, at least 3) at even
  ///               times from the opening to the closing, the middle one world_from_object itself
  void add_moving_instances(std::span<const InstanceInput> instances, std::span<const Mat4d> poses,
                            const std::string& name);
  /// Uniform radiance, linear Rec.709, finite and not negative.
  void set_world_color(const Vec3& radiance);
  void set_world_environment(std::shared_ptr<const Environment> environment, double strength,
                             const Mat3d& texture_from_world);
  /// What is seen behind the scene, of which the two above are what lights it: three outputs,
  /// radiance. std::invalid_argument if there are not three.
  /// @param max_radiance  a bound of what is too small to be found (a sun's disc)
  void set_world_program(std::shared_ptr<const Program> program, float max_radiance = 0.0f);
  void set_camera(const CameraDesc& camera);
  /// Of a scene without a camera, whose sessions bring their own: where the first of them looks
  /// from. Positions are floats from an origin that commit chooses by the eye; without one it is
  /// the middle of the scene.
  void set_eye(const CameraDesc& camera);
  /// Throws std::invalid_argument naming the lamp when a number of it is out of range.
  void add_lamp(LampInput lamp);
  /// Throws std::invalid_argument when lists of slots name what is not there.
  void set_tables(SceneTables tables);
  /// Which hits count on instances that have a see-through material among their slots; what the
  /// filter reads outlives the scene.
  /// @param see_through  [materials of the tables], not 0: the filter is asked
  /// commit throws std::invalid_argument if there are not as many.
  void set_hit_filter(const HitFilter& filter, std::vector<std::uint8_t> see_through);

  /// What surfaces look like, a material of the tables each; after set_tables.
  /// @param instance_random  of each instance a number from 0 to 1, or none at all
  /// std::invalid_argument when their number is not that of the tables.
  void set_surfaces(std::vector<Material> surfaces, std::vector<float> instance_random);

  /// Builds the tree over instances. Throws Cancelled; after it the scene can only be dropped.
  /// @param keep_inputs  for inputs(); else what was added is given back, 152 bytes an instance
  void commit(ThreadPool& pool, const Cancel& cancel, bool keep_inputs = true);
  bool committed() const { return committed_; }

  const SceneView& view() const { return view_; }
  const CameraView& camera() const { return camera_; }
  const CameraDesc& camera_desc() const { return camera_desc_; }
  bool has_camera() const { return has_camera_; }
  EnvironmentView environment() const;
  bool world_is_uniform() const { return !environment_; }
  const SceneTables& tables() const { return tables_; }
  /// Whether an instance is a shadow catcher: known when the instances are.
  bool has_catchers() const { return has_catchers_; }
  /// Whether an instance is seen by one alone of diffuse and shadow rays; known as early.
  bool splits_light_rays() const { return splits_light_rays_; }
  /// Whether everything is taken at rest (ShutterDesc::still), and the next two say what moves.
  bool is_still() const { return has_camera_ && camera_desc_.shutter.still; }
  const FilmSteps& film_steps() const { return film_steps_; }
  StepsView steps() const;
  /// An upper bound of the radiance that the world sends along any ray.
  float max_radiance() const;
  /// Those that were added, once the scene is committed.
  const LampTable& lamps() const { return lamps_; }
  const std::vector<LampInput>& lamp_inputs() const { return lamp_inputs_; }
  /// About the most that one camera sample brings by lamps: LampTable::max_radiance where they are
  /// nearer than a thousandth of the scene's length.
  float max_lamp_radiance() const {
    return lamps_.max_radiance(static_cast<float>(1e-3 * length_), static_cast<float>(length_));
  }

  const Vec3d& origin() const { return origin_; }
  /// Whether commit would choose an origin for this camera that is more than OriginGrid::kFarSteps
  /// from the one that is: what the camera sees close by is coarser than it could be.
  bool is_far_from_origin(const CameraDesc& camera) const;
  const std::vector<std::shared_ptr<const Mesh>>& meshes() const { return meshes_; }
  /// What was added, for whoever writes it down; throws std::invalid_argument if commit has given
  /// it back.
  const std::vector<InstanceInput>& inputs() const;
  /// Poses of those of inputs() that move, in their order.
  struct MovingInput {
    std::uint32_t instance, pose_count;
    std::size_t first_pose;  ///< in poses()
  };
  const std::vector<MovingInput>& moving_inputs() const { return moving_inputs_; }
  const std::vector<Mat4d>& poses() const { return poses_; }
  std::uint64_t triangle_count() const;  ///< counted once an instance
  std::uint32_t instance_count() const {
    return static_cast<std::uint32_t>(instances_.empty() ? inputs_.size() : instances_.size());
  }
  std::uint32_t invisible_count() const { return invisible_count_; }  ///< scaled to a line or point
  std::size_t byte_count() const;

  const Vec3& world_color() const { return world_color_; }
  const std::shared_ptr<const Environment>& world_environment() const { return environment_; }
  double world_strength() const { return strength_; }
  const Mat3d& texture_from_world() const { return texture_from_world_; }
  const Program* world_program() const { return world_program_.get(); }
  float world_program_max() const { return world_program_max_; }

 private:
  void require_open() const;
  void choose_origin();
  void place(const InstanceInput& input, std::span<const Mat4d> poses, ThreadPool& pool,
             const Cancel& cancel);
  void add_steps(std::span<const Mat4d> poses, const Vec3d& mesh_origin);
  void filter_by_materials();
  void mark_filtered();
  void view_meshes();
  void build_tree(ThreadPool& pool, const Cancel& cancel);

  bool committed_ = false;
  bool has_camera_ = false;
  bool has_catchers_ = false;
  bool splits_light_rays_ = false;
  std::vector<std::shared_ptr<const Mesh>> meshes_;
  std::vector<InstanceInput> inputs_;
  std::vector<MovingInput> moving_inputs_;
  std::vector<Mat4d> poses_;
  bool inputs_gone_ = false;
  Vec3 world_color_{0.0f};
  std::shared_ptr<const Environment> environment_;
  double strength_ = 1.0;
  std::shared_ptr<const Program> world_program_;
  float world_program_max_ = 0.0f;
  float emission_max_ = 0.0f;  // of surfaces, as far as is known
  Mat3d texture_from_world_{1.0};
  CameraDesc camera_desc_;
  SceneTables tables_;
  HitFilter hit_filter_;
  std::shared_ptr<MaterialFilter> material_filter_;  // null: nothing is see-through
  std::vector<std::uint8_t> see_through_;            // of tables_.materials
  std::vector<LampInput> lamp_inputs_;

  Vec3d origin_{0.0};
  OriginGrid origins_;
  std::optional<Vec3d> eye_;
  double length_ = 1.0;  // of the bounds' longest side
  LampTable lamps_;
  std::vector<std::shared_ptr<const Mesh>> traced_meshes_;  // meshes_, then the flattened ones
  std::vector<MeshView> mesh_views_;
  std::vector<InstanceView> instances_;
  MotionTable motion_;
  std::vector<InstanceSteps> steps_;
  std::vector<std::uint32_t> instance2steps_;  // empty: all stand still
  std::vector<const float*> mesh_steps_;       // of traced_meshes_; empty: not asked
  std::uint32_t invisible_count_ = 0;
  InstanceTree tree_;
  CameraTables camera_tables_;
  CameraView camera_;
  FilmSteps film_steps_;
  SceneView view_;
};

}  // namespace komorebi
