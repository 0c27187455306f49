// Rays: ours beside Embree's, the very same rays, in turns.
#include <cstdio>

#include "bench/answers.h"
#include "bench/bench_meshes.h"
#include "bench/clock.h"
#include "bench/embree_rays.h"
#include "bench/json_row.h"
#include "bench/parts.h"
#include "io/image.h"
#include "render/environment.h"

namespace komorebi::bench {
namespace {

using testing::TestScene;

/// One line of the table: who traces, on which tree, how, and with which instructions.
struct Row {
  std::string engine, tree, query, instructions;
  std::function<bool(std::uint32_t)> met;  ///< each ray's answer after the work
};

struct Entrants {
  std::vector<Row> rows;
  std::vector<Contender> contenders;

  void add(Row row, std::function<void()> prepare, std::function<void()> work) {
    rows.push_back(std::move(row));
    contenders.push_back({std::move(prepare), std::move(work)});
  }
};

/// `body(chunk)` for all chunks of a set on the threads of a pool.
template <class Body>
void each_chunk(ThreadPool& pool, const RaySet& set, Body body) {
  pool.for_each_chunk(set.chunk_count(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) body(static_cast<std::uint32_t>(k));
  });
}

/// How our tracer is asked: by bundles, by a span, or for closest hits.
void add_ours(Entrants& entrants, const TestScene& scene, const std::string& builder,
              const RaySet& set, bool closest, ThreadPool& pool,
              const std::vector<std::string>& sets) {
  const SceneView view = scene.view();
  const auto add = [&](const char* query, const std::string& instructions, auto trace) {
    auto answers = std::make_shared<Answers>(set, closest);
    entrants.add(
        {"komorebi", builder, query, instructions,
         [answers](std::uint32_t i) { return answers->met(i); }},
        [instructions] { force_instruction_set(instructions); },
        [&set, &pool, answers, trace] {
          each_chunk(pool, set, [&](std::uint32_t k) { trace(k, *answers); });
        });
  };
  for (const std::string& name : sets) {
    if (closest) {
      add("span", name, [&set, view](std::uint32_t k, Answers& answers) {
        intersect(view, set.span(k), answers.hits(set.first_ray(k)));
      });
      continue;
    }
    add("bundles", name, [&set, view](std::uint32_t k, Answers& answers) {
      occluded(view, set.bundles(k), answers.bits(k));
    });
    if (name != sets.front()) continue;
    add("span", name, [&set, view](std::uint32_t k, Answers& answers) {
      occluded(view, set.span(k), answers.bits(k));
    });
  }
}

void add_embree(Entrants& entrants, const EmbreePeer& peer, const std::string& mode,
                const EmbreeQuery& query, const RaySet& set, ThreadPool& pool,
                const std::shared_ptr<EmbreeRays>& rays) {
  const auto work = [&, query, rays] {
    each_chunk(pool, set, [&](std::uint32_t k) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      context.flags = query.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                     : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
      rays->trace(peer.scene(), &context, k);
    });
  };
  const std::string name = query.width == 0 ? "1M" : std::to_string(query.width);
  entrants.add(
      {"embree", mode, name + (query.coherent ? " coherent" : ""), "own choice",
       [rays](std::uint32_t i) { return rays->met(i); }},
      [rays, &set] { rays->reset(set.list); }, work);
}

/// "1", "16", "16c" (coherent), "1M", "1Mc".
EmbreeQuery embree_query(const std::string& word) {
  const bool coherent = word.back() == 'c';
  return {word.find('M') != std::string::npos ? 0 : std::stoi(word), coherent};
}

void print(const Options& options, const testing::TriangleMesh& mesh, const std::string& kind,
           const RaySet& set, unsigned threads, const Entrants& entrants,
           const std::vector<std::vector<double>>& seconds) {
  const Row& first = entrants.rows.front();  // ours
  for (std::size_t i = 0; i < entrants.rows.size(); ++i) {
    const Row& row = entrants.rows[i];
    entrants.contenders[i].prepare();  // once more, since some share their rays
    entrants.contenders[i].work();
    double blocked = 0.0, differing = 0.0;
    for (std::uint32_t k = 0; k < set.list.size(); ++k) {
      const bool here = row.met(k);
      blocked += here;
      differing += here != first.met(k);
    }
    JsonRow("rays")
        .text("mesh", options.text("name", "mesh"))
        .number("triangles", static_cast<double>(mesh.triangle_count()))
        .text("rays", kind)
        .number("rays_a_point", set.rays_a_point())
        .number("ray_count", set.list.size())
        .number("threads", threads)
        .text("engine", row.engine)
        .text("tree", row.tree)
        .text("query", row.query)
        .text("instructions", row.instructions)
        .numbers("seconds", seconds[i])
        .number("blocked_share", blocked / set.list.size())
        .number("differing_share", differing / set.list.size())
        .print();
  }
}

View chosen_view(const Options& options, const Aabb& box) {
  const bool y_up = options.text("up", "y") == "y";
  const Vec3 up = y_up ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
  const std::vector<double> v = options.numbers("view", "");
  if (v.size() != 6) return outside_view(box, up);
  View view;
  view.up = up;
  view.width = 1.5f;
  view.eye = Vec3(Vec3d(v[0], v[1], v[2]));
  view.forward = glm::normalize(Vec3(Vec3d(v[3], v[4], v[5])));
  return view;
}

