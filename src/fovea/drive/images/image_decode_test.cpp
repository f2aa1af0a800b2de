#include "fovea/drive/images/image_decode.h"

#include <gtest/gtest.h>
#include <jpeglib.h>

#include <span>

#include "../../../../tests/kitti_test_drive.h"
#include "fovea/errors.h"

namespace fovea::image_decode_test {

using test::error_of;
using test::pattern;
using test::TemporaryFolder;
using test::write_png;
using test::write_text;

/// A photograph-like image: JPEG keeps smooth colours to a few grey values.
Image gradient(int width, int height, int channels) {
  Image image(width, height, channels);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) {
        image.pixel(x, y)[c] = static_cast<std::uint8_t>(60 + x + (c == 1 ? y : 0));
      }
    }
  }
  return image;
}

void write_jpeg(const test::fs::path& file, const Image& image, bool progressive = false,
                J_COLOR_SPACE color = JCS_UNKNOWN, std::span<const jpeg_scan_info> scans = {}) {
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  ASSERT_NE(stream, nullptr);
  jpeg_compress_struct codec{};
  jpeg_error_mgr errors{};
  codec.err = jpeg_std_error(&errors);
  jpeg_create_compress(&codec);
  jpeg_stdio_dest(&codec, stream);
  codec.image_width = static_cast<JDIMENSION>(image.width);
  codec.image_height = static_cast<JDIMENSION>(image.height);
  codec.input_components = image.channels;
  codec.in_color_space = color != JCS_UNKNOWN  ? color
                         : image.channels == 3 ? JCS_RGB
                                               : JCS_GRAYSCALE;
  jpeg_set_defaults(&codec);
  jpeg_set_quality(&codec, 98, TRUE);
  if (progressive) jpeg_simple_progression(&codec);
  if (!scans.empty()) {
    codec.scan_info = scans.data();
    codec.num_scans = static_cast<int>(scans.size());
  }
  jpeg_start_compress(&codec, TRUE);
  while (codec.next_scanline < codec.image_height) {
    JSAMPROW row = const_cast<JSAMPROW>(image.pixel(0, static_cast<int>(codec.next_scanline)));
    jpeg_write_scanlines(&codec, &row, 1);
  }
  jpeg_finish_compress(&codec);
  jpeg_destroy_compress(&codec);
  std::fclose(stream);
}

int worst_difference(const Image& a, const Image& b) {
  int worst = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    worst = std::max(worst, std::abs(int(a.data[i]) - int(b.data[i])));
  }
  return worst;
}

class ImageDecode : public testing::Test {
 protected:
  std::string message() const {
    return error_of<InputError>([&] { read_image(file_); });
  }
  bool fails_with(const std::string& text) const {
    const std::string what = message();
    return what.find(text) != std::string::npos && what.find(file_.string()) != std::string::npos;
  }
  TemporaryFolder folder_;
  test::fs::path file_ = folder_.path() / "0000000007.png";
};

TEST_F(ImageDecode, PngIsExact) {
  for (const int channels : {1, 3}) {
    const Image image = pattern(31, 17, channels);
    write_png(file_, image);
    const Image read = read_image(file_);
    EXPECT_EQ(read.width, 31);
    EXPECT_EQ(read.height, 17);
    EXPECT_EQ(read.channels, channels);
    EXPECT_EQ(read.data, image.data);
  }
}

TEST_F(ImageDecode, PngWithAlphaOrPaletteBecomesRgb) {
  const std::vector<std::uint8_t> rgba{1, 2, 3, 255, 40, 50, 60, 128};
  write_png(file_, 2, 1, PNG_FORMAT_RGBA, rgba.data());
  EXPECT_EQ(read_image(file_).data, (std::vector<std::uint8_t>{1, 2, 3, 40, 50, 60}));

  const std::vector<std::uint8_t> indices{1, 0, 1}, colors{10, 20, 30, 200, 210, 220};
  write_png(file_, 3, 1, PNG_FORMAT_RGB_COLORMAP, indices.data(), colors.data(), 2);
  EXPECT_EQ(read_image(file_).data,
            (std::vector<std::uint8_t>{200, 210, 220, 10, 20, 30, 200, 210, 220}));
}

TEST_F(ImageDecode, PngOf16BitsIsRefused) {
  const std::vector<std::uint16_t> samples{1000, 2000, 3000, 4000};
  write_png(file_, 2, 2, PNG_FORMAT_LINEAR_Y, samples.data());
  EXPECT_TRUE(fails_with("16 bits")) << message();
}

