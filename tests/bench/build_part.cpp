// Builds: ours beside Embree's, in forked processes, so that every first build is cold.
#include "bench/bench_meshes.h"
#include "bench/clock.h"
#include "bench/embree_peer.h"
#include "bench/fresh_process.h"
#include "bench/json_row.h"
#include "bench/parts.h"
#include "bench/touch_memory.h"
#include "bvh/mesh_tree.h"
#include "bvh/validate.h"
#include "parallel/scratch.h"

namespace komorebi::bench {
namespace {

/// Bytes a triangle, more than any first build takes.
constexpr double kMostBytes = 512.0;

/// Builds after the first, of which the median counts: fewer where each takes long.
std::size_t warm_count(double cold_seconds) {
  return cold_seconds < 0.3 ? 3 : 1;
}

struct Entrant {
  std::string engine, mode;
  /// {bytes, peak bytes during the first build, cold seconds, warm seconds…}
  std::function<std::vector<double>()> measure;
};

/// Times `first`, then `again` a few times.
std::vector<double> times(const std::function<void()>& first, const std::function<void()>& again,
                          const std::function<double()>& bytes) {
  forget_peak();
  const double before = memory("VmRSS");
  const double cold = seconds_of(first);
  std::vector<double> values{bytes(), memory("VmHWM") - before, cold};
  for (std::size_t k = 0; k < warm_count(cold); ++k) values.push_back(seconds_of(again));
  return values;
}

/// Either engine builds it before it is measured, so that its threads run and its code is there:
/// Embree starts threads at the first build, and the system spreads new ones when they have run.
testing::TriangleMesh small_mesh() {
  return bumpy_sphere(2e4);
}

std::vector<double> measure_ours(const testing::TriangleMesh& mesh, const std::string& builder,
                                 unsigned threads) {
  ThreadPool pool(threads);
  const Cancel cancel;
  const testing::TriangleMesh small = small_mesh();
  build_mesh_tree(small.vtx2xyz, small.tri2vtx, builder_from_name(builder), pool, cancel);
  release_scratch();
  MeshTree tree;
  const auto build = [&] {
    tree = MeshTree();
    tree = build_mesh_tree(mesh.vtx2xyz, mesh.tri2vtx, builder_from_name(builder), pool, cancel);
  };
  return times(build, build, [&] { return static_cast<double>(tree.byte_count()); });
}

std::vector<double> measure_embree(const testing::TriangleMesh& mesh, const std::string& mode,
                                   unsigned threads) {
  const testing::TriangleMesh small = small_mesh();
  EmbreePeer(embree_mode(mode), threads).build(small);
  EmbreePeer peer(embree_mode(mode), threads);
  return times([&] { peer.build(mesh); }, [&] { peer.rebuild(); },
               [&] { return peer.byte_count(); });
}

void check_trees(const testing::TriangleMesh& mesh, const std::vector<std::string>& builders) {
  in_fresh_process([&] {
    ThreadPool pool(2);
    const Cancel cancel;
    for (const std::string& builder : builders) {
      const MeshTree tree =
          build_mesh_tree(mesh.vtx2xyz, mesh.tri2vtx, builder_from_name(builder), pool, cancel);
      const std::string fault = validate(tree, mesh.vtx2xyz, mesh.tri2vtx);
      if (!fault.empty()) throw std::runtime_error("a wrong tree: " + fault);
    }
    return std::vector<double>{};
  });
}

}  // namespace

void build_part(const Options& options) {
  const testing::TriangleMesh mesh = load_mesh(options.text("mesh", ""));
  const std::vector<std::string> builders = known_builders(options);
  if (options.whole("validate", 1) != 0) check_trees(mesh, builders);
  for (const std::string& word : options.list("threads", "1,2")) {
    const auto threads = static_cast<unsigned>(std::stoul(word));
    std::vector<Entrant> entrants;
    for (const std::string& builder : builders) {
      entrants.push_back(
          {"komorebi", builder, [&, builder] { return measure_ours(mesh, builder, threads); }});
    }
    for (const std::string& mode : options.list("modes", "LOW,MEDIUM,MEDIUM+COMPACT,HIGH")) {
      entrants.push_back(
          {"embree", mode, [&, mode] { return measure_embree(mesh, mode, threads); }});
    }
    std::vector<std::vector<double>> cold(entrants.size()), warm(entrants.size());
    std::vector<double> bytes(entrants.size()), peak(entrants.size());
    for (int round = 0; round < options.whole("rounds", 5); ++round) {
      for (std::size_t i = 0; i < entrants.size(); ++i) {
        touch_free_memory(kMostBytes * static_cast<double>(mesh.triangle_count()));
        const std::vector<double> got = in_fresh_process(entrants[i].measure);
        std::vector<double> again(got.begin() + 3, got.end());
        std::sort(again.begin(), again.end());
        bytes[i] = got[0];
        peak[i] = std::max(peak[i], got[1]);
        cold[i].push_back(got[2]);
        warm[i].push_back(again[again.size() / 2]);
      }
    }
    for (std::size_t i = 0; i < entrants.size(); ++i) {
      JsonRow("build")
          .text("mesh", options.text("name", "mesh"))
          .number("triangles", static_cast<double>(mesh.triangle_count()))
          .number("vertices", static_cast<double>(mesh.vtx2xyz.size() / 3))
          .number("threads", threads)
          .text("engine", entrants[i].engine)
          .text("mode", entrants[i].mode)
          .numbers("cold_seconds", cold[i])
          .numbers("warm_seconds", warm[i])
          .number("bytes", bytes[i])
          .number("peak_bytes", peak[i])
          .print();
    }
  }
}

}  // namespace komorebi::bench
