#include "fovea/map/tile_columns.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "../../../tests/sample_map.h"
#include "fovea/map/value_plane.h"

namespace fovea::tile_columns_test {

constexpr std::size_t kCamera = 2, kFrame = 3;

std::vector<std::byte> bytes_of(std::initializer_list<int> values) {
  std::vector<std::byte> bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

PointCloud points_at_one_place(std::size_t count) {
  return one_point_each(std::vector<Eigen::Vector3f>(count, Eigen::Vector3f::Zero()));
}

TEST(PackedColumns, RunsAreTheirValuesByteByByteAndTheirLengths) {
  PointCloud tile = points_at_one_place(303);
  for (std::size_t i = 0; i < tile.size(); ++i) {
    tile.camera[i] = i < 2 ? 3 : i < 3 ? kNoCamera : 2;
    tile.frame[i] = i < 1 ? 0x04030201 : 7;
  }
  const PackedColumns columns = pack_columns(TilePoints::of(tile));
  // 300 points of camera 2 are more than a byte tells.
  EXPECT_EQ(columns[kCamera], bytes_of({3, 255, 2, 2, 1, 0, 255, 43}));
  EXPECT_EQ(columns[kFrame], bytes_of({1, 7, 7, 2, 0, 0, 3, 0, 0, 4, 0, 0, 0, 255, 45}));
}

TEST(PackedColumns, RunsOfAnyLengthComeBack) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (const std::size_t count : {1, 2, 255, 256, 257, 512, 513, 3000}) {
    PointCloud cloud = points_at_one_place(count);
    cloud.intensity.resize(count);
    for (std::size_t i = 0; i < count; ++i) cloud.intensity[i] = i % 1000 == 999 ? kNan : 0.25f;
    const TilePoints tile = TilePoints::of(cloud);
    const PackedColumns columns = pack_columns(tile);
    TilePoints back;
    for (std::size_t i = 0; i < kSaturatedColumn; ++i) {
      EXPECT_TRUE(packed_sizes(i, count).allow(columns[i].size())) << i << ' ' << count;
      EXPECT_TRUE(unpack_column(i, columns[i], count, back)) << i << ' ' << count;
    }
    expect_same_columns(back.cloud(), tile.cloud());
    EXPECT_EQ(pack_columns(back), columns);
  }
}

/// The k-th plane of a column of planes, without the differences.
std::vector<std::uint16_t> plane_of(const std::vector<std::byte>& bytes, std::size_t k,
                                    std::size_t count) {
  std::vector<std::uint16_t> values;
  unpack_plane(count, bytes.data() + k * kPlaneBytes * count, values);
  return values;
}

TEST(PackedColumns, ColorsAreCodesOfGreenAndOfRedAndBlueRelativeToIt) {
  PointCloud tile = points_at_one_place(2);
  tile.color = {{255, 128, 1}, {0, 64, 0}};
  const PackedColumns columns = pack_columns(TilePoints::of(tile));
  using Values = std::vector<std::uint16_t>;
  EXPECT_EQ(plane_of(columns[kColorColumn], 0, 2), (Values{2816, 2560}));
  EXPECT_EQ(plane_of(columns[kColorColumn], 1, 2), (Values{3071 - 2816, 65536 - 2560}));
  EXPECT_EQ(plane_of(columns[kColorColumn], 2, 2), (Values{65536 + 1024 - 2816, 65536 - 2560}));
}

TEST(PackedColumns, AllColorsOfEightBitsComeBack) {
  PointCloud tile = points_at_one_place(256 * 3);
  for (std::size_t i = 0; i < tile.size(); ++i) {
    const auto value = static_cast<std::uint8_t>(i / 3);
    tile.color[i] = {i % 3 == 0 ? value : std::uint8_t{7}, i % 3 == 1 ? value : std::uint8_t{255},
                     i % 3 == 2 ? value : std::uint8_t{0}};
  }
  TilePoints back;
  const PackedColumns columns = pack_columns(TilePoints::of(tile));
  EXPECT_TRUE(unpack_column(kColorColumn, columns[kColorColumn], tile.size(), back));
  for (std::size_t i = 0; i < tile.size(); ++i) EXPECT_EQ(back.colors[i].color, tile.color[i]);
}

TEST(PackedColumns, CodesBeyondTwelveBitsAreNotWhole) {
  const auto unpacks = [](std::uint16_t green, std::uint16_t red) {
    std::vector<std::byte> bytes(3 * kPlaneBytes);
    pack_plane(std::array<std::uint16_t, 1>{green}, bytes.data());
    pack_plane(std::array<std::uint16_t, 1>{red}, bytes.data() + kPlaneBytes);
    TilePoints tile;
    return unpack_column(kColorColumn, bytes, 1, tile);
  };
  EXPECT_TRUE(unpacks(4095, 0));
  EXPECT_FALSE(unpacks(4096, 0));
  EXPECT_FALSE(unpacks(4095, 1));
  EXPECT_FALSE(unpacks(0, 65535));
}

TEST(PackedColumns, ColumnsOfZerosTakeNoSpace) {
  TilePoints tile = TilePoints::of(points_at_one_place(3));
  tile.session.push_back(0, 3);
  tile.sensor.push_back(2, 3);
  const PackedColumns columns = pack_columns(tile);
  EXPECT_EQ(columns[12].size(), 0u);                       // saturated
  EXPECT_EQ(columns[13], bytes_of({2, 0, 2}));             // sensor
  EXPECT_EQ(columns[14].size() + columns[15].size(), 0u);  // sampling level, session
}

TEST(PackedColumns, SizesThatNoRunsHaveAreNotAllowed) {
  const PackedSizes sizes = packed_sizes(kFrame, 600);  // 5 bytes a run
  EXPECT_FALSE(sizes.allow(0));
  EXPECT_FALSE(sizes.allow(10));
  EXPECT_TRUE(sizes.allow(15));
  EXPECT_FALSE(sizes.allow(16));
  EXPECT_TRUE(sizes.allow(3000));
  EXPECT_FALSE(sizes.allow(3005));
}

TEST(PackedColumns, RunsOfOtherLengthsAreNotWhole) {
  TilePoints tile;
  EXPECT_TRUE(unpack_column(kCamera, bytes_of({2, 3, 1, 0}), 3, tile));
  EXPECT_FALSE(unpack_column(kCamera, bytes_of({2, 3, 0, 0}), 3, tile));
  EXPECT_FALSE(unpack_column(kCamera, bytes_of({2, 3, 1, 1}), 3, tile));
}

}  // namespace fovea::tile_columns_test
