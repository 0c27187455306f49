// Lamps: every sampler against its density and against integrals that know nothing of sampling.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/lamp_sample.h"
#include "render/lamps.h"
#include "support/direction_test.h"
#include "support/scenes.h"

namespace komorebi::testing {
namespace {

constexpr double kDegree = kPi / 180.0;

LampInput at(LampKind kind, const Vec3d& place, const Vec3d& turn = Vec3d(0.0)) {
  LampInput lamp;
  lamp.name = "test";
  lamp.kind = kind;
  lamp.radiance = Vec3d(3.0, 2.0, 1.0);
  Mat4d m = glm::translate(Mat4d(1.0), place);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d about(0.0);
    about[axis] = 1.0;
    m = glm::rotate(m, turn[axis], about);
  }
  lamp.world_from_lamp = m;
  return lamp;
}

LampInput area(LampKind kind, double u, double v, const Vec3d& place, const Vec3d& turn,
               double spread = kPi) {
  LampInput lamp = at(kind, place, turn);
  lamp.size_u = u;
  lamp.size_v = v;
  lamp.spread = spread;
  return lamp;
}

Lamp only(const LampInput& input) {
  check_lamp(input);
  return LampTable({input}, Vec3d(0.0)).view().lamps[0];
}

/// The share of a soft box's light at an angle to its axis, and of a spot's, in libm's doubles.
double soft_box(double spread, double cosine) {
  if (spread >= kPi) return 1.0;
  const double half = spread / 2.0, tangent = std::tan(std::acos(std::min(cosine, 1.0)));
  return std::max(0.0, (std::tan(half) - tangent) / (std::tan(half) - half));
}
double cone(const LampInput& lamp, const Vec3d& from_lamp) {
  if (lamp.spot_angle == 0.0) return 1.0;
  const Vec3d local =
      glm::normalize(glm::inverse(Mat3d(lamp.world_from_lamp)) * from_lamp) * Vec3d(1, 1, -1);
  const double limit = std::cos(lamp.spot_angle / 2.0), width = (1.0 - limit) * lamp.spot_blend;
  const double x =
      width > 0.0 ? std::clamp((local.z - limit) / width, 0.0, 1.0) : (local.z > limit ? 1.0 : 0.0);
  return x * x * (3.0 - 2.0 * x) * (lamp.spot_scales_by_cosine ? local.z : 1.0);
}

/// Irradiance of a point with this normal, per unit of radiance: over the lamp's surface, or over
/// the sun's directions.
double exact_irradiance(const LampInput& lamp, const Vec3d& p, const Vec3d& n) {
  constexpr int kSteps = 700;
  const Mat3d m(lamp.world_from_lamp);
  const Vec3d middle(lamp.world_from_lamp[3]);
  double sum = 0.0;
  const auto over = [&](const auto& f) {
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) sum += f((i + 0.5) / kSteps, (j + 0.5) / kSteps);
    }
    return sum / (double{kSteps} * kSteps);
  };
  const auto facing = [&](const Vec3d& d) { return std::max(0.0, glm::dot(d, n)); };
  if (lamp.kind == LampKind::kSun || lamp.kind == LampKind::kTangentSun) {
    const double half = lamp.angle / 2.0;
    return over([&](double u, double v) {
      const bool tangent = lamp.kind == LampKind::kTangentSun;
      const double r = tangent ? std::tan(half) * std::sqrt(u) : std::sin(half * u);
      const double z = tangent ? 1.0 : std::cos(half * u);
      const double phi = 2.0 * kPi * v;
      const Vec3d d = glm::normalize(m * Vec3d(r * std::cos(phi), r * std::sin(phi), z));
      const double weight = tangent ? kPi * std::pow(std::tan(half), 2) : 2.0 * kPi * half * r;
      return weight * facing(d);
    });
  }
  if (is_area(lamp.kind)) {
    return over([&](double u, double v) {
      const double x = 2.0 * u - 1.0, y = 2.0 * v - 1.0;
      if (lamp.kind == LampKind::kEllipse && x * x + y * y > 1.0) return 0.0;
      const Vec3d q = middle + m * Vec3d(0.5 * x * lamp.size_u, 0.5 * y * lamp.size_v, 0.0);
      const Vec3d d = glm::normalize(q - p);
      const double cosine = glm::dot(glm::normalize(m[2]), d);  // it shines along −z
      if (cosine <= 0.0) return 0.0;
      const double da = lamp.size_u * lamp.size_v * glm::length(m[0]) * glm::length(m[1]);
      return da * facing(d) * cosine * soft_box(lamp.spread, cosine) / glm::dot(q - p, q - p);
    });
  }
  const Vec3d axis = glm::normalize(middle - p);
  const double distance = glm::length(middle - p);
  const Frame frame = make_frame(Vec3(axis));
  const double half = lamp.kind == LampKind::kSphere ? std::asin(lamp.radius / distance)
                                                     : std::atan(lamp.radius / distance);
  return over([&](double u, double v) {
    const double angle = half * u, phi = 2.0 * kPi * v;
    const Vec3d d =
        std::cos(angle) * axis + std::sin(angle) * (std::cos(phi) * Vec3d(frame.tangent) +
                                                    std::sin(phi) * Vec3d(frame.bitangent));
    return 2.0 * kPi * half * std::sin(angle) * facing(d) * cone(lamp, -d);
  });
}

