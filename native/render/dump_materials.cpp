#include <stdexcept>

#include "render/dump.h"
#include "render/dump_programs.h"

namespace komorebi {
namespace {

void put_surface(const SurfaceProgram& surface, ProgramWriter& programs,
                 std::vector<std::uint32_t>& columns, std::vector<std::uint8_t>& lobes) {
  columns.push_back(programs.add(surface.program.get()));
  columns.push_back(static_cast<std::uint32_t>(surface.lobes.size()));
  for (const SurfaceLobe& lobe : surface.lobes) {
    lobes.push_back(lobe.transmits ? 1 : 0);
    lobes.push_back(lobe.normal != kNone ? 1 : 0);
  }
}

SurfaceProgram get_surface(ProgramReader& programs, const std::uint32_t* columns,
                           const std::vector<std::uint8_t>& lobes, std::size_t& next) {
  if (columns[0] == 0) return {};
  std::vector<SurfaceProgram::LobeInput> inputs;
  for (std::uint32_t i = 0; i < columns[1]; ++i, next += 2) {
    if (next + 1 >= lobes.size()) throw std::runtime_error("the scene has too few lobes");
    inputs.push_back({lobes[next] != 0, lobes[next + 1] != 0});
  }
  return {programs.program(columns[0]), inputs};
}

/// Camera: program and number of lobes; bounce: likewise; transparency to light rays.
constexpr std::size_t kSurfaceColumns = 5;

void put_surfaces(ArrayFile& file, const SceneTables& tables, ProgramWriter& programs) {
  const std::size_t n = tables.surfaces.size();
  std::vector<std::uint32_t> columns;
  std::vector<std::uint8_t> lobes;
  for (const Material& material : tables.surfaces) {
    put_surface(material.camera, programs, columns, lobes);
    put_surface(material.bounce, programs, columns, lobes);
    columns.push_back(programs.add(material.clear.get()));
  }
  file.put<std::uint32_t>("material/surface", columns, {n, kSurfaceColumns});
  file.put<std::uint8_t>("material/lobes", lobes, {lobes.size() / 2, 2});
  const std::size_t random = tables.instance_random.size();
  if (random > 0) file.put<float>("instance/random", tables.instance_random, {random});
}

std::vector<Material> get_surfaces(const ArrayFile& file, ProgramReader& programs) {
  const auto columns = file.get<std::uint32_t>("material/surface");
  const auto lobes = file.get<std::uint8_t>("material/lobes");
  std::vector<Material> surfaces(columns.size() / kSurfaceColumns);
  std::size_t next = 0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const std::uint32_t* const row = &columns[kSurfaceColumns * i];
    surfaces[i].camera = get_surface(programs, row, lobes, next);
    surfaces[i].bounce = get_surface(programs, row + 2, lobes, next);
    surfaces[i].clear = programs.program(row[4]);
  }
  return surfaces;
}

bool tells_nothing(const SceneTables& tables) {
  return tables.surfaces.empty() && !tables.lifts_rays() && !tables.cuts_cosines();
}

}  // namespace

void put_tables(ArrayFile& file, const Scene& scene, ProgramWriter& programs) {
  const SceneTables& tables = scene.tables();
  if (const std::uint32_t world = programs.add(scene.world_program())) {
    file.put_value<std::uint32_t>("world/program", world);
    file.put_value<float>("world/program_max", scene.world_program_max());
  }
  if (tells_nothing(tables)) return;
  std::vector<float> objects, materials;
  for (const ObjectInfo& o : tables.objects) {
    objects.insert(objects.end(), {o.terminator_cutoff, o.terminator_frequency, o.pass_index,
                                   o.color.x, o.color.y, o.color.z, o.alpha});
  }
  for (const MaterialInfo& material : tables.materials) materials.push_back(material.pass_index);
  file.put<float>("object/info", objects, {tables.objects.size(), 7});
  if (tables.surfaces.empty()) return;
  file.put<float>("material/pass_index", materials, {materials.size()});
  file.put<std::uint32_t>("material/slot_begin", tables.slot_begin, {tables.slot_begin.size()});
  file.put<std::uint32_t>("material/slots", tables.slots, {tables.slots.size()});
  put_surfaces(file, tables, programs);
}

void get_tables(const ArrayFile& file, Scene& scene, ProgramReader& programs) {
  if (file.has("world/program")) {
    scene.set_world_program(programs.program(file.get_value<std::uint32_t>("world/program")),
                            file.get_value<float>("world/program_max"));
  }
  if (!file.has("object/info")) return;
  const auto objects = file.get<float>("object/info");
  SceneTables tables;
  for (std::size_t i = 0; i + 6 < objects.size(); i += 7) {
    const float* const row = &objects[i];
    if (!(row[0] >= 0.0f && row[0] <= 1.0f && row[1] >= 1.0f && row[1] <= 2.0f)) {
      throw std::runtime_error("the scene's array \"object/info\" has values out of range");
    }
    ObjectInfo object;
    object.terminator_cutoff = row[0];
    object.terminator_frequency = row[1];
    object.pass_index = row[2];
    object.color = Vec3(row[3], row[4], row[5]);
    object.alpha = row[6];
    tables.objects.push_back(object);
  }
  if (!file.has("material/surface")) return scene.set_tables(std::move(tables));
  for (const float pass_index : file.get<float>("material/pass_index")) {
    tables.materials.push_back({pass_index, 0});
  }
  tables.slot_begin = file.get<std::uint32_t>("material/slot_begin");
  tables.slots = file.get<std::uint32_t>("material/slots");
  scene.set_tables(std::move(tables));
  std::vector<float> random;
  if (file.has("instance/random")) {
    random = file.get<float>("instance/random", scene.instance_count());
  }
  scene.set_surfaces(get_surfaces(file, programs), std::move(random));
}

}  // namespace komorebi
