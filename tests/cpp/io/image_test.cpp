// Image files, written by OpenImageIO itself or by hand and read back by us, and the reverse.
#include "io/image.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "support/shared_data.h"

namespace komorebi {
namespace {

namespace fs = std::filesystem;

class ImageFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("komorebi_" + std::string(test->name()) + "_" +
                                           std::to_string(std::random_device{}()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  // The sentence that reading `file` fails with; "" when it does not.
  static std::string error_of(const std::string& file) {
    try {
      read_image(file);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  // Row 0 at the top, as files have it.
  static void write(const std::string& file, int width, int height, int channels, const void* data,
                    OIIO::TypeDesc type, int tile = 0) {
    const auto output = OIIO::ImageOutput::create(file);
    ASSERT_TRUE(output) << OIIO::geterror();
    OIIO::ImageSpec spec(width, height, channels, type);
    spec.tile_width = spec.tile_height = tile;
    ASSERT_TRUE(output->open(file, spec)) << output->geterror();
    ASSERT_TRUE(output->write_image(type, data));
    ASSERT_TRUE(output->close());
  }

  fs::path folder_;
};

TEST_F(ImageFiles, ExrComesBackToTheBit) {
  Image image;
  image.width = 5;
  image.height = 3;
  image.channels = {"A.Z", "B.R", "C.id"};
  image.metadata = {{"komorebi:samples", "128"}, {"Software", "Komorebi"}};
  for (int i = 0; i < 45; ++i) image.pixels.push_back(std::ldexp(1.0f + 0.01f * float(i), i - 20));
  image.pixels[7] = std::numeric_limits<float>::infinity();
  image.pixels[8] = -3.4e38f;
  write_exr(path("a.exr"), image);

  const Image back = read_channels(path("a.exr"));
  EXPECT_EQ(back.width, 5u);
  EXPECT_EQ(back.height, 3u);
  EXPECT_EQ(back.channels, image.channels);
  EXPECT_EQ(back.pixels, image.pixels);
  for (const auto& entry : image.metadata) {
    EXPECT_NE(std::find(back.metadata.begin(), back.metadata.end(), entry), back.metadata.end())
        << entry.first;
  }
}

TEST_F(ImageFiles, RowZeroIsTheBottom) {
  const float top_down[] = {1, 1, 1, 2, 2, 2};  // two rows of one pixel
  write(path("a.exr"), 1, 2, 3, top_down, OIIO::TypeDesc::FLOAT);
  EXPECT_EQ(read_image(path("a.exr")).pixels, (std::vector<float>{2, 2, 2, 1, 1, 1}));
  Image image = read_channels(path("a.exr"));
  write_exr(path("b.exr"), image);
  const auto input = OIIO::ImageInput::open(path("b.exr"));
  float first_scanline[3];
  ASSERT_TRUE(input->read_scanline(0, 0, OIIO::TypeDesc::FLOAT, first_scanline));
  EXPECT_EQ(first_scanline[0], 1.0f);
}

TEST_F(ImageFiles, RadianceFileWrittenByHand) {
  std::ofstream file(path("a.hdr"), std::ios::binary);
  file << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
  const unsigned char rgbe[] = {128, 64, 32, 129, 255, 0, 128, 140};  // mantissa · 2^(e − 136)
  file.write(reinterpret_cast<const char*>(rgbe), sizeof rgbe);
  file.close();
  const Image image = read_image(path("a.hdr"));
  ASSERT_EQ(image.pixels.size(), 6u);
  const float expected[] = {1.0f, 0.5f, 0.25f, 255.0f * 16.0f, 0.0f, 128.0f * 16.0f};
  // Radiance's own convention adds half a step to the mantissa; OpenImageIO may or may not
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(image.pixels[i], expected[i], expected[i] / 64.0f + 9.0f * float(i >= 3));
  }
}

TEST_F(ImageFiles, EightAndSixteenBitFilesMapToUnitRange) {
  const unsigned char bytes[] = {0, 51, 255, 102, 153, 204};
  for (const char* name : {"a.png", "a.tif", "a.tga", "a.bmp"}) {
    write(path(name), 2, 1, 3, bytes, OIIO::TypeDesc::UINT8);
    const Image image = read_image(path(name));
    ASSERT_EQ(image.pixels.size(), 6u) << name;
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_NEAR(image.pixels[i], bytes[i] / 255.0f, 1e-7) << name;
  }
  const unsigned short shorts[] = {0, 13107, 65535};
  write(path("b.png"), 1, 1, 3, shorts, OIIO::TypeDesc::UINT16);
  EXPECT_NEAR(read_image(path("b.png")).pixels[1], 0.2f, 1e-6);
}

TEST_F(ImageFiles, JpegIsReadWithinItsLoss) {
  const std::vector<unsigned char> grey(16 * 16 * 3, 128);
  write(path("a.jpg"), 16, 16, 3, grey.data(), OIIO::TypeDesc::UINT8);
  for (const float value : read_image(path("a.jpg")).pixels) EXPECT_NEAR(value, 128 / 255.0f, 0.01);
}

TEST_F(ImageFiles, SrgbFilesAreDecodedWhenAsked) {
  const unsigned char bytes[] = {0, 10, 11, 128, 188, 255};
  write(path("a.png"), 2, 1, 3, bytes, OIIO::TypeDesc::UINT8);
  const Image image = read_image(path("a.png"), ColorSpace::kSrgb);
  for (std::size_t i = 0; i < 6; ++i) {
    const double x = bytes[i] / 255.0;
    const double linear = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(image.pixels[i], linear, 1e-6);
  }
}

TEST_F(ImageFiles, GreyBecomesThreeEqualChannelsAndAlphaGoes) {
  const float grey[] = {0.25f, 4.0f};
  write(path("grey.exr"), 2, 1, 1, grey, OIIO::TypeDesc::FLOAT);
  EXPECT_EQ(read_image(path("grey.exr")).pixels,
            (std::vector<float>{0.25f, 0.25f, 0.25f, 4.0f, 4.0f, 4.0f}));
  const float rgba[] = {1.0f, 2.0f, 3.0f, 0.5f};
  write(path("rgba.exr"), 1, 1, 4, rgba, OIIO::TypeDesc::FLOAT);
  const Image image = read_image(path("rgba.exr"));
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(image.pixels, (std::vector<float>{1.0f, 2.0f, 3.0f}));
}

TEST_F(ImageFiles, TiledFilesAreReadWhole) {
  std::vector<float> data;
  for (int i = 0; i < 70 * 33 * 3; ++i) data.push_back(static_cast<float>(i));
  write(path("a.exr"), 70, 33, 3, data.data(), OIIO::TypeDesc::FLOAT, 16);
  const Image image = read_image(path("a.exr"));
  for (std::size_t row = 0; row < 33; ++row) {
    for (std::size_t i = 0; i < 210; ++i) {
      ASSERT_EQ(image.pixels[row * 210 + i], data[(32 - row) * 210 + i]);
    }
  }
}

TEST_F(ImageFiles, ErrorsAreOneSentenceWithTheName) {
  std::ofstream(path("text.hdr")) << "this is no image\n";
  std::ofstream(path("empty.exr")).flush();
  write(path("whole.exr"), 64, 64, 3, std::vector<float>(64 * 64 * 3, 0.3f).data(),
        OIIO::TypeDesc::FLOAT);
  fs::copy_file(path("whole.exr"), path("cut.exr"));
  fs::resize_file(path("cut.exr"), fs::file_size(path("cut.exr")) / 2);
  write(path("whole.hdr"), 64, 64, 3, std::vector<float>(64 * 64 * 3, 0.3f).data(),
        OIIO::TypeDesc::FLOAT);
  fs::copy_file(path("whole.hdr"), path("cut.hdr"));
  fs::resize_file(path("cut.hdr"), fs::file_size(path("cut.hdr")) / 2);
  for (const char* name : {"missing.hdr", "text.hdr", "empty.exr", "cut.exr", "cut.hdr", "."}) {
    const std::string error = error_of(path(name));
    EXPECT_NE(error.find("\"" + path(name) + "\""), std::string::npos) << name << ": " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_LT(error.size(), path(name).size() + 300) << error;
  }
  EXPECT_NE(error_of(path("missing.hdr")).find("no such file"), std::string::npos);
  EXPECT_TRUE(OIIO::geterror().empty());
}

TEST_F(ImageFiles, AbsurdSizeIsRefusedBeforeMemoryIsTaken) {
  std::ofstream(path("a.hdr"), std::ios::binary)
      << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000000 +X 1000000\n";
  const std::string error = error_of(path("a.hdr"));
  EXPECT_NE(error.find("absurd size"), std::string::npos) << error;
}

TEST_F(ImageFiles, WritingWhereOneCannotIsAnError) {
  Image image;
  image.width = image.height = 1;
  image.channels = {"R"};
  image.pixels = {1.0f};
  EXPECT_THROW(write_exr(path("no/such/folder/a.exr"), image), std::runtime_error);
  image.pixels.push_back(2.0f);
  EXPECT_THROW(write_exr(path("a.exr"), image), std::invalid_argument);
}

TEST(Srgb, FollowsTheStandard) {
  for (int i = 0; i <= 40000; ++i) {
    const float x = static_cast<float>(i) / 10000.0f;
    const double exact = x <= 0.04045f ? x / 12.92 : std::pow((double{x} + 0.055) / 1.055, 2.4);
    ASSERT_NEAR(linear_from_srgb(x), exact, 1e-6 * exact + 1e-12) << x;
  }
  EXPECT_EQ(linear_from_srgb(0.0f), 0.0f);
  EXPECT_EQ(linear_from_srgb(1.0f), 1.0f);
  EXPECT_NEAR(linear_from_srgb(-0.02f), -0.02 / 12.92, 1e-9);
  EXPECT_TRUE(std::isinf(linear_from_srgb(std::numeric_limits<float>::infinity())));
}

struct Map {
  const char* file;
  unsigned width, height;
  double max_luminance;
};
class SharedMaps : public ::testing::TestWithParam<Map> {};
INSTANTIATE_TEST_SUITE_P(All, SharedMaps,
                         ::testing::Values(Map{"rooitou_park_1k.hdr", 1024, 512, 6.515e4},
                                           Map{"StageEnvLatLong.exr", 1000, 500, 4096.0},
                                           Map{"OrientationLatLong.exr", 1024, 512, 0.9907},
                                           Map{"NV_Default_HDR_3000x1500.hdr", 3000, 1500, 41.38},
                                           Map{"park_dwaa_negative.exr", 512, 256, 852.0}));

// Sizes and peaks as the data's own manifest gives them.
TEST_P(SharedMaps, HaveTheirKnownSizeAndPeak) {
  KOMOREBI_SHARED_FILE(path, std::string("data/hdri/") + GetParam().file);
  const Image image = read_image(path);
  EXPECT_EQ(image.width, GetParam().width);
  EXPECT_EQ(image.height, GetParam().height);
  double peak = 0.0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    const float* p = &image.pixels[i];
    peak = std::max(peak, 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]);
  }
  EXPECT_NEAR(peak / GetParam().max_luminance, 1.0, 0.01);
}

}  // namespace
}  // namespace komorebi