struct Case {
  const char* name;
  LampInput lamp;
  Vec3d normal{0.0, 0.0, 1.0};
};

std::vector<Case> cases() {
  const Vec3d tilt(0.4, -0.3, 1.0);
  std::vector<Case> all;
  for (const double degrees : {0.5, 40.0, 170.0}) {
    for (const LampKind kind : {LampKind::kSun, LampKind::kTangentSun}) {
      LampInput sun = at(kind, Vec3d(0.0), tilt);
      sun.angle = degrees * kDegree;
      all.push_back({"sun", sun});
    }
  }
  for (const double radius : {0.01, 0.7, 1.9}) {
    for (const LampKind kind : {LampKind::kSphere, LampKind::kDisk}) {
      LampInput ball = at(kind, {0.5, -1.0, 1.7});
      ball.radius = radius;
      all.push_back({"ball", ball});
      all.push_back({"ball at the horizon", ball, glm::normalize(Vec3d(1.0, 1.5, 0.1))});
      ball.world_from_lamp = at(kind, {0.5, -1.0, 1.7}, {0.5, 0.3, 0.0}).world_from_lamp;
      ball.world_from_lamp[0] *= 1.6;
      ball.spot_angle = 90.0 * kDegree;
      ball.spot_blend = 0.4;
      all.push_back({"spot", ball});
      ball.spot_scales_by_cosine = true;
      all.push_back({"spot of 3.x", ball});
    }
  }
  for (const LampKind kind : {LampKind::kRectangle, LampKind::kEllipse}) {
    for (const double spread : {180.0, 70.0, 12.0}) {
      all.push_back(
          {"near", area(kind, 1.5, 0.6, {0.3, -0.2, 1.0}, {0.2, 0.1, 1.0}, spread * kDegree)});
      all.push_back(
          {"touching", area(kind, 1.5, 0.6, {0.3, -0.2, 0.02}, {0, 0, 1.0}, spread * kDegree)});
    }
    all.push_back({"far", area(kind, 1.5, 0.6, {20.0, -9.0, 15.0}, {0.4, 0.9, 1.0})});
    all.push_back({"tiny", area(kind, 1e-3, 2e-3, {2.0, -9.0, 15.0}, {0.4, 0.3, 1.0})});
    all.push_back({"grazed", area(kind, 1.0, 3.0, {2.0, 0.5, 1.0}, {0.0, 0.5 * kPi + 0.45, 0.0})});
    all.push_back({"half below", area(kind, 2.0, 2.0, {1.0, 0.0, 0.1}, {0.0, 0.9, 0.0})});
  }
  return all;
}

