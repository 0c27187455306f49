// Builds and occlusion rays, with Embree beside where it was found; what is timed is validated
// first. The meshes are real ones: ../shared/data/meshes (or $KOMOREBI_SHARED).
#include <benchmark/benchmark.h>

#include <bit>
#include <map>
#include <memory>

#include "bench/ao_rays.h"
#include "bvh/validate.h"
#include "support/read_mesh.h"
#include "support/shared_data.h"

#ifdef KOMOREBI_EMBREE
#include "support/embree_scene.h"
#endif

namespace komorebi {
namespace {

using testing::RayList;
using testing::TestScene;
using testing::TriangleMesh;

constexpr const char* kMeshes[] = {"dragon_vrip.ply.gz", "sponza_dabrovic.ply", "bunny_hr.obj"};
constexpr std::uint32_t kSpan = 4096;  ///< rays per call, as the integrator's batches

/// One of kMeshes, read once; null and an error in `state` if it is not there.
const TriangleMesh* load(benchmark::State& state, std::size_t which) {
  static std::map<std::size_t, TriangleMesh> meshes;
  const auto path = testing::shared_folder() / "data/meshes" / kMeshes[which];
  state.SetLabel(kMeshes[which]);
  if (!std::filesystem::exists(path)) {
    state.SkipWithError(("not there: " + path.string()).c_str());
    return nullptr;
  }
  if (!meshes.contains(which)) meshes[which] = testing::read_mesh(path);
  return &meshes[which];
}

void Build(benchmark::State& state) {
  const TriangleMesh* mesh = load(state, static_cast<std::size_t>(state.range(0)));
  if (mesh == nullptr) return;
  ThreadPool pool(static_cast<unsigned>(state.range(1)));
  const Cancel cancel;
  MeshTree tree;
  for (auto _ : state) {
    tree = build_mesh_tree(mesh->vtx2xyz, mesh->tri2vtx, Builder::kLinear, pool, cancel);
    benchmark::DoNotOptimize(tree.nodes.data());
  }
  if (!validate(tree, mesh->vtx2xyz, mesh->tri2vtx).empty()) state.SkipWithError("wrong tree");
  const auto triangles = static_cast<double>(mesh->triangle_count());
  state.counters["triangles/s"] =
      benchmark::Counter(triangles, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["bytes/triangle"] = static_cast<double>(tree.byte_count()) / triangles;
}
BENCHMARK(Build)
    ->ArgsProduct({{0, 1, 2}, {1, 2}})
    ->ArgNames({"mesh", "threads"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// A scene and its rays, made once a mesh and reach.
struct Occlusion {
  std::unique_ptr<TestScene> scene;
  RayList rays;
};

const Occlusion& occlusion(const TriangleMesh& mesh, std::size_t which, float reach) {
  static std::map<std::pair<std::size_t, float>, Occlusion> cache;
  Occlusion& entry = cache[{which, reach}];
  if (!entry.scene) {
    entry.scene = std::make_unique<TestScene>(2);
    entry.scene->add_mesh(mesh);
    entry.scene->add_instance(0);
    entry.scene->commit();
    entry.rays = ambient_rays(*entry.scene, camera_rays(*entry.scene, 256), 16, reach);
  }
  return entry;
}

std::uint32_t count_bits(const std::vector<std::uint32_t>& words) {
  std::uint32_t count = 0;
  for (const std::uint32_t word : words) count += static_cast<std::uint32_t>(std::popcount(word));
  return count;
}

void Occluded(benchmark::State& state) {
  const auto which = static_cast<std::size_t>(state.range(0));
  const TriangleMesh* mesh = load(state, which);
  if (mesh == nullptr) return;
  const Occlusion& setup = occlusion(*mesh, which, static_cast<float>(state.range(1)) / 100.0f);
  const SceneView view = setup.scene->view();
  const RayList& rays = setup.rays;
  ThreadPool pool(static_cast<unsigned>(state.range(2)));
  std::vector<std::uint32_t> bits((rays.size() + 31) / 32);
  for (auto _ : state) {
    pool.for_each_chunk(rays.size(), kSpan, [&](std::size_t begin, std::size_t end) {
      occluded(
          view,
          rays.span(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end - begin)),
          bits.data() + begin / 32);
    });
  }
  for (std::uint32_t i = 0; i < rays.size(); i += 97) {
    if (((bits[i / 32] >> (i % 32)) & 1u) != (occluded_scalar(view, rays[i]) ? 1u : 0u)) {
      state.SkipWithError("a ray was answered wrongly");
    }
  }
  state.counters["rays/s"] =
      benchmark::Counter(rays.size(), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["occluded%"] = 100.0 * count_bits(bits) / rays.size();
}
BENCHMARK(Occluded)
    ->ArgsProduct({{0, 1, 2}, {0, 10}, {1, 2}})
    ->ArgNames({"mesh", "reach%", "threads"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

#ifdef KOMOREBI_EMBREE
void EmbreeOccluded(benchmark::State& state) {
  const auto which = static_cast<std::size_t>(state.range(0));
  const TriangleMesh* mesh = load(state, which);
  if (mesh == nullptr) return;
  const Occlusion& setup = occlusion(*mesh, which, static_cast<float>(state.range(1)) / 100.0f);
  const testing::EmbreeScene embree(*mesh);
  ThreadPool pool(static_cast<unsigned>(state.range(2)));
  std::vector<std::uint32_t> bits((setup.rays.size() + 31) / 32);
  for (auto _ : state) {
    pool.for_each_chunk(setup.rays.size(), kSpan, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (i % 32 == 0) bits[i / 32] = 0;
        const bool covered = embree.occluded(setup.rays[static_cast<std::uint32_t>(i)]);
        bits[i / 32] |= static_cast<std::uint32_t>(covered) << (i % 32);
      }
    });
  }
  state.counters["rays/s"] =
      benchmark::Counter(setup.rays.size(), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["occluded%"] = 100.0 * count_bits(bits) / setup.rays.size();
}
BENCHMARK(EmbreeOccluded)
    ->ArgsProduct({{0, 1, 2}, {0, 10}, {1, 2}})
    ->ArgNames({"mesh", "reach%", "threads"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
#endif

}  // namespace
}  // namespace komorebi

BENCHMARK_MAIN();
