#include "fovea/map/point_files/pcd_reader.h"

#include <gmock/gmock.h>

#include "../../../../tests/peak_memory.h"
#include "fovea/core/point_formats/lzf.h"
#include "fovea/map/point_files/cloud_test_files.h"

namespace fovea::pcd_reader_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

class PcdReaderTest : public CloudFileTest {
 protected:
  CloudFile read(const std::string& content, const Eigen::Vector3d& origin = {0, 0, 0}) const {
    return read_pcd(write(content), origin);
  }
  void expect_rejected(const std::string& content, const std::string& why) const {
    EXPECT_THAT([&] { read(content); }, ThrowsMessage<InputError>(HasSubstr(why))) << content;
  }
};

std::string header(const std::string& fields, const std::string& data, int points) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + fields + "WIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
         std::to_string(points) + "\nDATA " + data + "\n";
}

const std::string kPacked = "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\n";

/// LZF by hand: runs of one byte as a literal and a copy of it, everything else as literals.
std::string lzf_compress(const std::string& bytes) {
  std::string packed;
  for (std::size_t at = 0; at < bytes.size();) {
    packed += '\0';  // one literal
    packed += bytes[at];
    std::size_t run = bytes.find_first_not_of(bytes[at], at);
    if (run == std::string::npos) run = bytes.size();
    std::size_t copies = run - at - 1;
    at = run;
    while (copies >= 3) {
      const std::size_t count = std::min<std::size_t>(copies, 264);
      if (count <= 8) {
        packed += static_cast<char>((count - 2) << 5);
      } else {
        packed += static_cast<char>(7 << 5);
        packed += static_cast<char>(count - 9);
      }
      packed += '\0';  // distance 1
      copies -= count;
    }
    at -= copies;
  }
  return packed;
}

std::string compressed(const std::string& fields, int points, const std::string& columns) {
  std::string bytes = header(fields, "binary_compressed", points);
  const std::string packed = lzf_compress(columns);
  put(bytes, static_cast<std::uint32_t>(packed.size()));
  put(bytes, static_cast<std::uint32_t>(columns.size()));
  return bytes + packed;
}

TEST_F(PcdReaderTest, UnpacksLzf) {
  EXPECT_EQ(lzf_decompress(std::string("\x02xyz", 4), 3), "xyz");
  // xyz, then 5 bytes from 3 before: the copy overlaps itself.
  EXPECT_EQ(lzf_decompress(std::string("\x02xyz\x60\x02", 6), 8), "xyzxyzxy");
  const std::string long_run(1000, 'a');
  EXPECT_EQ(lzf_decompress(lzf_compress(long_run), 1000), long_run);
  // A copy from 256 + 1 before: the distance's upper bits.
  std::string far;
  for (int i = 0; i < 257; ++i) far += static_cast<char>(i * 7 % 251);
  std::string packed;
  for (std::size_t at = 0; at < far.size(); at += 32) {
    const std::string part = far.substr(at, 32);
    packed += static_cast<char>(part.size() - 1) + part;
  }
  EXPECT_EQ(lzf_decompress(packed + std::string("\x21\x00", 2), 260), far + far.substr(0, 3));
  // A growth by kLzfMaxRatio at most.
  EXPECT_LE(long_run.size(), kLzfMaxRatio * lzf_compress(long_run).size());
}

TEST_F(PcdReaderTest, RefusesDamagedLzf) {
  EXPECT_EQ(lzf_decompress(std::string("\x02xy", 3), 3), std::nullopt);         // literals end
  EXPECT_EQ(lzf_decompress(std::string("\x00x\x20\x01", 4), 4), std::nullopt);  // before the begin
  EXPECT_EQ(lzf_decompress(std::string("\x00x\x20", 3), 4), std::nullopt);      // no distance
  EXPECT_EQ(lzf_decompress(std::string("\x00x\xe0", 3), 4), std::nullopt);      // no length
  EXPECT_EQ(lzf_decompress(std::string("\x00x\x20\x00", 4), 3), std::nullopt);  // too much
  EXPECT_EQ(lzf_decompress(std::string("\x00x\x20\x00", 4), 5), std::nullopt);  // too little
}