TEST(Lamp, MeanOfSamplesIsTheIrradiance) {
  for (const Case& c : cases()) {
    const Lamp lamp = only(c.lamp);
    RandomBits random(7);
    constexpr int kSamples = 200000;
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      const LampSample s = sample_lamp(lamp, Vec3(0.0f), Vec3(c.normal), random.next_2d());
      if (!(s.pdf > 0.0f)) continue;
      const double cosine = std::max(0.0, glm::dot(Vec3d(s.direction), c.normal));
      const double value = double{s.radiance.x} / c.lamp.radiance.x * cosine / double{s.pdf};
      sum += value;
      squares += value * value;
    }
    const double mean = sum / kSamples;
    const double error = std::sqrt(std::max(0.0, squares / kSamples - mean * mean) / kSamples);
    const double exact = exact_irradiance(c.lamp, Vec3d(0.0), c.normal);
    EXPECT_NEAR(mean, exact, 4.5 * error + 1e-3 * exact)
        << c.name << " of kind " << static_cast<int>(c.lamp.kind) << ", radius " << c.lamp.radius
        << ", angle " << c.lamp.angle << ", spread " << c.lamp.spread;
  }
}

TEST(Lamp, SamplesFollowTheirDensity) {
  // By solid angle all directions of these are equally likely, so the density is 1 / its size.
  LampInput sun = at(LampKind::kSun, Vec3d(0.0), {0.4, -0.3, 1.0});
  sun.angle = 100.0 * kDegree;
  LampInput ball = at(LampKind::kSphere, {0.5, -1.0, 1.7}),
            disk = at(LampKind::kDisk, {0.5, -1, 1.7});
  ball.radius = disk.radius = 1.2;
  const LampInput plate = area(LampKind::kRectangle, 1.5, 0.6, {0.3, -0.2, 0.5}, {0.2, 0.1, 1.0});
  const double d = std::sqrt(0.25 + 1.0 + 1.7 * 1.7);
  const auto within = [](const Vec3d& axis, double angle) {
    return [=](const Vec3& at) { return std::acos(glm::dot(Vec3d(at), axis)) < angle; };
  };
  const Vec3d to_ball = Vec3d(0.5, -1, 1.7) / d;
  const Mat4d inverse = glm::inverse(plate.world_from_lamp);
  const std::pair<LampInput, std::function<bool(const Vec3&)>> shapes[] = {
      {sun, within(Vec3d(sun.world_from_lamp[2]), 50.0 * kDegree)},
      {ball, within(to_ball, std::asin(1.2 / d))},
      {disk, within(to_ball, std::atan(1.2 / d))},
      {plate, [&](const Vec3& direction) {
         const Vec3d o(inverse * glm::dvec4(0, 0, 0, 1)), r = Mat3d(inverse) * Vec3d(direction);
         const double t = -o.z / r.z;
         return t > 0.0 && std::abs(o.x + t * r.x) < 0.75 && std::abs(o.y + t * r.y) < 0.3;
       }}};
  for (const auto& [input, meets] : shapes) {
    const Lamp lamp = only(input);
    const SphereGrid grid{24, 24, 60};
    double solid_angle = 0.0;
    for (const double part :
         grid.integrate([&](const Vec3& at) { return meets(at) ? 1.0 : 0.0; })) {
      solid_angle += part;
    }
    const ChiSquare test = test_directions(
        grid, 100000, 11,
        [&](const Bits2& bits) {
          const LampSample s = sample_lamp(lamp, Vec3(0.0f), Vec3(0, 0, 1),
                                           Vec2(to_unit_float(bits.x), to_unit_float(bits.y)));
          EXPECT_NEAR(double{s.pdf} * solid_angle, 1.0, 2e-3);
          return s.direction;
        },
        [&](const Vec3& at) { return meets(at) ? 1.0 / solid_angle : 0.0; });
    EXPECT_GT(test.p_value, 1e-4) << "kind " << static_cast<int>(input.kind);
    EXPECT_GT(test.degrees, 5);
  }
}

