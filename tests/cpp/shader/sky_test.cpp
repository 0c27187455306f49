// Skies: elementary functions of lanes against libm, tables of any number of threads, and the sun's
// disc against its closed form. tests/blender/test_sky.py holds them beside Cycles.
#include "shader/sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "parallel/thread_pool.h"
#include "shader/sky_lanes.h"
#include "shader/sky_radiance.h"

namespace komorebi {
namespace {

SkyDesc sky_of(SkyModel model) {
  SkyDesc sky;
  sky.model = model;
  sky.sun_elevation = 0.5f;
  sky.sun_rotation = 1.0f;
  return sky;
}

constexpr SkyModel kScattering[] = {SkyModel::kNishita, SkyModel::kSingleScattering,
                                    SkyModel::kMultipleScattering};

TEST(SkyLanes, ExpAgreesWithLibm) {
  for (int i = -87000; i < 88000; ++i) {
    const auto x = static_cast<float>(i * 0.001);
    const double exact = std::exp(double{x});
    ASSERT_NEAR(exp_lane(x), exact, 3e-7 * (1.0 + std::abs(x)) * exact) << x;
  }
  EXPECT_EQ(exp_lane(-90.0f), 0.0f);
  EXPECT_EQ(exp_lane(-1e6f), 0.0f);
}

TEST(SkyLanes, LogAgreesWithLibm) {
  for (double x = 1e-30; x < 1e30; x *= 1.0007) {
    const auto value = static_cast<float>(x);
    const double exact = std::log(double{value});
    ASSERT_NEAR(log_lane(value), exact, 2e-7 * (1.0 + std::abs(exact))) << x;
  }
}

TEST(SkyLanes, HeightOverASphere) {
  const double radius = 6371.0;
  for (double height = 0.001; height < 120.0; height *= 1.01) {
    const auto excess = static_cast<float>(height * (2.0 * radius + height));
    ASSERT_NEAR(height_over(static_cast<float>(radius), excess), height, 1e-6 * height) << height;
  }
}

TEST(Sky, TablesAreTheSameForAnyThreads) {
  ThreadPool one(1), three(3);
  for (const SkyModel model : kScattering) {
    const SkyDesc sky = sky_of(model);
    const std::vector<float> table = sky_table(sky, one);
    EXPECT_EQ(table, sky_table(sky, three));
    for (const float value : table) ASSERT_TRUE(std::isfinite(value));
  }
}

// Far above the horizon the disc is even but for its limb: ∫ (0.4 + 0.6 √(1 − r²)) 2 r dr = 0.8.
TEST(Sky, MeanOfTheDisc) {
  ThreadPool pool(2);
  for (const SkyModel model : kScattering) {
    SkyDesc sky = sky_of(model);
    sky.sun_intensity = 100.0f;
    const std::vector<float> table = sky_table(sky, pool), numbers = sky_numbers(sky);
    const SkySun sun = sky_sun(sky, table);
    EXPECT_FLOAT_EQ(sun.radius, 0.5f * sky.sun_size);
    const Vec3 middle = ScatteringSky(numbers.data(), table).radiance(sun.direction);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sun.radiance[c] / middle[c], 0.8, 5e-4);
  }
}

TEST(Sky, NoSunBelowTheHorizon) {
  ThreadPool pool(1);
  for (const SkyModel model : kScattering) {
    SkyDesc sky = sky_of(model);
    sky.sun_elevation = -0.2f;
    EXPECT_EQ(sky_sun(sky, sky_table(sky, pool)).radiance, Vec3(0.0f));
  }
}

TEST(Sky, BadDirectionsAndTablesDoNoHarm) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> numbers = sky_numbers(sky_of(SkyModel::kMultipleScattering));
  const std::vector<float> small(5, 1.0f);
  for (const Vec3& d : {Vec3(kNaN), Vec3(0.0f), Vec3(1e30f), Vec3(0.0f, 0.0f, -1e30f)}) {
    EXPECT_FALSE(ScatteringSky(numbers.data(), small).radiance(d).x > 0.0f) << "no rows, no light";
    preetham_radiance(sky_numbers(sky_of(SkyModel::kPreetham)).data(), d);
    hosek_radiance(sky_numbers(sky_of(SkyModel::kHosek)).data(), d);
  }
}

TEST(Sky, SaysWhatIsWrong) {
  SkyDesc sky = sky_of(SkyModel::kNishita);
  sky.altitude = std::numeric_limits<float>::infinity();
  EXPECT_THROW(sky_numbers(sky), std::invalid_argument);
  sky.altitude = 0.0f;
  sky.sun_size = 0.0f;
  EXPECT_THROW(sky_numbers(sky), std::invalid_argument);
  ThreadPool pool(1);
  EXPECT_THROW(sky_table(sky_of(SkyModel::kHosek), pool), std::invalid_argument);
}

}  // namespace
}  // namespace komorebi
