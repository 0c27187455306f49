#include "render/world_program.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/environment.h"

namespace komorebi {
namespace {

float shown(float x) {
  return x > 0.0f ? x : 0.0f;
}

Vec3 shown(float r, float g, float b) {
  if (!(std::isfinite(r) && std::isfinite(g) && std::isfinite(b))) return Vec3(0.0f);
  return Vec3(shown(r), shown(g), shown(b));
}

constexpr std::uint32_t kLanes = Program::kLanes;

/// Runs a world's program in at most kLanes directions; results: [outputs][kLanes].
void run(const Program& program, Program::Scratch& scratch, const Vec3* directions,
         std::uint32_t count, std::vector<float>& results) {
  float columns[6][kLanes];  // the direction, and the opposite one
  for (std::uint32_t i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) {
      columns[c][i] = directions[i][c];
      columns[3 + c][i] = -directions[i][c];
    }
  }
  ShadePoints points;
  points.count = count;
  static constexpr float kZero[kLanes] = {};
  for (auto& input : points.input) std::fill_n(input, 3, kZero);
  const auto set = [&](PointInput input, std::size_t first) {
    for (std::size_t c = 0; c < 3; ++c) {
      points.input[static_cast<std::size_t>(input)][c] = columns[first + c];
    }
  };
  for (const PointInput along : {PointInput::kPosition, PointInput::kObjectPoint}) set(along, 0);
  for (const PointInput back : {PointInput::kNormal, PointInput::kTrueNormal, PointInput::kIncoming,
                                PointInput::kObjectNormal}) {
    set(back, 3);
  }
  std::vector<const float*> none(4 * program.attributes().size(), kZero);
  points.attribute = reinterpret_cast<const float* const(*)[4]>(none.data());
  results.resize(program.output_count() * kLanes);
  std::vector<float*> out;
  for (std::size_t i = 0; i < program.output_count(); ++i) out.push_back(&results[i * kLanes]);
  program.run(points, scratch, out.data());
}

}  // namespace

void run_world(const Program& program, Program::Scratch& scratch, const Vec3* directions,
               std::uint32_t count, Vec3* radiance) {
  thread_local std::vector<float> results;
  run(program, scratch, directions, count, results);
  for (std::uint32_t i = 0; i < count; ++i) {
    radiance[i] = shown(results[i], results[kLanes + i], results[2 * kLanes + i]);
  }
}

void world_values(const Program& program, const Vec3& direction, std::uint32_t count,
                  float* values) {
  thread_local Program::Scratch scratch;
  thread_local std::vector<float> results;
  run(program, scratch, &direction, 1, results);
  for (std::uint32_t i = 0; i < count; ++i) values[i] = results[i * kLanes];
}

Vec3 world_radiance(const RenderContext& context, const Vec3& direction) {
  if (context.world_program == nullptr) return environment_radiance(context.environment, direction);
  thread_local Program::Scratch scratch;
  Vec3 radiance;
  run_world(*context.world_program, scratch, &direction, 1, &radiance);
  return radiance;
}

float brightest(const Program& program) {
  ThreadPool alone(1);
  const std::vector<float> texels = world_texels(program, 128, 64, alone, Cancel());
  return *std::max_element(texels.begin(), texels.end());
}

std::vector<float> world_texels(const Program& program, std::uint32_t width, std::uint32_t height,
                                ThreadPool& pool, const Cancel& cancel) {
  if (width == 0 || height == 0 || width > 1u << 16 || height > 1u << 16) {
    throw std::invalid_argument(program.name() + ": a map of " + std::to_string(width) + " × " +
                                std::to_string(height) + " pixels cannot be made of it");
  }
  std::vector<float> texels(std::size_t{3} * width * height);
  pool.for_each_chunk(height, 1, [&](std::size_t begin, std::size_t end) {
    Program::Scratch scratch;
    Vec3 directions[Program::kLanes], radiance[Program::kLanes];
    for (std::size_t row = begin; row < end && !cancel.raised(); ++row) {
      const float v = (static_cast<float>(row) + 0.5f) / static_cast<float>(height);
      for (std::uint32_t first = 0; first < width; first += Program::kLanes) {
        const std::uint32_t count = std::min(Program::kLanes, width - first);
        for (std::uint32_t i = 0; i < count; ++i) {
          const float u = (static_cast<float>(first + i) + 0.5f) / static_cast<float>(width);
          directions[i] = direction_from_equirectangular(Vec2(u, v));
        }
        run_world(program, scratch, directions, count, radiance);
        float* to = &texels[3 * (row * width + first)];
        for (std::uint32_t i = 0; i < count; ++i) {
          for (int c = 0; c < 3; ++c) *to++ = radiance[i][c];
        }
      }
    }
  });
  if (cancel.raised()) throw Cancelled();
  return texels;
}

}  // namespace komorebi