TEST_F(ImageDecode, DamagedPngIsAnErrorWithoutNoise) {
  testing::internal::CaptureStderr();
  for (const double share : {0.99, 0.9, 0.5, 0.1}) {
    write_png(file_, pattern(200, 100, 3));
    test::truncate(file_, share);
    EXPECT_TRUE(fails_with("PNG image cannot be read")) << share;
  }
  write_png(file_, pattern(200, 100, 3));
  std::string bytes = test::read_text(file_);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
  write_text(file_, bytes);
  EXPECT_TRUE(fails_with("PNG image cannot be read"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(ImageDecode, AbsurdPngIsRefusedBeforeMemoryIsTaken) {
  write_png(file_, pattern(2, 2, 3));
  std::string bytes = test::read_text(file_);
  bytes[16] = 0x7f;  // width 2 billion; the header's checksum no longer fits, either
  write_text(file_, bytes);
  EXPECT_TRUE(fails_with("PNG image cannot be read"));
  const std::vector<std::uint8_t> row(kMaxImageSide + 1);
  write_png(file_, static_cast<int>(row.size()), 1, PNG_FORMAT_GRAY, row.data());
  EXPECT_TRUE(fails_with("Invalid IHDR")) << message();
}

TEST_F(ImageDecode, JpegIsToldByItsContent) {
  for (const int channels : {1, 3}) {
    for (const bool progressive : {false, true}) {
      const Image image = gradient(64, 40, channels);
      write_jpeg(file_, image, progressive);  // though the name ends in .png
      const Image read = read_image(file_);
      ASSERT_EQ(read.channels, channels);
      ASSERT_EQ(read.data.size(), image.data.size());
      EXPECT_LE(worst_difference(read, image), 6);
    }
  }
}

TEST_F(ImageDecode, DamagedJpegIsAnErrorWithoutNoise) {
  testing::internal::CaptureStderr();
  for (const double share : {0.98, 0.9, 0.5, 0.1}) {
    write_jpeg(file_, pattern(200, 100, 3));
    test::truncate(file_, share);  // libjpeg would fill the rest with grey and only warn
    EXPECT_TRUE(fails_with("JPEG image cannot be read")) << share;
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(ImageDecode, JpegThatIsNoRgbOrAbsurdIsRefused) {
  write_jpeg(file_, gradient(16, 16, 4), false, JCS_CMYK);
  EXPECT_TRUE(fails_with("JPEG image cannot be read"));
  write_jpeg(file_, gradient(static_cast<int>(kMaxImageSide) + 1, 1, 1));
  EXPECT_TRUE(fails_with("too many")) << message();
}

TEST_F(ImageDecode, JpegThatNoFileOfItsLengthHoldsIsRefused) {
  write_jpeg(file_, gradient(16, 16, 1));
  std::string bytes = test::read_text(file_);
  const std::size_t size = bytes.find("\xff\xc0") + 5;
  for (const std::size_t side : {size, size + 2}) {
    bytes[side] = static_cast<char>(kMaxImageSide >> 8);
    bytes[side + 1] = 0;
  }
  write_text(file_, bytes);
  EXPECT_TRUE(fails_with("too short for its pixels")) << message();
}

TEST_F(ImageDecode, JpegOfCountlessScansIsRefused) {
  // A scan that refines nothing may be repeated.
  constexpr std::array<jpeg_scan_info, 2> kScans{{{1, {0}, 0, 0, 0, 0}, {1, {0}, 1, 63, 0, 0}}};
  write_jpeg(file_, gradient(16, 16, 1), true, JCS_UNKNOWN, kScans);
  const std::string bytes = test::read_text(file_);
  const std::size_t begin = bytes.rfind("\xff\xda"), end = bytes.rfind("\xff\xd9");
  std::string many = bytes.substr(0, end);
  for (int i = 0; i < 200; ++i) many += bytes.substr(begin, end - begin);
  write_text(file_, many + bytes.substr(end));
  EXPECT_TRUE(fails_with("scans are too many")) << message();
}

TEST_F(ImageDecode, OtherFilesAreNoImages) {
  EXPECT_TRUE(fails_with("cannot be read"));  // missing
  write_text(file_, "");
  EXPECT_TRUE(fails_with("neither a PNG nor a JPEG"));
  write_text(file_, "GIF89a.......");
  EXPECT_TRUE(fails_with("neither a PNG nor a JPEG"));
  write_text(file_, "\x89PNG\r\n\x1a\n");
  EXPECT_TRUE(fails_with("truncated"));
}

}  // namespace fovea::image_decode_test
