#include "fovea/map/point_files/las_reader.h"

#include <gmock/gmock.h>

#include "../../../../tests/peak_memory.h"
#include "fovea/map/point_files/cloud_test_files.h"

namespace fovea::las_reader_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

using Color16 = std::array<std::uint16_t, 3>;

struct Format {
  int number, minor;
  std::size_t length, color;
};
constexpr Format kFormats[] = {{2, 2, 26, 20}, {3, 2, 34, 28}, {5, 3, 63, 28},
                               {7, 4, 36, 30}, {8, 4, 38, 30}, {10, 4, 67, 30}};

/// Points (100, 200, -300), (101, ...), ... in units of 0.01 m from (1000, 0, 0).
std::string las(const Format& format, const std::vector<Color16>& colors, std::size_t extra = 0) {
  const std::size_t header_bytes = format.minor == 4 ? 375 : format.minor == 3 ? 235 : 227;
  std::string bytes(header_bytes + 5, '\0');  // a gap before the points
  bytes.replace(0, 4, "LASF");
  put_at(bytes, 24, std::uint8_t{1});
  put_at(bytes, 25, static_cast<std::uint8_t>(format.minor));
  put_at(bytes, 94, static_cast<std::uint16_t>(header_bytes));
  put_at(bytes, 96, static_cast<std::uint32_t>(bytes.size()));
  put_at(bytes, 104, static_cast<std::uint8_t>(format.number));
  put_at(bytes, 105, static_cast<std::uint16_t>(format.length + extra));
  if (format.minor == 4) {
    put_at(bytes, 247, static_cast<std::uint64_t>(colors.size()));
  } else {
    put_at(bytes, 107, static_cast<std::uint32_t>(colors.size()));
  }
  for (const std::size_t axis : {0, 1, 2}) put_at(bytes, 131 + 8 * axis, 0.01);
  put_at(bytes, 155, 1000.0);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    std::string record(format.length + extra, '\0');
    put_at(record, 0, static_cast<std::int32_t>(100 + i));
    put_at(record, 4, std::int32_t{200});
    put_at(record, 8, std::int32_t{-300});
    for (const std::size_t c : {0, 1, 2}) put_at(record, format.color + 2 * c, colors[i][c]);
    bytes += record;
  }
  return bytes;
}

class LasReaderTest : public CloudFileTest {
 protected:
  CloudFile read(const std::string& content) const {
    return read_las(write(content), {1001, 0, 0});
  }
  void expect_rejected(const std::string& content, const std::string& why) const {
    EXPECT_THAT([&] { read(content); }, ThrowsMessage<InputError>(HasSubstr(why)));
  }
};

TEST_F(LasReaderTest, ReadsEveryFormatWithColors) {
  for (const Format& format : kFormats) {
    for (const std::size_t extra : {0, 7}) {
      const CloudFile cloud = read(las(format, {{65535, 65280, 0}, {257, 513, 0x8000}}, extra));
      ASSERT_EQ(cloud.points.size(), 2u) << format.number;
      EXPECT_TRUE(cloud.points.position[0].isApprox(Eigen::Vector3f(0, 2, -3), 1e-5f));
      EXPECT_NEAR(cloud.points.position[1].x(), 0.01f, 1e-5f);
      EXPECT_THAT(cloud.points.color, ElementsAre(Rgb{255, 255, 0}, Rgb{1, 2, 128}));
      EXPECT_THAT(cloud.points.camera, ElementsAre(0, 0));
      EXPECT_FALSE(cloud.has_camera);
    }
  }
}

TEST_F(LasReaderTest, TakesSmallColorsForEightBits) {
  EXPECT_THAT(read(las(kFormats[0], {{255, 1, 0}, {3, 2, 1}})).points.color,
              ElementsAre(Rgb{255, 1, 0}, Rgb{3, 2, 1}));
  EXPECT_THAT(read(las(kFormats[0], {{255, 1, 0}, {256, 2, 1}})).points.color,
              ElementsAre(Rgb{0, 0, 0}, Rgb{1, 0, 0}));
}

TEST_F(LasReaderTest, LeavesOutWithheldPoints) {
  for (const Format& format : kFormats) {
    std::string bytes = las(format, {{1, 1, 1}, {2, 2, 2}});
    const std::size_t first = bytes.size() - 2 * format.length;
    bytes[first + 15] = static_cast<char>(format.number >= 6 ? 1 << 2 : 1 << 7);
    EXPECT_THAT(read(bytes).points.color, ElementsAre(Rgb{2, 2, 2})) << format.number;
  }
}

TEST_F(LasReaderTest, FallsBackToTheLegacyCount) {
  std::string bytes = las(kFormats[3], {{1, 1, 1}});
  put_at(bytes, 247, std::uint64_t{0});
  put_at(bytes, 107, std::uint32_t{1});
  EXPECT_EQ(read(bytes).points.size(), 1u);
}

TEST_F(LasReaderTest, RejectsWhatItCannotRead) {
  const std::string good = las(kFormats[0], {{1, 1, 1}});
  const auto with = [&](std::size_t offset, auto value) {
    std::string bytes = good;
    put_at(bytes, offset, value);
    return bytes;
  };
  expect_rejected("", "no LAS file");
  expect_rejected("ply\n", "no LAS file");
  expect_rejected(good.substr(0, 200), "ends early");
  expect_rejected(with(25, std::uint8_t{1}), "LAS 1.1");
  expect_rejected(with(25, std::uint8_t{4}), "too short for its version");
  expect_rejected(with(94, std::uint16_t{10}), "too short for its version");
  expect_rejected(with(104, std::uint8_t{1}), "point format 1 has no colours");
  expect_rejected(with(104, std::uint8_t{2 + 128}), "laszip");
  expect_rejected(with(105, std::uint16_t{25}), "byte 105");
  expect_rejected(with(96, std::uint32_t{100}), "inside the header");
  expect_rejected(with(96, 4000000000u), "too short for its 1 points");
  expect_rejected(with(107, 4000000000u), "too short for its 4000000000 points");
  expect_rejected(with(131, 0.0), "scale");
  expect_rejected(with(139, std::nan("")), "scale");
  expect_rejected(with(171, std::numeric_limits<double>::infinity()), "byte 171");
  expect_rejected(with(155, 1e300), "point 0");
  std::string many = las(kFormats[3], {{1, 1, 1}});
  put_at(many, 247, ~std::uint64_t{0});
  expect_rejected(many, "too short");
  EXPECT_THROW(read_las(folder_ / "missing.las", {0, 0, 0}), InputError);
  EXPECT_THROW(read_las(folder_, {0, 0, 0}), InputError);
}

TEST_F(LasReaderTest, PointsOf64KiBTakeNoMemoryWhereThereAreNone) {
  std::string bytes = las(kFormats[0], {});
  put_at(bytes, 105, std::uint16_t{65535});
  EXPECT_LT(rise_of_peak_memory([&] { read(bytes); }), kMemoryOfASmallFile);
}

TEST_F(LasReaderTest, DamageIsHarmless) {
  for (const Format& format : {kFormats[0], kFormats[3]}) {
    expect_damage_is_harmless(las(format, {{1, 2, 3}, {4, 5, 6}}),
                              [](const auto& file) { read_las(file, {0, 0, 0}); });
  }
}

}  // namespace fovea::las_reader_test
