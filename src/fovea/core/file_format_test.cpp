#include "fovea/core/file_format.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>

namespace fovea::file_format_test {

using namespace std::string_literals;

FileFormat format_of(const std::string& bytes) { return sniff_format(bytes).format; }

TEST(FileFormat, HeadersArePcdPlyAndLas) {
  EXPECT_EQ(format_of("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"),
            FileFormat::kPcd);
  EXPECT_EQ(format_of("VERSION 0.7\nFIELDS x y z\n"), FileFormat::kPcd);
  EXPECT_EQ(format_of("# a comment\r\n\r\nFIELDS x y z\n"), FileFormat::kPcd);
  EXPECT_EQ(format_of("# a comment\n1 2 3 and more text\n"), FileFormat::kText);
  for (const char* text :
       {"ply\n", "ply\r\n", "ply \n", "ply\t \r\n", "ply", "\xef\xbb\xbfply\n"}) {
    EXPECT_EQ(format_of(text), FileFormat::kPly) << text;
  }
  EXPECT_EQ(format_of("plywood is no point cloud"), FileFormat::kText);
  EXPECT_EQ(format_of("LASF" + std::string(100, '\0') + '\x03'), FileFormat::kLas);
  EXPECT_EQ(format_of("LASF" + std::string(100, '\0') + '\x83'), FileFormat::kLaz);
}

TEST(FileFormat, NothingAndOneByteAreUnknown) {
  EXPECT_EQ(format_of(""), FileFormat::kUnknown);
  EXPECT_EQ(format_of("p"), FileFormat::kUnknown);
  EXPECT_EQ(format_of(std::string(512, '\0')), FileFormat::kUnknown);
}

TEST(FileFormat, OtherFormatsHaveNames) {
  EXPECT_EQ(sniff_format("ASTM-E57\1\0\0\0"s).name, "an E57 point cloud");
  EXPECT_EQ(sniff_format("PK\3\4"s).name, "a ZIP archive");
  EXPECT_EQ(sniff_format("II*\0"s).name, "a TIFF image");
  EXPECT_EQ(sniff_format(std::string(257, 'a') + "ustar\0"s).name, "a tar archive");
  EXPECT_EQ(sniff_format("<?xml version=\"1.0\"?>").name, "an XML file");
  EXPECT_EQ(sniff_format("BZh91AY&SY").name, "bzip2-compressed data");
  EXPECT_EQ(sniff_format("\x89HDF\r\n\x1a\n").name, "an HDF5 file");
}

/// Coordinates of scans have no first bytes of another format.
TEST(FileFormat, PointsWithoutAHeaderAreUnknown) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> coordinate(-100, 100), intensity(0, 1);
  for (int i = 0; i < 200'000; ++i) {
    std::string bytes(16 * 4, '\0');
    for (std::size_t at = 0; at < bytes.size(); at += 4) {
      const float value = at % 16 == 12 ? intensity(random) : coordinate(random);
      std::memcpy(bytes.data() + at, &value, 4);
    }
    ASSERT_EQ(format_of(bytes), FileFormat::kUnknown) << i;
  }
}

/// The least and the largest float32 that a file of a signature can begin with are no coordinates.
TEST(FileFormat, ShortSignaturesAreNoCoordinates) {
  const auto value_of = [](const std::string& bytes) {
    float value = 0;
    std::memcpy(&value, bytes.data(), 4);
    return std::abs(value);
  };
  for (const std::string& bytes : {"II*\0"s, "MM\0*"s, "RIFF"s, "\x28\xb5\x2f\xfd"s, "PK\3\4"s,
                                   "glTF"s, "\xd4\xc3\xb2\xa1"s, "\x0a\x0d\x0d\x0a"s, "LASF"s,
                                   "ply\n"s, "ply "s, "\xff\xd8\xff\xe0"s, "\x1f\x8b\x08\x00"s}) {
    ASSERT_NE(format_of(bytes), FileFormat::kUnknown);
    EXPECT_TRUE(value_of(bytes) < 1e-3f || value_of(bytes) > 1e3f) << bytes;
  }
  float near_31_98 = 31.98f;  // bytes ff d8 ff but the last one
  std::uint32_t bits = 0x41ffd8ffu;
  std::memcpy(&near_31_98, &bits, 4);
  EXPECT_NEAR(near_31_98, 31.98f, 0.01f);
  EXPECT_EQ(format_of("\xff\xd8\xff\x41"), FileFormat::kUnknown);
}

}  // namespace fovea::file_format_test
