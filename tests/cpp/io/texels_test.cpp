// Picture files in the type of number that they have, written by OpenImageIO itself.
#include "io/texels.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

namespace komorebi {
namespace {

namespace fs = std::filesystem;

class TexelFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("komorebi_texels_" + std::to_string(std::random_device{}()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  static void write(const std::string& file, int width, int height, int channels, const void* data,
                    OIIO::TypeDesc type) {
    const auto output = OIIO::ImageOutput::create(file);
    ASSERT_TRUE(output) << OIIO::geterror();
    OIIO::ImageSpec spec(width, height, channels, type);
    spec.attribute("oiio:UnassociatedAlpha", 1);  // PNG writers take the numbers as they are
    ASSERT_TRUE(output->open(file, spec)) << output->geterror();
    ASSERT_TRUE(output->write_image(type, data));
    ASSERT_TRUE(output->close());
  }
  static std::string error_of(const std::string& file) {
    try {
      read_texels(file, {});
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  static std::vector<std::uint8_t> bytes(const Texels& texels) {
    const auto* p = reinterpret_cast<const std::uint8_t*>(texels.data.get());
    return {p, p + texels.byte_count()};
  }
  static std::vector<std::byte> contents(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::vector<char> data{std::istreambuf_iterator<char>(stream), {}};
    std::vector<std::byte> out(data.size());
    std::memcpy(out.data(), data.data(), data.size());
    return out;
  }

  fs::path folder_;
};

TEST_F(TexelFiles, ColoursAreMultipliedByAlphaInBytes) {
  const std::uint8_t rgba[] = {200, 100, 50, 128, 9, 8, 7, 0};  // two rows
  write(path("a.png"), 1, 2, 4, rgba, OIIO::TypeDesc::UINT8);
  EXPECT_EQ(bytes(read_texels(path("a.png"), {})),
            (std::vector<std::uint8_t>{0, 0, 0, 0, 100, 50, 25, 128}));
  EXPECT_EQ(bytes(read_texels(path("a.png"), {false, false})),
            (std::vector<std::uint8_t>{9, 8, 7, 0, 200, 100, 50, 128}));
  EXPECT_EQ(bytes(read_texels(path("a.png"), {false, true})),
            (std::vector<std::uint8_t>{9, 8, 7, 255, 200, 100, 50, 255}));
}

TEST_F(TexelFiles, FewerChannelsAreWidened) {
  const std::uint8_t values[] = {10, 20, 30, 40, 50, 60};
  write(path("grey.png"), 6, 1, 1, values, OIIO::TypeDesc::UINT8);
  const Texels grey = read_texels(path("grey.png"), {});
  EXPECT_EQ(grey.channels, 1u);
  EXPECT_EQ(bytes(grey), (std::vector<std::uint8_t>{10, 20, 30, 40, 50, 60}));
  write(path("ga.png"), 3, 1, 2, values, OIIO::TypeDesc::UINT8);
  EXPECT_EQ(bytes(read_texels(path("ga.png"), {})),
            (std::vector<std::uint8_t>{10, 10, 10, 20, 30, 30, 30, 40, 50, 50, 50, 60}));
  write(path("rgb.png"), 2, 1, 3, values, OIIO::TypeDesc::UINT8);
  EXPECT_EQ(bytes(read_texels(path("rgb.png"), {})),
            (std::vector<std::uint8_t>{10, 20, 30, 255, 40, 50, 60, 255}));
}

TEST_F(TexelFiles, NumbersKeepTheirType) {
  const std::uint16_t shorts[] = {1, 2, 3, 65535};
  write(path("s.png"), 1, 1, 4, shorts, OIIO::TypeDesc::UINT16);
  EXPECT_EQ(read_texels(path("s.png"), {}).type, TexelType::kShort);
  const float floats[] = {0.25f, 4.0f, 1e6f, 0.5f, 7.0f};
  write(path("f.exr"), 1, 1, 4, floats, OIIO::TypeDesc::FLOAT);
  const Texels full = read_texels(path("f.exr"), {});
  EXPECT_EQ(full.type, TexelType::kFloat);
  EXPECT_EQ(reinterpret_cast<const float*>(full.data.get())[2], 1e6f);  // EXR is premultiplied
  const std::uint16_t halves[] = {0x3c00, 0x4000, 0x3800};
  write(path("h.exr"), 1, 1, 3, halves, OIIO::TypeDesc::HALF);
  const Texels half = read_texels(path("h.exr"), {});
  EXPECT_EQ(half.type, TexelType::kHalf);
  EXPECT_EQ(reinterpret_cast<const std::uint16_t*>(half.data.get())[3], 0x3c00);
  write(path("five.exr"), 1, 1, 5, floats, OIIO::TypeDesc::FLOAT);
  EXPECT_EQ(read_texels(path("five.exr"), {}).channels, 4u);
  const Texels header = read_texel_header(path("h.exr"));
  EXPECT_EQ(header.byte_count(), half.byte_count());
}

TEST_F(TexelFiles, FilesInMemoryAreReadAlike) {
  std::vector<std::uint8_t> values(4 * 32 * 16);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint8_t>(i * 7);
  std::vector<float> floats(values.begin(), values.end());
  for (const char* name : {"a.png", "a.tga", "a.jpg", "a.exr", "a.hdr"}) {
    const std::string format = fs::path(name).extension();
    const bool is_float = format == ".exr" || format == ".hdr";
    const int channels = format == ".jpg" || format == ".hdr" ? 3 : 4;
    write(path(name), 32, 16, channels, is_float ? (const void*)floats.data() : values.data(),
          is_float ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    const auto file = contents(path(name));
    for (const std::string& known_as : {std::string(name), std::string("no ending")}) {
      EXPECT_EQ(bytes(read_texels(file, known_as, {})), bytes(read_texels(path(name), {})))
          << known_as;
    }
  }
}

TEST_F(TexelFiles, TallFilesAreReadInBandsAndMayBeCancelled) {
  constexpr int kWidth = 5, kHeight = 333;
  std::vector<float> values(4 * kWidth * kHeight);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 997) / 997.0f;
  std::vector<float> upward;
  for (int y = kHeight - 1; y >= 0; --y) {
    const float* const row = values.data() + 4 * kWidth * y;
    upward.insert(upward.end(), row, row + 4 * kWidth);
  }
  struct Layout {
    const char* name;
    int rows_per_strip, tile;
  };
  for (const Layout& layout :
       {Layout{"lines.exr", 0, 0}, Layout{"tiles.exr", 0, 32}, Layout{"strips.tif", 48, 0},
        Layout{"strip.tif", kHeight, 0}, Layout{"tiles.tif", 0, 16}}) {
    const std::string file = path(layout.name);
    OIIO::ImageSpec spec(kWidth, kHeight, 4, OIIO::TypeDesc::FLOAT);
    if (layout.rows_per_strip > 0) spec.attribute("tiff:RowsPerStrip", layout.rows_per_strip);
    spec.tile_width = spec.tile_height = layout.tile;
    const auto output = OIIO::ImageOutput::create(file);
    ASSERT_TRUE(output && output->open(file, spec) &&
                output->write_image(OIIO::TypeDesc::FLOAT, values.data()) && output->close());
    const Texels read = read_texels(file, {false, false});
    ASSERT_EQ(read.byte_count(), upward.size() * sizeof(float));
    EXPECT_EQ(std::memcmp(read.data.get(), upward.data(), read.byte_count()), 0) << layout.name;
    Cancel cancel;
    cancel.raise();
    EXPECT_THROW(read_texels(file, {}, cancel), Cancelled);
  }
}

TEST_F(TexelFiles, BadFilesAreASentence) {
  EXPECT_EQ(error_of(path("none.png")), "image \"" + path("none.png") + "\": no such file");
  EXPECT_NE(error_of(folder_.string()).find("is a folder"), std::string::npos);
  std::ofstream(path("empty.png")).close();
  EXPECT_NE(error_of(path("empty.png")).find("not an image"), std::string::npos);
  const std::vector<float> values(3 * 64 * 64, 0.3f);
  std::mt19937 random(1);
  std::vector<std::uint8_t> noise(3 * 64 * 64);
  for (auto& v : noise) v = static_cast<std::uint8_t>(random());
  for (const char* name : {"a.exr", "a.hdr", "a.png", "a.tif"}) {
    const bool is_float = fs::path(name).extension() != ".png";
    std::vector<float> light(noise.begin(), noise.end());
    write(path(name), 64, 64, 3, is_float ? (const void*)light.data() : noise.data(),
          is_float ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    for (const double share : {0.01, 0.3, 0.7}) {
      const auto size = static_cast<std::uintmax_t>(share * double(fs::file_size(path(name))));
      fs::copy_file(path(name), path(std::string("cut_") + name),
                    fs::copy_options::overwrite_existing);
      fs::resize_file(path(std::string("cut_") + name), size);
      const std::string error = error_of(path(std::string("cut_") + name));
      EXPECT_NE(error.find("cut_"), std::string::npos) << name << " " << share << ": " << error;
      const auto file = contents(path(std::string("cut_") + name));
      EXPECT_THROW(read_texels(file, name, {}), std::runtime_error) << name << " " << share;
    }
  }
  // a Radiance file that claims to be huge
  std::ofstream(path("huge.hdr"))
      << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 99999 +X 99999\nxxxx";
  EXPECT_NE(error_of(path("huge.hdr")).find("absurd size"), std::string::npos)
      << error_of(path("huge.hdr"));
  std::ofstream(path("zero.hdr")) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 0\n";
  EXPECT_NE(error_of(path("zero.hdr")), "");
}

}  // namespace
}  // namespace komorebi
