// Hair: ours beside Embree's curves, the very same rays, one thread.
#include <cmath>
#include <cstdio>
#include <random>

#include "bench/clock.h"
#include "bench/json_row.h"
#include "bench/parts.h"
#include "bvh/traverse.h"
#include "render/scene.h"
#include "support/embree_curves.h"
#include "support/ray_list.h"

namespace komorebi::bench {
namespace {

using testing::Curves;
using testing::EmbreeCurves;
using testing::RayList;

/// Camera rays in blocks of 8 × 8 pixels that look at the fur from outside.
RayList camera_rays(std::uint32_t size) {
  RayList rays;
  for (std::uint32_t block = 0; block < (size / 8) * (size / 8); ++block) {
    for (std::uint32_t i = 0; i < 64; ++i) {
      const double x = 8.0 * (block % (size / 8)) + i % 8 + 0.5;
      const double y =
          8.0 * (block / (size / 8)) + i / 8 + 0.5;  // NOLINT(bugprone-integer-division)
      Ray ray;
      ray.origin = Vec3(0, -4, 0);
      ray.direction =
          Vec3(glm::normalize(Vec3d(0.7 * (x / size - 0.5), 1.0, 0.7 * (y / size - 0.5))));
      rays.push_back(ray);
    }
  }
  return rays;
}

/// Rays into the half of all directions that faces the eye, from where camera rays met hair.
RayList light_rays(const RayList& camera, const std::vector<Hit>& hits, std::uint32_t each) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  RayList rays;
  for (std::uint32_t i = 0; i < camera.size(); ++i) {
    if (!hits[i].valid()) continue;
    const Ray from = camera[i];
    for (std::uint32_t k = 0; k < each; ++k) {
      Ray ray;
      Vec3 d(uniform(random), uniform(random), uniform(random));
      while (glm::dot(d, d) > 1.0f) d = Vec3(uniform(random), uniform(random), uniform(random));
      ray.origin = from.origin + hits[i].t * from.direction;
      ray.direction = glm::normalize(d);
      if (glm::dot(ray.direction, from.direction) > 0.0f) ray.direction = -ray.direction;
      ray.t_min = 1e-3f;
      rays.push_back(ray);
    }
  }
  return rays;
}

void print_build(const std::string& shape, const std::string& engine, const std::string& tree,
                 const Curves& curves, double seconds, double bytes) {
  const auto strands = double(curves.offsets.size() - 1);
  JsonRow("curves")
      .text("kind", "build")
      .text("shape", shape)
      .text("engine", engine)
      .text("tree", tree)
      .number("strands", strands)
      .number("segments", double(curves.radius.size()) / strands - 1.0)
      .number("build_seconds", seconds)
      .number("bytes", bytes)
      .print();
}

}  // namespace

void curves_part(const Options& options) {
  const auto strands = static_cast<std::uint32_t>(options.whole("strands", 200000));
  const auto segments = static_cast<std::uint32_t>(options.whole("segments", 8));
  const auto threads = static_cast<unsigned>(options.whole("build-threads", 2));
  const double length = options.numbers("length", "0.3")[0];
  const double width = options.numbers("width", "0.0005")[0];
  ThreadPool pool(threads);
  for (const std::string& shape : options.list("shapes", "RIBBON,THICK")) {
    const bool ribbon = shape == "RIBBON";
    const Curves curves = testing::made_fur(strands, segments, length, width, 1.5,
                                            ribbon ? CurveShape::kRibbon : CurveShape::kThick);
    std::unique_ptr<EmbreeCurves> peer;
    const double their_build =
        seconds_of([&] { peer = std::make_unique<EmbreeCurves>(curves, 5, threads); });
    print_build(shape, "embree", "", curves, their_build, peer->byte_count());
    for (const std::string& builder : options.list("builders", "LINEAR,SAH")) {
      std::shared_ptr<const Mesh> mesh;
      const double build = seconds_of(
          [&] { mesh = Mesh::build(curves.input(), builder_from_name(builder), pool, Cancel()); });
      print_build(shape, "komorebi", builder, curves, build, double(mesh->byte_count()));
      Scene scene;
      const InstanceInput instance{scene.add_mesh(mesh), Mat4d(1.0), 0, kMaskAll, 0};
      scene.add_instances({&instance, 1}, "fur");
      scene.commit(pool, Cancel());
      const Vec3 origin(scene.origin());
      const RayList camera = camera_rays(static_cast<std::uint32_t>(options.whole("size", 256)));
      std::vector<Hit> hits(camera.size()), theirs(camera.size());
      const auto moved = [&](const RayList& list) {
        RayList result;
        for (std::uint32_t i = 0; i < list.size(); ++i) {
          Ray ray = list[i];
          ray.origin -= origin;
          result.push_back(ray);
        }
        return result;
      };
      const RayList our_camera = moved(camera);
      intersect(scene.view(), our_camera.span(), hits.data());
      const RayList light = light_rays(camera, hits, 8), our_light = moved(light);
      std::vector<std::uint32_t> bits(light.size() / 32 + 1), their_bits(bits.size());
      const std::vector<Contender> contenders = {
          {[] {}, [&] { intersect(scene.view(), our_camera.span(), hits.data()); }},
          {[] {},
           [&] {
             for (std::uint32_t i = 0; i < camera.size(); ++i) {
               theirs[i] = peer->intersect(camera[i], !ribbon);
             }
           }},
          {[] {}, [&] { occluded(scene.view(), our_light.span(), bits.data()); }},
          {[] {},
           [&] {
             std::fill(their_bits.begin(), their_bits.end(), 0u);
             for (std::uint32_t i = 0; i < light.size(); ++i) {
               if (peer->occluded(light[i], !ribbon)) their_bits[i / 32] |= 1u << (i % 32);
             }
           }}};
      const auto seconds = interleave(contenders, options.whole("rounds", 3));
      std::size_t met = 0, other = 0, blocked = 0, differing = 0;
      for (std::uint32_t i = 0; i < camera.size(); ++i) {
        met += hits[i].valid() ? 1u : 0u;
        other += hits[i].primitive != theirs[i].primitive ? 1u : 0u;
      }
      for (std::uint32_t i = 0; i < light.size(); ++i) {
        const unsigned a = (bits[i / 32] >> (i % 32)) & 1u,
                       b = (their_bits[i / 32] >> (i % 32)) & 1u;
        blocked += a;
        differing += a != b ? 1 : 0;
      }
      const char* names[] = {"camera", "camera", "light", "light"};
      for (std::size_t k = 0; k < contenders.size(); ++k) {
        const double rays = k < 2 ? double(camera.size()) : double(light.size());
        const bool ours = k % 2 == 0;
        JsonRow("curves")
            .text("kind", "rays")
            .text("shape", shape)
            .text("rays", names[k])
            .text("engine", ours ? "komorebi" : "embree")
            .text("tree", ours ? builder : "")
            .text("beside", builder)
            .number("count", rays)
            .number("met_share", double(k < 2 ? met : blocked) / rays)
            .number("differing_share", double(k < 2 ? other : differing) / rays)
            .numbers("seconds", seconds[k])
            .print();
      }
    }
  }
}

}  // namespace komorebi::bench
