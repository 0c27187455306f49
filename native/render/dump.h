#pragma once

#include <memory>
#include <string>

#include "render/scene.h"
#include "render/settings.h"

namespace komorebi {

/// A scene with its settings, as it comes out of a dump.
struct DumpedRender {
  std::shared_ptr<Scene> scene;  ///< not yet committed
  Settings settings;
};

/// Writes everything a render needs into one file of named arrays (io/array_file.h):
///
///     mesh/N/name, vtx2xyz, origin, tri2vtx, corner2normal*, tri2smooth*, tri2material*,
///         motion_positions*, motion_corner2normal*  (MeshInput)
///     mesh/N/name, origin, keys, curve_offsets, shape, subdivisions, curve2material*  (curves)
///     mesh/N/name, origin, points  (points)
///     mesh/N/attribute/M/name, domain, rows  (AttributeInput)
///     instance/mesh, world_from_object, object_index, mask, flags, material_slots
///     instance/motion/instance*, pose_count*, poses*  of those that move (add_moving_instances)
///     object/info*  terminator's cutoff and frequency, pass_index, color, alpha (ObjectInfo)
///     material/surface*, lobes*, pass_index*, slot_begin*, slots*, instance/random*  (Material)
///     world/color  or  world/texels, world/strength, world/texture_from_world
///     world/program*, world/program_max*  (Scene::set_world_program)
///     program/N/…, texture/N/…  (dump_programs.h)
///     lamp/kind*, flags*, scales_by_cosine*, radiance*, world_from_lamp*, numbers*  (LampInput,
///         for_each_lamp_number)
///     camera/kind, clip_from_world or world_from_camera, clip_start, clip_end, resolution,
///         lens/…*, panorama/…*, stereo/…*   by the names in camera_fields.h
///     camera/motion/poses*, zoom_open, zoom_close  (CameraMotionDesc)
///     camera/shutter/curve*, rolling_duration*     (ShutterDesc)
///     settings/…   one value a setting, by its name on scene.komorebi
///
/// (* only where the scene, mesh or camera has them.) Vertices, keys and points (x, y, z, radius)
/// are relative to `origin`; matrices are column-major. Throws std::runtime_error naming the file.
void write_dump(const std::string& path, const Scene& scene, const Settings& settings);

/// Throws std::runtime_error or std::invalid_argument with a sentence naming what is wrong.
DumpedRender read_dump(const std::string& path, ThreadPool& pool, const Cancel& cancel);

/// Parts of it alone.
class ArrayFile;
class ProgramWriter;
class ProgramReader;
void put_attributes(ArrayFile& file, const std::string& mesh_key, const Mesh& mesh);
/// Owns what is read from a dump.
class DumpedAttributes {
 public:
  DumpedAttributes(const ArrayFile& file, const std::string& mesh_key);
  const std::vector<AttributeInput>& inputs() const { return inputs_; }

 private:
  std::vector<std::vector<float>> rows_;
  std::vector<AttributeInput> inputs_;
};
/// Tables of objects and materials, surfaces, and the world's program.
void put_tables(ArrayFile& file, const Scene& scene, ProgramWriter& programs);
void get_tables(const ArrayFile& file, Scene& scene, ProgramReader& programs);
void put_camera(ArrayFile& file, const CameraDesc& camera);
CameraDesc get_camera(const ArrayFile& file);
void put_lamps(ArrayFile& file, const std::vector<LampInput>& lamps);
void get_lamps(const ArrayFile& file, Scene& scene);
void put_settings(ArrayFile& file, const Settings& settings);
Settings get_settings(const ArrayFile& file);

}  // namespace komorebi