TEST(Lamp, SamplesEndOnTheLamp) {
  RandomBits random(3);
  for (const Case& c : cases()) {
    if (is_distant(c.lamp.kind)) continue;
    const Lamp lamp = only(c.lamp);
    for (int i = 0; i < 200; ++i) {
      const LampSample s = sample_lamp(lamp, Vec3(0.0f), Vec3(c.normal), random.next_2d());
      if (!(s.pdf > 0.0f)) continue;
      EXPECT_NEAR(glm::length(s.direction), 1.0f, 1e-5f);
      const Vec3d place = double{s.distance} * Vec3d(s.direction);
      const Vec3d local(glm::inverse(c.lamp.world_from_lamp) * glm::dvec4(place, 1.0));
      const double scale = 1e-5 * glm::length(Vec3d(c.lamp.world_from_lamp[3]));
      if (is_area(c.lamp.kind)) {
        EXPECT_NEAR(local.z, 0.0, scale) << c.name;
        EXPECT_LT(std::abs(local.x), 0.5 * c.lamp.size_u + scale) << c.name;
        EXPECT_LT(std::abs(local.y), 0.5 * c.lamp.size_v + scale) << c.name;
      } else if (c.lamp.kind == LampKind::kSphere) {
        const double away = glm::length(place - Vec3d(c.lamp.world_from_lamp[3]));
        EXPECT_NEAR(away, c.lamp.radius, 3e-3 * c.lamp.radius + scale) << c.name;
      }
    }
  }
}

TEST(Lamp, ABallLightsWhatIsWithinIt) {
  LampInput ball = at(LampKind::kSphere, {0.2, 0.1, 0.3});
  ball.radius = 2.0;
  const Lamp lamp = only(ball);
  RandomBits random(5);
  for (int i = 0; i < 100; ++i) {
    const LampSample s = sample_lamp(lamp, Vec3(0.0f), Vec3(0, 0, 1), random.next_2d());
    // By the cosine: each sample brings π times the radiance.
    EXPECT_NEAR(s.direction.z / s.pdf, kPiFloat, 1e-4f);
    const Vec3 end = s.distance * s.direction - Vec3(0.2f, 0.1f, 0.3f);
    EXPECT_NEAR(glm::length(end), 2.0f, 1e-4f);
  }
}

TEST(Lamp, ParallelRaysOfAnArea) {
  // As narrow as a spread may be, and none at all, bring the same on average: π L over the shape.
  for (const LampKind kind : {LampKind::kRectangle, LampKind::kEllipse}) {
    const Lamp lamp = only(area(kind, 2.0, 1.0, {0, 0, 3}, Vec3d(0.0), 0.0));
    const LampSample below = sample_lamp(lamp, Vec3(0.9f, 0, 1), Vec3(0, 0, 1), Vec2(0.5f));
    EXPECT_EQ(below.pdf, 1.0f);
    EXPECT_EQ(below.direction, Vec3(0, 0, 1));
    EXPECT_FLOAT_EQ(below.distance, 2.0f);
    EXPECT_FLOAT_EQ(below.radiance.x, 3.0f * kPiFloat);
    EXPECT_EQ(sample_lamp(lamp, Vec3(1.1f, 0, 1), Vec3(0, 0, 1), Vec2(0.5f)).pdf, 0.0f);
    const bool corner = sample_lamp(lamp, Vec3(0.9f, 0.4f, 1), Vec3(0, 0, 1), Vec2(0.5f)).pdf > 0;
    EXPECT_EQ(corner, kind == LampKind::kRectangle);
    EXPECT_EQ(sample_lamp(lamp, Vec3(0, 0, 4), Vec3(0, 0, -1), Vec2(0.5f)).pdf, 0.0f);
  }
}