TEST_F(PcdReaderTest, ReadsTexts) {
  const CloudFile cloud =
      read(header(kPacked, "ascii", 2) + "1 2 3 66051\r\n-1.5 1e1 0 4294901760\n", {1, 1, 1});
  EXPECT_THAT(cloud.points.position,
              ElementsAre(Eigen::Vector3f(0, 1, 2), Eigen::Vector3f(-2.5f, 9, -1)));
  EXPECT_THAT(cloud.points.color, ElementsAre(Rgb{1, 2, 3}, Rgb{255, 0, 0}));
  EXPECT_THAT(cloud.points.camera, ElementsAre(0, 0));
  EXPECT_FALSE(cloud.has_camera);
  EXPECT_TRUE(cloud.points.frame.empty());
}

TEST_F(PcdReaderTest, ReadsColoursPackedIntoAFloat) {
  const std::string fields = "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n";
  // 0x00102030 as a float's bits is a tiny number; other programs write the whole number.
  const CloudFile cloud =
      read(header(fields, "ascii", 2) + "1 2 3 1.48091464e-39\n1 2 3 1056816\n");
  EXPECT_THAT(cloud.points.color, ElementsAre(Rgb{16, 32, 48}, Rgb{16, 32, 48}));
  expect_rejected(header(fields, "ascii", 1) + "1 2 3 nan\n", "not a number");
  std::string bytes = header(fields, "binary", 1);
  for (const float x : {1.f, 2.f, 3.f}) put(bytes, x);
  put(bytes, std::uint32_t{0xff102030});  // of no number, as a float
  EXPECT_THAT(read(bytes).points.color, ElementsAre(Rgb{16, 32, 48}));
}

const std::string kAllFields =
    "FIELDS _ x y z r g b camera frame interpolated\nSIZE 1 8 8 8 1 1 1 1 4 1\n"
    "TYPE U F F F U U U I I U\nCOUNT 3 1 1 1 1 1 1 1 1 1\n";

TEST_F(PcdReaderTest, ReadsBinaryAndCompressedCloudsAlike) {
  std::string rows, columns;
  for (const int i : {0, 1}) {
    rows += "pad";
    for (const double x : {500000.25 + i, 2.0, 3.0}) put(rows, x);
    rows += {1, 2, static_cast<char>(200)};
    put(rows, static_cast<std::int8_t>(i == 0 ? 3 : kNoCamera));
    put(rows, 100 + i);
    put(rows, static_cast<std::uint8_t>(i));
  }
  std::size_t offset = 0;
  for (const std::size_t bytes : {3, 8, 8, 8, 1, 1, 1, 1, 4, 1}) {
    for (const std::size_t i : {0, 1}) columns += rows.substr(rows.size() / 2 * i + offset, bytes);
    offset += bytes;
  }
  for (const std::string& bytes :
       {header(kAllFields, "binary", 2) + rows, compressed(kAllFields, 2, columns)}) {
    const CloudFile cloud = read(bytes, {500000, 0, 0});
    EXPECT_THAT(cloud.points.position,
                ElementsAre(Eigen::Vector3f(0.25f, 2, 3), Eigen::Vector3f(1.25f, 2, 3)));
    EXPECT_THAT(cloud.points.color, ElementsAre(Rgb{1, 2, 200}, Rgb{1, 2, 200}));
    EXPECT_THAT(cloud.points.camera, ElementsAre(3, kNoCamera));
    EXPECT_THAT(cloud.points.frame, ElementsAre(100, 101));
    EXPECT_THAT(cloud.points.interpolated, ElementsAre(0, 1));
    EXPECT_TRUE(cloud.has_camera);
    expect_damage_is_harmless(bytes, [](const auto& file) { read_pcd(file, {0, 0, 0}); });
  }
}

TEST_F(PcdReaderTest, LeavesOutWhatWasNotMeasured) {
  const CloudFile cloud = read(header(kPacked, "ascii", 2) + "nan nan nan 0\n1 2 3 66051\n");
  EXPECT_THAT(cloud.points.position, ElementsAre(Eigen::Vector3f(1, 2, 3)));
  expect_rejected(header(kPacked, "ascii", 2) + "1 2 3 4\ninf 2 3 4\n", "point 1");
}

