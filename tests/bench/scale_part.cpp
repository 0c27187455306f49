// Growth: builds, bytes and rays of one shape at rising triangle counts, and of one mesh at rising
// numbers of instances. Every size is measured in a process of its own.
#include <cstdio>

#include "bench/bench_meshes.h"
#include "bench/clock.h"
#include "bench/fresh_process.h"
#include "bench/json_row.h"
#include "bench/made_meshes.h"
#include "bench/parts.h"
#include "bench/ray_sets.h"
#include "bench/touch_memory.h"
#include "support/test_scene.h"

namespace komorebi::bench {
namespace {

using testing::TestScene;

/// Bytes a triangle or instance, more than mesh and tree take in the making.
constexpr double kMostBytes = 256.0;

/// Seconds of 16 ambient rays for each place that a view sees, median of three; and their number.
std::pair<double, double> trace_ambient(const TestScene& scene, const Aabb& box, float reach,
                                        ThreadPool& pool) {
  const testing::RayList camera = camera_rays(outside_view(box, Vec3(0, 1, 0)), 4);
  const RaySet set = ambient_set(places(scene.view(), camera), 16, reach);
  if (set.list.size() == 0) throw std::runtime_error("the view sees nothing");
  const SceneView view = scene.view();
  const auto trace = [&] {
    pool.for_each_chunk(set.chunk_count(), 1, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> bits(RaySet::kChunk / 32);
      for (std::size_t k = begin; k < end; ++k) {
        occluded(view, set.bundles(static_cast<std::uint32_t>(k)), bits.data());
      }
    });
  };
  std::vector<double> seconds = interleave({{[] {}, trace}}, 3)[0];
  std::sort(seconds.begin(), seconds.end());
  return {seconds[1], static_cast<double>(set.list.size())};
}

/// {triangles, seconds of the build, tree's bytes, mesh's bytes, peak bytes, ray seconds, rays}
std::vector<double> grow_triangles(double wanted, const std::string& builder, unsigned threads) {
  forget_peak();
  const double before = memory("VmRSS");
  TestScene scene(threads);
  testing::TriangleMesh mesh = bumpy_sphere(wanted);
  const auto triangles = static_cast<double>(mesh.triangle_count());
  const double mesh_bytes = 4.0 * static_cast<double>(mesh.vtx2xyz.size() + mesh.tri2vtx.size());
  const double build =
      seconds_of([&] { scene.add_mesh(std::move(mesh), builder_from_name(builder)); });
  const double peak = memory("VmHWM") - before;
  scene.add_instance(0);
  scene.commit();
  const auto bytes = static_cast<double>(scene.tree(0).byte_count());
  ThreadPool pool(threads);
  const auto [seconds, rays] = trace_ambient(scene, scene.tree(0).bounds, kFloatMax, pool);
  return {triangles, build, bytes, mesh_bytes, peak, seconds, rays};
}

/// The same for instances of one mesh on a square grid, each turned about its own axis.
std::vector<double> grow_instances(double wanted, unsigned threads) {
  TestScene scene(threads);
  scene.add_mesh(bumpy_sphere(5e4));
  forget_peak();
  const double before = memory("VmRSS");
  Numbers number;
  const int side = std::max(1, static_cast<int>(std::lround(std::sqrt(wanted))));
  for (int i = 0; i < side * side; ++i) {
    const double angle = 6.28318 * static_cast<double>(number.next());
    const double c = std::cos(angle), s = std::sin(angle);
    const Vec3 place(2.4f * float(i % side), 0.4f * number.next(), 2.4f * float(i / side));
    scene.add_instance(0, Mat3d(c, 0, s, 0, 1, 0, -s, 0, c), place);
  }
  const double build = seconds_of([&] { scene.commit(Builder::kSah); });
  const double peak = memory("VmHWM") - before;
  const auto bytes = static_cast<double>(scene.instance_tree().byte_count());
  const double instance_bytes = static_cast<double>(sizeof(InstanceView)) * side * side;
  ThreadPool pool(threads);
  const Aabb box = scene.instance_tree().bounds;
  const auto [seconds, rays] = trace_ambient(scene, box, kFloatMax, pool);
  return {double(side) * side, build, bytes, instance_bytes, peak, seconds, rays};
}

void print(const char* grows, const std::string& builder, const std::vector<double>& v,
           unsigned threads) {
  JsonRow("scale")
      .text("grows", grows)
      .text("tree", builder)
      .number("threads", threads)
      .number("count", v[0])
      .number("build_seconds", v[1])
      .number("tree_bytes", v[2])
      .number("input_bytes", v[3])
      .number("peak_bytes", v[4])
      .number("ray_seconds", v[5])
      .number("ray_count", v[6])
      .print();
}

}  // namespace

void scale_part(const Options& options) {
  const auto threads = static_cast<unsigned>(options.whole("threads", 2));
  for (const std::string& builder : known_builders(options)) {
    for (const double wanted : options.numbers("triangles", "1e6,4e6,16e6,5e7")) {
      std::fprintf(stderr, "scale: %g triangles, %s\n", wanted, builder.c_str());
      touch_free_memory(kMostBytes * wanted);
      print("triangles", builder,
            in_fresh_process([&] { return grow_triangles(wanted, builder, threads); }), threads);
    }
  }
  for (const double wanted : options.numbers("instances", "1,1e2,1e4,1e6")) {
    std::fprintf(stderr, "scale: %g instances\n", wanted);
    touch_free_memory(kMostBytes * wanted);
    print("instances", "SAH", in_fresh_process([&] { return grow_instances(wanted, threads); }),
          threads);
  }
}

}  // namespace komorebi::bench