TEST(Lamp, ImportanceIsNothingOnlyWhereNoLightComes) {
  RandomBits random(9);
  for (const Case& c : cases()) {
    const Lamp lamp = only(c.lamp);
    for (int i = 0; i < 3000; ++i) {
      const Vec2 a = random.next_2d(), b = random.next_2d();
      const Vec3 p = 3.0f * uniform_sphere(a), n = uniform_sphere(b);
      const LampSample s = sample_lamp(lamp, p, n, random.next_2d());
      if (!(s.pdf > 0.0f && s.radiance.x > 0.0f && glm::dot(s.direction, n) > 0.0f)) continue;
      EXPECT_GT(lamp_importance(lamp, p, n), 0.0f) << c.name;
    }
  }
}

TEST(Lamp, IsChosenAsOftenAsItsProbabilitySays) {
  for (const int count : {5, 8, 9, 500}) {
    std::vector<LampInput> inputs;
    RandomBits random(13);
    for (int i = 0; i < count; ++i) {
      const Vec2 u = random.next_2d();
      LampInput lamp = at(i % 7 == 2 ? LampKind::kDirection : LampKind::kPoint,
                          4.0 * Vec3d(uniform_sphere(random.next_2d())), {double{u.x}, 0, 0});
      lamp.radiance = Vec3d(i % 5 == 3 ? 0.0 : double{u.y} * (i % 7 == 2 ? 0.05 : 1.0));
      inputs.push_back(lamp);
    }
    const LampTable table(inputs, Vec3d(0.0));
    const LampsView lamps = table.view();
    EXPECT_EQ(lamps.nodes == nullptr, count <= 9);
    const Vec3 n = glm::normalize(Vec3(0.3f, -0.2f, 1.0f));
    std::vector<std::uint64_t> observed(lamps.count, 0);
    std::vector<double> probability(lamps.count, 0.0);
    constexpr int kDraws = 200000;
    for (int i = 0; i < kDraws; ++i) {
      const LampChoice choice =
          choose_lamp(lamps, Vec3(0.1f), n, 0, random.next().x * 2.3283064365386963e-10);
      if (choice.lamp == kNone) continue;  // a branch of the tree that turned out to be all below
      ASSERT_LT(choice.lamp, lamps.count);
      ASSERT_GE(choice.u, 0.0f);
      ASSERT_LT(choice.u, 1.0f);
      ++observed[choice.lamp];
      probability[choice.lamp] = double{choice.probability};
    }
    double sum = 0.0;
    for (double& p : probability) {
      sum += p;
      p *= kDraws;
    }
    EXPECT_GT(sum, 0.9);
    EXPECT_LT(sum, 1.001);
    EXPECT_GT(chi_square(observed, probability).p_value, 1e-4) << count;
    for (std::uint32_t i = 0; i < lamps.count; ++i) {
      EXPECT_EQ(max_abs(lamps.lamps[i].radiance) == 0.0f && observed[i] > 0, false);
    }
  }
}

TEST(Lamp, RefusesWhatCannotBe) {
  const auto refused = [](LampInput lamp) {
    lamp.name = "Key";
    try {
      check_lamp(lamp);
      return std::string();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
  };
  LampInput lamp = at(LampKind::kSphere, Vec3d(0.0));
  EXPECT_EQ(refused(lamp), "lamp \"Key\": its radius must be positive");
  lamp.radius = 1.0;
  EXPECT_EQ(refused(lamp), "");
  lamp.radiance.y = std::nan("");
  EXPECT_NE(refused(lamp).find("not finite"), std::string::npos);
  lamp = area(LampKind::kRectangle, 1.0, 0.0, Vec3d(0.0), Vec3d(0.0));
  EXPECT_EQ(refused(lamp), "lamp \"Key\": its sizes must be positive");
  lamp.size_v = 1.0;
  lamp.world_from_lamp[2] *= 0.0;
  EXPECT_EQ(refused(lamp), "lamp \"Key\": its matrix is flat");
  lamp = at(LampKind::kSun, Vec3d(0.0));
  EXPECT_NE(refused(lamp), "");
  lamp = at(LampKind::kPoint, Vec3d(0.0, std::nan(""), 0.0));
  EXPECT_EQ(refused(lamp), "lamp \"Key\": its matrix is not finite");
}

}  // namespace
}  // namespace komorebi::testing