TEST_F(PcdReaderTest, CloudsWithoutColorsAreUncoloured) {
  const CloudFile cloud =
      read(header("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n", "ascii", 1) + "1 2 3");
  EXPECT_THAT(cloud.points.camera, ElementsAre(kNoCamera));
}

TEST_F(PcdReaderTest, RejectsMalformedClouds) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string bytes = header(kPacked, "ascii", 1) + "1 2 3 4\n";
    return bytes.replace(bytes.find(from), from.size(), to);
  };
  expect_rejected("", "no PCD file");
  expect_rejected("ply\nformat ascii 1.0\n", "no PCD file");
  expect_rejected(std::string(70000, 'x'), "64 KiB");
  expect_rejected(kPacked, "no DATA");
  expect_rejected(with("DATA ascii", "DATA hex"), "hex");
  expect_rejected(with("COUNT 1 1 1 1", "COUNT 1 1 1"), "one a field");
  expect_rejected(with("COUNT 1", "COUNT 2"), "COUNT 1");
  expect_rejected(with("COUNT 1", "COUNT 99999999999"), "too many numbers");
  expect_rejected(with("SIZE 4", "SIZE 3"), "type F and size 3");
  expect_rejected(with("TYPE F", "TYPE Q"), "type Q");
  expect_rejected(with("TYPE F", "TYPE U"), "type F");
  expect_rejected(with("SIZE 4 4 4 4", "SIZE 4 4 4 8"), "four bytes");
  expect_rejected(with("FIELDS x y", "FIELDS x w"), "no field y");
  expect_rejected(with("FIELDS x y z rgb", "FIELDS x y z r"), "not all there");
  expect_rejected(with("WIDTH 1", "WIDTH -1"), "\"-1\" is no count");
  expect_rejected(with("WIDTH 1", "WIDTH 2"), "POINTS");
  expect_rejected(with("WIDTH 1\nHEIGHT 1", "WIDTH 9999999999999999\nHEIGHT 9999999999999999"),
                  "too large");
  expect_rejected(with("VIEWPOINT", "VIEWPORT"), "VIEWPORT");
  expect_rejected(with("1 2 3 4\n", "1 2 3\n"), "too short");
  expect_rejected(with("1 2 3 4\n", "1.25 2 3\n"), "cloud:12");
  expect_rejected(with("1 2 3 4\n", "1.25 2 3 0.5\n"), "whole number");
  const std::string many = header(kPacked, "binary", 1'000'000'000);
  expect_rejected(many + "0123456789abcdef", "too short");
  expect_rejected(header(kPacked, "binary", 2) + "0123456789abcdef", "too short");
}

TEST_F(PcdReaderTest, PointsOf64KiBTakeNoMemoryWhereThereAreNone) {
  const std::string bytes =
      header("FIELDS x y z pad\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 65000\n", "binary", 0);
  EXPECT_LT(rise_of_peak_memory([&] { read(bytes); }), kMemoryOfASmallFile);
}

TEST_F(PcdReaderTest, RejectsDamagedCompression) {
  const std::string good = compressed(kPacked, 2, std::string(32, '\0'));
  ASSERT_EQ(read(good).points.size(), 2u);
  const std::size_t sizes = good.find("compressed\n") + 11;
  const auto with = [&](std::size_t offset, std::uint32_t value) {
    std::string bytes = good;
    put_at(bytes, sizes + offset, value);
    return bytes;
  };
  expect_rejected(with(0, 4000000000u), "too short");
  expect_rejected(with(4, 4000000000u), "size of the points");
  expect_rejected(with(8, 0xffffffffu), "damaged");
  expect_rejected(header(kPacked, "binary_compressed", 1) + "abc", "no sizes");
  EXPECT_THROW(read_pcd(folder_ / "missing.pcd", {0, 0, 0}), InputError);
  EXPECT_THROW(read_pcd(folder_, {0, 0, 0}), InputError);
}

}  // namespace fovea::pcd_reader_test