/// "camera", "ao:16", "ao:16:0.1" (a tenth of the diagonal), "map:16".
RaySet make_set(const std::string& kind, const testing::RayList& camera,
                const std::vector<Place>& from, float diagonal, const EnvironmentView& map) {
  if (kind == "camera") return camera_set(camera);
  std::istringstream words(kind);
  std::string name, count, reach;
  std::getline(words, name, ':');
  std::getline(words, count, ':');
  std::getline(words, reach, ':');
  const auto rays = static_cast<std::uint32_t>(std::stoul(count));
  // Of many rays a place, fewer places: about as many rays of each kind.
  std::vector<Place> chosen;
  const std::size_t step = std::max<std::size_t>(1, rays / 16);
  for (std::size_t tile = 0; tile * 64 * step < from.size(); ++tile) {
    const std::size_t first = tile * 64 * step;
    for (std::size_t i = first; i < std::min(first + 64, from.size()); ++i)
      chosen.push_back(from[i]);
  }
  if (name == "map") return environment_set(chosen, rays, map);
  return ambient_set(chosen, rays, reach.empty() ? kFloatMax : std::stof(reach) * diagonal);
}

}  // namespace

void rays_part(const Options& options) {
  const testing::TriangleMesh mesh = load_mesh(options.text("mesh", ""));
  const auto most = static_cast<unsigned>(options.whole("build-threads", 2));
  std::vector<std::pair<std::string, std::unique_ptr<TestScene>>> scenes;
  for (const std::string& builder : known_builders(options)) {
    auto scene = std::make_unique<TestScene>(most);
    scene->add_mesh(mesh, builder_from_name(builder));
    scene->add_instance(0);
    scene->commit();
    scenes.emplace_back(builder, std::move(scene));
  }
  std::vector<std::pair<std::string, std::unique_ptr<EmbreePeer>>> peers;
  for (const std::string& mode : options.list("modes", "LOW,MEDIUM,MEDIUM+ROBUST,HIGH")) {
    auto peer = std::make_unique<EmbreePeer>(embree_mode(mode), most);
    peer->build(mesh);
    peers.emplace_back(mode, std::move(peer));
  }
  std::unique_ptr<Environment> map;
  EnvironmentView light = constant_environment(Vec3(1.0f));
  if (const std::string path = options.text("map", ""); !path.empty()) {
    Image image = read_image(path);
    map = std::make_unique<Environment>(path, image.width, image.height, std::move(image.pixels));
    const bool y_up = options.text("up", "y") == "y";  // the map's up is z
    const Mat3d turn = y_up ? Mat3d(1, 0, 0, 0, 0, 1, 0, -1, 0) : Mat3d(1.0);
    light = map->view(1.0, turn);
  }
  std::vector<std::string> instructions = built_instruction_sets();
  std::vector<std::string> sets{instructions.front()};
  for (const std::string& name : options.list("instructions", "SSE4")) {
    const bool known =
        std::find(instructions.begin(), instructions.end(), name) != instructions.end();
    if (known && name != sets.front()) sets.push_back(name);
  }

  const Aabb box = scenes.front().second->tree(0).bounds;
  const Vec3 diagonal = box.hi - box.lo;
  const testing::RayList camera = camera_rays(chosen_view(options, box), options.whole("tiles", 4));
  const std::vector<Place> from = places(scenes.front().second->view(), camera);
  std::fprintf(stderr, "%zu of %u camera rays hit\n", from.size(), camera.size());
  if (from.empty()) throw std::runtime_error("the view sees nothing");
  for (const std::string& kind : options.list("kinds", "ao:16,ao:16:0.1")) {
    const RaySet set = make_set(kind, camera, from, std::sqrt(glm::dot(diagonal, diagonal)), light);
    std::map<int, std::shared_ptr<EmbreeRays>> filled;
    for (const std::string& word : options.list("threads", "1")) {
      const auto threads = static_cast<unsigned>(std::stoul(word));
      ThreadPool pool(threads);
      Entrants entrants;
      for (const auto& [builder, scene] : scenes) {
        add_ours(entrants, *scene, builder, set, kind == "camera", pool, sets);
      }
      for (const auto& [mode, peer] : peers) {
        const bool wide = mode == "MEDIUM" || mode == "HIGH" || options.whole("all", 0) != 0;
        for (const std::string& q : options.list("queries", "1,8,16,16c,1M,1Mc")) {
          const EmbreeQuery query = embree_query(q);
          if (query.width != 1 && !wide) continue;
          // Rays in Embree's layout: one copy serves all who ask in the same way.
          auto& rays = filled[query.width];
          if (!rays) rays = embree_rays(set, query.width, kind == "camera");
          add_embree(entrants, *peer, mode, query, set, pool, rays);
        }
      }
      const auto seconds = interleave(entrants.contenders, options.whole("rounds", 5));
      print(options, mesh, kind, set, threads, entrants, seconds);
      force_instruction_set("");
    }
  }
}

}  // namespace komorebi::bench
