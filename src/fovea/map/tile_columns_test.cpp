#include "fovea/map/tile_columns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>

#include "../../../tests/sample_map.h"

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
    for (std::size_t i = 0; i < kStoredColumns; ++i) {
      EXPECT_TRUE(packed_sizes(i, count).allow(columns[i].size())) << i << ' ' << count;
      EXPECT_TRUE(unpack_column(i, columns[i], count, back)) << i << ' ' << count;
    }
    expect_same_columns(back.cloud(), tile.cloud());
    EXPECT_EQ(pack_columns(back), columns);
  }
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
