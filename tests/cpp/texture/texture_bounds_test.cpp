// Bounds of look-ups hold the look-ups, and are narrow where a picture is even.
#include "texture/texture_bounds.h"

#include <gtest/gtest.h>

#include <random>

#include "support/leaf_picture.h"

namespace komorebi::testing {
namespace {

TextureColor color_of(bool srgb, bool data) {
  TextureColor color;
  color.srgb = srgb;
  color.data = data;
  return color;
}

/// How many of the bounds of random areas are known, and how many narrow, of red and of alpha.
struct Told {
  int red = 0, alpha = 0, narrow_alpha = 0;
};

Told expect_bounds(const Texture& texture, const TextureBounds& bounds,
                   const TextureSampling& how) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-1.7f, 2.6f), share(0.0f, 1.0f);
  Told told;
  for (int i = 0; i < 400; ++i) {
    const float width = std::exp2(-12.0f * share(random)), u = place(random), v = place(random);
    const float height = width * (0.3f + share(random));
    FloatRange found[4];
    bounds.lookup(how, {u, u + width}, {v, v + height}, found);
    told.red += found[0].known();
    told.alpha += found[3].known();
    told.narrow_alpha += found[3].hi - found[3].lo < 1e-4f;
    for (int k = 0; k < 60; ++k) {
      const auto between = [&](float a, float b) {
        const float x = k == 0 ? a : k == 1 ? b : a + share(random) * (b - a);
        return std::min(std::max(x, a), b);
      };
      const Vec4 value = texture.lookup(how, between(u, u + width), between(v, v + height));
      for (int c = 0; c < 4; ++c) {
        EXPECT_LE(found[c].lo, value[c]) << c << " " << u << " " << v << " " << width;
        EXPECT_GE(found[c].hi, value[c]) << c << " " << u << " " << v << " " << width;
      }
    }
  }
  return told;
}

TEST(TextureBounds, HoldLookupsOfEveryKind) {
  ThreadPool pool(2);
  for (const std::uint32_t channels : {1u, 4u}) {
    for (const TexelType type : {TexelType::kByte, TexelType::kFloat}) {
      for (const bool srgb : {false, true}) {
        for (const auto& [width, height] : {std::pair(1u, 1u), std::pair(150u, 41u)}) {
          const auto texture =
              leaf_picture(width, height, type, channels, color_of(srgb, !srgb), pool);
          const TextureBounds bounds(*texture, pool);
          for (const auto interpolation :
               {Interpolation::kClosest, Interpolation::kLinear, Interpolation::kCubic}) {
            for (const auto extension :
                 {Extension::kRepeat, Extension::kExtend, Extension::kClip, Extension::kMirror}) {
              const Told told = expect_bounds(*texture, bounds, {interpolation, extension, true});
              EXPECT_EQ(told.alpha, 400);
              EXPECT_GT(told.narrow_alpha, width > 1 ? 150 : -1) << "in even parts";
              EXPECT_TRUE(told.red == 400 || (srgb && channels == 4));
            }
          }
        }
      }
    }
  }
}

TEST(TextureBounds, KnowNothingOfTilesAndOfPlacesThatAreUnknown) {
  ThreadPool pool(1);
  const auto leaf = leaf_picture(8, 8, TexelType::kByte, 4, {}, pool);
  const Texture tiles("tiles", {{1001u, leaf}});
  FloatRange found[4];
  TextureBounds(tiles, pool).lookup({}, {0.1f, 0.2f}, {0.1f, 0.2f}, found);
  EXPECT_FALSE(found[3].known());
  TextureBounds(*leaf, pool).lookup({}, {0.1f, 0.2f}, {}, found);
  EXPECT_FALSE(found[3].known());
}

}  // namespace
}  // namespace komorebi::testing
